! SPDX-License-Identifier: MIT
!> Checkpoints: the complete state of a run in one HDF5 file, and a run from one. Loads, boundary conditions and the
!> flow that is subtracted follow from the scene; the ordering of the equations from their pattern. The rest is here.
module checkpoints
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use, intrinsic :: iso_fortran_env, only: int64
   use kinds, only: wp
   use run_state, only: run_t
   use control_state, only: control_state_t, new_control_state
   use degrees_of_freedom, only: dofs_t
   use output_tables, only: tables_t, flush_tables
   use model_types, only: model_t, gravity_at
   use porous_domain, only: copy_state
   use run_summary, only: new_peaks
   use sparsity_pattern, only: make_pattern
   use hdf5_file, only: h5_t, new_file, write_file, close_file, put, put_text, get, get_text, extent_of
   use restart_files, only: restart_kind_t, put_origin, open_restart
   use faults, only: fault_t, raise, EXIT_OUTPUT, EXIT_RESTART
   use namelists, only: group_t
   use texts, only: whole
   implicit none (type, external)
   private
   public :: write_checkpoint, read_checkpoint, CHECKPOINT

   character(*), parameter :: CHECKPOINT = 'checkpoint.h5'
   type(restart_kind_t), parameter :: KIND_OF_FILE = restart_kind_t('checkpoint of mud_host', '17', &
      CHECKPOINT//' of a run', &
      ' is an HDF5 file, but no checkpoint of mud_host; name the '//CHECKPOINT//' of a run.', &
      'Finish the run with the program that began it.')
   integer, parameter :: N_COUNTERS = 15, AT_FRAMES = 13, AT_PAIRS = 14, AT_SUDDEN = 15   !< Of the list of counters.
   character(*), parameter :: DAMAGED = ' is damaged: an entry is missing, has another extent or a wrong '// &
                                        'checksum; use an older copy, or start anew.'
   character(*), parameter :: BALANCE = 'kinetic, kinetic_0, skeleton, pores, gravity, loads, supports, '// &
                                        'contact, friction, seepage, damping [kJ], outflow, outflow_air [m3], '// &
                                        'largest_work, open_0, most_created [kJ], overdue [-], tolerated [kJ], '// &
                                        'water: gained, turned, received, moved, open_0 [m3]'
contains
   !> Writes the complete state of a run to checkpoint.h5 in the folder of the tables, in place of an older one. Fault
   !> EXIT_OUTPUT: a table or the checkpoint cannot be written.
   subroutine write_checkpoint(model, run, tables, fault)
      type(model_t), intent(in) :: model
      type(run_t), intent(in) :: run
      type(tables_t), intent(inout) :: tables
      type(fault_t), intent(inout) :: fault
      type(h5_t) :: file
      type(control_state_t) :: control
      logical :: good

      ! What the checkpoint counts on comes first.
      call flush_tables(tables, fault)
      if (fault%code /= 0) return
      call new_file(file, tables%folder//'/'//CHECKPOINT, guarded=.true.)
      call put_origin(file, KIND_OF_FILE)
      call put_text(file, 'scene', trim(model%name))
      call put_text(file, 'fingerprint', model%fingerprint)
      call put(file, 'groups', model%hashes, '-', &
               'two numbers for every group of the scene, to find the one that differs')
      call put_text(file, 'origin', tables%origin)
      associate (s => run%state, c => run%at)
         call put(file, 'counters', counters_of(run, tables), '-', 'stage, step of it, cuts in force, good steps, '// &
                  'steps, iterations, cuts, rate evaluations, tangent in every iteration, bytes of '// &
                  'histories.csv, bytes of ledger.csv, bytes of contact.csv, of the table of '// &
                  'reactions, fields written, pairs of unknowns brought '// &
                  'together by contacts, sudden loads applied over the stage')
         call put(file, 'stage', [s%time, c%t_start, c%nominal, c%factor], 's', &
                  'time, start of the stage, step without cuts, share of it [-]')
         call put(file, 'ledger', transfer(run%ledger, [0.0_wp]), 'kJ', BALANCE)
         call put(file, 'largest', run%system%largest, 'kN', 'largest scale of every field')
         call put(file, 'frames', tables%frames%times, 's', 'times of the fields written so far')
         call put(file, 'x_start', c%x_start, 'm, kPa', 'unknowns at the start of the stage')
         call put(file, 'x', s%x, 'm, kPa', 'unknowns u_r, u_z, p_w, p_c of every node')
         call put(file, 'v', s%v, 'm/s, kPa/s', 'their rates')
         call put(file, 'a', s%a, 'm/s2', 'accelerations')
         call put(file, 'stress', s%stress, 'kPa', 'effective stress of every quadrature point, tension positive')
         call put(file, 'state', reshape(s%state, [state_rows(model), size(s%state)/max(1, state_rows(model))]), &
                  'of the material', 'state variables of every quadrature point; one list where laws differ')
         call put(file, 'e', s%e, '-', 'void ratio')
         call put(file, 's', s%s, '-', 'degree of saturation')
         call put(file, 's_rate', s%s_rate, '1/s, m3/s', 'its rate; the flows out, of both fluids and of air')
      end associate
      if (allocated(run%at%sudden)) call put(file, 'sudden', run%at%sudden, 'kN', &
         'what acted at once at the start of the stage and is applied evenly over it')
      if (allocated(run%damping_stress)) call put(file, 'damping_stress', run%damping_stress, 'kPa', &
         'stress of the damping in proportion to the stiffness')
      if (size(model%points) > 0) call put(file, 'peaks', [tables%peaks%value, tables%peaks%time, &
         tables%peaks%dt], 'm, kPa, s', 'largest unknowns of the named points so far, when, and the step')
      control = run%control
      call exchange_control(file, control, .false.)
      if (allocated(run%constraint%dashpots)) call put(file, 'offset', run%constraint%offset, 'kN, m3/s', &
                                                      'flow that is subtracted, forces that hold the ground')
      if (size(tractions_of(run)) > 0) call put(file, 'friction', tractions_of(run), 'kPa', &
                                                'traction of every slave node of the contacts with friction')
      if (pairs_of(run) > 0) call put(file, 'pairs', reshape(run%system%contacts%extra, [2*pairs_of(run)]), '-', &
                                      'pairs of unknowns that contacts brought into the matrix')
      call write_file(file, good)
      if (.not. good) call raise(fault, EXIT_OUTPUT, tables%folder//'/'//CHECKPOINT//' cannot be written; is the '// &
                                 'disk full? The one before is untouched: make room and use --restart.')
   end subroutine write_checkpoint

   !> Puts a prepared run where the checkpoint was written. Fault EXIT_RESTART: no HDF5, no checkpoint, a damaged one,
   !> one of another version, or of another scene.
   subroutine read_checkpoint(path, model, run, tables, fault)
      character(*), intent(in) :: path
      type(model_t), intent(in) :: model
      type(run_t), intent(inout) :: run
      type(tables_t), intent(inout) :: tables
      type(fault_t), intent(inout) :: fault
      type(h5_t) :: file
      real(wp) :: counters(N_COUNTERS)
      real(wp), allocatable :: states(:, :)
      character(64) :: origin
      real(wp) :: stage(4), ledger(storage_size(run%ledger)/storage_size(0.0_wp))

      call open_restart(path, KIND_OF_FILE, file, fault)
      if (fault%code /= 0) return
      call check_scene(path, model, file, fault)
      if (fault%code == 0) then
         counters = 0.0_wp
         call get(file, 'counters', counters)
         if (.not. possible(counters, size(model%stages))) then
            file%good = .false.
            counters = 0.0_wp
         end if
         call get(file, 'stage', stage)
         call get(file, 'ledger', ledger)
         call get(file, 'largest', run%system%largest)
         allocate (run%at%x_start, mold=run%state%x)
         if (allocated(tables%frames%times)) deallocate (tables%frames%times)
         allocate (tables%frames%times(nint(counters(AT_FRAMES))))
         call get(file, 'frames', tables%frames%times)
         call get(file, 'x_start', run%at%x_start)
         call take_peaks(file, size(model%points), tables)
         call get(file, 'x', run%state%x)
         call get(file, 'v', run%state%v)
         call get(file, 'a', run%state%a)
         call get(file, 'stress', run%state%stress)
         states = reshape(run%state%state, [state_rows(model), size(run%state%state)/max(1, state_rows(model))])
         call get(file, 'state', states)
         run%state%state = reshape(states, [size(states)])
         call get(file, 'e', run%state%e)
         call get(file, 's', run%state%s)
         call get(file, 's_rate', run%state%s_rate)
         if (counters(AT_SUDDEN) > 0.5_wp) then
            allocate (run%at%sudden(model%dofs%n))
            call get(file, 'sudden', run%at%sudden)
         end if
         if (allocated(run%damping_stress)) call get(file, 'damping_stress', run%damping_stress)
         if (allocated(run%constraint%dashpots)) call get(file, 'offset', run%constraint%offset)
         if (file%good) call take_tractions(file, run)
         run%control = new_control_state(size(run%state%x, 2), size(run%state%s_rate), size(model%contacts))
         if (file%good) call exchange_control(file, run%control, .true.)
         if (file%good .and. counters(AT_PAIRS) > 0.5_wp) &
            call take_pairs(file, nint(counters(AT_PAIRS)), model%dofs, run)
         if (file%good) then
            run%state%time = stage(1)
            run%state%gravity = gravity_at(model, stage(1))
            run%at%t_start = stage(2)
            run%at%nominal = stage(3)
            run%at%factor = stage(4)
            run%ledger = transfer(ledger, run%ledger)
            call take_counters(counters, run, tables)
            tables%stage = model%stages(run%at%stage)%name
            origin = get_text(file, 'origin')
            tables%origin = origin(:len(tables%origin))
            call copy_state(run%state, run%next)
         else
            call raise(fault, EXIT_RESTART, path//DAMAGED)
         end if
      end if
      call close_file(file)
   end subroutine read_checkpoint

   !> State variables of a point where all have as many, else 1.
   pure integer function state_rows(model) result(rows)
      type(model_t), intent(in) :: model
      integer :: e

      rows = model%domain%regions(model%domain%region_of(1))%law%n_state
      do e = 2, size(model%domain%region_of)
         if (model%domain%regions(model%domain%region_of(e))%law%n_state /= rows) rows = 1
      end do
   end function state_rows

   !> Largest values of the named points so far.
   subroutine take_peaks(file, points, tables)
      type(h5_t), intent(inout) :: file
      integer, intent(in) :: points
      type(tables_t), intent(inout) :: tables
      real(wp), allocatable :: list(:)

      tables%peaks = new_peaks(points)
      associate (n => size(tables%peaks%value))
         allocate (list(3*n))
         if (n > 0) call get(file, 'peaks', list)
         tables%peaks%value = reshape(list(:n), shape(tables%peaks%value))
         tables%peaks%time = reshape(list(n + 1:2*n), shape(tables%peaks%time))
         tables%peaks%dt = reshape(list(2*n + 1:), shape(tables%peaks%dt))
      end associate
   end subroutine take_peaks

   !> Writes the control of the time step, or reads it, component by component. Names have no folder: HDF5 would store
   !> the time at which it was made, and equal runs would leave different files.
   subroutine exchange_control(file, control, reading)
      type(h5_t), intent(inout) :: file
      type(control_state_t), intent(inout) :: control   !< After new_control_state.
      logical, intent(in) :: reading

      associate (c => control%controller, m => control%memory)
         call number('dt', c%dt, 's', 'next step')
         call number('last_ratio', c%last_ratio, '-', 'error over allowance of the last accepted step')
         call flag('held', c%held, 'the last attempt was rejected: the next step is no longer')
         call number('t_sudden', control%t_sudden, 's', 'time of the last sudden change')
         call whole_number('fresh', control%fresh, 'accepted steps since then')
         call number('start_up', control%start_up, 's', 'span in which changes are expected to grow yet')
         call whole_number('rejected', control%rejected, 'steps repeated because of their error, in the whole run')
         call row('scale', control%scale, 'm, kPa', 'largest change of every field in the run')
         call row('limits', control%limits, '-', 'steps by what kept them short')
         call row('touching', control%touching, '-', 'whether a contact was closed at the start of the step')
         call table('x_first', control%x_first, 'm, kPa', 'unknowns at the start of the stage')
         call flag('rates_known', m%known, 'rates of the step before are known, with nothing sudden since')
         call number('rates_dt', m%dt, 's', 'step from those rates to the present ones')
         call table('rate', m%rate, 'm/s, kPa/s', 'rates of the unknowns one step back')
         call row('s_rate', m%s_rate, '1/s', 'rates of saturation one step back')
      end associate
   contains
      subroutine table(name, values, unit, meaning)
         character(*), intent(in) :: name, unit, meaning
         real(wp), intent(inout), contiguous :: values(:, :)

         if (reading) then
            call get(file, 'control_'//name, values)
         else
            call put(file, 'control_'//name, values, unit, meaning)
         end if
      end subroutine table

      subroutine row(name, values, unit, meaning)
         character(*), intent(in) :: name, unit, meaning
         real(wp), intent(inout), contiguous :: values(:)

         if (reading) then
            call get(file, 'control_'//name, values)
         else
            call put(file, 'control_'//name, values, unit, meaning)
         end if
      end subroutine row

      subroutine number(name, value, unit, meaning)
         character(*), intent(in) :: name, unit, meaning
         real(wp), intent(inout) :: value
         real(wp) :: values(1)

         values = value
         call row(name, values, unit, meaning)
         value = values(1)
      end subroutine number

      subroutine whole_number(name, value, meaning)
         character(*), intent(in) :: name, meaning
         integer, intent(inout) :: value
         real(wp) :: as_real

         as_real = real(value, wp)
         call number(name, as_real, '-', meaning)
         value = nint(as_real)
      end subroutine whole_number

      subroutine flag(name, value, meaning)
         character(*), intent(in) :: name, meaning
         logical, intent(inout) :: value
         integer :: as_count

         as_count = merge(1, 0, value)
         call whole_number(name, as_count, meaning)
         value = as_count == 1
      end subroutine flag
   end subroutine exchange_control

   !> The matrix with all the room that contacts have asked for: its ordering, and so every digit, depends on it.
   subroutine take_pairs(file, pairs, dofs, run)
      type(h5_t), intent(inout) :: file
      integer, intent(in) :: pairs
      type(dofs_t), intent(in) :: dofs
      type(run_t), intent(inout) :: run
      integer :: flat(2*pairs)

      call get(file, 'pairs', flat)
      if (.not. file%good) return
      run%system%contacts%extra = reshape(flat, [2, pairs])
      call make_pattern(dofs%n, dofs%element, run%system%contacts%extra, run%pattern)
      deallocate (run%assembly%values)
      allocate (run%assembly%values(size(run%pattern%col)), source=0.0_wp)
   end subroutine take_pairs

   !> Refuses a checkpoint of another scene: fault EXIT_RESTART names the first group that differs.
   subroutine check_scene(path, model, file, fault)
      character(*), intent(in) :: path
      type(model_t), intent(in) :: model
      type(h5_t), intent(inout) :: file
      type(fault_t), intent(inout) :: fault
      integer, allocatable :: theirs(:)
      character(:), allocatable :: there
      integer :: g, groups

      if (get_text(file, 'fingerprint') == model%fingerprint) return
      allocate (theirs(extent_of(file, 'groups')))
      call get(file, 'groups', theirs)
      if (size(theirs) == 0 .or. .not. file%good) then
         call raise(fault, EXIT_RESTART, path//DAMAGED)
         return
      end if
      groups = size(model%groups)
      do g = 1, min(groups, size(theirs)/2)
         if (any(model%hashes(2*g - 1:2*g) /= theirs(2*g - 1:2*g))) exit
      end do
      there = whole(size(theirs)/2)
      if (g > groups) then
         call different(whole(groups)//' groups are here, and '//there//' were in the scene of the checkpoint')
      else if (2*g > size(theirs)) then
         call different('the checkpoint has no '//named(model%groups(g))//', for its scene ended after '//there// &
                        ' groups')
      else
         call different(named(model%groups(g))//' is another group, or has another key, value or file, here than '// &
                        'in the checkpoint')
      end if
   contains
      subroutine different(text)
         character(*), intent(in) :: text

         call raise(fault, EXIT_RESTART, path//' belongs to another scene ('//trim(get_text(file, 'scene'))// &
                    '): '//text//'. Groups, keys, values and files must be those of the run, but for threads, '// &
                    'goals and checkpoint_*; start a changed scene from its beginning.')
      end subroutine different

      function named(group) result(text)
         type(group_t), intent(in) :: group
         character(:), allocatable :: text

         text = '&'//trim(group%name)//' in line '//whole(group%line)
      end function named
   end subroutine check_scene

   !> Tractions of all contacts with friction, one behind the other [kPa].
   pure function tractions_of(run) result(tractions)
      type(run_t), intent(in) :: run
      real(wp), allocatable :: tractions(:)
      integer :: i

      allocate (tractions(0))
      if (.not. allocated(run%system%contacts%interfaces)) return
      do i = 1, size(run%system%contacts%interfaces)
         associate (t => run%system%contacts%interfaces(i))
            if (t%rubs) tractions = [tractions, t%friction%traction]
         end associate
      end do
   end function tractions_of

   subroutine take_tractions(file, run)
      type(h5_t), intent(inout) :: file
      type(run_t), intent(inout) :: run
      real(wp) :: tractions(size(tractions_of(run)))
      integer :: i, at

      if (size(tractions) == 0) return
      call get(file, 'friction', tractions)
      if (.not. file%good) return
      at = 0
      do i = 1, size(run%system%contacts%interfaces)
         associate (t => run%system%contacts%interfaces(i))
            if (.not. t%rubs) cycle
            t%friction%traction = tractions(at + 1:at + size(t%friction%traction))
            at = at + size(t%friction%traction)
         end associate
      end do
   end subroutine take_tractions

   pure integer function pairs_of(run) result(pairs)
      type(run_t), intent(in) :: run

      pairs = 0
      if (allocated(run%system%contacts%extra)) pairs = size(run%system%contacts%extra, 2)
   end function pairs_of

   !> As real numbers, which are exact up to 2**53.
   pure function counters_of(run, tables) result(counters)
      type(run_t), intent(in) :: run
      type(tables_t), intent(in) :: tables
      real(wp) :: counters(N_COUNTERS)

      associate (c => run%at)
         counters = real([integer(int64) :: c%stage, c%step, c%cuts, c%good, run%steps, run%iterations, run%cuts, &
                          run%rate_evaluations, tables%history%bytes, tables%ledger%bytes, tables%contact%bytes, &
                          tables%reactions%bytes, size(tables%frames%times), pairs_of(run), &
                          merge(1, 0, allocated(c%sudden))], wp)
      end associate
   end function counters_of

   !> Whether counters may be those of a run: whole numbers, none below 0, a stage of `stages`.
   pure logical function possible(counters, stages)
      real(wp), intent(in) :: counters(N_COUNTERS)
      integer, intent(in) :: stages
      real(wp), parameter :: LARGEST(N_COUNTERS) = [spread(real(huge(0), wp), 1, 7), spread(2.0_wp**53, 1, 5), &
                                                    spread(real(huge(0), wp)/2, 1, 2), 1.0_wp]

      ! A comparison with what is no number may end the program.
      possible = all(ieee_is_finite(counters))
      if (possible) possible = all(counters >= 0.0_wp .and. counters <= LARGEST)
      if (possible) possible = counters(1) >= 0.5_wp .and. counters(1) <= stages
   end function possible

   pure subroutine take_counters(counters, run, tables)
      real(wp), intent(in) :: counters(N_COUNTERS)
      type(run_t), intent(inout) :: run
      type(tables_t), intent(inout) :: tables

      run%at%stage = nint(counters(1))
      run%at%step = nint(counters(2))
      run%at%cuts = nint(counters(3))
      run%at%good = nint(counters(4))
      run%steps = nint(counters(5))
      run%iterations = nint(counters(6))
      run%cuts = nint(counters(7))
      run%rate_evaluations = nint(counters(8), int64)
      tables%history%bytes = nint(counters(9), int64)
      tables%ledger%bytes = nint(counters(10), int64)
      tables%contact%bytes = nint(counters(11), int64)
      tables%reactions%bytes = nint(counters(12), int64)
   end subroutine take_counters
end module checkpoints
