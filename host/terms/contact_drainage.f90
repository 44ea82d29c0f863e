! SPDX-License-Identifier: MIT
!> Drainage that follows a contact, the key drainage of &contact: while a node of the slave presses and at least half of
!> it is covered, it is impervious, and the &fix of pressures along the slave do not act on it. This is decided at the
!> start of a step from the displacements there, so that a step is smooth and a restart decides the same.
!> docs/theory/contact.md section 5.
module contact_drainage
   use acting_places, only: share_an_edge
   use exit_codes, only: EXIT_CONVERGENCE
   use kinds, only: wp
   use key_table, only: key_table_t
   use model_types, only: model_t, problem_t
   use contact_interfaces, only: contacts_t
   use prescribed_values, only: constraint_t
   use faults, only: fault_t, raise, EXIT_INPUT
   use scene_parts, only: place_of
   use scene_term, only: scene_term_t
   use scene_types, only: item_of
   use unknown_fields, only: DISPLACEMENTS
   implicit none (type, external)
   private
   public :: contact_drainage_t

   type, extends(scene_term_t) :: contact_drainage_t
      logical, allocatable :: follows(:)        !< (contacts) Whether its drainage follows its state.
      logical, allocatable :: gives_way(:, :)   !< (fixes, contacts) A pressure prescribed along edges of the slave.
   contains
      procedure :: build_group, before_step
   end type contact_drainage_t

   real(wp), parameter :: HALF = 0.5_wp*(1 - 1.0e-9_wp)   !< Up to rounding: half an edge may lie exactly opposite.
contains
   !> Finds which &fix give way to a contact: those that prescribe a pressure on all nodes of an edge of the slave.
   !> Fault EXIT_INPUT: the scene has no pressures, rain falls on the slave, or a contact whose drainage follows its
   !> state has no such &fix.
   subroutine build_group(self, k, number, model, fault)
      class(contact_drainage_t), intent(inout) :: self
      type(key_table_t), intent(inout) :: k
      integer, intent(in) :: number
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      logical :: follows
      integer :: f

      follows = .false.
      call k%flag('drainage', follows, 'fixed|state', 'state', &
                  'state: nodes in contact are released from &fix of pressures', ':p_w')
      if (k%lists) return
      if (.not. allocated(self%follows)) then
         allocate (self%follows(size(model%contacts)), source=.false.)
         allocate (self%gives_way(size(model%fixes), size(model%contacts)), source=.false.)
      end if
      self%follows(number) = follows
      if (.not. follows) return
      self%wanted = .true.
      if (.not. model%domain%with_w) call raise(fault, EXIT_INPUT, place_of(item_of(k%group))// &
         'drainage = ''state'' needs pressures; see fields in &scene.')
      if (fault%code /= 0) return
      do f = 1, size(model%fixes)
         if (model%fixes(f)%field <= DISPLACEMENTS) cycle
         self%gives_way(f, number) = share_an_edge(model, model%contacts(number)%slave, model%fixes(f)%group)
      end do
      do f = 1, size(model%loads)
         if (.not. model%loads(f)%limits .or. fault%code /= 0) cycle
         if (.not. any(model%loads(f)%in_stage .and. model%contacts(number)%in_stage)) cycle
         if (share_an_edge(model, model%contacts(number)%slave, model%loads(f)%group)) call raise(fault, EXIT_INPUT, &
            place_of(model%loads(f))//'rain on '''//trim(model%loads(f)%group_name)//''' would fall on nodes in '// &
            'contact too, which drainage = ''state'' of the contact '//trim(model%contacts(number)%name)// &
            ' makes impervious; leave drainage out, or let it rain beside the slave.')
      end do
      if (fault%code /= 0) return
      if (.not. any(self%gives_way(:, number))) call raise(fault, EXIT_INPUT, 'Contact '// &
         trim(model%contacts(number)%name)//': drainage = ''state'' releases &fix of p_w, p_c or p_a on the slave, '// &
         'and there is none; prescribe the pressures on the whole boundary, or leave drainage out.')
   end subroutine build_group

   !> Marks nodes that are impervious where the step starts from. What the last evaluation of the contacts left behind
   !> stays. docs/theory/contact.md section 5. Fault EXIT_CONVERGENCE: a kernel refuses the displacements.
   subroutine before_step(self, dt, problem, fault)
      class(contact_drainage_t), intent(inout) :: self
      real(wp), intent(in) :: dt
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault

      select type (contacts => problem%system%contacts)
      type is (contacts_t)
         if (contacts%probe(problem%state%x)) then
            call seal(self, problem%model, contacts, problem%constraint)
         else
            call raise(fault, EXIT_CONVERGENCE, 'Drainage at the start of a step: '//contacts%message()//'.')
         end if
      end select
   end subroutine before_step

   subroutine seal(self, model, contacts, constraint)
      class(contact_drainage_t), intent(in) :: self
      type(model_t), intent(in) :: model
      type(contacts_t), intent(inout) :: contacts
      type(constraint_t), intent(inout) :: constraint
      logical, allocatable :: sealed(:)
      integer :: c, f

      if (.not. allocated(constraint%released)) &
         allocate (constraint%released(size(model%fixes), size(model%domain%mesh%x, 2)))
      constraint%released = .false.
      do c = 1, size(model%contacts)
         associate (t => contacts%interfaces(c))
            t%sealed = 0
            if (.not. self%follows(c) .or. .not. t%acts) cycle
            sealed = t%probe%pressure > 0.0_wp
            where (sealed) sealed = t%probe%weight/t%probe%whole >= HALF
            t%sealed = count(sealed)
            do f = 1, size(model%fixes)
               if (self%gives_way(f, c)) constraint%released(f, t%slave%node) = &
                  constraint%released(f, t%slave%node) .or. sealed
            end do
         end associate
      end do
   end subroutine seal
end module contact_drainage
