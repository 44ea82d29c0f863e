! SPDX-License-Identifier: MIT
!> Runs on meshes of a family in one HDF5 file, from which a refinement that was interrupted goes on.
module level_store
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use faults, only: fault_t, raise, EXIT_OUTPUT, EXIT_RESTART
   use hdf5_file, only: HAS_HDF5, h5_t, new_file, write_file, close_file, put, put_text, get, get_text, extent_of
   use kinds, only: wp
   use level_runs, only: level_run_t
   use restart_files, only: restart_kind_t, put_origin, open_restart, codes_of
   use texts, only: whole
   use unknown_fields, only: FIELDS
   implicit none (type, external)
   private
   public :: write_levels, read_levels, LEVELS_FILE

   character(*), parameter :: LEVELS_FILE = 'levels.h5'
   type(restart_kind_t), parameter :: KIND_OF_FILE = restart_kind_t('meshes of mud_host', '1', &
      LEVELS_FILE//' of a run with mesh = ''auto''', &
      ' does not hold the meshes of a run with mesh = ''auto''; name its '//LEVELS_FILE// &
      '. A checkpoint of a single run belongs to a scene without mesh = ''auto''.', 'Start anew.')
   integer, parameter :: MOST_RUNS = 100

   !> Numbers that are read one after the other; good is false once they end too early or are impossible.
   type :: reader_t
      real(wp), allocatable :: numbers(:)
      integer :: at = 0
      logical :: good = .true.
   end type reader_t
contains
   !> Writes all runs in place of an older file. Nothing without HDF5. Fault EXIT_OUTPUT: it cannot be written.
   subroutine write_levels(folder, fingerprint, runs, fault)
      character(*), intent(in) :: folder, fingerprint   !< Of the scene.
      type(level_run_t), intent(in) :: runs(:)
      type(fault_t), intent(inout) :: fault
      type(h5_t) :: file
      logical :: good
      integer :: i

      if (.not. HAS_HDF5) return
      call new_file(file, folder//'/'//LEVELS_FILE, guarded=.true.)
      call put_origin(file, KIND_OF_FILE)
      call put_text(file, 'fingerprint', fingerprint)
      call put(file, 'runs', [real(size(runs), wp)], '-', 'number of runs')
      do i = 1, size(runs)
         call put(file, 'run_'//whole(i), numbers_of(runs(i)), '-', 'a run: see level_store of mud_host')
      end do
      call write_file(file, good)
      if (.not. good) call raise(fault, EXIT_OUTPUT, folder//'/'//LEVELS_FILE//' cannot be written; is the disk full?')
   end subroutine write_levels

   !> Runs of a scene. Fault EXIT_RESTART: no HDF5, no such file, a damaged one, or one of another version or scene.
   subroutine read_levels(path, fingerprint, runs, fault)
      character(*), intent(in) :: path, fingerprint   !< Of the scene.
      type(level_run_t), allocatable, intent(out) :: runs(:)
      type(fault_t), intent(inout) :: fault
      type(h5_t) :: file
      type(reader_t) :: reader
      type(level_run_t) :: one
      real(wp) :: n(1)
      integer :: i

      allocate (runs(0))
      call open_restart(path, KIND_OF_FILE, file, fault)
      if (fault%code /= 0) return
      if (get_text(file, 'fingerprint') /= fingerprint) then
         call raise(fault, EXIT_RESTART, path//' belongs to another scene: groups, keys, values and files must be '// &
                    'those of the run, but for threads, checkpoint_* and budget.')
      end if
      if (fault%code == 0) then
         n = 0.0_wp
         call get(file, 'runs', n)
         if (file%good) file%good = ieee_is_finite(n(1))
         if (file%good) file%good = n(1) >= 0.0_wp .and. n(1) <= MOST_RUNS
         do i = 1, merge(nint(n(1)), 0, file%good)
            reader = reader_t()
            allocate (reader%numbers(extent_of(file, 'run_'//whole(i))))
            call get(file, 'run_'//whole(i), reader%numbers)
            if (file%good) file%good = all(ieee_is_finite(reader%numbers))
            if (file%good) call take_run(reader, one)
            file%good = file%good .and. reader%good
            if (.not. file%good) exit
            runs = [runs, one]
         end do
         if (.not. file%good) call raise(fault, EXIT_RESTART, path//' is damaged; start anew.')
      end if
      call close_file(file)
   end subroutine read_levels

   !> A run as one list of numbers: texts by the codes of their characters.
   pure function numbers_of(run) result(list)
      type(level_run_t), intent(in) :: run
      real(wp), allocatable :: list(:)
      integer :: i

      associate (p => run%pilot)
         list = [run%mesh, run%fineness, run%newton, &
                 real([run%level, p%elements, p%unknowns, p%steps, p%iterations, p%cuts], wp), &
                 p%seconds, p%processor, p%work, p%stress, p%phases, p%megabytes, merge(1.0_wp, 0.0_wp, p%has)]
         list = [list, real([size(p%names), size(p%supports), size(p%time), size(p%ends)], wp), &
                 merge(1.0_wp, 0.0_wp, [p%prescribed]), p%time, [p%x], p%force_time, [p%force]]
         do i = 1, size(p%ends)
            list = [list, real(size(p%ends(i)%times), wp), p%ends(i)%times]
         end do
         do i = 1, size(p%names)
            list = [list, real(codes_of(p%names(i)), wp)]
         end do
         do i = 1, size(p%supports)
            list = [list, real(codes_of(p%supports(i)), wp)]
         end do
      end associate
   end function numbers_of

   !> The same back.
   subroutine take_run(reader, run)
      type(reader_t), intent(inout) :: reader
      type(level_run_t), intent(out) :: run
      real(wp) :: key(3), counts(6), scalars(4), has(FIELDS)
      integer :: points, supports, times, stages, i

      call take(reader, key)
      run%mesh = key(1)
      run%fineness = key(2)
      run%newton = key(3)
      associate (p => run%pilot)
         call take(reader, counts)
         if (.not. all(counts >= 0.0_wp .and. counts < huge(0))) reader%good = .false.
         call take(reader, scalars)
         call take(reader, p%phases)
         call take(reader, p%megabytes)
         call take(reader, has)
         points = next_count(reader)
         supports = next_count(reader)
         times = next_count(reader)
         stages = next_count(reader)
         ! Without an overflow.
         if (reader%good) reader%good = real(FIELDS, wp)*max(1, points)*times + real(supports, wp)*times <= &
                                        size(reader%numbers)
         if (.not. reader%good) return
         run%level = nint(counts(1))
         p%elements = nint(counts(2))
         p%unknowns = nint(counts(3))
         p%steps = nint(counts(4))
         p%iterations = nint(counts(5))
         p%cuts = nint(counts(6))
         p%seconds = scalars(1)
         p%processor = scalars(2)
         p%work = scalars(3)
         p%stress = scalars(4)
         p%has = has > 0.5_wp
         p%prescribed = reshape(next(reader, FIELDS*points) > 0.5_wp, [FIELDS, points])
         p%time = next(reader, times)
         p%x = reshape(next(reader, FIELDS*points*times), [FIELDS, points, times])
         p%force_time = next(reader, times)
         p%force = reshape(next(reader, supports*times), [supports, times])
         allocate (p%ends(stages), p%names(points), p%supports(supports))
         do i = 1, stages
            p%ends(i)%times = next(reader, next_count(reader))
         end do
         do i = 1, points
            p%names(i) = text_of(next(reader, len(p%names)))
         end do
         do i = 1, supports
            p%supports(i) = text_of(next(reader, len(p%supports)))
         end do
         p%done = reader%good .and. reader%at == size(reader%numbers)
         reader%good = p%done
      end associate
   end subroutine take_run

   !> So many numbers; zeros, and no good reader, where there are fewer.
   pure subroutine take(reader, values)
      type(reader_t), intent(inout) :: reader
      real(wp), intent(out) :: values(:)

      values = 0.0_wp
      if (reader%good) reader%good = size(values) <= size(reader%numbers) - reader%at
      if (.not. reader%good) return
      values = reader%numbers(reader%at + 1:reader%at + size(values))
      reader%at = reader%at + size(values)
   end subroutine take

   !> The same as a list.
   function next(reader, n) result(values)
      type(reader_t), intent(inout) :: reader
      integer, intent(in) :: n
      real(wp) :: values(n)

      call take(reader, values)
   end function next

   !> A count, which is at most the numbers that are left; 0 where the reader is not good.
   integer function next_count(reader) result(n)
      type(reader_t), intent(inout) :: reader
      real(wp) :: value(1)

      call take(reader, value)
      n = 0
      if (reader%good) reader%good = value(1) >= 0.0_wp .and. value(1) <= size(reader%numbers)
      if (reader%good) n = nint(value(1))
   end function next_count

   pure function text_of(codes) result(text)
      real(wp), intent(in) :: codes(:)
      character(size(codes)) :: text
      integer :: i

      text = ''
      do i = 1, size(codes)
         if (codes(i) >= 32.0_wp .and. codes(i) < 127.5_wp) text(i:i) = achar(nint(codes(i)))
      end do
   end function text_of
end module level_store
