! SPDX-License-Identifier: MIT
!> The terms of the program. A new term is one new file and one line in `list_terms`.
module term_registry
   use absorbing, only: absorbing_t
   use buffer, only: buffer_t
   use contact_drainage, only: contact_drainage_t
   use faults, only: fault_t
   use friction, only: friction_t
   use key_table, only: key_table_t
   use model_types, only: model_t, term_t, term_box_t
   use staging, only: staging_t
   use strength, only: strength_t
   implicit none (type, external)
   private
   public :: own_groups, declare_keys, build_terms

   integer, parameter :: GROUP_LENGTH = 12
contains
   !> All of them, unbuilt, in the order in which they act.
   subroutine list_terms(list)
      type(term_box_t), allocatable, intent(out) :: list(:)

      allocate (list(0))
      call add(strength_t())
      call add(staging_t())
      call add(absorbing_t())
      call add(contact_drainage_t())
      call add(friction_t())
      call add(buffer_t())
   contains
      subroutine add(one)
         class(term_t), intent(in) :: one
         type(term_box_t) :: box

         allocate (box%term, source=one)
         list = [list, box]
      end subroutine add
   end subroutine list_terms

   !> Names of the groups of a scene that belong to terms.
   function own_groups() result(names)
      character(GROUP_LENGTH), allocatable :: names(:)
      type(term_box_t), allocatable :: list(:)
      integer :: i

      call list_terms(list)
      allocate (names(0))
      do i = 1, size(list)
         if (list(i)%term%group() /= '') names = [character(GROUP_LENGTH) :: names, list(i)%term%group()]
      end do
   end function own_groups

   !> Lists the keys that terms have in the group of a table.
   subroutine declare_keys(k)
      type(key_table_t), intent(inout) :: k
      type(term_box_t), allocatable :: list(:)
      integer :: i

      call list_terms(list)
      do i = 1, size(list)
         call list(i)%term%declare(k)
      end do
   end subroutine declare_keys

   !> Gives a model the terms that its scene asks for. Faults: theirs.
   subroutine build_terms(model, fault)
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(term_box_t), allocatable :: list(:)
      logical, allocatable :: there(:)
      integer :: i

      call list_terms(list)
      allocate (there(size(list)), source=.false.)
      do i = 1, size(list)
         if (fault%code == 0) call list(i)%term%build(model, there(i), fault)
      end do
      model%terms = pack(list, there)
   end subroutine build_terms
end module term_registry
