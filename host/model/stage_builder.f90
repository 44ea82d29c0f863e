! SPDX-License-Identifier: MIT
!> Histories and stages of a scene, &history and &stage, and the time integration that holds where a stage leaves it
!> open.
module stage_builder
   use kinds, only: wp
   use convergence, only: measure_in
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use generalised_alpha, only: analysis_t, STATIC, QUASI_STATIC, DYNAMIC, is_flow
   use history_shapes, only: pairs_of_shape, SHAPE_WORDS, TABLE
   use key_schema, only: REQUIRED, UNBOUNDED
   use key_table, only: key_table_t
   use model_types, only: model_t
   use number_pairs, only: read_pairs
   use scene_parts, only: amplitude_t, stage_t, place_of
   use scene_types, only: item_of
   use texts, only: short, LENGTH
   implicit none (type, external)
   private
   public :: build_history, build_stage, place_histories, choose_schemes

   real(wp), parameter :: BIG = UNBOUNDED, TINY_ = 1.0e-30_wp, ZERO = 0.0_wp, ONE = 1.0_wp
   integer, parameter :: MANY = 1000000
   type(analysis_t), parameter :: KINDS(3) = [STATIC, QUASI_STATIC, DYNAMIC]   !< In the order of the words.
   real(wp), parameter :: DEFAULT_TOLERANCE = 1.0e-3_wp  !< Of stages without dt in scenes that give none.
   real(wp), parameter :: NEWTON_SHARE = 0.1_wp          !< Newton's tolerance as a share of the steps'.
   real(wp), parameter :: NEWTON_LARGEST = 1.0e-4_wp     !< Its bound: the residuals of all steps add up.
   real(wp), parameter :: ROUNDING = 1.0e-9_wp   !< Of a time, relative to the length of a history.
   real(wp), parameter :: SMOOTH = 0.8_wp     !< rho_inf of a stage without contact.
   real(wp), parameter :: OPENING = 0.0_wp    !< With contact: no energy is gained where a penalty opens and closes
                                              !< (docs/theory/host.md section 4.1).
contains
   !> Builds a &history: times and factors from the keys, from a file with two numbers a line, or of a known shape.
   !> Fault EXIT_INPUT: keys that contradict each other, a file that cannot be read, times that do not ascend.
   subroutine build_history(k, model, fault)
      type(key_table_t), intent(inout) :: k
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(amplitude_t) :: amplitude
      character(LENGTH) :: file
      real(wp) :: start, period
      integer :: shape, repeats

      amplitude%scene_item_t = item_of(k%group)
      call k%text('name', amplitude%name, 'name, for the key history of loads', REQUIRED)
      shape = TABLE
      call k%word('kind', shape, SHAPE_WORDS, 'pairs of a table, a wave, or a pulse between 0 and 1')
      call k%numbers('times', amplitude%times, -BIG, BIG, 'ascending [s]; straight lines between, constant outside', &
                     '-file')
      call k%numbers('values', amplitude%values, -BIG, BIG, 'factors at these times [-]', '-file')
      file = ''
      call k%text('file', file, 'instead: text file, a time and a factor in every line')
      start = 0.0_wp
      period = 0.0_wp
      repeats = 1
      call k%number('start', start, -BIG, BIG, 'when a wave or pulse begins [s]; 0 before')
      call k%number('period', period, TINY_, BIG, 'period of a sine, length of a pulse [s]')
      call k%whole('repeats', repeats, 1, 10000, 'waves or pulses, one after the other; 0 after them')
      call k%texts('stages', amplitude%stages, &
                   'times count from the start of each of these stages; default: of the run')
      if (k%lists) return
      allocate (amplitude%arcs(0))
      if (shape /= TABLE) then
         if (k%given('times|values|file') .or. .not. k%given('period')) then
            call raise(fault, EXIT_INPUT, place_of(amplitude)//'history '//trim(amplitude%name)//' has a kind that '// &
                       'needs its period [s], and neither times and values nor a file.')
            return
         end if
         call pairs_of_shape(shape, start, period, repeats, amplitude%times, amplitude%values, amplitude%arcs)
      else if (k%given('start|period|repeats')) then
         call raise(fault, EXIT_INPUT, place_of(amplitude)//'start, period and repeats are those of a sine or a '// &
                    'pulse, and history '//trim(amplitude%name)//' is a table; give kind = ''sine'', '// &
                    '''half_sine'', ''haversine'' or ''triangle''.')
         return
      end if
      if (k%given('file')) call read_pairs(trim(file), trim(k%group%file), k%group%line, 'a time and a factor', &
                                           amplitude%times, amplitude%values, fault)
      if (fault%code /= 0) return
      if (size(amplitude%times) == 0 .or. size(amplitude%times) /= size(amplitude%values)) then
         call raise(fault, EXIT_INPUT, at_line(k%group%file, k%group%line)//'history '//trim(amplitude%name)// &
                    ' needs as many values as times.')
      else if (any(amplitude%times(2:) <= amplitude%times(:size(amplitude%times) - 1))) then
         call raise(fault, EXIT_INPUT, at_line(k%group%file, k%group%line)//'the times of history '// &
                    trim(amplitude%name)//' must ascend.')
      end if
      model%amplitudes = [model%amplitudes, amplitude]
   end subroutine build_history

   !> Builds a &stage, once the tolerance of the scene is known. Fault EXIT_INPUT: steps that lack dt, or ends of steps
   !> that cannot be read or do not ascend.
   subroutine build_stage(k, model, fault)
      type(key_table_t), intent(inout) :: k
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(stage_t) :: stage
      character(LENGTH) :: ends
      real(wp), allocatable :: lengths(:)
      integer :: steps, kind

      call k%text('name', stage%name, 'name of the stage', REQUIRED)
      kind = 0
      call k%word('analysis', kind, 'static|quasi_static|dynamic', 'kind of the stage', REQUIRED)
      if (kind > 0) stage%analysis_t = KINDS(kind)
      call k%number('duration', stage%duration, TINY_, BIG, 'duration [s]', REQUIRED)
      call k%number('dt', stage%dt, TINY_, BIG, 'time step [s]; where steps are controlled the first one')
      steps = 0
      call k%word('steps', steps, 'given|controlled', &
                  'given: dt; controlled: by their error, default with step_tolerance or without dt')
      ends = ''
      call k%text('step_ends', ends, 'given steps: file with the end of every step since the start of the stage '// &
                  'and its length [s]', 'steps=given')
      call k%number('output_dt', stage%output_dt, TINY_, BIG, &
                    'controlled steps end at multiples of it, with fields [s]', ':controlled')
      call k%number('dt_growth', stage%dt_growth, ONE, 10*ONE, 'factor on the step after every accepted one', ':given')
      call k%number('dt_max', stage%dt_max, TINY_, BIG, 'largest step, of controlled ones and with dt_growth [s]', &
                    ':grows')
      call k%whole('cuts', stage%cuts, 0, 40, 'how often a step may be halved')
      call k%number('rho_inf', stage%rho_inf, ZERO, ONE, &
                    'spectral radius of generalised-alpha [-]; default 0.8, dynamic with contact 0', &
                    'analysis=quasi_static|dynamic')
      call k%number('created_energy', stage%created_energy, TINY_, BIG, &
                    'energy created out of nothing that ends the run, share of the largest work [-]', &
                    'analysis=dynamic')
      call k%number('tolerance', stage%tolerance, 1.0e-14_wp, 0.1_wp, 'Newton: error that ends the '// &
                    'iteration [-]; what is left after contact is lost depends on it by per cents, see host/SCENE.md')
      call k%word('measure', stage%measure, 'forces|residual|correction|change|auto', &
                  'measure of the error that ends the iteration, see host/SCENE.md')
      call k%whole('max_iterations', stage%max_iterations, 1, 1000, 'Newton: linear solves before the step is cut')
      call k%flag('predictor', stage%no_predictor, 'rates|none', 'none', 'start of the iteration')
      call k%flag('start', stage%solve_start, 'solve|zero', 'solve', 'accelerations at the start of a dynamic stage', &
                  'analysis=dynamic')
      call k%flag('zero_displacements', stage%zero_displacements, 'no|yes', 'yes', &
                  'displacements are set to zero at the end of the stage')
      call k%whole('every', stage%every, 1, MANY, 'histories are written every so many steps')
      call k%whole('fields', stage%fields, 0, MANY, &
                   'fields are written every so many steps; 0: at the end; without: controlled steps at 50 times')
      if (k%lists) return
      stage%film = .not. (k%given('fields') .or. k%given('output_dt'))
      call ask_steps(k, model%step_tolerance, steps == 2, stage, fault)
      if (k%given('step_ends')) call read_pairs(trim(ends), trim(k%group%file), k%group%line, &
                                                'the end of a step and its length [s]', stage%ends, lengths, fault)
      if (fault%code == 0 .and. k%given('step_ends')) then
         if (stage%controlled .or. size(stage%ends) == 0 .or. any(stage%ends(2:) <= &
             stage%ends(:size(stage%ends) - 1))) call raise(fault, EXIT_INPUT, at_line(k%group%file, k%group%line)// &
            'step_ends of &stage '//trim(stage%name)//' needs steps = ''given'', and times in '//trim(ends)// &
            ' that ascend [s].')
      end if
      associate (last => size(model%stages))
         if (last > 0) stage%start = model%stages(last)%start + model%stages(last)%duration
      end associate
      model%stages = [model%stages, stage]
   end subroutine build_stage

   !> Sets what the tolerance of the scene asks of the keys that a stage leaves out: steps, and Newton's tolerance.
   !> docs/theory/host.md section 4.5. Fault EXIT_INPUT: steps = "given" without dt.
   subroutine ask_steps(k, tolerance, by_error, stage, fault)
      type(key_table_t), intent(in) :: k
      real(wp), intent(in) :: tolerance  !< Of the scene; 0: not given.
      logical, intent(in) :: by_error    !< The key steps says it.
      type(stage_t), intent(inout) :: stage
      type(fault_t), intent(inout) :: fault

      stage%step_tolerance = tolerance
      if (.not. tolerance > 0.0_wp) stage%step_tolerance = DEFAULT_TOLERANCE
      stage%controlled = tolerance > 0.0_wp .or. .not. k%given('dt')
      if (k%given('steps')) stage%controlled = by_error
      if (.not. (k%given('dt') .or. stage%controlled)) call raise(fault, EXIT_INPUT, at_line(k%group%file, &
         k%group%line)//'&stage with steps = ''given'' needs dt [s].')
      if (stage%controlled .and. .not. k%given('tolerance')) &
         stage%tolerance = min(NEWTON_LARGEST, NEWTON_SHARE*stage%step_tolerance)
   end subroutine ask_steps

   !> Places histories whose times count from stages in the time of the run, anew at the start of each of these stages.
   !> docs/theory/host.md section 7.2. Fault EXIT_INPUT: a history lasts beyond the start of the stage that it begins
   !> anew in, or would jump there.
   subroutine place_histories(model, fault)
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      integer :: i

      do i = 1, size(model%amplitudes)
         if (fault%code == 0 .and. size(model%amplitudes(i)%stages) > 0) &
            call place(model%stages, model%amplitudes(i), fault)
      end do
   end subroutine place_histories

   subroutine place(stages, h, fault)
      type(stage_t), intent(in) :: stages(:)
      type(amplitude_t), intent(inout) :: h
      type(fault_t), intent(inout) :: fault
      logical :: named(size(stages))
      real(wp), allocatable :: times(:), values(:)
      integer, allocatable :: arcs(:)
      real(wp) :: start, length
      integer :: i, s, n, first

      named = [(any(h%stages == stages(s)%name), s=1, size(named))]
      n = size(h%times)
      if (count(named) > 1 .and. abs(h%values(n) - h%values(1)) > 0.0_wp) then
         call raise(fault, EXIT_INPUT, place_of(h)//'history '''//trim(h%name)//''' begins anew in several stages, '// &
                    'with the factor '//short(h%values(1))//' after '//short(h%values(n))//': it would jump. Let '// &
                    'it end with the factor that it begins with, or name one stage.')
         return
      end if
      length = h%times(n) - h%times(1)
      allocate (times(0), values(0), arcs(0))
      do s = 1, size(named)
         if (.not. named(s)) cycle
         start = stages(s)%start
         i = size(times)
         first = 1
         if (i > 0) then
            if (start + h%times(1) < times(i) - ROUNDING*length) then
               call raise(fault, EXIT_INPUT, place_of(h)//'history '''//trim(h%name)//''' lasts up to '// &
                          short(times(i))//' s, and begins anew at '//short(start + h%times(1))//' s with stage '// &
                          trim(stages(s)%name)//': shorten it, or lengthen the stage before.')
               return
            end if
            ! Where it begins anew at once the last pair is the first one.
            if (start + h%times(1) <= times(i) + ROUNDING*length) first = 2
            if (first == 1 .and. size(h%arcs) > 0) arcs = [arcs, 0]
         end if
         times = [times, start + h%times(first:)]
         values = [values, h%values(first:)]
         arcs = [arcs, h%arcs]
      end do
      call move_alloc(times, h%times)
      call move_alloc(values, h%values)
      call move_alloc(arcs, h%arcs)
   end subroutine place

   !> Sets rho_inf and the measure of Newton's error of the stages that the scene leaves them open in.
   !> docs/theory/host.md sections 4.1 and 5.1.
   pure subroutine choose_schemes(model)
      type(model_t), intent(inout) :: model
      logical :: touching
      integer :: i, k

      do i = 1, size(model%stages)
         associate (stage => model%stages(i))
            touching = any([(model%contacts(k)%in_stage(i), k=1, size(model%contacts))])
            stage%measure = measure_in(stage%measure, stage%has_inertia, touching)
            if (stage%rho_inf >= 0.0_wp) cycle
            stage%rho_inf = SMOOTH
            if (stage%has_inertia .and. touching) stage%rho_inf = OPENING
            ! What the steps of a flow do not resolve, and forces that nothing balances at its start, are to go at once:
            ! with rho_inf they fade as rho_inf to the power of the steps.
            if (is_flow(stage)) stage%rho_inf = OPENING
         end associate
      end do
   end subroutine choose_schemes
end module stage_builder
