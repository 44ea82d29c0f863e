! SPDX-License-Identifier: MIT
!> Contacts and plates as rows of tables.
module contact_rows
   use kinds, only: wp
   use boundary_conditions, only: plate_loads
   use contact_interfaces, only: contacts_t, contact_interface_t, tangential_tractions, probe_copy
   use model_types, only: model_t, plate_t
   use run_state, only: run_t
   use run_tables, only: columns_of
   implicit none (type, external)
   private
   public :: contact_columns, contact_row, contact_nodes

   character(7), parameter :: COLUMNS(7) = [character(7) :: 'thrust', 'energy', 'area', 'active', 'sealed', 'drag', &
      'sliding']
contains
   !> Names the columns of contact.csv; contact_row has their units.
   function contact_columns(model) result(head)
      type(model_t), intent(in) :: model
      character(:), allocatable :: head
      integer :: i, k

      head = 'time,dt,work'
      do i = 1, size(model%contacts)
         head = head//columns_of(model%contacts(i)%name, COLUMNS)
      end do
      do i = 1, size(model%plates)
         do k = 1, size(model%plates(i)%coordinates)
            head = head//columns_of(model%plates(i)%name, model%plates(i)%coordinates(k)%names)
         end do
      end do
   end function contact_columns

   !> Makes the row of contact.csv: contacts at the level of values within the step, plates at its end. time, dt [s],
   !> work [kJ]; of every contact vertical force on the master, upwards [kN], energy of the penalty [kJ], area of the
   !> active nodes [m2], active nodes, sealed nodes, friction on the master along the slave's tangent, summed up [kN],
   !> nodes whose friction is at its limit; of every coordinate of a plate its value [m], rate [m/s], acceleration
   !> [m/s2] and load [kN]; of an angle [-], [1/s], [1/s2], moment [kN m].
   function contact_row(run, work) result(row)
      type(run_t), intent(in) :: run   !< After a step that was taken over.
      real(wp), intent(in) :: work     !< Work done on contacts so far [kJ].
      real(wp), allocatable :: row(:)
      integer :: i

      row = [run%state%time, run%scheme%dt, work]
      if (allocated(run%system%contacts)) then
         select type (contacts => run%system%contacts)
         type is (contacts_t)
            row = [row, (values(contacts%interfaces(i)), i=1, size(run%model%contacts))]
         end select
      end if
      row = [row, (of_plate(run%model%plates(i)), i=1, size(run%model%plates))]
   contains
      pure function of_plate(plate) result(list)
         type(plate_t), intent(in) :: plate
         real(wp) :: list(4*size(plate%coordinates)), loads(size(plate%coordinates))
         integer :: k

         loads = plate_loads(run%model, plate, run%state%time)
         do k = 1, size(loads)
            associate (of => plate%coordinates(k), f => plate%coordinates(k)%field, node => plate%coordinates(k)%node, &
                       state => run%state)
               list(4*k - 3:4*k) = [[state%x(f, node), state%v(f, node), state%a(f, node)]/of%unit, loads(k)]
            end associate
         end do
      end function of_plate

      pure function values(t) result(list)
         type(contact_interface_t), intent(in) :: t
         real(wp) :: list(size(COLUMNS))

         list = 0.0_wp
         list(5) = t%sealed
         if (.not. t%acts) return
         associate (r => t%result)
            list(:4) = [sum(r%force(2:2*t%geometry%slave_nodes:2)), r%energy, sum(r%weight, mask=r%active), &
                        real(count(r%active), wp)]
            list(6:) = [dot_product(r%weight, r%traction), real(count(r%side /= 0), wp)]
         end associate
      end function values
   end function contact_row

   !> Lists slave nodes of the contacts that act, at the displacements of a state: number of the contact, coordinates at
   !> the start, weight, share of it that is covered, gap, pressure, shear stress of friction at the start of its step.
   !> A state that a kernel refuses has none.
   function contact_nodes(run) result(table)
      type(run_t), intent(in) :: run
      real(wp), allocatable :: table(:, :)   !< (8, nodes) [-, m, m, m2, -, m, kPa, kPa]
      type(contacts_t) :: contacts
      real(wp), allocatable :: shear(:)
      logical :: good
      integer :: c, i

      allocate (table(8, 0))
      call probe_copy(run%system%contacts, run%state%x, contacts, good)
      if (.not. good) return
      do c = 1, size(run%model%contacts)
         associate (t => contacts%interfaces(c), found => contacts%interfaces(c)%probe)
            if (.not. t%acts) cycle
            shear = tangential_tractions(t)
            table = reshape([table, (real(c, wp), t%slave%x0(:, i), found%weight(i), &
                                     found%weight(i)/found%whole(i), found%gap(i), found%pressure(i), shear(i), &
                                     i=1, size(shear))], [8, size(table, 2) + size(shear)])
         end associate
      end do
   end function contact_nodes
end module contact_rows
