! SPDX-License-Identifier: MIT
!> Return-point memory (ours; docs/theory/memory-rules.md): a loading process that is interrupted is remembered, and
!> goes on where the path comes back to the point where it was left; a loop that closes is forgotten (Masing's second
!> rule; wiping-out property of Preisach).
module mud_return_point
   use mud_kinds, only: wp, SQRT_2_3
   use mud_critical_state, only: lode_factor
   use mud_options, only: interrupt_past, resume_past
   use mud_params, only: params_t
   use mud_registry, only: MAX_INTERRUPTED
   use mud_state, only: memory_t, interrupted_t
   use mud_tensor, only: ddot, norm, square
   implicit none (type, external)
   private
   public :: place_t, place_at, note_progress, note_farthest, projection_on_chord, interrupt, watched_process, &
             beyond_target, target_limit, resume_process

   !> A substep tells the direction of its process where its loading direction is within 45 degrees of the chord from
   !> the memory; without this bound circles about a biased state ratchet sideways [-].
   real(wp), parameter :: SMALLEST_COSINE = 0.7_wp
   !> A target beyond the bounding surface is reached just inside it, because r approaches the surface but never
   !> arrives [-].
   real(wp), parameter :: SURFACE_MARGIN = 1.001_wp

   !> Place of a loading process in its way.
   type :: place_t
      logical :: loading   !< There is a loading direction.
      real(wp) :: r(6)     !< stress ratio [-]
      real(wp) :: x        !< (r - r_in):n [-]
      real(wp) :: chord(6) !< from the memory, with the floor along n [-]
      real(wp) :: length   !< length of the chord [-]
      real(wp) :: along    !< t:chord, t the elastic rate of the stress ratio under the whole strain, of any length
   end type place_t
contains
   !> The place of a process that began at r_in. r_in, r and n [-], t of any length. docs/theory/memory-rules.md section
   !> 3.2.
   pure function place_at(par, r_in, loading, r, n, t) result(place)
      type(params_t), intent(in) :: par
      real(wp), intent(in) :: r_in(6)
      logical, intent(in) :: loading
      real(wp), intent(in) :: r(6), n(6), t(6)
      type(place_t) :: place

      place%loading = loading
      place%r = r
      place%chord = r - r_in
      place%x = ddot(place%chord, n)
      place%chord = place%chord + par%x_floor*n
      place%length = norm(place%chord)
      place%along = ddot(t, place%chord)
   end function place_at

   !> Direction and target of the present process, where it goes forwards. docs/theory/memory-rules.md section 3.2. A
   !> place without a chord changes nothing.
   pure subroutine note_progress(place, memory)
      type(place_t), intent(in) :: place
      type(memory_t), intent(inout) :: memory

      if (place%length <= 0.0_wp) return
      memory%direction = place%chord/place%length
      memory%target = ddot(place%r, memory%direction)
   end subroutine note_progress

   !> A process that turns aside may go farther in its direction: the target is the farthest. Where r:direction is
   !> largest the place hardly matters, so that the target does not depend on where exactly the process turned aside.
   !> r [-]; docs/theory/memory-rules.md section 3.2.
   pure subroutine note_farthest(r, memory)
      real(wp), intent(in) :: r(6)
      type(memory_t), intent(inout) :: memory

      memory%target = max(memory%target, ddot(r, memory%direction))
   end subroutine note_farthest

   !> Projection of the elastic rate of the stress ratio on the chord, not negative where a process goes forwards: (r -
   !> r_in):n is not negative, the loading direction is near the chord from the memory, and the whole strain leads along
   !> it. The chord counts, not the running direction: on a smoothly turned loop n follows the turn, and no reversal
   !> would ever be found. The path may leave the elastic domain sideways while it reloads: n then still points forwards
   !> while r falls, which is no progress. Its sign counts: x and length are [-], t:chord is in the unit of t. -1
   !> without a loading direction. docs/theory/memory-rules.md section 3.2.
   pure real(wp) function projection_on_chord(par, place)
      type(params_t), intent(in) :: par
      type(place_t), intent(in) :: place

      projection_on_chord = -1.0_wp
      if (.not. place%loading .or. abs(place%along) <= 0.0_wp) return   ! suction alone tells nothing
      projection_on_chord = min(place%x, place%x + par%x_floor - SMALLEST_COSINE*place%length, place%along)
   end function projection_on_chord

   !> The present process is interrupted; the next has no direction yet. A full stack drops its two newest entries,
   !> which are the smallest loop. docs/theory/memory-rules.md section 3.3.
   pure subroutine interrupt(memory)
      type(memory_t), intent(inout) :: memory

      if (memory%depth == MAX_INTERRUPTED) memory%depth = MAX_INTERRUPTED - 2
      memory%depth = memory%depth + 1
      memory%interrupted(memory%depth) = &
         interrupted_t(memory%r_in, memory%direction, memory%target, 0.0_wp)
      call interrupt_past(memory)
      memory%direction = 0.0_wp
      memory%target = 0.0_wp
   end subroutine interrupt

   !> Number of the interrupted process that the path may come back to, 0 if there is none: the newest while the path
   !> leads back along it (the reversal is then still held back by the hysteresis or by the elastic domain), otherwise
   !> the one before it, whose direction the present process shares. docs/theory/memory-rules.md section 3.4.
   pure integer function watched_process(memory, t) result(k)
      type(memory_t), intent(in) :: memory
      real(wp), intent(in) :: t(6)   !< elastic rate of the stress ratio, of any length

      k = memory%depth
      if (k == 0) return
      if (ddot(t, memory%interrupted(k)%direction) > 0.0_wp) return
      k = k - 1
      if (k == 0) return
      if (ddot(t, memory%interrupted(k)%direction) <= 0.0_wp) k = 0
   end function watched_process

   !> Distance of r beyond the target of an interrupted process, negative before it [-]. docs/theory/memory-rules.md
   !> section 3.4.
   pure real(wp) function beyond_target(par, process, r, m_b) result(distance)
      type(params_t), intent(in) :: par
      type(interrupted_t), intent(in) :: process
      real(wp), intent(in) :: r(6)
      real(wp), intent(in) :: m_b    !< M^b at r [-]

      distance = ddot(r, process%direction) - min(process%target, target_limit(par, process)*m_b)
   end function beyond_target

   !> Farthest target on the bounding surface in the direction of a process, over M^b [-]. docs/theory/memory-rules.md
   !> section 3.4.
   pure real(wp) function target_limit(par, process) result(limit)
      type(params_t), intent(in) :: par
      type(interrupted_t), intent(in) :: process

      limit = SQRT_2_3*lode_factor(par%critical, ddot(square(process%direction), process%direction))/SURFACE_MARGIN
   end function target_limit

   !> Process k goes on; it and the loops above it leave the stack. The memory becomes the softer one of the present
   !> process and of process k along t. k is from 1 to the depth, not checked; r [-], t of any length.
   !> docs/theory/memory-rules.md section 3.4.
   pure subroutine resume_process(k, r, t, memory)
      integer, intent(in) :: k
      real(wp), intent(in) :: r(6), t(6)
      type(memory_t), intent(inout) :: memory

      associate (process => memory%interrupted(k))
         if (ddot(r - process%r_in, t) >= ddot(r - memory%r_in, t)) memory%r_in = process%r_in
         memory%direction = process%direction
         memory%target = process%target
      end associate
      call resume_past(k, memory)
      memory%depth = k - 1
      memory%eps_q_p = 0.0_wp
   end subroutine resume_process
end module mud_return_point
