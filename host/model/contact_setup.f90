! SPDX-License-Identifier: MIT
!> Contacts of a model at the start of a run: set up, and seated.
module contact_setup
   use acting_places, only: facing_edges
   use kinds, only: wp
   use boundary_conditions, only: plate_loads
   use model_types, only: model_t, plate_t
   use surface_forces, only: surface_forces_t
   use unknown_fields, only: AT_U_Z
   use contact_types, only: contact_status_t, contact_message, CONTACT_OK, TWO_PI
   use contact_interfaces, only: contacts_t, surface_t, plate_link_t, surface_of, new_interface, tie_to_plate, &
                                 plate_surface
   use porous_domain, only: model_state_t
   use faults, only: fault_t, raise, EXIT_INPUT
   implicit none (type, external)
   private
   public :: prepare_contacts, place_heavy_plates
contains
   !> Prepares the contacts of a model; a fault names the contact and what is wrong with its surfaces. Fault EXIT_INPUT,
   !> where contact_prepare refuses them. Without contacts nothing is allocated.
   subroutine prepare_contacts(model, contacts, fault)
      type(model_t), intent(in) :: model
      class(surface_forces_t), allocatable, intent(out) :: contacts
      type(fault_t), intent(inout) :: fault
      type(contacts_t), allocatable :: built
      type(contact_status_t) :: status
      type(surface_t) :: master
      type(plate_link_t) :: link
      integer :: i, at

      at = size(model%contacts)
      if (at == 0 .and. .not. any(model%plates%penalty > 0.0_wp)) return
      allocate (built)
      allocate (built%interfaces(at + count(model%plates%penalty > 0.0_wp)))
      associate (mesh => model%domain%mesh)
         do i = 1, size(model%contacts)
            associate (one => model%contacts(i))
               link = plate_link_t()
               if (one%plate > 0) then
                  master = plate_surface(model%plates(one%plate)%corners)
                  link = link_of(model%plates(one%plate))
               else
                  master = surface_of(facing_edges(model, one%master, one%in_stage), mesh%x)
               end if
               call new_interface(model%dofs, surface_of(facing_edges(model, one%slave, one%in_stage), mesh%x), &
                                  master, link, one%options, built%interfaces(i), status)
               if (status%code == CONTACT_OK) cycle
               call raise(fault, EXIT_INPUT, 'Contact '//trim(one%name)//': '//contact_message(status)//'.')
               return
            end associate
         end do
         ! Behind the contacts, what springs tie to a plate.
         do i = 1, size(model%plates)
            associate (plate => model%plates(i))
               if (.not. plate%penalty > 0.0_wp) cycle
               at = at + 1
               call tie_to_plate(model%dofs, surface_of(mesh%groups(plate%group)%edges, mesh%x), link_of(plate), &
                                 plate%penalty, built%interfaces(at))
            end associate
         end do
      end associate
      call move_alloc(built, contacts)
   end subroutine prepare_contacts

   !> Describes a plate as contacts know it.
   type(plate_link_t) function link_of(plate) result(link)
      type(plate_t), intent(in) :: plate

      allocate (link%motion, source=plate%motion)
      allocate (link%field(size(plate%coordinates)), link%node(size(plate%coordinates)))
      link%field(:) = plate%coordinates%field
      link%node(:) = plate%coordinates%node
   end function link_of

   !> A heavy plate starts where the penalty alone carries what acts on it downwards: so it is held from the first
   !> iteration on. docs/theory/contact.md section 4. Sets u_z of plates with a face of their own that looks down.
   subroutine place_heavy_plates(model, state)
      type(model_t), intent(in) :: model
      type(model_state_t), intent(inout) :: state
      real(wp) :: area, load
      real(wp), allocatable :: loads(:)
      integer :: i

      do i = 1, size(model%contacts)
         if (model%contacts(i)%plate == 0) cycle
         associate (plate => model%plates(model%contacts(i)%plate))
            loads = plate_loads(model, plate, state%time)
            load = -loads(1)
            if (.not. plate%heavy .or. load <= 0.0_wp) cycle
            area = area_below(plate%corners)
            if (area <= 0.0_wp) cycle
            state%x(AT_U_Z, plate%node) = -load/(model%contacts(i)%options%penalty*area)
         end associate
      end do
   contains
      !> Sums the area of the lowest edges of a face that look down [m2].
      pure real(wp) function area_below(corners) result(area)
         real(wp), intent(in) :: corners(:, :)   !< (2, corners) [m]
         real(wp) :: part
         integer :: i

         area = 0.0_wp
         do i = 2, size(corners, 2)
            if (maxval(corners(2, i - 1:i)) > minval(corners(2, :))) cycle
            part = corners(1, i) - corners(1, i - 1)
            if (model%domain%axisymmetric) part = part*0.5_wp*TWO_PI*sum(corners(1, i - 1:i))
            area = area + max(0.0_wp, part)
         end do
      end function area_below
   end subroutine place_heavy_plates
end module contact_setup
