! SPDX-License-Identifier: MIT
!> The laws that programs offer by name. A new law is one new file and one line in `list_laws`.
module material_registry
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use key_schema, only: key_t, check_group, get_text
   use material_elastic, only: new_elastic, ELASTIC_KEYS
   use material_mud, only: new_mud, MUD_KEYS
   use material_point, only: material_t
   use material_umat, only: new_umat, UMAT_KEYS
   use namelists, only: group_t
   use spelling, only: nearest_name
   use texts, only: lower_case, LENGTH
   implicit none (type, external)
   private
   public :: law_names, law_keys, is_law, new_material

   abstract interface
      !> Makes a law of a group whose entries were checked against its keys.
      subroutine new_i(group, law, title, fault)
         import :: group_t, material_t, fault_t
         type(group_t), intent(in) :: group
         class(material_t), allocatable, intent(out) :: law
         character(*), intent(inout) :: title   !< Name of the material, where the law knows a better one.
         type(fault_t), intent(inout) :: fault
      end subroutine new_i
   end interface

   type :: law_t
      character(12) :: name
      procedure(new_i), pointer, nopass :: new => null()
      type(key_t), allocatable :: keys(:)
      logical :: open = .false.   !< Takes keys that are not in its list, and checks them itself.
   end type law_t

   !> Keys of every law, which mean nothing to it.
   character(9), parameter :: OF_ALL(3) = [character(9) :: 'law', 'name', 'reference']
contains
   subroutine list_laws(list)
      type(law_t), allocatable, intent(out) :: list(:)

      allocate (list(0))
      call add('mud', new_mud, MUD_KEYS, open=.true.)
      call add('elastic', new_elastic, ELASTIC_KEYS)
      call add('umat', new_umat, UMAT_KEYS)
   contains
      subroutine add(name, new, keys, open)
         character(*), intent(in) :: name
         procedure(new_i) :: new
         type(key_t), intent(in) :: keys(:)
         logical, intent(in), optional :: open
         type(law_t) :: law

         law%name = name
         law%new => new
         law%keys = keys
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

   !> Keys of a law, of a group of its name, but for those that all laws have. There must be such a law.
   function law_keys(name) result(keys)
      character(*), intent(in) :: name
      type(key_t), allocatable :: keys(:)
      type(law_t), allocatable :: list(:)

      call list_laws(list)
      keys = list(findloc(list%name, name, dim=1))%keys
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
      list(place)%keys%group = group%name(:12)   ! errors name the group as the file does
      call check_group(list(place)%keys, own, list(place)%open, fault)
      own%name = list(place)%name
      if (fault%code == 0) call list(place)%new(own, law, title, fault)
      call get_text(group, 'name', title)
   end subroutine new_material
end module material_registry
