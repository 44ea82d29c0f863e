! SPDX-License-Identifier: MIT
!> The laws that programs offer by name. A new law is one new file and one line in `list_laws`.
module material_registry
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use key_schema, only: key_t, check_group, get_text
   use key_table, only: key_table_t, listing, reading
   use material_elastic, only: new_elastic
   use material_mud, only: new_mud
   use material_point, only: material_t
   use material_umat, only: new_umat
   use namelists, only: group_t
   use spelling, only: nearest_name
   use texts, only: lower_case, LENGTH
   implicit none (type, external)
   private
   public :: law_names, law_keys, is_law, new_material

   abstract interface
      !> Declares the keys of a law, and makes it of the group that the table reads; it may be left out of one that
      !> lists.
      subroutine new_i(k, law, title, fault)
         import :: key_table_t, material_t, fault_t
         type(key_table_t), intent(inout) :: k
         class(material_t), allocatable, intent(out) :: law
         character(*), intent(inout) :: title   !< Name of the material, where the law knows a better one.
         type(fault_t), intent(inout) :: fault
      end subroutine new_i
   end interface

   type :: law_t
      character(12) :: name
      procedure(new_i), pointer, nopass :: new => null()
      logical :: open = .false.   !< Takes keys that it does not declare, and checks them itself.
   end type law_t

   !> Keys of every law, which mean nothing to it.
   character(9), parameter :: OF_ALL(3) = [character(9) :: 'law', 'name', 'reference']
contains
   subroutine list_laws(list)
      type(law_t), allocatable, intent(out) :: list(:)

      allocate (list(0))
      call add('mud', new_mud, open=.true.)
      call add('elastic', new_elastic)
      call add('umat', new_umat)
   contains
      subroutine add(name, new, open)
         character(*), intent(in) :: name
         procedure(new_i) :: new
         logical, intent(in), optional :: open
         type(law_t) :: law

         law%name = name
         law%new => new
         if (present(open)) law%open = open
         list = [list, law]
      end subroutine add
   end subroutine list_laws

   !> Names of all laws. names(:) has an entry a law, in lower case.
   function law_names() result(names)
      character(12), allocatable :: names(:)
      type(law_t), allocatable :: list(:)

      call list_laws(list)
      names = list%name
   end function law_names

   !> Whether a law has this name, which is in lower case.
   logical function is_law(name)
      character(*), intent(in) :: name

      is_law = any(law_names() == name)
   end function is_law

   !> Keys of a law, as those of a group, but for those that all laws have. There must be such a law.
   function law_keys(name, group) result(keys)
      character(*), intent(in) :: name, group
      type(key_t), allocatable :: keys(:)
      type(law_t), allocatable :: list(:)
      type(key_table_t) :: table
      class(material_t), allocatable :: unused
      character(LENGTH) :: title
      type(fault_t) :: none
      integer :: place

      call list_laws(list)
      table = listing(group)
      title = ''
      place = findloc(list%name, name, dim=1)
      call list(place)%new(table, unused, title, none)
      call move_alloc(table%keys, keys)
   end function law_keys

   !> The law `name` with what a group gives, whatever the name of the group. A fault (EXIT_INPUT) names an unknown law,
   !> key or value with file and line; law is then not allocated or of no use.
   subroutine new_material(name, group, law, title, fault)
      character(*), intent(in) :: name
      type(group_t), intent(in) :: group
      class(material_t), allocatable, intent(out) :: law
      character(LENGTH), intent(out) :: title   !< Name of the material.
      type(fault_t), intent(inout) :: fault
      type(law_t), allocatable :: list(:)
      type(key_table_t) :: table
      type(group_t) :: own
      integer :: place, i

      call list_laws(list)
      title = name
      place = findloc(list%name, lower_case(name), dim=1)
      if (place == 0) then
         call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'there is no law '//trim(name)// &
                    '; the nearest is '//trim(list(nearest_name(name, list%name))%name)//'.')
         return
      end if
      own = group
      own%count = 0
      do i = 1, group%count
         associate (item => group%entries(i))
            if (any(OF_ALL == lower_case(item%key))) cycle
            own%count = own%count + 1
            own%entries(own%count) = item
         end associate
      end do
      call check_group(law_keys(list(place)%name, trim(group%name)), own, list(place)%open, fault)
      table = reading(own)
      if (fault%code == 0) call list(place)%new(table, law, title, fault)
      call get_text(group, 'name', title)
   end subroutine new_material
end module material_registry
