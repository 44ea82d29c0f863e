! SPDX-License-Identifier: MIT
!> Memory of loading processes: when a new one begins, and what each rule then does with the memory.
!> Jumps only: they happen between substeps, never inside a rate.
module mud_reversal
   use mud_kinds, only: wp
   use mud_options, only: new_past, begin_past
   use mud_params, only: params_t
   use mud_registry, only: RULE_CLASSIC, RULE_THRESHOLD, RULE_REPOSITIONING, RULE_RETURN_POINT
   use mud_return_point, only: interrupt
   use mud_state, only: memory_t
   use mud_tensor, only: ddot
   implicit none (type, external)
   private
   public :: new_memory, begin_process, accept_process, drag_process, drags_memory, interrupted_share
contains
   !> Memory of a point that starts at, or comes back without a past to, the stress ratio r. r and all of the memory
   !> [-]. docs/theory/material.md section 1.4.
   pure function new_memory(r) result(memory)
      real(wp), intent(in) :: r(6)
      type(memory_t) :: memory

      memory%r_in = r
      memory%r_before = r
      memory%direction = 0.0_wp
      memory%target = 0.0_wp
      memory%eps_q_p = 0.0_wp
      memory%x_before = 0.0_wp
      memory%x_running = 0.0_wp
      memory%depth = 0
      call new_past(memory)
   end function new_memory

   !> A new loading process begins at r in the direction n, with an elastic rate of the stress ratio along t. r and n
   !> [-], t of any length. docs/theory/memory-rules.md section 2.
   pure subroutine begin_process(par, r, n, t, memory)
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
      case (RULE_RETURN_POINT)
         ! A softening surface drifts past the memory while the process goes on forwards: that is no interruption.
         if (any(abs(memory%direction) > 0.0_wp)) then
            if (ddot(t, memory%direction) <= 0.0_wp) call interrupt(memory)
         end if
      case default
         memory%r_before = memory%r_in
      end select
      memory%r_in = r_in
      call begin_past(memory)
      memory%eps_q_p = 0.0_wp
      memory%x_running = 0.0_wp
   end subroutine begin_process

   !> Books an accepted substep with a plastic shear d_eps_q in which a process has drifted back to r and has taken its
   !> beginning along. All [-]; docs/theory/memory-rules.md section 1.2.
   pure subroutine drag_process(r, d_eps_q, memory)
      real(wp), intent(in) :: r(6), d_eps_q
      type(memory_t), intent(inout) :: memory

      memory%r_in = r
      memory%eps_q_p = memory%eps_q_p + d_eps_q
   end subroutine drag_process

   !> True where a process that has not gone forwards yet takes its beginning along while it drifts backwards: the rules
   !> that begin anew at r. docs/theory/memory-rules.md section 1.2.
   pure logical function drags_memory(par)
      type(params_t), intent(in) :: par

      drags_memory = par%guarded .and. (par%memory_rule == RULE_CLASSIC .or. par%memory_rule == RULE_RETURN_POINT)
   end function drags_memory

   !> m of paper eq. (16): 1 for a process that has hardly begun, 0 for a genuine one. eps_q_p and m [-];
   !> docs/theory/memory-rules.md section 2.2.
   pure real(wp) function interrupted_share(par, eps_q_p) result(m)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: eps_q_p

      m = 0.0_wp
      if (eps_q_p < par%eps_hat) m = 1.0_wp - (eps_q_p/par%eps_hat)**par%j_exp
   end function interrupted_share

   !> Books an accepted substep whose place that counts has (r - r_in):n = x. x and the plastic shear d_eps_q of the
   !> substep [-]; x below 0 is not kept. docs/theory/memory-rules.md section 2.3.
   pure subroutine accept_process(loading, x, d_eps_q, memory)
      logical, intent(in) :: loading   !< There was a loading direction.
      real(wp), intent(in) :: x, d_eps_q
      type(memory_t), intent(inout) :: memory

      memory%eps_q_p = memory%eps_q_p + d_eps_q
      if (loading .and. x >= 0.0_wp) memory%x_running = x
   end subroutine accept_process
end module mud_reversal
