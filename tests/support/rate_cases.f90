! SPDX-License-Identifier: MIT
!> Random arguments of a rate, by kind of state, for tests of derivatives.
module rate_cases
   use mud_bonding, only: suction_law_t, bonding
   use mud_kinds, only: wp
   use mud_params, only: params_t, read_params, default_props
   use mud_critical_state, only: bounding_norm
   use mud_rate, only: rate_t
   use mud_rates, only: rate_at, conditions_t, MODE_ORDINARY, MODE_ELASTIC
   use mud_status, only: mud_status_t
   use mud_registry, only: P_G_0, P_K_0, P_M_C, P_N_B, P_N_D, P_H_0, P_A_0
   use mud_tensor, only: IDENTITY, norm, ddot, deviator
   use path_tools, only: parameters, vector_of
   use random_states, only: random_t, uniform, log_uniform, random_tensor, random_deviator
   implicit none (type, external)
   private
   public :: case_t, random_case, rising_case, evaluate, same_branch, law_in

   !> A rate's arguments.
   type :: case_t
      type(params_t) :: par
      real(wp) :: sigma(6), e, p_c, z(6), r_in(6), d_strain(6), d_pc
      integer :: mode = MODE_ORDINARY
   end type case_t
contains
   !> True if the same pieces of every min, max and < > act, and the direction has not jumped to another root.
   logical function same_branch(a, b)
      type(rate_t), intent(in) :: a, b

      same_branch = (a%loading .eqv. b%loading) .and. (a%iso_active .eqv. b%iso_active) .and. &
                    (a%floored .eqv. b%floored) .and. (a%capped_d .eqv. b%capped_d) .and. &
                    (a%capped_h .eqv. b%capped_h) .and. (a%iso_kept .eqv. b%iso_kept)
      if (.not. same_branch) return
      if (a%loading) same_branch = (a%z_n > 0.0_wp .eqv. b%z_n > 0.0_wp) .and. norm(a%n - b%n) < 0.1_wp
   end function same_branch

   subroutine evaluate(this, d_strain, d_pc, w, near)
      type(case_t), intent(in) :: this
      real(wp), intent(in) :: d_strain(6), d_pc
      type(rate_t), intent(inout) :: w
      type(rate_t), intent(in), optional :: near   !< as rate_at has it

      call rate_at(this%par, vector_of(this%sigma, this%z), &
                   conditions_t(bond=bonding(law_in(this), this%p_c, this%e), e=this%e, r_in=this%r_in), &
                   d_strain, d_pc, this%mode, w, near)
   end subroutine evaluate

   !> The suction law of its phase, which bonds where there is suction.
   pure function law_in(this) result(law)
      type(case_t), intent(in) :: this
      type(suction_law_t) :: law

      law = this%par%suction
      law%bonds = this%p_c > 0.0_wp
   end function law_in

   !> A random state of a kind, with stress ratios up to and beyond the bounding surface.
   function random_case(random, kind) result(this)
      type(random_t), intent(inout) :: random
      character(*), intent(in) :: kind
      type(case_t) :: this
      type(mud_status_t) :: status
      type(rate_t) :: w
      real(wp) :: p, r(6), q(6)

      call read_params(default_props(), this%par, status)
      this%e = uniform(random, 0.5_wp, 1.1_wp)
      p = log_uniform(random, 1.0_wp, 5000.0_wp)
      if (kind == 'low') p = this%par%p_min*uniform(random, 1.0_wp, 3.0_wp)
      this%p_c = 0.0_wp
      this%d_pc = 0.0_wp
      if (kind == 'unsaturated') this%p_c = log_uniform(random, 1.0_wp, 1.0e4_wp)
      if (kind == 'critical') then
         this%e = this%par%critical%n_c*(p + this%par%critical%alpha_csl)**(-this%par%critical%lambda) &
            + uniform(random, -1.0e-3_wp, 1.0e-3_wp)
      end if
      this%z = uniform(random, 0.0_wp, 4.0_wp)*random_deviator(random)
      this%r_in = 0.0_wp
      this%sigma = p*IDENTITY
      this%d_strain = 1.0e-3_wp*random_tensor(random)
      call evaluate(this, this%d_strain, 0.0_wp, w)
      r = random_deviator(random)
      r = uniform(random, 0.0_wp, 1.1_wp)*bounding_norm(this%par%critical, r, norm(r), w%m_b)*r
      this%sigma = p*(r + IDENTITY)
      this%r_in = r - uniform(random, 0.0_wp, 1.0_wp)*random_deviator(random)
      select case (kind)
      case ('turning')
         ! (r - r_in):n small or negative, n across r
         this%r_in = r + uniform(random, -1.0e-2_wp, 1.0e-2_wp)*random_deviator(random)
      case ('unsaturated')
         this%d_pc = uniform(random, -1.0_wp, 1.0_wp)*1.0e-3_wp*w%k
      case ('elastic')
         this%mode = MODE_ELASTIC
      case ('kink')
         ! at r = 0 the direction is that of the strain, so x is known beforehand
         this%sigma = p*IDENTITY
         r = deviator(this%d_strain)/norm(deviator(this%d_strain))
         q = random_deviator(random)
         q = q - ddot(q, r)*r
         this%r_in = -this%par%x_floor*((1.0_wp + uniform(random, -1.0e-8_wp, 1.0e-8_wp))*r + q)
      end select
   end function random_case

   !> A random sand and state in which (r - r_in):n begins below its floor and passes it as n turns from t towards r:
   !> with much fabric and dilatancy the direction equation of the floor then has a root before it passes, and that of
   !> the rising x another behind. Parameters beyond those of published sands make both frequent.
   function rising_case(random) result(this)
      type(random_t), intent(inout) :: random
      type(case_t) :: this
      type(rate_t) :: w
      real(wp) :: p, r(6), along(6), across(6), before, beside

      this%par = parameters([P_G_0, P_K_0, P_M_C, P_N_B, P_N_D, P_H_0, P_A_0], &
                          [uniform(random, 40.0_wp, 300.0_wp), uniform(random, 40.0_wp, 600.0_wp), &
                           uniform(random, 0.9_wp, 1.8_wp), uniform(random, 0.5_wp, 4.0_wp), &
                           uniform(random, 0.5_wp, 8.0_wp), log_uniform(random, 1.0_wp, 50.0_wp), &
                           uniform(random, 0.2_wp, 3.0_wp)])
      this%e = uniform(random, 0.5_wp, 1.1_wp)
      p = log_uniform(random, this%par%p_min, 5000.0_wp)
      this%p_c = 0.0_wp
      this%d_pc = 0.0_wp
      r = random_deviator(random)
      ! one after the other: the order of functions in an expression is the compiler's
      this%z = uniform(random, -4.0_wp, 4.0_wp)*r
      beside = uniform(random, 0.0_wp, 2.0_wp)
      this%z = this%z + beside*random_deviator(random)
      this%d_strain = 1.0e-3_wp*random_tensor(random)
      this%r_in = 0.0_wp
      this%sigma = p*IDENTITY
      call evaluate(this, this%d_strain, 0.0_wp, w)
      r = uniform(random, 0.0_wp, 1.05_wp)*bounding_norm(this%par%critical, r, norm(r), w%m_b)*r
      this%sigma = p*(r + IDENTITY)
      this%r_in = r
      ! t does not depend on the memory
      call evaluate(this, this%d_strain, 0.0_wp, w)
      along = w%t/w%t_norm
      across = w%r - ddot(w%r, along)*along
      across = across/max(norm(across), epsilon(p))
      before = this%par%x_floor*uniform(random, -30.0_wp, 1.0_wp)
      beside = log_uniform(random, 3.0e-3_wp, 1.5_wp)
      this%r_in = r - before*along - sign(beside, uniform(random, -1.0_wp, 1.0_wp))*across
   end function rising_case
end module rate_cases
