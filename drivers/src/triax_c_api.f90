! SPDX-License-Identifier: MIT
!> The functions of mud_triax.h: a case given as text, its table in memory.
module triax_c_api
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_char, c_double, c_null_ptr, c_null_char, c_loc, &
                                          c_f_pointer, c_associated
   use faults, only: fault_t, raise, EXIT_INPUT
   use namelists, only: group_t, groups_of_text
   use kinds, only: wp
   use texts, only: text_at
   use triax_accuracy, only: accuracy_t, reach_accuracy, note_accuracy
   use stress_units, only: in_unit
   use triax_case, only: case_t, make_case
   use triax_columns, only: COLUMNS
   use triax_control, only: tally_t
   use triax_output, only: table_t, open_memory_table
   use triax_point, only: point_t
   use triax_progress, only: timer_t
   use triax_run, only: run_test
   implicit none (type, external)
   private
   public :: triax_run_text, triax_rows, triax_columns_, triax_column, triax_values, triax_remarks, triax_free
contains
   !> Runs a case. A handle is given where there are rows: also after a test that stopped (3), not after one that was
   !> refused (2). Threads wait for each other: gfortran keeps the length of a text that a function returns (deferred
   !> length) in static storage, so that the readers and messages of two tests at once would cut each other's texts.
   !> Codes, and what is NULL when: mud_triax.h.
   integer(c_int) function triax_run_text(text, name, handle, message, length) bind(c, name='mud_triax_run')
      type(c_ptr), value :: text, name, message
      type(c_ptr), intent(out) :: handle
      integer(c_int), value :: length

      !$omp critical (one_test)
      call run_text(text, name, handle, message, length, triax_run_text)
      !$omp end critical (one_test)
   end function triax_run_text

   subroutine run_text(text, name, handle, message, length, code)
      type(c_ptr), intent(in) :: text, name, message
      type(c_ptr), intent(out) :: handle
      integer(c_int), intent(in) :: length
      integer(c_int), intent(out) :: code
      type(table_t), pointer :: result
      type(group_t), allocatable :: groups(:)
      type(case_t) :: test
      type(tally_t) :: tally
      type(accuracy_t) :: answer
      type(timer_t) :: timer
      type(point_t) :: point
      type(fault_t) :: fault
      character(:), allocatable :: file

      handle = c_null_ptr
      file = 'case'
      if (c_associated(name)) file = text_at(name)
      if (c_associated(text)) then
         call groups_of_text(text_at(text), file, groups, fault)
      else
         call raise(fault, EXIT_INPUT, 'There is no text of a case.')
      end if
      if (fault%code == 0) call make_case(groups, file, test, fault)
      if (fault%code == 0) then
         allocate (result)
         call open_memory_table(test, result, fault)
         if (test%accuracy > 0.0_wp) then
            call reach_accuracy(test, answer)
            call note_accuracy(answer, result, fault)
         end if
         call run_test(test, result, tally, timer, point, fault)
         handle = c_loc(result)
      end if
      call put(trim(fault%text), message, length)
      code = fault%code
   end subroutine run_text

   !> Counts the rows, 0 without a handle.
   integer(c_int) function triax_rows(handle) bind(c, name='mud_triax_rows')
      type(c_ptr), value :: handle
      type(table_t), pointer :: result

      triax_rows = 0
      result => result_of(handle)
      if (.not. associated(result)) return
      triax_rows = result%rows
   end function triax_rows

   !> Counts the columns, 0 without a handle.
   integer(c_int) function triax_columns_(handle) bind(c, name='mud_triax_columns')
      type(c_ptr), value :: handle
      type(table_t), pointer :: result

      triax_columns_ = 0
      result => result_of(handle)
      if (.not. associated(result)) return
      triax_columns_ = size(result%shown, kind=c_int)
   end function triax_columns_

   !> A text about a column: MUD_TRIAX_NAME, _UNIT or _MEANING. -1: no handle, no such column (from 0) or field.
   integer(c_int) function triax_column(handle, index, field, text, len) bind(c, name='mud_triax_column')
      type(c_ptr), value :: handle, text
      integer(c_int), value :: index, field, len
      type(table_t), pointer :: result

      triax_column = -1
      result => result_of(handle)
      if (.not. associated(result)) return
      if (index < 0 .or. index >= size(result%shown)) return
      triax_column = 0
      associate (column => result%shown(index + 1))
         select case (field)
         case (1)
            call put(trim(COLUMNS(column)%name), text, len)
         case (2)
            call put(in_unit(trim(COLUMNS(column)%unit), result%unit), text, len)
         case (3)
            call put(trim(COLUMNS(column)%meaning), text, len)
         case default
            triax_column = -1
         end select
      end associate
   end function triax_column

   !> Copies all values, column after column. (rows, columns), in the units of triax_column; -1: no handle or no room.
   integer(c_int) function triax_values(handle, values) bind(c, name='mud_triax_values')
      type(c_ptr), value :: handle, values
      type(table_t), pointer :: result
      real(c_double), pointer :: room(:, :)

      triax_values = -1
      result => result_of(handle)
      if (.not. (associated(result) .and. c_associated(values))) return
      call c_f_pointer(values, room, [result%rows, size(result%shown)])
      room = result%kept(:result%rows, :)
      triax_values = 0
   end function triax_values

   !> Writes what the head of a file would say, and how stages ended: "name: text" lines. Returns how long it is.
   integer(c_int) function triax_remarks(handle, text, length) bind(c, name='mud_triax_remarks')
      type(c_ptr), value :: handle, text
      integer(c_int), value :: length
      type(table_t), pointer :: result

      triax_remarks = 0
      result => result_of(handle)
      if (.not. associated(result)) return
      call put(result%remarks, text, length)
      triax_remarks = len(result%remarks, c_int)
   end function triax_remarks

   !> Frees a result; nothing without a handle.
   subroutine triax_free(handle) bind(c, name='mud_triax_free')
      type(c_ptr), value :: handle
      type(table_t), pointer :: result

      result => result_of(handle)
      if (.not. associated(result)) return
      deallocate (result)
   end subroutine triax_free

   !> Result that a handle points to; nothing without one.
   function result_of(handle) result(found)
      type(c_ptr), intent(in) :: handle
      type(table_t), pointer :: found

      nullify (found)
      if (c_associated(handle)) call c_f_pointer(handle, found)
   end function result_of

   !> Into a buffer of `length` bytes, cut to fit and always closed by a null.
   subroutine put(text, place, length)
      character(*), intent(in) :: text
      type(c_ptr), intent(in) :: place
      integer(c_int), intent(in) :: length
      character(kind=c_char), pointer :: letters(:)
      integer :: i, last

      if (.not. c_associated(place) .or. length < 1) return
      call c_f_pointer(place, letters, [length])
      last = min(len(text), int(length) - 1)
      do i = 1, last
         letters(i) = text(i:i)
      end do
      letters(last + 1) = c_null_char
   end subroutine put
end module triax_c_api
