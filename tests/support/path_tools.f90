! SPDX-License-Identifier: MIT
!> One point, as the suites of the contract see it: a soil of named PROPS, a start, increments, and the answer with the
!> state by name. What the core keeps its parameters and its state in is known here alone.
module path_tools
   use mud_bonding, only: suction_law_t, is_bonded, bonding, bonding_t
   use mud_critical_state, only: critical_void_ratio, bounding_ratio, bounding_norm
   use mud_elastic, only: bulk_modulus
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
   use mud_preloading, only: log_contraction, NO_CONTRACTION, Y_LOG_CHI
   use mud_retention, only: retention_t, saturation_t, log_suction, on_main_curve_t, on_main_curve, main_curve, &
      path_t, saturation_after
   use mud_vector, only: NY, Y_Z, Y_Z_END
   implicit none (type, external)
   private
   public :: soil_t, point_t, counts_t, soil_of, material, changed, isotropic, general_start, update_between, advance, &
             rate_of_state, undrained, axial_only, triaxial, mean_stress, shear_stress, distance, full, rotation
   !> What the laws say of a soil.
   public :: bulk_modulus_of, bonding_factor_of, critical_void_ratio_of, bounding_ratio_of, bounding_norm_of, &
             main_saturation_of, saturation_scanned
   !> For suites of single laws: the parameters and the vector as the core has them.
   public :: parameters, vector_of, suction_law, retention_with

   !> Parameters of a soil: those of PROPS by their index, and as the core reads them, for suites of single laws.
   type :: soil_t
      real(wp) :: props(NPROPS)
      type(params_t) :: laws
   end type soil_t

   !> A point, in the terms of STATEV.
   type :: point_t
      real(wp) :: sigma(6)         !< effective stress [kPa], compression positive
      real(wp) :: z(6)             !< fabric [-]
      real(wp) :: e, gap           !< void ratio, with the gap, and the part of it that is gap [-]
      real(wp) :: margin           !< of the isotropic memory [-]
      real(wp) :: fluidity         !< [-]
      real(wp) :: p_c, s_w         !< suction [kPa], degree of saturation [-]
      real(wp) :: psi              !< state parameter [-]
      real(wp) :: eps_q_total      !< plastic shear of all processes [-]
      real(wp) :: last_step        !< size of the substep proposed last [-]
      real(wp) :: from_centre(6)   !< strain from the centre of the elastic domain [-]
      logical :: open              !< held by the tension cut-off
      real(wp) :: r_in(6)          !< memory of the present process [-]
      real(wp) :: r_before(6)      !< that of the process before [-]
      real(wp) :: direction(6)     !< in which the present one moves the stress ratio [-]
      real(wp) :: target           !< what it has reached along that [-]
      real(wp) :: eps_q_p          !< its plastic shear [-]
      real(wp) :: chi, chi_own     !< contraction of all processes and of the present one [-]
      integer :: depth             !< interrupted processes
      type(state_t), private :: kept   !< the rest of the state; what stands above counts
   end type point_t

   !> What updates did.
   type :: counts_t
      integer :: rate = 0, substep = 0, reject = 0, reset = 0, floor = 0, cap_d = 0, cap_h = 0, hysteresis = 0, &
                 iso_kept = 0, no_root = 0, min_step = 0, open = 0, tensile = 0
   end type counts_t
contains
   !> The soil of PROPS; an entry that is not accepted stops the test program.
   function soil_of(props) result(soil)
      real(wp), intent(in) :: props(NPROPS)
      type(soil_t) :: soil
      type(mud_status_t) :: status

      soil%props = props
      call read_params(props, soil%laws, status)
      if (status%code /= 0) error stop 'path_tools: a parameter of the test is not accepted'
   end function soil_of

   !> The parameters of the paper, so without elastic domain, with some entries changed.
   function material(entries, values) result(soil)
      integer, intent(in), optional :: entries(:)   !< P_*
      real(wp), intent(in), optional :: values(:)
      type(soil_t) :: soil
      real(wp) :: props(NPROPS)

      props = default_props()
      props(P_RHO_E) = 0.0_wp
      if (present(entries) .and. present(values)) props(entries) = values
      soil = soil_of(props)
   end function material

   !> A soil with some entries changed.
   function changed(soil, entries, values) result(other)
      type(soil_t), intent(in) :: soil
      integer, intent(in) :: entries(:)   !< P_*
      real(wp), intent(in) :: values(:)
      type(soil_t) :: other
      real(wp) :: props(NPROPS)

      props = soil%props
      props(entries) = values
      other = soil_of(props)
   end function changed

   !> The parameters of `material` as the core has them.
   function parameters(entries, values) result(par)
      integer, intent(in), optional :: entries(:)
      real(wp), intent(in), optional :: values(:)
      type(params_t) :: par
      type(soil_t) :: soil

      soil = material(entries, values)
      par = soil%laws
   end function parameters

   !> A point at an isotropic stress, without a past.
   function isotropic(soil, p, e, p_c) result(point)
      type(soil_t), intent(in) :: soil
      real(wp), intent(in) :: p, e
      real(wp), intent(in), optional :: p_c
      type(point_t) :: point

      point = general_start(soil, p*IDENTITY, e, p_c)
   end function isotropic

   !> A point at any stress, without a past.
   function general_start(soil, sigma, e, p_c) result(point)
      type(soil_t), intent(in) :: soil
      real(wp), intent(in) :: sigma(6), e
      real(wp), intent(in), optional :: p_c
      type(point_t) :: point
      type(state_t) :: state
      type(mud_status_t) :: status
      real(wp) :: suction

      suction = 0.0_wp
      if (present(p_c)) suction = p_c
      call initial_state(soil%laws, sigma, e, suction, state, status)
      if (status%code /= 0) error stop 'path_tools: a start of the test is not accepted'
      call see(state, point)
   end function general_start

   !> The point of a state of the core.
   pure subroutine see(state, point)
      type(state_t), intent(in) :: state
      type(point_t), intent(inout) :: point

      point%sigma = state%sigma
      point%z = state%z
      point%e = state%e
      point%gap = state%gap
      point%margin = state%margin
      point%fluidity = state%fluidity
      point%p_c = state%p_c
      point%s_w = state%s_w
      point%psi = state%psi
      point%eps_q_total = state%eps_q_total
      point%last_step = state%last_step
      point%from_centre = state%from_centre
      point%open = state%open
      point%r_in = state%memory%r_in
      point%r_before = state%memory%r_before
      point%direction = state%memory%direction
      point%target = state%memory%target
      point%eps_q_p = state%memory%eps_q_p
      point%chi = state%memory%chi
      point%chi_own = state%memory%chi_own
      point%depth = state%memory%depth
      point%kept = state
   end subroutine see

   !> The state of the core of a point.
   pure subroutine take(point, state)
      type(point_t), intent(in) :: point
      type(state_t), intent(inout) :: state

      state = point%kept
      state%sigma = point%sigma
      state%z = point%z
      state%e = point%e
      state%gap = point%gap
      state%margin = point%margin
      state%fluidity = point%fluidity
      state%p_c = point%p_c
      state%s_w = point%s_w
      state%psi = point%psi
      state%eps_q_total = point%eps_q_total
      state%last_step = point%last_step
      state%from_centre = point%from_centre
      state%open = point%open
      state%memory%r_in = point%r_in
      state%memory%r_before = point%r_before
      state%memory%direction = point%direction
      state%memory%target = point%target
      state%memory%eps_q_p = point%eps_q_p
      state%memory%chi = point%chi
      state%memory%chi_own = point%chi_own
      state%memory%depth = point%depth
   end subroutine take

   !> One increment from a point that stays, its counts added up; `reached` is the share of it that was integrated.
   !> Where status%code is not 0, `after` and `blocks` are undefined.
   subroutine update_between(soil, before, d_strain, d_pc, tangent, after, blocks, counts, reached, status, record)
      type(soil_t), intent(in) :: soil
      type(point_t), intent(in) :: before
      real(wp), intent(in) :: d_strain(6), d_pc
      integer, intent(in) :: tangent                 !< TANGENT_*
      type(point_t), intent(inout) :: after
      type(blocks_t), intent(inout) :: blocks
      type(counts_t), intent(inout) :: counts
      real(wp), intent(out) :: reached
      type(mud_status_t), intent(out) :: status
      type(trace_t), intent(inout), optional :: record
      type(integration_t) :: it

      it%traced = present(record)
      if (present(record)) it%trace = record
      call take(before, it%state)
      call update_point(soil%laws, d_strain, d_pc, tangent, it, blocks)
      call see(it%state, after)
      call add(counts, it%counters)
      reached = it%reached
      status = it%status
      if (present(record)) record = it%trace
   end subroutine update_between

   !> Goes along a straight path in equal increments; stops at the first one that fails.
   subroutine advance(soil, point, d_strain, d_pc, increments, counts, code)
      type(soil_t), intent(in) :: soil
      type(point_t), intent(inout) :: point
      real(wp), intent(in) :: d_strain(6), d_pc      !< of the whole path
      integer, intent(in) :: increments
      type(counts_t), intent(inout), optional :: counts
      integer, intent(out), optional :: code         !< without it a failure stops the test program
      type(point_t) :: next
      type(blocks_t) :: blocks
      type(counts_t) :: unasked
      type(mud_status_t) :: status
      real(wp) :: reached
      integer :: i

      if (present(code)) code = 0
      do i = 1, increments
         if (present(counts)) then
            call update_between(soil, point, d_strain/increments, d_pc/increments, TANGENT_NONE, next, blocks, counts, &
                                reached, status)
         else
            call update_between(soil, point, d_strain/increments, d_pc/increments, TANGENT_NONE, next, blocks, &
                                unasked, reached, status)
         end if
         if (status%code /= 0) then
            if (.not. present(code)) then
               print '(a, i0, a, i0)', 'path_tools: increment ', i, ' ended with code ', status%code
               error stop 1
            end if
            code = status%code
            return
         end if
         point = next
      end do
   end subroutine advance

   !> Sums of the counters: an update counts its own substeps only.
   subroutine add(counts, more)
      type(counts_t), intent(inout) :: counts
      type(counters_t), intent(in) :: more

      counts%rate = counts%rate + more%rate
      counts%substep = counts%substep + more%substep
      counts%reject = counts%reject + more%reject
      counts%reset = counts%reset + more%reset
      counts%floor = counts%floor + more%floor
      counts%cap_d = counts%cap_d + more%cap_d
      counts%cap_h = counts%cap_h + more%cap_h
      counts%hysteresis = counts%hysteresis + more%held_back
      counts%iso_kept = counts%iso_kept + more%iso_kept
      counts%no_root = counts%no_root + more%no_root
      counts%min_step = counts%min_step + more%min_step
      counts%open = counts%open + more%open
      counts%tensile = counts%tensile + more%tensile
   end subroutine add

   !> One ordinary rate at a point.
   function rate_of_state(soil, point, d_strain, d_pc) result(w)
      type(soil_t), intent(in) :: soil
      type(point_t), intent(in) :: point
      real(wp), intent(in) :: d_strain(6), d_pc
      type(rate_t) :: w
      type(suction_law_t) :: law

      law = soil%laws%suction
      law%bonds = is_bonded(law, max(point%p_c, point%p_c + d_pc))
      call rate_at(soil%laws, &
                   vector_of(point%sigma, point%z, log_contraction(point%chi, point%chi_own), point%fluidity), &
                   conditions_t(bond=bonding(law, point%p_c, point%e), e=point%e, r_in=point%r_in), &
                   d_strain, d_pc, MODE_ORDINARY, w)
   end function rate_of_state

   !> Bulk modulus at a void ratio and a mean stress p [kPa].
   pure real(wp) function bulk_modulus_of(soil, e, p)
      type(soil_t), intent(in) :: soil
      real(wp), intent(in) :: e, p

      bulk_modulus_of = bulk_modulus(soil%laws%elastic, e, p)
   end function bulk_modulus_of

   !> f(zeta) at a point.
   pure real(wp) function bonding_factor_of(soil, point)
      type(soil_t), intent(in) :: soil
      type(point_t), intent(in) :: point
      type(bonding_t) :: bond

      bond = bonding(soil%laws%suction, point%p_c, point%e)
      bonding_factor_of = bond%f
   end function bonding_factor_of

   !> Critical void ratio without suction at a mean stress p [kPa].
   pure real(wp) function critical_void_ratio_of(soil, p)
      type(soil_t), intent(in) :: soil
      real(wp), intent(in) :: p

      critical_void_ratio_of = critical_void_ratio(soil%laws%critical, 1.0_wp, p)
   end function critical_void_ratio_of

   !> M^b of a state parameter.
   pure real(wp) function bounding_ratio_of(soil, psi)
      type(soil_t), intent(in) :: soil
      real(wp), intent(in) :: psi

      bounding_ratio_of = bounding_ratio(soil%laws%critical, psi)
   end function bounding_ratio_of

   !> Norm of the bounding stress ratio in the direction of r at M^b = m_b.
   pure real(wp) function bounding_norm_of(soil, r, m_b)
      type(soil_t), intent(in) :: soil
      real(wp), intent(in) :: r(6), m_b

      bounding_norm_of = bounding_norm(soil%laws%critical, r, norm(r), m_b)
   end function bounding_norm_of

   !> S_w of a main curve, of drying or of wetting, at a suction [kPa] and a void ratio.
   pure real(wp) function main_saturation_of(soil, dries, p_c, e)
      type(soil_t), intent(in) :: soil
      logical, intent(in) :: dries
      real(wp), intent(in) :: p_c, e
      type(on_main_curve_t) :: on

      associate (retention => soil%laws%suction%retention_t)
         on = on_main_curve(retention, main_curve(retention, dries), log_suction(retention, p_c, e))
      end associate
      main_saturation_of = on%s_w
   end function main_saturation_of

   !> S_w to which a suction [kPa] brings a point at its void ratio, along the branch that its turns leave.
   pure real(wp) function saturation_scanned(soil, point, p_c)
      type(soil_t), intent(in) :: soil
      type(point_t), intent(in) :: point
      real(wp), intent(in) :: p_c
      type(saturation_t) :: sat
      type(retention_t) :: branch
      type(path_t) :: path

      associate (retention => soil%laws%suction%retention_t)
         path = path_t(log_suction(retention, point%p_c, point%e), point%s_w, point%kept%turns)
         call saturation_after(retention, p_c, point%e, path, sat, branch)
      end associate
      saturation_scanned = sat%s_w
   end function saturation_scanned

   !> What suction does to such a material.
   function suction_law(entries, values) result(law)
      integer, intent(in), optional :: entries(:)
      real(wp), intent(in), optional :: values(:)
      type(suction_law_t) :: law
      type(params_t) :: par

      par = parameters(entries, values)
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

   pure real(wp) function mean_stress(point)
      type(point_t), intent(in) :: point

      mean_stress = trace(point%sigma)/3.0_wp
   end function mean_stress

   !> q = sigma_11 - sigma_33, for triaxial paths along axis 1.
   pure real(wp) function shear_stress(point)
      type(point_t), intent(in) :: point

      shear_stress = point%sigma(1) - point%sigma(3)
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
