!> Contacts and plates as rows of tables.
module contact_rows
   use kinds, only: wp
   use boundary_loads, only: plate_load
   use contact_interfaces, only: contacts_t, contact_interface_t, evaluate_contacts
   use model_types, only: model_t
   use porous_domain, only: state_t
   use unknown_fields, only: AT_U_Z
   implicit none (type, external)
   private
   public :: contact_columns, contact_row, contact_nodes
contains
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

      row = [state%time, dt, work, (values(contacts%interfaces(i)), i=1, size(model%contacts)), &
             (state%x(AT_U_Z, model%plates(i)%node), state%v(AT_U_Z, model%plates(i)%node), &
              state%a(AT_U_Z, model%plates(i)%node), plate_load(model, model%plates(i), state%time), &
              i=1, size(model%plates))]
   contains
      pure function values(t) result(list)
         type(contact_interface_t), intent(in) :: t
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
         if (.not. probe%interfaces(c)%acts) cycle
         associate (k => probe%interfaces(c)%kernel, slave => probe%interfaces(c)%slave)
            table = reshape([table, (real(c, wp), slave%x0(:, i), k%weight(i), k%weight(i)/k%whole(i), k%gap(i), &
                                     k%pressure(i), i=1, size(slave%node))], [7, size(table, 2) + size(slave%node)])
         end associate
      end do
   end subroutine contact_nodes
end module contact_rows
