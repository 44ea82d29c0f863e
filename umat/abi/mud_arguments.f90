! SPDX-License-Identifier: MIT
!> Reads what hosts pass to umat_, with NULL pointers, memory that was never set and other orders of components.
module mud_arguments
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_associated, c_f_pointer
   use mud_host_increment, only: never_began, suction_change
   use mud_kinds, only: wp, NOTHING
   use mud_params, only: completed, is_length
   use mud_registry, only: NPROPS, NPROPS_BASE, NSTATV_BASE, P_SHEAR_ORDER, S_SUCTION
   use mud_status, only: fail, mud_status_t, MUD_BAD_NTENS, MUD_NULL_ARGUMENT, MUD_BAD_NPROPS, MUD_BAD_NSTATV, &
      MUD_BAD_INPUT, ON_ARGUMENT, ON_PROPS, ON_STATEV, ON_ROTATION
   use mud_tensor, only: is_finite, within
   use mud_units, only: stress_unit, LARGEST_STRESS
   implicit none (type, external)
   private
   public :: check_arguments, rotates, read_rotation, turns_unread, begins_late, is_green_strain, suction_t, &
             read_suction, component_order, integer_at, real_at, SUCTION_AS_GIVEN, SUCTION_CONTRADICTS, &
             SUCTION_UNREADABLE, ARGUMENT_NAMES

   !> DROT may differ from a rotation by this, rounding of single-precision hosts [-].
   real(wp), parameter :: ORTHOGONAL = 1.0e-6_wp
   !> PREDEF may differ from the suction of STATEV by this share of the larger one, or of an atmosphere: rounding of
   !> single-precision hosts, and of a suction that returns to zero [-, kPa].
   real(wp), parameter :: SAME_SUCTION = 1.0e-6_wp, ATMOSPHERE = 100.0_wp
   !> PNEWDT with which CalculiX enters. It passes PREDEF and DPRED that it has never set, and a DROT that its finite
   !> strains (@ABAQUSNL) do not follow.
   real(wp), parameter :: PNEWDT_OF_CALCULIX = -1.0_wp
   !> TIME(2) up to this share of DTIME is the beginning of the analysis: rounding of sums of times [-].
   real(wp), parameter :: AT_THE_START = 1.0e-6_wp
   !> Green's and logarithmic strain are told apart where their traces differ by more than TELLABLE [-]; a trace within
   !> CLOSE of that difference belongs to Green's.
   real(wp), parameter :: TELLABLE = 1.0e-7_wp, CLOSE = 1.0e-2_wp
   real(wp), parameter :: LARGEST_GRADIENT = 100.0_wp   !< A larger entry of DFGRD1 is memory that was never set [-].

   integer, parameter :: SUCTION_AS_GIVEN = 0, SUCTION_CONTRADICTS = 1, SUCTION_UNREADABLE = 2
   !> Arguments that must be given, in the order in which status%index counts them.
   character(6), parameter :: ARGUMENT_NAMES(7) = ['STRESS', 'STATEV', 'DSTRAN', 'NTENS ', 'NSTATV', 'PROPS ', 'NPROPS']

   !> Suction at the start of an increment and its change [kPa], and whether the host's numbers were taken.
   type :: suction_t
      real(wp) :: start = 0.0_wp, change = 0.0_wp
      integer :: reading = SUCTION_AS_GIVEN   !< One of SUCTION_*.
      real(wp) :: predef = 0.0_wp             !< PREDEF(1) as the host gave it [kPa].
   end type suction_t
contains
   !> NULL pointers, NTENS, and counts that would make the arrays unreadable. MUD_NULL_ARGUMENT with the place in
   !> ARGUMENT_NAMES, MUD_BAD_NTENS (NTENS neither 6 nor 4, NDI not 3), MUD_BAD_NPROPS (below 1), MUD_BAD_NSTATV (too
   !> small).
   subroutine check_arguments(stress, statev, dstran, ndi, ntens, nstatv_, props, nprops_, status)
      type(c_ptr), intent(in) :: stress, statev, dstran, ndi, ntens, nstatv_, props, nprops_
      type(mud_status_t), intent(out) :: status
      logical :: given(7)
      integer :: n

      given = [c_associated(stress), c_associated(statev), c_associated(dstran), c_associated(ntens), &
               c_associated(nstatv_), c_associated(props), c_associated(nprops_)]
      if (.not. all(given)) then
         status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT, findloc(given, .false., dim=1))
         return
      end if
      n = integer_at(ntens)
      if (n /= 6 .and. n /= 4) then
         status = fail(MUD_BAD_NTENS, ON_ARGUMENT, 0, real(n, wp), 4.0_wp, 6.0_wp)
         return
      end if
      if (c_associated(ndi)) then
         if (integer_at(ndi) /= 3) then
            status = fail(MUD_BAD_NTENS, ON_ARGUMENT, 0, real(integer_at(ndi), wp), 3.0_wp, 3.0_wp)
            return
         end if
      end if
      n = integer_at(nprops_)
      if (n < 1) status = fail(MUD_BAD_NPROPS, ON_PROPS, 0, real(n, wp), &
                                    real(NPROPS_BASE, wp), real(NPROPS, wp))
      n = integer_at(nstatv_)
      if (n < NSTATV_BASE) &
         status = fail(MUD_BAD_NSTATV, ON_STATEV, 0, real(n, wp), real(NSTATV_BASE, wp), huge(1.0_wp))
   end subroutine check_arguments

   !> DROT as a matrix. None where it is NULL or zero, where the point has no past that could be rotated (hosts without
   !> finite rotations pass memory that was never set), and from CalculiX, whose stress and strain stand in axes that do
   !> not turn. Anything else that is no rotation is refused. Its status is MUD_BAD_INPUT on ON_ROTATION; entries [-],
   !> orthogonality to a tolerance.
   subroutine read_rotation(drot, past, pnewdt, rotation, status)
      type(c_ptr), intent(in) :: drot, pnewdt
      logical, intent(in) :: past
      real(wp), intent(out) :: rotation(3, 3)
      type(mud_status_t), intent(out) :: status
      real(c_double), pointer, contiguous :: matrix(:)
      real(wp) :: given(9), deviation
      integer :: i

      rotation = unit_matrix()
      if (enters_as_calculix(pnewdt)) return
      if (.not. (past .and. c_associated(drot))) return
      call c_f_pointer(drot, matrix, [9])
      do i = 1, 9
         given(i) = matrix(i)
         if (within(given(i), NOTHING)) given(i) = 0.0_wp   ! memory that was never set often reads so
         if (within(given(i), 1.0_wp + ORTHOGONAL)) cycle
         status = fail(MUD_BAD_INPUT, ON_ROTATION, i, given(i), -1.0_wp, 1.0_wp)
         return
      end do
      if (all(abs(given) <= 0.0_wp)) return
      rotation = reshape(given, [3, 3])
      deviation = maxval(abs(matmul(rotation, transpose(rotation)) - unit_matrix()))
      if (deviation > ORTHOGONAL) then
         status = fail(MUD_BAD_INPUT, ON_ROTATION, 0, deviation, 0.0_wp, ORTHOGONAL)
      else if (determinant(rotation) < 0.0_wp) then
         status = fail(MUD_BAD_INPUT, ON_ROTATION, 10, determinant(rotation), 1.0_wp, 1.0_wp)
      end if
   end subroutine read_rotation

   !> True if a DROT that is more than no rotation is not read, because the host enters as CalculiX does.
   logical function turns_unread(drot, pnewdt)
      type(c_ptr), intent(in) :: drot, pnewdt
      real(wp) :: given(3, 3)

      turns_unread = .false.
      if (.not. enters_as_calculix(pnewdt)) return
      if (.not. c_associated(drot)) return
      given = matrix_at(drot)
      if (.not. all(is_finite(given))) return
      turns_unread = maxval(abs(matmul(given, transpose(given)) - unit_matrix())) <= ORTHOGONAL &
                     .and. maxval(abs(given - unit_matrix())) > ORTHOGONAL
   end function turns_unread

   !> True if a point without a past begins in the midst of an analysis: TIME(2), the time at the start of the
   !> increment, is beyond the first. Only of hosts that give PNEWDT: of the others some pass one number as TIME, as
   !> Kratos does.
   logical function begins_late(past, time, dtime, pnewdt)
      logical, intent(in) :: past
      type(c_ptr), intent(in) :: time, dtime, pnewdt
      real(c_double), pointer, contiguous :: times(:)
      real(wp) :: step

      begins_late = .false.
      if (past .or. .not. (c_associated(time) .and. c_associated(pnewdt))) return
      call c_f_pointer(time, times, [2])
      step = real_at(dtime)
      if (.not. (is_finite(times(2)) .and. is_finite(step))) return
      begins_late = times(2) > max(AT_THE_START*step, NOTHING)
   end function begins_late

   !> True if a host that enters as CalculiX does gives Green's strain, (F^T F - 1)/2, where MUD takes the logarithmic
   !> one: its door @ABAQUS with finite strains (NLGEOM), for which it has @ABAQUSNL. Seen by the traces of the total
   !> strain at the end, which no rotation changes: (|F|^2 - 3)/2 against ln det F.
   logical function is_green_strain(stran, dstran, dfgrd1, pnewdt)
      type(c_ptr), intent(in) :: stran, dstran, dfgrd1, pnewdt
      real(c_double), pointer, contiguous :: strain(:), increment(:)
      real(wp) :: f(3, 3), green, logarithmic, given

      is_green_strain = .false.
      if (.not. enters_as_calculix(pnewdt)) return
      if (.not. (c_associated(stran) .and. c_associated(dfgrd1))) return
      call c_f_pointer(stran, strain, [3])
      call c_f_pointer(dstran, increment, [3])
      f = matrix_at(dfgrd1)
      if (.not. (all(is_finite(f)) .and. all(is_finite(strain)) .and. all(is_finite(increment)))) return
      if (.not. (maxval(abs(f)) < LARGEST_GRADIENT .and. determinant(f) > 0.0_wp)) return
      given = sum(strain) + sum(increment)
      green = 0.5_wp*(sum(f**2) - 3.0_wp)
      logarithmic = log(determinant(f))
      if (abs(green - logarithmic) > TELLABLE) &
         is_green_strain = abs(given - green) <= CLOSE*abs(green - logarithmic)
   end function is_green_strain

   !> Nine numbers of a host, by columns.
   function matrix_at(pointer) result(matrix)
      type(c_ptr), intent(in) :: pointer
      real(wp) :: matrix(3, 3)
      real(c_double), pointer, contiguous :: given(:, :)

      call c_f_pointer(pointer, given, [3, 3])
      matrix = given
   end function matrix_at

   pure real(wp) function determinant(a)
      real(wp), intent(in) :: a(3, 3)

      determinant = a(1, 1)*(a(2, 2)*a(3, 3) - a(2, 3)*a(3, 2)) - a(1, 2)*(a(2, 1)*a(3, 3) - a(2, 3)*a(3, 1)) &
                    + a(1, 3)*(a(2, 1)*a(3, 2) - a(2, 2)*a(3, 1))
   end function determinant

   !> True if there is something to rotate: a rotation that is not exactly none, and numbers. False for a STATEV that is
   !> not finite: the update refuses it.
   pure logical function rotates(rotation, statev)
      real(wp), intent(in) :: rotation(3, 3), statev(:)

      rotates = any(abs(rotation - unit_matrix()) > 0.0_wp)
      if (rotates) rotates = all(is_finite(statev))
   end function rotates

   pure function unit_matrix() result(unit)
      real(wp) :: unit(3, 3)
      integer :: i

      unit = 0.0_wp
      do i = 1, 3
         unit(i, i) = 1.0_wp
      end do
   end function unit_matrix

   !> Suction and its change. The degree of saturation may not jump between two increments, so the suction that STATEV
   !> holds is the start, as in mud_update, and PREDEF + DPRED the end; that PREDEF says otherwise is read off. In the
   !> unit of p_atm; props(:) of any size, of which p_atm counts. Nothing is refused: a suction that is not finite or
   !> too large is handed on as it is.
   type(suction_t) function read_suction(predef, dpred, pnewdt, statev, props) result(suction)
      type(c_ptr), intent(in) :: predef, dpred, pnewdt
      real(wp), intent(in) :: statev(:), props(:)
      real(wp) :: stored, unit

      suction = suction_t(value_if_set(predef), value_if_set(dpred))
      suction%predef = suction%start
      stored = statev(S_SUCTION)
      if (enters_as_calculix(pnewdt)) then
         if (is_set(suction%start) .or. is_set(suction%change)) suction%reading = SUCTION_UNREADABLE
         suction%start = stored
         suction%change = 0.0_wp
      else if (.not. c_associated(predef)) then
         suction%start = stored
      else if (.not. never_began(statev)) then
         if (.not. is_length(size(props))) return
         unit = stress_unit(completed(props))
         ! What is beyond the largest suction is refused as it is.
         if (.not. (within(suction%start, LARGEST_STRESS*unit) .and. within(stored, LARGEST_STRESS*unit))) return
         if (.not. is_finite(suction%change)) return
         if (.not. within(suction%start - stored, SAME_SUCTION*max(abs(suction%start), abs(stored), &
                                                                   ATMOSPHERE*unit))) then
            suction%reading = SUCTION_CONTRADICTS
         end if
         suction%change = suction_change(stored, suction%start + suction%change)
         suction%start = stored
      end if
   end function read_suction

   logical function enters_as_calculix(pnewdt)
      type(c_ptr), intent(in) :: pnewdt

      enters_as_calculix = .false.
      if (.not. is_finite(real_at(pnewdt))) return
      enters_as_calculix = abs(real_at(pnewdt) - PNEWDT_OF_CALCULIX) <= 0.0_wp
   end function enters_as_calculix

   !> Order in which a host has the components that MUD has as 11, 22, 33, 12, 13, 23. It is its own inverse. props(:)
   !> of any size; the order of MUD where the size or shear_order is not good.
   pure function component_order(props) result(order)
      real(wp), intent(in) :: props(:)
      integer :: order(6)

      order = [1, 2, 3, 4, 5, 6]
      if (.not. is_length(size(props))) return
      if (.not. is_finite(props(P_SHEAR_ORDER))) return
      if (nint(min(max(props(P_SHEAR_ORDER), 0.0_wp), 1.0_wp)) == 1) order = [1, 2, 3, 4, 6, 5]
   end function component_order

   !> First number of an optional array, 0 where the host gives none. The pointer is NULL or points to an int of C.
   integer function integer_at(pointer)
      type(c_ptr), intent(in) :: pointer
      integer(c_int), pointer :: value

      integer_at = 0
      if (.not. c_associated(pointer)) return
      call c_f_pointer(pointer, value)
      integer_at = value
   end function integer_at

   !> Value of a real argument, 0 where its pointer is NULL; it points to a double of C.
   real(wp) function real_at(pointer)
      type(c_ptr), intent(in) :: pointer
      real(c_double), pointer :: value

      real_at = 0.0_wp
      if (.not. c_associated(pointer)) return
      call c_f_pointer(pointer, value)
      real_at = value
   end function real_at

   !> Value of a real argument, 0 where its pointer is NULL or the value is far below any physical number.
   real(wp) function value_if_set(pointer)
      type(c_ptr), intent(in) :: pointer

      value_if_set = real_at(pointer)
      if (.not. is_set(value_if_set)) value_if_set = 0.0_wp
   end function value_if_set

   pure logical function is_set(value)
      real(wp), intent(in) :: value

      is_set = .not. within(value, NOTHING)
   end function is_set
end module mud_arguments
