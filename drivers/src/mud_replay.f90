! SPDX-License-Identifier: MIT
!> Runs a saved increment alone: its substeps, how it ends, whether it ends as it did, whether cutting it helps.
program mud_replay
   use, intrinsic :: iso_fortran_env, only: wp => real64, output_unit, error_unit
   use, intrinsic :: iso_c_binding, only: c_int, c_null_char
   use mud_interface, only: mud_report, mud_substep, mud_version, mud_update, mud_trace_increment, &
      mud_save_increment, mud_status_text, mud_message, mud_index, MUD_STATEV, MUD_SUBSTEP_ACCEPTED, &
      MUD_SUBSTEP_REJECTED, MUD_MODE_ELASTIC, MUD_MODE_HELD, MUD_JUMP_REVERSAL, MUD_JUMP_RETURN, MUD_JUMP_NEW
   use replay_file, only: increment_t, read_increment
   use faults, only: fault_t, raise, EXIT_INPUT, EXIT_OUTPUT
   use arguments, only: option_t, read_command_line, option_given, option_value, WORD_LENGTH
   use texts, only: from_c, read_number, short, whole
   implicit none (type, external)

   integer, parameter :: BUFFER = 1600
   integer, parameter :: DEFAULT_ROWS = 40
   integer, parameter :: MOST_ROWS = 1000000
   integer, parameter :: MOST_PARTS = 1024   !< The increment is cut into 2, 4, 8 .. parts, at most so many.

   type(option_t) :: options(4) = [ &
      option_t('--help', letter='-h', answers=.true.), &
      option_t('--version', answers=.true.), &
      option_t('--steps', 'an integer from 0 to 1000000'), &
      option_t('--save', 'the name of a new file')]
   character(WORD_LENGTH) :: file
   type(fault_t) :: fault
   type(increment_t) :: increment
   integer :: rows

   call read_command_line(options, 'increment file', 'see mud_replay --help', file, fault)
   if (fault%code == 0 .and. option_given(options, '--help')) then
      call print_help()
   else if (fault%code == 0 .and. option_given(options, '--version')) then
      write (output_unit, '(a)') 'mud_replay, MUD library '//version()
   else
      if (fault%code == 0) call read_rows()
      if (fault%code == 0) call read_increment(trim(file), increment, fault)
      if (fault%code == 0) call replay(increment)
      if (fault%code == 0 .and. option_given(options, '--save')) call save(increment, option_value(options, '--save'))
   end if
   if (fault%code /= 0) then
      write (error_unit, '(a)') 'mud_replay: '//trim(fault%text)
      stop fault%code, quiet=.true.
   end if

contains
   !> How many substeps are shown.
   subroutine read_rows()
      real(wp) :: value
      logical :: good

      rows = DEFAULT_ROWS
      if (.not. option_given(options, '--steps')) return
      call read_number(option_value(options, '--steps'), value, good)
      if (good) good = value >= 0.0_wp .and. value <= MOST_ROWS .and. abs(value - anint(value)) <= 0.0_wp
      if (good) then
         rows = nint(value)
      else
         call raise(fault, EXIT_INPUT, '--steps needs an integer from 0 to '//whole(MOST_ROWS)//', found `'// &
                    option_value(options, '--steps')//'`.')
      end if
   end subroutine read_rows

   subroutine print_help()
      write (output_unit, '(a)') &
         'usage: mud_replay FILE [--steps N] [--save COPY]', &
         '       mud_replay --help | --version', &
         '', &
         'Runs an increment that mud_save_increment, umat_ (MUD_SAVE_FAILED) or mud_triax --save-failed wrote.', &
         'The file may be edited, for instance to try another tolerance.', &
         '', &
         '   --steps N     show at most N substeps, the first and the last ones; default '//whole(DEFAULT_ROWS), &
         '   --save COPY   write the increment again with the status it has now, to a new file', &
         '', &
         'Columns: time and size as shares of the increment; error relative, to be compared with `tolerance`;', &
         'where the substep led: p'' (compression positive) and q = sqrt(3/2 s:s) [unit of p_atm], e, S_w; rates,', &
         'reversals and guards counted since the increment began. Notes: reversal, return, new: what the memory did', &
         'at the beginning of the substep; elastic: inside the elastic domain; held: by the tension cut-off; event:', &
         'the substep was shortened to end at one.', &
         '', &
         'Exit codes: 0 replayed, whatever the increment''s status; 2 input refused; 4 COPY cannot be written.'
   end subroutine print_help

   subroutine replay(inc)
      type(increment_t), intent(in) :: inc
      type(mud_report) :: report
      type(mud_substep), allocatable :: head(:), tail(:)
      integer(c_int) :: attempts, first, code

      write (output_unit, '(a)') 'increment   '//trim(file), &
         '   library  '//trim(inc%library)//'; this is '//version(), &
         '   origin   '//trim(inc%origin)
      ! 0 is added because a minus zero would only confuse.
      write (output_unit, '(a, 6(1x, es12.5))') '   stress  ', inc%stress + 0.0_wp
      write (output_unit, '(a, 6(1x, es12.5))') '   dstrain ', inc%dstrain + 0.0_wp
      write (output_unit, '(a)') '            (11, 22, 33, 12, 13, 23; tension positive, engineering shear)', &
         '   suction  '//short(inc%suction)//', change '//short(inc%dsuction)
      if (abs(state('layout')) > 0.0_wp) then
         write (output_unit, '(a)') '   state    e '//short(state('void_ratio'))//', S_w '// &
            short(state('saturation'))//', psi '//short(state('state_parameter'))
      else
         write (output_unit, '(a)') '   state    new: STATEV is not initialised'
      end if

      ! Once for the first rows; again for the last, whose place is known by then.
      allocate (head(rows - rows/2), tail(rows/2))
      code = mud_trace_increment(inc%props, size(inc%props), inc%stress, inc%statev, size(inc%statev), inc%dstrain, &
                                 inc%suction, inc%dsuction, inc%tangent, 1, head, size(head), attempts, report)
      if (attempts > 0 .and. rows > 0) write (output_unit, '(/a)') &
         ' substep      time      size  outcome      error           p''            q        e      S_w    rates '// &
         'resets guards'
      call print_rows(head(:min(size(head), int(attempts))), 1)
      first = max(attempts - size(tail) + 1, size(head) + 1)
      if (first <= attempts) then
         code = mud_trace_increment(inc%props, size(inc%props), inc%stress, inc%statev, size(inc%statev), inc%dstrain, &
                                    inc%suction, inc%dsuction, inc%tangent, first, tail, size(tail), attempts, report)
         if (first > size(head) + 1) write (output_unit, '(a)') '     ...   '//whole(int(first) - size(head) - 1)// &
            ' substeps not shown (--steps)'
         call print_rows(tail(:attempts - first + 1), int(first))
      else if (rows == 0 .and. attempts > 0) then
         write (output_unit, '(a)') '     ...   '//whole(int(attempts))//' substeps not shown (--steps)'
      end if

      write (output_unit, '(/a)') 'status      '//whole(int(report%status))//': '//message(report)
      write (output_unit, '(a)') '   work     '//whole(int(report%n_substep))//' substeps, '// &
         whole(int(report%n_reject))//' rejected, '//whole(int(report%n_rate))//' rates, '// &
         whole(int(report%n_reset))//' resets; '//short(100.0_wp*report%reached)//' % of the increment'
      write (output_unit, '(a)') '   saved    '//comparison(inc, report)
      if (report%status > 0) call try_parts(inc)
   end subroutine replay

   subroutine print_rows(steps, first)
      type(mud_substep), intent(in) :: steps(:)
      integer, intent(in) :: first
      real(wp) :: p, deviator(6)
      character(8) :: outcome
      character(120) :: notes
      integer :: i

      do i = 1, size(steps)
         associate (step => steps(i))
            p = sum(step%stress(1:3))/3.0_wp
            deviator = step%stress
            deviator(1:3) = deviator(1:3) - p
            outcome = 'FAILED'
            if (step%outcome == MUD_SUBSTEP_ACCEPTED) outcome = 'accepted'
            if (step%outcome == MUD_SUBSTEP_REJECTED) outcome = 'rejected'
            notes = ''
            if (step%jump == MUD_JUMP_REVERSAL) notes = trim(notes)//' reversal'
            if (step%jump == MUD_JUMP_RETURN) notes = trim(notes)//' return'
            if (step%jump == MUD_JUMP_NEW) notes = trim(notes)//' new'
            if (step%mode == MUD_MODE_ELASTIC) notes = trim(notes)//' elastic'
            if (step%mode == MUD_MODE_HELD) notes = trim(notes)//' held'
            if (step%landed /= 0) notes = trim(notes)//' event'
            if (step%n_no_root > 0) notes = trim(notes)//' no direction: '//whole(int(step%n_no_root))
            write (output_unit, '(i8, 2es10.3, 2x, a, es10.2, 2es13.5, 2f9.5, i9, i9, i7, a)') first + i - 1, &
               step%time, step%size, outcome, step%error, -p, sqrt(1.5_wp*(sum(deviator(1:3)**2) + &
               2.0_wp*sum(deviator(4:6)**2))), step%void_ratio, step%saturation, step%n_rate, step%n_reset, &
               step%n_guard, trim(notes)
         end associate
      end do
   end subroutine print_rows

   !> Whether the increment ends as the file says it did.
   function comparison(inc, report) result(text)
      type(increment_t), intent(in) :: inc
      type(mud_report), intent(in) :: report
      character(:), allocatable :: text
      character(200) :: sentence
      character(:), allocatable :: this
      integer(c_int) :: code

      if (all([inc%status, inc%n_rate, inc%n_substep, inc%n_reject] == &
              [report%status, report%n_rate, report%n_substep, report%n_reject]) .and. &
          abs(inc%reached - report%reached) <= 0.0_wp) then
         text = 'the same status, work and share reached'
         return
      end if
      sentence = c_null_char
      code = mud_status_text(inc%status, sentence, len(sentence, kind=c_int))
      text = 'DIFFERENT: status '//whole(int(inc%status))//' ('//from_c(sentence)//'), '//whole(int(inc%n_substep))// &
             ' substeps, '//whole(int(inc%n_reject))//' rejected, '//whole(int(inc%n_rate))//' rates; '// &
             short(100.0_wp*inc%reached)//' % of the increment'
      this = version()
      if (code == 0 .and. inc%library /= this) text = text//' (by another version)'
   end function comparison

   !> The increment in 2, 4, 8 .. equal parts, until all of them pass.
   subroutine try_parts(inc)
      type(increment_t), intent(in) :: inc
      type(mud_report) :: report
      real(wp) :: stress(6), share, suction
      real(wp), allocatable :: statev(:)
      integer :: parts, i

      parts = 1
      do while (parts < MOST_PARTS)
         parts = 2*parts
         share = 1.0_wp/real(parts, wp)
         stress = inc%stress
         statev = inc%statev
         suction = inc%suction
         do i = 1, parts
            if (mud_update(inc%props, size(inc%props), stress, statev, size(statev), share*inc%dstrain, suction, &
                           share*inc%dsuction, inc%tangent, stress, statev, report=report) /= 0) exit
            suction = inc%suction + real(i, wp)*share*inc%dsuction
         end do
         if (i > parts) then
            write (output_unit, '(a)') '   cut      it passes in '//whole(parts)//' equal parts'
            return
         end if
      end do
      write (output_unit, '(a)') '   cut      it does not pass in '//whole(parts)//' equal parts: number '//whole(i)// &
         ' fails with status '//whole(int(report%status))
   end subroutine try_parts

   subroutine save(inc, copy)
      type(increment_t), intent(in) :: inc
      character(*), intent(in) :: copy   !< Name of a new file.
      character(BUFFER) :: text

      text = c_null_char
      if (mud_save_increment(copy//c_null_char, trim(inc%origin)//c_null_char, inc%props, size(inc%props), &
                             inc%stress, inc%statev, size(inc%statev), inc%dstrain, inc%suction, inc%dsuction, &
                             inc%tangent, text, len(text)) /= 0) then
         call raise(fault, EXIT_OUTPUT, copy//': '//from_c(text))
      end if
   end subroutine save

   !> A state variable of the increment's start, by its name.
   real(wp) function state(name)
      character(*), intent(in) :: name

      state = increment%statev(mud_index(MUD_STATEV, name//c_null_char) + 1)
   end function state

   function message(report) result(text)
      type(mud_report), intent(in) :: report
      character(:), allocatable :: text
      character(BUFFER) :: raw

      raw = c_null_char
      if (mud_message(report, raw, len(raw)) < 0) raw = '?'//c_null_char
      text = from_c(raw)
   end function message

   function version() result(text)
      character(:), allocatable :: text
      character(32) :: raw

      raw = c_null_char
      if (mud_version(raw, len(raw)) < 0) raw = '?'//c_null_char
      text = from_c(raw)
   end function version
end program mud_replay
