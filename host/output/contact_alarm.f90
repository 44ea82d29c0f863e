! SPDX-License-Identifier: MIT
!> Warnings of contacts: surfaces that overlap where they begin to act, or that have penetrated each other without
!> pressure; forces that are little more than rounding.
module contact_alarm
   use warnings, only: print_warning
   use kinds, only: wp
   use contact_interfaces, only: contacts_t, shortest_edge, probe_copy
   use run_state, only: run_t
   use texts, only: place_text, short
   use unknown_fields, only: AT_U_Z
   implicit none (type, external)
   private
   public :: warn_of_overlaps, warn_of_penetration, warn_of_rounding

   !> Depth over the length of the edge from which the warning is given: a curved surface that rolls on leaves about an
   !> eighth of the ratio of edge length to radius, 1e-3 with a mesh that is fine enough for contact [-].
   real(wp), parameter :: ALARMING_DEPTH = 1.0e-3_wp
   !> Depth over the length of the shortest edge below which an overlap is rounding of the input: the strain that it
   !> asks for is as small [-].
   real(wp), parameter :: ROUNDING_DEPTH = 1.0e-6_wp
   !> Times the depth to which a heavy plate is placed: its share under the edges of the plate differs from the mean.
   real(wp), parameter :: PLACED = 2.0_wp
   real(wp), parameter :: NOTABLE = 1.0e-3_wp   !< Share of the forces of contacts from which their rounding is told.
contains
   !> Warns where contacts begin to act with surfaces that overlap, on standard error: the penalty presses them apart at
   !> once. The depth to which a heavy plate is placed at the start is no overlap. docs/theory/contact.md section 4.
   subroutine warn_of_overlaps(run)
      type(run_t), intent(in) :: run
      type(contacts_t) :: contacts
      real(wp) :: depth
      integer :: i, at
      logical :: good

      if (size(run%model%contacts) == 0) return
      call probe_copy(run%system%contacts, run%state%x, contacts, good)
      if (.not. good) return
      do i = 1, size(run%model%contacts)
         associate (t => contacts%interfaces(i), one => run%model%contacts(i), x => run%state%x)
            if (.not. t%acts) cycle
            if (run%at%stage > 1) then
               if (one%in_stage(run%at%stage - 1)) cycle
            end if
            at = maxloc(t%probe%pressure, 1)
            depth = t%probe%pressure(at)/one%options%penalty
            if (depth <= ROUNDING_DEPTH*shortest_edge(t%slave)) cycle
            if (one%plate > 0) then
               associate (plate => run%model%plates(one%plate))
                  if (plate%heavy .and. depth <= -PLACED*x(AT_U_Z, plate%node)) cycle
               end associate
            end if
            associate (place => t%slave%x0(:, at) + x(:2, t%slave%node(at)))
               call print_warning('contact '//trim(one%name)//' begins with surfaces that overlap by up to '// &
                  short(depth)//' m, near '//place_text(place)//'. The penalty presses there with '// &
                  short(t%probe%pressure(at))//' kPa and stores '//short(t%probe%energy)//' kJ, which no load has '// &
                  'done: '//advice(ROUNDING_DEPTH*shortest_edge(t%slave)))
            end associate
         end associate
      end do
   contains
      !> Without inertia surfaces that only touch hold nothing.
      function advice(least) result(text)
         real(wp), intent(in) :: least   !< Overlap that is not told [m].
         character(:), allocatable :: text

         text = 'a dynamic stage throws the surfaces apart. If that is not meant, move the plate or the mesh so '// &
                'that they only touch, or find the prestress in a static stage before.'
         if (.not. run%stage%has_inertia) text = 'the stage finds the prestress. If none is meant, move the plate '// &
            'or the mesh until they overlap by no more than '//short(least)//' m, which is enough for what contact '// &
            'alone holds.'
      end function advice
   end subroutine warn_of_overlaps

   !> Warns once of every contact whose surfaces have penetrated each other, on standard error, also where the run is
   !> quiet. From 1e-3 of the length of an edge on: docs/theory/contact.md section 2.4.
   subroutine warn_of_penetration(run)
      type(run_t), intent(in) :: run
      character(:), allocatable :: name
      integer :: i

      if (size(run%model%contacts) == 0) return
      select type (contacts => run%system%contacts)
      type is (contacts_t)
         do i = 1, size(run%model%contacts)
            associate (t => contacts%interfaces(i))
               if (.not. t%acts .or. t%result%unpressed <= ALARMING_DEPTH) cycle
               name = 'contact '//trim(run%model%contacts(i)%name)
               call print_warning(name//', time '//short(run%next%time)//' s: near '// &
                  place_text(t%result%unpressed_at)//' the surfaces have penetrated each other by '// &
                  short(100*t%result%unpressed)//' % of an edge without pressure, which its gaps do not see. Set '// &
                  'gap = ''combined'' in &contact, or refine the slave there.', once='penetration of '//name)
            end associate
         end do
      end select
   end subroutine warn_of_penetration

   !> Warns at the end of a stage without inertia of contacts that press with little more than the rounding of places,
   !> whose differences gaps are, times the penalty. docs/theory/host.md section 5.1.
   subroutine warn_of_rounding(run)
      type(run_t), intent(in) :: run
      real(wp) :: thrust
      integer :: i

      if (size(run%model%contacts) == 0 .or. run%stage%has_inertia) return
      select type (contacts => run%system%contacts)
      type is (contacts_t)
         thrust = 0.0_wp
         do i = 1, size(run%model%contacts)
            associate (t => contacts%interfaces(i))
               if (.not. t%acts) cycle
               if (allocated(t%spring)) return
               thrust = thrust + sum(t%result%weight*t%result%pressure)
            end associate
         end do
         if (thrust > 0.0_wp .and. contacts%rounding > NOTABLE*thrust) call print_warning('stage '// &
            trim(run%stage%name)//': contacts press with '//short(thrust)//' kN, of which '// &
            short(contacts%rounding)//' kN may be rounding: gaps are differences of places, and the penalty '// &
            'multiplies their digits. Set a smaller penalty, or measure heights from near the contact.')
      end select
   end subroutine warn_of_rounding
end module contact_alarm
