! SPDX-License-Identifier: MIT
!> Drainage that follows a contact: while a node of the slave presses and at least half of it is covered, it is
!> impervious, and the &fix of pressures along the slave do not act on it. Decided at the start of a step from the
!> displacements there, so that a step is smooth and a restart decides the same.
!> docs/theory/contact.md section 5.
module contact_drainage
   use exit_codes, only: EXIT_CONVERGENCE
   use kinds, only: wp
   use model_types, only: model_t
   use contact_types, only: contact_message
   use contact_interfaces, only: contacts_t, start_points
   use faults, only: fault_t, raise, EXIT_INPUT
   use unknown_fields, only: DISPLACEMENTS
   implicit none (type, external)
   private
   public :: drainage_t, prepare_drainage, find_impervious_nodes, is_released

   !> Nothing is allocated where every contact has fixed drainage.
   type :: drainage_t
      logical, allocatable :: gives_way(:, :)   !< (fixes, contacts) A pressure prescribed along edges of the slave.
      logical, allocatable :: released(:, :)    !< (fixes, nodes) In the step under way.
   end type drainage_t

   real(wp), parameter :: HALF = 0.5_wp*(1 - 1.0e-9_wp)   !< Up to rounding: half an edge may lie exactly opposite.
contains
   !> Which &fix give way to which contacts. Those that prescribe a pressure on all nodes of an edge of the slave. Fault
   !> EXIT_INPUT: a contact whose drainage follows its state has none.
   subroutine prepare_drainage(model, drainage, fault)
      type(model_t), intent(in) :: model
      type(drainage_t), intent(out) :: drainage
      type(fault_t), intent(inout) :: fault
      integer :: c, f

      if (.not. any([(model%contacts(c)%drains_by_state, c=1, size(model%contacts))])) return
      allocate (drainage%gives_way(size(model%fixes), size(model%contacts)), source=.false.)
      allocate (drainage%released(size(model%fixes), size(model%domain%mesh%x, 2)), source=.false.)
      do c = 1, size(model%contacts)
         if (.not. model%contacts(c)%drains_by_state) cycle
         do f = 1, size(model%fixes)
            if (model%fixes(f)%field <= DISPLACEMENTS) cycle
            drainage%gives_way(f, c) = share_an_edge(model, model%contacts(c)%slave, model%fixes(f)%group)
         end do
         if (.not. any(drainage%gives_way(:, c))) call raise(fault, EXIT_INPUT, 'Contact '// &
            trim(model%contacts(c)%name)//': drainage = ''state'' releases &fix of p_w, p_c or p_a on the slave, '// &
            'and there is none; prescribe the pressures on the whole boundary, or leave drainage out.')
      end do
   end subroutine prepare_drainage

   !> Whether a group has all nodes of an edge of the slave: a boundary that only ends on it does not give way.
   pure logical function share_an_edge(model, slave, group) result(shared)
      type(model_t), intent(in) :: model
      integer, intent(in) :: slave, group
      logical, allocatable :: in_group(:)
      integer :: e

      allocate (in_group(size(model%domain%mesh%x, 2)), source=.false.)
      in_group(model%domain%mesh%groups(group)%nodes) = .true.
      shared = .false.
      associate (edges => model%domain%mesh%groups(slave)%edges)
         do e = 1, size(edges, 2)
            shared = shared .or. all(in_group(edges(:, e)))
         end do
      end associate
   end function share_an_edge

   !> The impervious nodes at given displacements. What the last evaluation of the contacts left behind stays.
   !> docs/theory/contact.md section 5. Fault EXIT_CONVERGENCE: a kernel refuses the displacements.
   subroutine find_impervious_nodes(model, drainage, contacts, x, fault)
      type(model_t), intent(in) :: model
      type(drainage_t), intent(inout) :: drainage
      type(contacts_t), intent(inout) :: contacts
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) at the start of the step [m, kPa]
      type(fault_t), intent(inout) :: fault
      character(400) :: text
      logical, allocatable :: sealed(:)
      integer :: c, f

      if (.not. allocated(drainage%gives_way)) return
      if (.not. start_points(contacts, x)) then
         call contact_message(contacts%status, text)
         call raise(fault, EXIT_CONVERGENCE, 'Drainage at the start of a step: '//trim(text)//'.')
         return
      end if
      drainage%released = .false.
      do c = 1, size(model%contacts)
         contacts%interfaces(c)%sealed = 0
         if (.not. model%contacts(c)%drains_by_state .or. .not. contacts%interfaces(c)%acts) cycle
         associate (point => contacts%interfaces(c)%point, nodes => contacts%interfaces(c)%slave%node)
            sealed = point%pressure > 0.0_wp .and. point%coverage >= HALF
            contacts%interfaces(c)%sealed = count(sealed)
            do f = 1, size(model%fixes)
               if (.not. drainage%gives_way(f, c)) cycle
               drainage%released(f, nodes) = drainage%released(f, nodes) .or. sealed
            end do
         end associate
      end do
   end subroutine find_impervious_nodes

   !> Whether the contact has released the value that a &fix prescribes at a node.
   pure logical function is_released(drainage, fix, node)
      type(drainage_t), intent(in) :: drainage
      integer, intent(in) :: fix, node   !< Numbers.

      is_released = .false.
      if (allocated(drainage%released)) is_released = drainage%released(fix, node)
   end function is_released
end module contact_drainage
