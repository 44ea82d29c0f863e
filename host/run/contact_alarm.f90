! SPDX-License-Identifier: MIT
!> Warning of a run in which a surface has penetrated another one without contact pressure.
module contact_alarm
   use warnings, only: print_warning
   use kinds, only: wp
   use contact_interfaces, only: contacts_t
   use model_types, only: model_t
   use texts, only: short
   implicit none (type, external)
   private
   public :: warn_of_penetration

   !> Depth over the length of the edge from which the warning is given: a curved surface that rolls on leaves about an
   !> eighth of the ratio of edge length to radius, 1e-3 with a mesh that is fine enough for contact [-].
   real(wp), parameter :: ALARMING_DEPTH = 1.0e-3_wp
contains
   !> After an accepted step; once for every contact, on standard error, also where the run is quiet. From 1e-3 of the
   !> length of an edge on: docs/theory/contact.md section 2.4. Raises no fault.
   subroutine warn_of_penetration(model, time, contacts)
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: time   !< [s]
      type(contacts_t), intent(inout) :: contacts
      integer :: i

      if (.not. allocated(contacts%interfaces)) return
      do i = 1, size(contacts%interfaces)
         associate (t => contacts%interfaces(i))
            if (.not. t%acts .or. t%told .or. t%result%unpressed <= ALARMING_DEPTH) cycle
            t%told = .true.
            call print_warning('contact '//trim(model%contacts(i)%name)//', time '// &
               short(time)//' s: near ('//short(t%result%unpressed_at(1))//', '//short(t%result%unpressed_at(2))// &
               ') m the surfaces have penetrated each other by '//short(100*t%result%unpressed)// &
               ' % of an edge without pressure, which its gaps do not see. Set gap = ''combined'' in &contact, or '// &
               'refine the slave there.')
         end associate
      end do
   end subroutine warn_of_penetration
end module contact_alarm
