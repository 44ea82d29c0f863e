! SPDX-License-Identifier: MIT
!> The table of effects, printed and as a file.
module effects_table
   use kinds, only: wp
   use effect_types, only: effect_t, UNBOUNDED, UNKNOWN, NEVER
   use csv, only: csv_t, new_csv, write_line, close_csv
   use faults, only: fault_t
   use texts, only: short, whole
   implicit none (type, external)
   private
   public :: print_effects, write_effects
contains
   !> The table for people.
   subroutine print_effects(unit, table)
      integer, intent(in) :: unit
      type(effect_t), intent(in) :: table(:)
      character(8) :: cells(2)
      logical :: doubtful
      integer :: i

      doubtful = .false.
      write (unit, '(a,t30,a,t35,a,t41,a,t58,a,t75,a,t84,a,t92,a)') 'effect', 'is', 'by', 'estimate', 'threshold', &
         'unknowns', 'entries', 'because'
      do i = 1, size(table)
         associate (t => table(i))
            doubtful = doubtful .or. exceeds(t)
            cells = [character(8) :: whole(t%unknowns), whole(t%entries)]
            write (unit, '(a28,1x,a4,1x,a5,1x,2a17,2(a8,1x),a)') t%name, state_of(t), by(t), &
               with_unit(t%estimate, t%unit), with_unit(t%threshold, t%unit), cells, trim(t%why)
         end associate
      end do
      if (doubtful) write (unit, '(a)') 'off!: off although its estimate is above the threshold.'
   contains
      pure function with_unit(value, name) result(text)
         real(wp), intent(in) :: value
         character(*), intent(in) :: name
         character(17) :: text

         text = number(value)
         if (text /= '-' .and. value < UNBOUNDED .and. name /= '-') text = trim(text)//' '//name
      end function with_unit
   end subroutine print_effects

   pure logical function exceeds(effect)
      type(effect_t), intent(in) :: effect

      exceeds = .not. effect%on .and. effect%estimate > effect%threshold
   end function exceeds

   pure function state_of(effect) result(text)
      type(effect_t), intent(in) :: effect
      character(4) :: text

      text = merge('off!', merge('on  ', 'off ', effect%on), exceeds(effect))
   end function state_of

   pure function by(effect) result(text)
      type(effect_t), intent(in) :: effect
      character(5) :: text

      text = merge('hand ', 'scene', effect%by_hand)
   end function by

   pure function number(value) result(text)
      real(wp), intent(in) :: value
      character(17) :: text

      if (value >= UNBOUNDED) then
         text = 'not bounded'
      else if (value <= UNKNOWN) then
         text = '-'
      else
         text = short(value)
      end if
   end function number

   !> effects.csv: the table, and what the run has shown of the effects that are off.
   subroutine write_effects(folder, table, fault)
      character(*), intent(in) :: folder
      type(effect_t), intent(in) :: table(:)
      type(fault_t), intent(inout) :: fault
      character(32) :: seen
      type(csv_t) :: file
      integer :: i

      call new_csv(folder//'/effects.csv', 'effect,on,by,estimate,unit,threshold,unknowns,entries,largest_seen,'// &
                     'crossed_at,because', file, fault)
      do i = 1, size(table)
         associate (t => table(i))
            seen = ','
            if (t%monitored) seen = short(t%largest)//','
            if (t%crossed > NEVER) seen = trim(seen)//short(t%crossed)
            call write_line(file, trim(t%name)//','//trim(state_of(t))//','//trim(by(t))//','// &
               trim(number(t%estimate))//','//trim(t%unit)//','//trim(number(t%threshold))//','// &
               whole(t%unknowns)//','//whole(t%entries)//','//trim(seen)//',"'//trim(t%why)//'"', fault)
         end associate
      end do
      call close_csv(file, fault)
   end subroutine write_effects
end module effects_table
