! SPDX-License-Identifier: MIT
!> How far the answers of two pilots lie apart. docs/theory/host.md section 11.
module pilot_differences
   use kinds, only: wp
   use history_distance, only: farthest
   use pilot_runs, only: pilot_t
   use unknown_fields, only: FIELDS, FIELD_NAMES, DISPLACEMENTS, AT_P_W, AT_P_C
   implicit none (type, external)
   private
   public :: difference_t, difference, influence_t

   real(wp), parameter :: NO_ANSWER = 1.0e-4_wp       !< A smaller range, as share of its kind's largest, is no answer.
   real(wp), parameter :: NO_PRESSURE = 1.0e-3_wp     !< The same of a pressure, as a share of the stresses' change.

   !> How far two runs lie apart.
   type :: difference_t
      real(wp) :: share = 0.0_wp                      !< Distance as a share of the answer's range [-].
      real(wp) :: change = 0.0_wp                     !< Second run less first, where they differ most [m, kPa, kN].
      character(72) :: answer = ''
   end type difference_t

   !> What an effect changes in one answer.
   type :: influence_t
      integer :: effect = 0                           !< Row of the table of effects.
      character(72) :: answer = ''
      real(wp) :: range = 0.0_wp                      !< What the share is of [m, kPa, kN].
      real(wp) :: change = 0.0_wp                     !< Second run less first, where they differ most [m, kPa, kN].
      real(wp) :: share = 0.0_wp                      !< [-]
   end type influence_t
contains
   !> How far the answers of two runs of one mesh lie apart, as shares of the range of each answer in the first; a field
   !> that one of them lacks is measured by its change against the largest change of an effective stress.
   !> docs/theory/host.md section 11. The force of a support that moves is an answer too. `worst` is the answer that
   !> differs most; `influences` lists all answers that either run has.
   subroutine difference(one, two, worst, influences)
      type(pilot_t), intent(in) :: one, two
      type(difference_t), intent(out) :: worst
      type(influence_t), allocatable, intent(out), optional :: influences(:)   !< (answers)
      type(influence_t) :: all(FIELDS*size(one%names) + size(one%supports))
      real(wp) :: range(FIELDS, size(one%names)), force_range(size(one%supports)), largest(2), scale, apart, change
      logical :: both(size(one%force_time))
      integer :: f, i, of, n

      n = 0
      range = maxval(one%x, dim=3) - minval(one%x, dim=3)
      largest = [maxval(range(:DISPLACEMENTS, :)), maxval(range(DISPLACEMENTS + 1:, :))]
      largest(2) = max(largest(2), NO_PRESSURE/NO_ANSWER*one%stress)
      do i = 1, size(one%names)
         do f = 1, FIELDS
            of = merge(1, 2, f <= DISPLACEMENTS)
            if (one%has(f) .and. two%has(f)) then
               if (range(f, i) <= NO_ANSWER*largest(of)) cycle
               scale = range(f, i)
               change = farthest(one%time, one%x(f, i, :), two%time, two%x(f, i, :))
            else if (one%has(f)) then
               call lost(one, f, i, change, scale)
            else if (two%has(f)) then
               call lost(two, f, i, change, scale)
            else
               cycle
            end if
            call compare(trim(one%names(i))//'.'//trim(FIELD_NAMES(f)))
         end do
      end do
      ! Before the first step no force is known, and those of a step belong to a moment within it.
      both = one%force_time >= two%force_time(min(2, size(two%force_time))) .and. &
             one%force_time <= two%force_time(size(two%force_time))
      force_range = maxval(one%force, dim=2) - minval(one%force, dim=2)
      do i = 1, size(one%supports)
         if (force_range(i) <= NO_ANSWER*maxval(force_range)) cycle
         scale = force_range(i)
         change = farthest(pack(one%force_time, both), pack(one%force(i, :), both), two%force_time, two%force(i, :))
         call compare(trim(one%supports(i)))
      end do
      if (present(influences)) influences = all(:n)
   contains
      subroutine compare(answer)
         character(*), intent(in) :: answer

         apart = abs(change)/max(scale, tiny(1.0_wp)/epsilon(1.0_wp))
         n = n + 1
         all(n) = influence_t(0, answer, scale, change, apart)
         if (apart > worst%share) worst = difference_t(apart, change, all(n)%answer)
      end subroutine compare
   end subroutine difference

   !> A pressure that is no unknown any more: its change; of suction that beyond zero alone.
   pure subroutine lost(run, field, point, change, scale)
      type(pilot_t), intent(in) :: run
      integer, intent(in) :: field, point
      real(wp), intent(out) :: change, scale   !< [kPa]

      scale = run%stress
      change = 0.0_wp
      if (field == AT_P_W) change = -(maxval(run%x(field, point, :)) - minval(run%x(field, point, :)))
      if (field == AT_P_C) change = -(maxval(max(0.0_wp, run%x(field, point, :))) &
                                      - minval(max(0.0_wp, run%x(field, point, :))))
   end subroutine lost
end module pilot_differences
