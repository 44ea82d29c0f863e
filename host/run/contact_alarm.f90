! SPDX-License-Identifier: MIT
!> Warnings of contacts: surfaces that overlap where they begin to act, or that have penetrated each other without
!> pressure.
module contact_alarm
   use warnings, only: print_warning
   use kinds, only: wp
   use contact_interfaces, only: contacts_t, probe_contacts, shortest_edge
   use generalised_alpha, only: DYNAMIC
   use model_types, only: model_t
   use scene_types, only: acts_in
   use texts, only: short
   use unknown_fields, only: AT_U_Z
   implicit none (type, external)
   private
   public :: warn_of_penetration, warn_of_overlap

   !> Depth over the length of the edge from which the warning is given: a curved surface that rolls on leaves about an
   !> eighth of the ratio of edge length to radius, 1e-3 with a mesh that is fine enough for contact [-].
   real(wp), parameter :: ALARMING_DEPTH = 1.0e-3_wp
   !> Depth over the length of the shortest edge below which an overlap is rounding of the input: the strain that it
   !> asks for is as small [-].
   real(wp), parameter :: ROUNDING_DEPTH = 1.0e-6_wp
   !> Times the depth to which a heavy plate is placed: its share under the edges of the plate differs from the mean.
   real(wp), parameter :: PLACED = 2.0_wp
contains
   !> Where contacts begin to act with surfaces that overlap, on standard error: the penalty presses them apart at once.
   !> The depth to which a heavy plate is placed at the start is no overlap. docs/theory/contact.md section 4. Raises no
   !> fault.
   subroutine warn_of_overlap(model, number, contacts, x)
      type(model_t), intent(in) :: model
      integer, intent(in) :: number      !< Of the stage that begins; the contacts act as it says.
      type(contacts_t), intent(inout) :: contacts
      real(wp), intent(in) :: x(:, :)    !< (FIELDS, nodes) Displacements first [m].
      real(wp) :: depth
      integer :: i, at

      if (size(model%contacts) == 0) return
      if (.not. probe_contacts(contacts, x)) return
      do i = 1, size(model%contacts)
         if (.not. contacts%interfaces(i)%acts) cycle
         if (number > 1) then
            if (acts_in(model%contacts(i)%stages, model%stages(number - 1)%name)) cycle
         end if
         associate (t => contacts%interfaces(i), one => model%contacts(i))
            at = maxloc(t%probe%pressure, 1)
            depth = t%probe%pressure(at)/one%options%penalty
            if (depth <= ROUNDING_DEPTH*shortest_edge(t%slave)) cycle
            if (one%plate > 0) then
               if (model%plates(one%plate)%heavy .and. depth <= -PLACED*x(AT_U_Z, model%plates(one%plate)%node)) cycle
            end if
            associate (place => t%slave%x0(:, at) + x(:2, t%slave%node(at)))
               call print_warning('contact '//trim(one%name)//' begins with surfaces that overlap by up to '// &
                  short(depth)//' m, near ('//short(place(1))//', '//short(place(2))//') m. The penalty presses '// &
                  'there with '//short(t%probe%pressure(at))//' kPa and stores '//short(t%probe%energy)//' kJ, '// &
                  'which no load has done: '//advice(model%stages(number)%kind, ROUNDING_DEPTH*shortest_edge(t%slave)))
            end associate
         end associate
      end do
   contains
      !> Without inertia surfaces that only touch hold nothing.
      function advice(kind, least) result(text)
         integer, intent(in) :: kind
         real(wp), intent(in) :: least   !< Overlap that is not told [m].
         character(:), allocatable :: text

         text = 'a dynamic stage throws the surfaces apart. If that is not meant, move the plate or the mesh so '// &
                'that they only touch, or find the prestress in a static stage before.'
         if (kind /= DYNAMIC) text = 'the stage finds the prestress. If none is meant, move the plate or the mesh '// &
            'until they overlap by no more than '//short(least)//' m, which is enough for what contact alone holds.'
      end function advice
   end subroutine warn_of_overlap

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
