!> Contacts of a scene: set up, seated, switched by stages, and their row of contact.csv.
module host_contact
   use kinds, only: wp
   use boundary_loads, only: plate_load
   use model_types, only: model_t, stage_t, acts_in
   use contact_types, only: contact_status_t, contact_message, CONTACT_OK, TWO_PI
   use contact_interfaces, only: contacts_t, touch_t, surface_t, surface_of, new_touch, plate_surface, evaluate_contacts
   use degrees_of_freedom, only: dofs_t
   use porous_domain, only: state_t
   use faults, only: fault_t, raise, EXIT_INPUT
   implicit none (type, external)
   private
   public :: prepare_contacts, seat_plates, contacts_act, contact_columns, contact_row, contact_nodes
contains
   subroutine prepare_contacts(model, dofs, contacts, fault)
      type(model_t), intent(in) :: model
      type(dofs_t), intent(in) :: dofs
      type(contacts_t), intent(out) :: contacts
      type(fault_t), intent(inout) :: fault
      type(contact_status_t) :: status
      type(surface_t) :: master
      character(400) :: text
      integer :: i, node

      if (size(model%contacts) == 0) return
      allocate (contacts%touch(size(model%contacts)))
      associate (mesh => model%domain%mesh)
         do i = 1, size(model%contacts)
            associate (one => model%contacts(i))
               node = 0
               if (one%plate > 0) then
                  associate (plate => model%plates(one%plate))
                     master = plate_surface(plate%r, plate%z, plate%up)
                     node = plate%node
                  end associate
               else
                  master = surface_of(mesh%groups(one%master)%edges, mesh%x)
               end if
               call new_touch(dofs, surface_of(mesh%groups(one%slave)%edges, mesh%x), master, node, one%options, &
                              contacts%touch(i), status)
               if (status%code == CONTACT_OK) cycle
               call contact_message(status, text)
               call raise(fault, EXIT_INPUT, 'Contact '//trim(one%name)//': '//trim(text)//'.')
               return
            end associate
         end do
      end associate
   end subroutine prepare_contacts

   !> A heavy plate starts where the penalty alone carries what acts on it downwards: so it is held from the first
   !> iteration on.
   subroutine seat_plates(model, contacts, state)
      type(model_t), intent(in) :: model
      type(contacts_t), intent(in) :: contacts
      type(state_t), intent(inout) :: state
      real(wp) :: area, load
      integer :: i

      if (.not. allocated(contacts%touch)) return
      do i = 1, size(model%contacts)
         if (model%contacts(i)%plate == 0) cycle
         associate (plate => model%plates(model%contacts(i)%plate))
            load = -plate_load(model, plate, state%time)
            if (.not. plate%heavy .or. load <= 0.0_wp .or. plate%up) cycle
            area = plate%r(2) - plate%r(1)
            if (model%domain%axisymmetric) area = area*0.5_wp*TWO_PI*sum(plate%r)
            state%x(2, plate%node) = -load/(model%contacts(i)%options%penalty*area)
         end associate
      end do
   end subroutine seat_plates

   !> Which contacts take part in a stage.
   subroutine contacts_act(model, stage, contacts)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(contacts_t), intent(inout) :: contacts
      integer :: i

      if (.not. allocated(contacts%touch)) return
      do i = 1, size(model%contacts)
         contacts%touch(i)%acts = acts_in(model%contacts(i)%stages, stage%name)
      end do
   end subroutine contacts_act

   !> Columns of contact.csv.
   function contact_columns(model) result(head)
      type(model_t), intent(in) :: model
      character(:), allocatable :: head
      character(1 + len(model%contacts%name)) :: name
      integer :: i

      head = 'time,dt,work'
      do i = 1, size(model%contacts)
         name = ','//model%contacts(i)%name
         head = head//trim(name)//'.thrust'//trim(name)//'.energy'//trim(name)//'.area'//trim(name)//'.active'// &
                trim(name)//'.sealed'
      end do
      do i = 1, size(model%plates)
         name = ','//model%plates(i)%name
         head = head//trim(name)//'.u_z'//trim(name)//'.v_z'//trim(name)//'.a_z'//trim(name)//'.load'
      end do
   end function contact_columns

   !> Its row after a step: contacts at the level of values within the step, plates at its end.
   function contact_row(model, contacts, dt, state, work) result(row)
      type(model_t), intent(in) :: model
      type(contacts_t), intent(in) :: contacts
      real(wp), intent(in) :: dt, work
      type(state_t), intent(in) :: state
      real(wp), allocatable :: row(:)
      integer :: i

      row = [state%time, dt, work, (values(contacts%touch(i)), i=1, size(model%contacts)), &
             (state%x(2, model%plates(i)%node), state%v(2, model%plates(i)%node), state%a(2, model%plates(i)%node), &
              plate_load(model, model%plates(i), state%time), i=1, size(model%plates))]
   contains
      pure function values(t) result(list)
         type(touch_t), intent(in) :: t
         real(wp) :: list(5)

         list = [t%thrust, t%energy, t%area, real(t%active, wp), real(t%sealed, wp)]
      end function values
   end function contact_row

   !> Slave nodes of the contacts that act, at the displacements of a state: number of the contact, coordinates at the
   !> start, weight, share of it that is covered, gap, pressure. A state that a kernel refuses has none.
   subroutine contact_nodes(model, contacts, state, table)
      type(model_t), intent(in) :: model
      type(contacts_t), intent(in) :: contacts
      type(state_t), intent(in) :: state
      real(wp), allocatable, intent(out) :: table(:, :)
      type(contacts_t) :: probe
      integer :: c, i

      allocate (table(7, 0))
      probe = contacts
      if (.not. evaluate_contacts(probe, state%x, .false.)) return
      do c = 1, size(model%contacts)
         if (.not. probe%touch(c)%acts) cycle
         associate (k => probe%touch(c)%kernel, slave => probe%touch(c)%slave)
            table = reshape([table, (real(c, wp), slave%x0(:, i), k%weight(i), k%weight(i)/k%whole(i), k%gap(i), &
                                     k%pressure(i), i=1, size(slave%node))], [7, size(table, 2) + size(slave%node)])
         end associate
      end do
   end subroutine contact_nodes
end module host_contact
