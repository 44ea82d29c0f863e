! SPDX-License-Identifier: MIT
!> Material, start and path of one point, as the contract tests use them.
module path_tools
   use mud_bonding, only: suction_law_t, is_bonded, bonding
   use mud_integration, only: integration_t
   use mud_kinds, only: wp
   use mud_params, only: params_t, read_params, default_props
   use mud_point, only: update_point, TANGENT_NONE
   use mud_rate, only: rate_t
   use mud_rates, only: rate_at, conditions_t, MODE_ORDINARY
   use mud_registry, only: NPROPS, P_RHO_E
   use mud_state, only: state_t, counters_t
   use mud_status, only: mud_status_t
   use mud_tensor, only: IDENTITY, trace, norm
   use mud_blocks, only: blocks_t
   use mud_start, only: initial_state
   use mud_trace, only: trace_t
   use random_states, only: random_t, uniform
   use mud_fluidity, only: Y_FLUIDITY
   use mud_preloading, only: NO_CONTRACTION, Y_LOG_CHI
   use mud_retention, only: retention_t
   use mud_vector, only: NY, Y_Z, Y_Z_END
   implicit none (type, external)
   private
   public :: material, isotropic, general_start, update_between, advance, rate_of_state, undrained, axial_only, &
             triaxial, mean_stress, shear_stress, distance, full, rotation, vector_of, suction_law, retention_with

contains
   !> The parameters of the paper, so without elastic domain, with some entries changed; an entry that is not accepted
   !> stops the test program.
   function material(entries, values) result(par)
      integer, intent(in), optional :: entries(:)   !< P_*
      real(wp), intent(in), optional :: values(:)
      type(params_t) :: par
      type(mud_status_t) :: status
      real(wp) :: props(NPROPS)

      props = default_props()
      props(P_RHO_E) = 0.0_wp
      if (present(entries) .and. present(values)) props(entries) = values
      call read_params(props, par, status)
      if (status%code /= 0) error stop 'path_tools: a parameter of the test is not accepted'
   end function material

   !> A point at an isotropic stress, without a past.
   function isotropic(par, p, e, p_c) result(state)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: p, e
      real(wp), intent(in), optional :: p_c
      type(state_t) :: state

      state = general_start(par, p*IDENTITY, e, p_c)
   end function isotropic

   !> A point at any stress, without a past.
   function general_start(par, sigma, e, p_c) result(state)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: sigma(6), e
      real(wp), intent(in), optional :: p_c
      type(state_t) :: state
      type(mud_status_t) :: status
      real(wp) :: suction

      suction = 0.0_wp
      if (present(p_c)) suction = p_c
      call initial_state(par, sigma, e, suction, state, status)
      if (status%code /= 0) error stop 'path_tools: a start of the test is not accepted'
   end function general_start

   !> One increment from a state that stays. Arguments as in update_point, counters added up.
   subroutine update_between(par, before, d_strain, d_pc, tangent, after, blocks, counters, reached, status, record)
      type(params_t), intent(in) :: par
      type(state_t), intent(in) :: before
      real(wp), intent(in) :: d_strain(6), d_pc
      integer, intent(in) :: tangent
      type(state_t), intent(inout) :: after
      type(blocks_t), intent(inout) :: blocks
      type(counters_t), intent(inout) :: counters
      real(wp), intent(out) :: reached
      type(mud_status_t), intent(out) :: status
      type(trace_t), intent(inout), optional :: record
      type(integration_t) :: it

      it%traced = present(record)
      if (present(record)) it%trace = record
      it%state = before
      it%counters = counters
      call update_point(par, d_strain, d_pc, tangent, it, blocks)
      after = it%state
      counters = it%counters
      reached = it%reached
      status = it%status
      if (present(record)) record = it%trace
   end subroutine update_between

   !> Goes along a straight path in equal increments; stops at the first one that fails.
   subroutine advance(par, state, d_strain, d_pc, increments, counters, code)
      type(params_t), intent(in) :: par
      type(state_t), intent(inout) :: state
      real(wp), intent(in) :: d_strain(6), d_pc      !< of the whole path
      integer, intent(in) :: increments
      type(counters_t), intent(inout), optional :: counters
      integer, intent(out), optional :: code         !< without it a failure stops the test program
      type(state_t) :: next
      type(blocks_t) :: blocks
      type(counters_t) :: sums
      type(mud_status_t) :: status
      real(wp) :: reached
      integer :: i

      if (present(code)) code = 0
      do i = 1, increments
         sums = counters_t()
         call update_between(par, state, d_strain/increments, d_pc/increments, TANGENT_NONE, next, blocks, sums, &
                             reached, status)
         if (present(counters)) call add(counters, sums)
         if (status%code /= 0) then
            if (.not. present(code)) then
               print '(a, i0, a, i0)', 'path_tools: increment ', i, ' ended with code ', status%code
               error stop 1
            end if
            code = status%code
            return
         end if
         state = next
      end do
   end subroutine advance

   !> Sums of the counters: an update counts its own substeps only.
   subroutine add(counters, more)
      type(counters_t), intent(inout) :: counters
      type(counters_t), intent(in) :: more

      counters%rate = counters%rate + more%rate
      counters%substep = counters%substep + more%substep
      counters%reject = counters%reject + more%reject
      counters%reset = counters%reset + more%reset
      counters%floor = counters%floor + more%floor
      counters%cap_d = counters%cap_d + more%cap_d
      counters%cap_h = counters%cap_h + more%cap_h
      counters%hysteresis = counters%hysteresis + more%hysteresis
      counters%iso_kept = counters%iso_kept + more%iso_kept
      counters%no_root = counters%no_root + more%no_root
      counters%min_step = counters%min_step + more%min_step
      counters%open = counters%open + more%open
      counters%tensile = counters%tensile + more%tensile
   end subroutine add

   !> One ordinary rate at a state.
   function rate_of_state(par, state, d_strain, d_pc) result(w)
      type(params_t), intent(in) :: par
      type(state_t), intent(in) :: state
      real(wp), intent(in) :: d_strain(6), d_pc
      type(rate_t) :: w
      type(suction_law_t) :: law

      law = par%suction
      law%bonds = is_bonded(law, max(state%p_c, state%p_c + d_pc))
      call rate_at(par, vector_of(state%sigma, state%z), &
                   conditions_t(bond=bonding(law, state%p_c, state%e), e=state%e, r_in=state%memory%r_in), &
                   d_strain, d_pc, MODE_ORDINARY, w)
   end function rate_of_state

   !> What suction does to such a material.
   function suction_law(entries, values) result(law)
      integer, intent(in), optional :: entries(:)
      real(wp), intent(in), optional :: values(:)
      type(suction_law_t) :: law
      type(params_t) :: par

      par = material(entries, values)
      law = par%suction
   end function suction_law

   !> The retention of such a material.
   function retention_with(entries, values) result(retention)
      integer, intent(in), optional :: entries(:)
      real(wp), intent(in), optional :: values(:)
      type(retention_t) :: retention
      type(suction_law_t) :: law

      law = suction_law(entries, values)
      retention = law%retention_t
   end function retention_with

   !> The integrated vector of stress [kPa] and fabric, of ln of the contraction that others left, and of a fluidity.
   pure function vector_of(sigma, z, log_chi, ell) result(y)
      real(wp), intent(in) :: sigma(6), z(6)
      real(wp), intent(in), optional :: log_chi, ell
      real(wp) :: y(NY)

      y = 0.0_wp
      y(1:6) = sigma
      y(Y_Z:Y_Z_END) = z
      y(Y_LOG_CHI) = NO_CONTRACTION
      if (present(log_chi)) y(Y_LOG_CHI) = log_chi
      if (present(ell)) y(Y_FLUIDITY) = ell
   end function vector_of

   !> Triaxial strain at constant volume, axis 1.
   pure function undrained(eps_a) result(strain)
      real(wp), intent(in) :: eps_a
      real(wp) :: strain(6)

      strain = eps_a*[1.0_wp, -0.5_wp, -0.5_wp, 0.0_wp, 0.0_wp, 0.0_wp]
   end function undrained

   !> Oedometric strain, axis 1.
   pure function axial_only(eps_a) result(strain)
      real(wp), intent(in) :: eps_a
      real(wp) :: strain(6)

      strain = [eps_a, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]
   end function axial_only

   !> Triaxial stress of a mean stress and a q along axis 1.
   pure function triaxial(p, q) result(sigma)
      real(wp), intent(in) :: p, q
      real(wp) :: sigma(6)

      sigma = p*IDENTITY + q/3.0_wp*[2.0_wp, -1.0_wp, -1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]
   end function triaxial

   pure real(wp) function mean_stress(state)
      type(state_t), intent(in) :: state

      mean_stress = trace(state%sigma)/3.0_wp
   end function mean_stress

   !> q = sigma_11 - sigma_33, for triaxial paths along axis 1.
   pure real(wp) function shear_stress(state)
      type(state_t), intent(in) :: state

      shear_stress = state%sigma(1) - state%sigma(3)
   end function shear_stress

   !> |a - b|/|b|
   pure real(wp) function distance(a, b)
      real(wp), intent(in) :: a(6), b(6)

      distance = norm(a - b)/norm(b)
   end function distance

   !> The 3 x 3 matrix of six components.
   pure function full(a) result(matrix)
      real(wp), intent(in) :: a(6)
      real(wp) :: matrix(3, 3)

      matrix(1, :) = [a(1), a(4), a(5)]
      matrix(2, :) = [a(4), a(2), a(6)]
      matrix(3, :) = [a(5), a(6), a(3)]
   end function full

   !> A random rotation matrix, from a random unit quaternion.
   function rotation(random) result(r)
      type(random_t), intent(inout) :: random
      real(wp) :: r(3, 3), q(4)
      integer :: i

      do i = 1, 4
         q(i) = uniform(random, -1.0_wp, 1.0_wp)
      end do
      q = q/sqrt(sum(q**2))
      r(1, :) = [1 - 2*(q(3)**2 + q(4)**2), 2*(q(2)*q(3) - q(1)*q(4)), 2*(q(2)*q(4) + q(1)*q(3))]
      r(2, :) = [2*(q(2)*q(3) + q(1)*q(4)), 1 - 2*(q(2)**2 + q(4)**2), 2*(q(3)*q(4) - q(1)*q(2))]
      r(3, :) = [2*(q(2)*q(4) - q(1)*q(3)), 2*(q(3)*q(4) + q(1)*q(2)), 1 - 2*(q(2)**2 + q(3)**2)]
   end function rotation
end module path_tools
