! SPDX-License-Identifier: MIT
!> Which unknowns at named points are answers.
module named_answers
   use kinds, only: wp
   use model_types, only: model_t
   use scene_types, only: acts_in
   implicit none (type, external)
   private
   public :: is_prescribed
contains
   !> Whether every stage prescribes an unknown throughout: then it is no answer.
   pure logical function is_prescribed(model, node, field) result(prescribed)
      type(model_t), intent(in) :: model
      integer, intent(in) :: node, field
      logical :: held
      integer :: i, k

      prescribed = .true.
      do i = 1, size(model%stages)
         held = .false.
         do k = 1, size(model%fixes)
            associate (fix => model%fixes(k))
               if (fix%field /= field .or. fix%limits .or. .not. acts_in(fix%stages, model%stages(i)%name)) cycle
               if (fix%from > -huge(1.0_wp) .or. fix%until < huge(1.0_wp)) cycle
               held = held .or. any(model%domain%mesh%groups(fix%group)%nodes == node)
            end associate
         end do
         prescribed = prescribed .and. held
      end do
   end function is_prescribed
end module named_answers
