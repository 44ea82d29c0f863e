! SPDX-License-Identifier: MIT
!> Error against work of the schemes on the paths of docs/theory/integration.md section 6.1, as CSV on the screen.
!>
!> work_precision REFERENCE.csv   tolerances 1e-2 .. 1e-10: error, rate evaluations, substeps, nanoseconds, status
!> work_precision orders          fixed substeps: errors across kinks and on a smooth path
!>
!> The order of the reference's rows is that of PATHS. Rounds are interleaved, as in mud_benchmark; times are medians.
program work_precision
   use, intrinsic :: iso_c_binding, only: c_int, c_double, c_null_char
   use, intrinsic :: iso_fortran_env, only: int64
   use mud_interface, only: mud_default_props, mud_prepared_size, mud_prepare, mud_init, mud_update, mud_index, &
      mud_count, mud_report, MUD_PROPS, MUD_STATEV, MUD_TANGENT_NONE
   implicit none (type, external)

   integer, parameter :: wp = c_double, PARTS = 3, ROUNDS = 7, DECADES = 9
   character(*), parameter :: SCHEMES(0:3) = ['auto', 'ME21', 'BS32', 'DP54']

   !> Straight parts of strain, tension positive with engineering shear; a part of zero strain and suction is left out.
   type :: path_t
      character(24) :: name
      real(wp) :: p, void_ratio, suction
      real(wp) :: strain(6, PARTS), d_suction(PARTS)
   end type path_t

   !> What a walk ended with.
   type :: result_t
      integer :: code = 0, rates = 0, substeps = 0, rejects = 0
      real(wp) :: stress(6) = 0.0_wp, nanoseconds = 0.0_wp
   end type result_t

   real(wp), parameter :: UNDRAINED(6) = [-1.0_wp, 0.5_wp, 0.5_wp, 0.0_wp, 0.0_wp, 0.0_wp]
   real(wp), parameter :: AXIAL(6) = [-1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]
   real(wp), parameter :: EQUAL(6) = [-1.0_wp, -1.0_wp, -1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]
   character(256) :: argument

   call get_command_argument(1, argument)
   if (argument == 'orders') then
      call print_orders()
   else
      call print_work(trim(argument))
   end if
contains
   function path_of(name, p, void_ratio, suction, direction, strains, d_suction) result(path)
      character(*), intent(in) :: name
      real(wp), intent(in) :: p, void_ratio, suction, direction(6), strains(:)
      real(wp), intent(in), optional :: d_suction(:)
      type(path_t) :: path
      integer :: i

      path%name = name
      path%p = p
      path%void_ratio = void_ratio
      path%suction = suction
      path%strain = 0.0_wp
      path%d_suction = 0.0_wp
      do i = 1, size(strains)
         path%strain(:, i) = strains(i)*direction
      end do
      if (present(d_suction)) path%d_suction(1:size(d_suction)) = d_suction
   end function path_of

   !> Every part in so many increments; the parts from `timed` on count.
   subroutine walk(path, scheme, tolerance, increments, timed, result)
      type(path_t), intent(in) :: path
      integer, intent(in) :: scheme, increments, timed
      real(wp), intent(in) :: tolerance
      type(result_t), intent(out) :: result
      real(wp), allocatable :: props(:), statev(:)
      real(wp) :: material(mud_prepared_size()), suction, d_suction
      type(mud_report) :: report
      character :: text(1)
      integer(c_int) :: n_props, n_statev, code
      integer(int64) :: before, after, per_second
      integer :: part, i, n

      n_props = mud_count(MUD_PROPS)
      n_statev = mud_count(MUD_STATEV)
      allocate (props(n_props), statev(n_statev))
      call set_material_of_reference(props, n_props)
      statev = 0.0_wp
      result%stress = path%p*EQUAL
      suction = path%suction
      code = mud_prepare(props, n_props, material, size(material), text, 0_c_int)
      if (code == 0) code = mud_init(material, result%stress, suction, path%void_ratio, 0.0_wp, statev, n_statev, &
                                     text, 0_c_int)
      if (code /= 0) error stop 'work_precision: a start is not accepted'
      call system_clock(before, per_second)
      do part = 1, PARTS
         if (all(abs(path%strain(:, part)) <= 0.0_wp)) exit
         n = merge(increments, 1, part >= timed)
         call set(props, merge(scheme, 3, part >= timed), merge(tolerance, 1.0e-11_wp, part >= timed))
         code = mud_prepare(props, n_props, material, size(material), text, 0_c_int)
         if (code /= 0) error stop 'work_precision: a material is not accepted'
         if (part == timed) statev(mud_index(MUD_STATEV, 'last_step'//c_null_char) + 1) = 0.0_wp
         d_suction = path%d_suction(part)/n
         do i = 1, n
            result%code = mud_update(material, result%stress, statev, n_statev, path%strain(:, part)/n, &
                                     suction + d_suction, MUD_TANGENT_NONE, result%stress, statev, report=report)
            if (part >= timed) then
               result%rates = result%rates + report%n_rate
               result%substeps = result%substeps + report%n_substep
               result%rejects = result%rejects + report%n_reject
            end if
            if (result%code /= 0) return
            suction = suction + d_suction
         end do
      end do
      call system_clock(after)
      result%nanoseconds = real(after - before, wp)*1.0e9_wp/real(per_second, wp)
   end subroutine walk

   !> The default material, without an elastic domain and with the rule `threshold`, as the reference has it.
   subroutine set_material_of_reference(props, n_props)
      real(wp), intent(inout) :: props(:)
      integer(c_int), intent(in) :: n_props

      if (mud_default_props(props, n_props) /= 0) error stop 'work_precision: no default material'
      props(mud_index(MUD_PROPS, 'rho_e'//c_null_char) + 1) = 0.0_wp
      props(mud_index(MUD_PROPS, 'memory_rule'//c_null_char) + 1) = 1.0_wp   ! threshold
   end subroutine set_material_of_reference

   subroutine set(props, scheme, tolerance)
      real(wp), intent(inout) :: props(:)
      integer, intent(in) :: scheme
      real(wp), intent(in) :: tolerance

      props(mud_index(MUD_PROPS, 'scheme'//c_null_char) + 1) = real(scheme, wp)
      props(mud_index(MUD_PROPS, 'tolerance'//c_null_char) + 1) = tolerance
   end subroutine set

   subroutine print_work(reference)
      character(*), intent(in) :: reference
      integer, parameter :: COUNT = 8
      type(path_t) :: paths(COUNT)
      type(result_t) :: results(COUNT, 0:3, DECADES)
      real(wp) :: times(ROUNDS, COUNT, 0:3, DECADES), known(2, COUNT), doubt(COUNT), error
      integer :: i, scheme, decade, round

      paths = [path_of('undrained_e735_p100', 100.0_wp, 0.735_wp, 0.0_wp, UNDRAINED, [0.25_wp]), &
               path_of('undrained_e833_p2000', 2000.0_wp, 0.833_wp, 0.0_wp, UNDRAINED, [0.25_wp]), &
               path_of('undrained_e907_p100', 100.0_wp, 0.907_wp, 0.0_wp, UNDRAINED, [0.25_wp]), &
               path_of('extension_e833_p100', 100.0_wp, 0.833_wp, 0.0_wp, UNDRAINED, [-0.10_wp]), &
               path_of('oedometer_e8_p50', 50.0_wp, 0.8_wp, 0.0_wp, AXIAL, [0.06_wp]), &
               path_of('isotropic_e8_p50', 50.0_wp, 0.8_wp, 0.0_wp, EQUAL, [0.02_wp]), &
               path_of('unsaturated_e8_p20', 20.0_wp, 0.8_wp, 100.0_wp, UNDRAINED, [0.10_wp]), &
               path_of('figure_1_threshold', 100.0_wp, 0.735_wp, 0.0_wp, UNDRAINED, &
                       [0.10_wp, -1.5e-4_wp, 0.05015_wp])]
      call read_reference(reference, paths, known, doubt)
      do round = 1, ROUNDS
         do decade = 1, DECADES
            do scheme = 0, 3
               do i = 1, COUNT
                  call walk(paths(i), scheme, 10.0_wp**(-1 - decade), 1, 1, results(i, scheme, decade))
                  times(round, i, scheme, decade) = results(i, scheme, decade)%nanoseconds
               end do
            end do
         end do
      end do
      print '(a)', 'path,scheme,tolerance,error,uncertainty,rates,substeps,rejected,ns,status'
      do i = 1, COUNT
         do scheme = 0, 3
            do decade = 1, DECADES
               associate (r => results(i, scheme, decade))
                  error = maxval(abs(-r%stress(1:2)/known(:, i) - 1.0_wp))
                  write (*, '(4a, es7.1)', advance='no') trim(paths(i)%name), ',', SCHEMES(scheme), ',', &
                     10.0_wp**(-1 - decade)
                  if (r%code == 0) write (*, '(a, es8.2)', advance='no') ',', error
                  if (r%code /= 0) write (*, '(a)', advance='no') ','
                  print '(a, es7.1, 5(a, i0))', ',', doubt(i), ',', r%rates, ',', r%substeps, ',', r%rejects, ',', &
                     nint(median(times(:, i, scheme, decade))), ',', r%code
               end associate
            end do
         end do
      end do
   end subroutine print_work

   subroutine read_reference(name, paths, known, doubt)
      character(*), intent(in) :: name
      type(path_t), intent(in) :: paths(:)
      real(wp), intent(out) :: known(:, :), doubt(:)
      character(200) :: line
      integer :: unit, status, row, comma

      open (newunit=unit, file=name, status='old', action='read', iostat=status)
      if (status /= 0) error stop 'usage: work_precision REFERENCE.csv | orders'
      row = 0
      do
         read (unit, '(a)', iostat=status) line
         if (status /= 0) exit
         if (line(1:1) == '#' .or. line(1:5) == 'path,') cycle
         row = row + 1
         comma = index(line, ',')
         if (line(:comma - 1) /= paths(row)%name) error stop 'work_precision: the reference lists other paths'
         read (line(comma + 1:), *) known(:, row), doubt(row)
      end do
      close (unit)
      if (row /= size(paths)) error stop 'work_precision: the reference lists other paths'
   end subroutine read_reference

   !> The first part leads, tightly integrated, to the start of what is measured.
   subroutine print_orders()
      integer, parameter :: COUNT = 6, FINEST = 10
      real(wp), parameter :: SIX(6) = [-1.0_wp, 0.4_wp, 0.5_wp, -0.6_wp, 0.4_wp, -0.3_wp]
      type(path_t) :: paths(COUNT)
      type(result_t) :: reference, result
      real(wp) :: error
      integer :: i, scheme, halving

      paths = [path_of('smooth', 100.0_wp, 0.78_wp, 0.0_wp, SIX, [0.02_wp, 0.01_wp]), &
               path_of('floor', 100.0_wp, 0.78_wp, 0.0_wp, SIX, [1.0e-9_wp, 2.0e-3_wp]), &
               path_of('reversal', 100.0_wp, 0.735_wp, 0.0_wp, UNDRAINED, [0.01_wp, -0.005_wp]), &
               path_of('full_saturation', 100.0_wp, 0.85_wp, 7.0_wp, SIX, [0.01_wp, 0.01_wp], [0.0_wp, -11.0_wp]), &
               path_of('phase_transformation', 2000.0_wp, 0.833_wp, 0.0_wp, UNDRAINED, [0.01_wp, 0.15_wp]), &
               path_of('compression_line', 50.0_wp, 0.8_wp, 0.0_wp, AXIAL, [0.02_wp, 0.04_wp])]
      print '(a)', 'case,scheme,substeps,error'
      do i = 1, COUNT
         call walk(paths(i), 3, 1.0e-11_wp, 1, 2, reference)
         if (reference%code /= 0) error stop 'work_precision: a reference failed'
         do scheme = 1, 3
            do halving = 0, FINEST
               call walk(paths(i), scheme, 0.1_wp, 2**halving, 2, result)
               ! a rejected substep is cut: those are no fixed substeps
               if (result%code /= 0 .or. result%substeps /= 2**halving) cycle
               error = maxval(abs(result%stress - reference%stress))/maxval(abs(reference%stress))
               print '(4a, i0, a, es8.2)', trim(paths(i)%name), ',', SCHEMES(scheme), ',', result%substeps, ',', error
            end do
         end do
      end do
   end subroutine print_orders

   pure real(wp) function median(values)
      real(wp), intent(in) :: values(:)
      integer :: i

      median = values(1)
      do i = 1, size(values)
         if (count(values < values(i)) <= size(values)/2 .and. count(values <= values(i)) > size(values)/2) then
            median = values(i)
         end if
      end do
   end function median
end program work_precision
