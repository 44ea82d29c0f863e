!> Memory of loading processes: when a new one begins, and what each rule then does with the memory.
!> Jumps only: they happen between substeps, never inside a rate.
module mud_reversal
   use mud_kinds, only: wp
   use mud_params, only: params_t
   use mud_registry, only: RULE_THRESHOLD, RULE_REPOSITIONING, RULE_RESUME
   use mud_state, only: memory_t
   use mud_tensor, only: ddot, norm
   implicit none (type, external)
   private
   public :: new_memory, reseat, accept_process, turns_back, begin_way_back, leave_way_back, way_back_distance, &
             resume_process, forget_process

   real(wp), parameter :: BALL = 1.5_wp   !< An elastic way back may leave r_turn by this factor (rule resume) [-].
contains
   !> Memory of a point that starts at, or comes back without a past to, the stress ratio r.
   pure function new_memory(r) result(memory)
      real(wp), intent(in) :: r(6)
      type(memory_t) :: memory

      memory%r_in = r
      memory%r_before = r
      memory%r_turn = 0.0_wp
      memory%n_turn = 0.0_wp
      memory%eps_q_p = 0.0_wp
      memory%x_before = 0.0_wp
      memory%x_running = 0.0_wp
      memory%way_back = 0.0_wp
      memory%suspended = .false.
   end function new_memory

   !> A new loading process begins at r in the direction n, with an elastic rate of the stress ratio along t.
   pure subroutine reseat(par, r, n, t, memory)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: r(6), n(6), t(6)
      type(memory_t), intent(inout) :: memory
      real(wp) :: r_in(6), x_before

      r_in = r
      select case (par%memory_rule)
      case (RULE_THRESHOLD)
         ! Paper eq. (15), mended: the weight (1 - m) belongs to the current back-stress.
         r_in = r + interrupted_share(par, memory%eps_q_p)*(memory%r_before - r)
         if (ddot(r - r_in, n) < 0.0_wp) r_in = r
         memory%r_before = memory%r_in
      case (RULE_REPOSITIONING)
         ! Comput. Mech. 71:385-408, eqs (16), (17).
         x_before = memory%x_before
         memory%x_before = memory%x_running
         r_in = r - interrupted_share(par, memory%eps_q_p)*x_before*n
         memory%r_before = memory%r_in
      case (RULE_RESUME)
         if (memory%suspended) then
            memory%r_in = r
            memory%x_running = 0.0_wp
            return
         end if
         ! Softening drifts past r_in while it goes on forwards: that is no interruption, and it would resume on the
         ! spot.
         if (ddot(t, memory%n_turn) <= 0.0_wp) then
            memory%suspended = .true.
            memory%r_turn = r
            memory%way_back = 0.0_wp
         end if
         memory%r_before = memory%r_in
      case default
         memory%r_before = memory%r_in
      end select
      memory%r_in = r_in
      memory%eps_q_p = 0.0_wp
      memory%x_running = 0.0_wp
   end subroutine reseat

   !> m of paper eq. (16): 1 for a process that has hardly begun, 0 for a genuine one.
   pure real(wp) function interrupted_share(par, eps_q_p) result(m)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: eps_q_p

      m = 0.0_wp
      if (eps_q_p < par%eps_hat) m = 1.0_wp - (eps_q_p/par%eps_hat)**par%j_exp
   end function interrupted_share

   !> After an accepted substep that began with (r - r_in):n = x in the direction n.
   pure subroutine accept_process(par, loading, x, n, d_eps_q, memory)
      type(params_t), intent(in) :: par
      logical, intent(in) :: loading
      real(wp), intent(in) :: x, n(6), d_eps_q
      type(memory_t), intent(inout) :: memory

      memory%eps_q_p = memory%eps_q_p + d_eps_q
      if (.not. loading) return
      if (x >= 0.0_wp) then
         memory%x_running = x
         if (.not. memory%suspended) memory%n_turn = n
      end if
      if (memory%suspended) then
         memory%way_back = 0.0_wp
         if (memory%eps_q_p > par%eps_hat) call forget_process(memory)
      end if
   end subroutine accept_process

   !> True where an elastic rate of the stress ratio, d_r (of any length), leads back to the suspended process.
   pure logical function turns_back(memory, d_r)
      type(memory_t), intent(in) :: memory
      real(wp), intent(in) :: d_r(6)

      turns_back = .false.
      if (memory%suspended) turns_back = ddot(d_r, memory%n_turn) > 0.0_wp
   end function turns_back

   !> (r - r_turn):n_turn, negative until the way back has been gone [-].
   pure real(wp) function way_back_distance(memory, r) result(distance)
      type(memory_t), intent(in) :: memory
      real(wp), intent(in) :: r(6)

      distance = ddot(r - memory%r_turn, memory%n_turn)
   end function way_back_distance

   !> Notes how far from the turning point an elastic way back begins; a later call on the same way changes nothing.
   pure subroutine begin_way_back(memory, r)
      type(memory_t), intent(inout) :: memory
      real(wp), intent(in) :: r(6)

      if (memory%way_back <= 0.0_wp) memory%way_back = norm(r - memory%r_turn)
   end subroutine begin_way_back

   !> After an accepted substep of the way back: one that leads elsewhere is no interruption but a new process.
   pure subroutine leave_way_back(memory, r)
      type(memory_t), intent(inout) :: memory
      real(wp), intent(in) :: r(6)

      if (norm(r - memory%r_turn) > BALL*memory%way_back) call forget_process(memory)
   end subroutine leave_way_back

   !> The suspended process goes on as if nothing had happened.
   pure subroutine resume_process(memory)
      type(memory_t), intent(inout) :: memory

      memory%r_in = memory%r_before
      memory%suspended = .false.
      memory%way_back = 0.0_wp
      memory%eps_q_p = 0.0_wp
   end subroutine resume_process

   !> The present process becomes the only one.
   pure subroutine forget_process(memory)
      type(memory_t), intent(inout) :: memory

      memory%suspended = .false.
      memory%way_back = 0.0_wp
   end subroutine forget_process
end module mud_reversal
