! SPDX-License-Identifier: MIT
!> The table of effects, printed and as a file.
module effects_table
   use kinds, only: wp
   use pilot_budget, only: pilots_account_t
   use effect_types, only: effect_t, NEVER, OF_GRAVITY
   use csv, only: csv_t, new_csv, write_line, close_csv, quoted
   use faults, only: fault_t
   use texts, only: short, whole
   implicit none (type, external)
   private
   public :: print_effects, print_pilots, write_effects, write_influences
contains
   !> What the pilots cost, and how good they are.
   subroutine print_pilots(unit, account)
      integer, intent(in) :: unit   !< Number of a Fortran unit.
      type(pilots_account_t), intent(in) :: account

      if (account%runs > 0) write (unit, '(a)') whole(account%runs)//' pilots in '//short(account%seconds)// &
         ' s: cells '//whole(account%cells)//' times, steps '//whole(account%steps)// &
         ' times as long as those of the scene.'
      if (account%over_share) write (unit, '(a)') 'No effect was tried: pilots would cost more than '// &
         'effects_pilot_share and ten seconds allow. The run takes what the scene says; mud_host --effects runs '// &
         'the pilots all the same.'
      if (account%own_error_known) write (unit, '(a)') 'The pilot''s own error, '// &
         'against pilots with steps, and cells, twice as long: '// &
         short(100*account%own_error%share)//' % of '//trim(account%own_error%answer)//'.'
   end subroutine print_pilots

   !> The table for people. `decided`: the run follows it.
   subroutine print_effects(unit, table, decided)
      integer, intent(in) :: unit   !< Number of a Fortran unit.
      type(effect_t), intent(in) :: table(:)   !< (rows)
      logical, intent(in) :: decided
      character(12) :: cells(4)
      integer :: i

      write (unit, '(a,t34,a,t40,a,t48,a,t61,a,t74,a,t83,a,t91,a)') 'effect', 'is', 'by', 'influence', 'change', &
         'unknowns', 'time', 'answer; remark'
      do i = 1, size(table)
         associate (t => table(i))
            cells = '-'
            if (t%influence >= 0.0_wp) cells = [character(12) :: short(100*t%influence)//' %', short(t%change), &
               whole(t%unknowns), short(t%seconds)]
            write (unit, '(a32,1x,a5,1x,a7,1x,2a13,a9,a7,1x,a)') t%name, state_of(t, decided), by(t), cells(1:2), &
               cells(3)(:8), cells(4)(:6), trim(t%answer)//trim(merge('; ', '  ', t%answer /= '' .and. t%why /= ''))// &
               ' '//trim(t%why)
         end associate
      end do
      do i = 1, size(table)
         associate (t => table(i))
            if (decided .and. t%added) write (unit, '(a)') 'Added: '//trim(t%name)//', which the scene does not '// &
               'have without effects = ''auto''.'//trim(merge(' The weight of 9.81 m/s2 acts at once; gravity in '// &
               '&scene says another.', repeat(' ', 70), t%kind == OF_GRAVITY))
         end associate
      end do
      write (unit, '(a)') 'Influence: largest change of an answer without the effect (with it where it is off), '// &
         'share of the answer''s range; change in m, kPa or kN;'
      write (unit, '(a)') 'time: processor time of the run without (with) it over that with all.'
   end subroutine print_effects

   pure function state_of(effect, decided) result(text)
      type(effect_t), intent(in) :: effect
      logical, intent(in) :: decided
      character(5) :: text

      text = merge('on   ', 'off  ', merge(effect%on, effect%present, decided))
   end function state_of

   pure function by(effect) result(text)
      type(effect_t), intent(in) :: effect
      character(5) :: text

      text = merge('hand ', 'pilot', effect%by_hand)
   end function by

   !> effects.csv: the table, and what the run has shown of the effects that are off. Fault EXIT_OUTPUT: it cannot be
   !> written.
   subroutine write_effects(folder, table, fault)
      character(*), intent(in) :: folder
      type(effect_t), intent(in) :: table(:)   !< (rows)
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: row
      type(csv_t) :: file
      integer :: i

      call new_csv(folder//'/effects.csv', 'effect,in_scene,on,by,influence,change,answer,fewer_unknowns,'// &
                   'time_ratio,limit,largest_seen,crossed_at,remark', file, fault)
      do i = 1, size(table)
         associate (t => table(i))
            row = quoted(trim(t%name))//','//trim(merge('yes', 'no ', t%present))//','// &
                  trim(merge('on ', 'off', t%on))//','//trim(by(t))//','
            if (t%influence >= 0.0_wp) then
               row = row//short(t%influence)//','//short(t%change)//','//quoted(trim(t%answer))//','// &
                     whole(t%unknowns)//','//short(t%seconds)//','
            else
               row = row//',,,,,'
            end if
            if (t%limit >= 0.0_wp) then
               row = row//short(t%limit)//','//short(t%largest)//','
               if (t%crossed > NEVER) row = row//short(t%crossed)
            else
               row = row//',,'
            end if
            call write_line(file, row//',"'//trim(t%why)//'"', fault)
         end associate
      end do
      call close_csv(file, fault)
   end subroutine write_effects

   !> effects_answers.csv: what every effect that was tried changes in every answer. Fault EXIT_OUTPUT: it cannot be
   !> written.
   subroutine write_influences(folder, table, account, fault)
      character(*), intent(in) :: folder
      type(effect_t), intent(in) :: table(:)   !< (rows)
      type(pilots_account_t), intent(in) :: account
      type(fault_t), intent(inout) :: fault
      type(csv_t) :: file
      integer :: i

      call new_csv(folder//'/effects_answers.csv', 'effect,in_scene,answer,range,change,influence', file, fault)
      do i = 1, size(account%influences)
         associate (t => account%influences(i), effect => table(account%influences(i)%effect))
            call write_line(file, quoted(trim(effect%name))//','//trim(merge('yes', 'no ', effect%present))//','// &
                            quoted(trim(t%answer))//','//short(t%range)//','//short(t%change)//','// &
                            short(t%share), fault)
         end associate
      end do
      call close_csv(file, fault)
   end subroutine write_influences
end module effects_table
