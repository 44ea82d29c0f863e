! SPDX-License-Identifier: MIT
!> Status codes. Negative: the caller's mistake. Positive: a hard increment, a smaller one may pass.
module mud_status
   use mud_kinds, only: wp
   implicit none (type, external)
   private
   public :: mud_status_t, fail
   public :: MUD_OK, MUD_BAD_NPROPS, MUD_BAD_NSTATV, MUD_BAD_NTENS, MUD_BAD_PROPS, MUD_BAD_STATE, MUD_BAD_INPUT, &
             MUD_NULL_ARGUMENT, MUD_BAD_VOID_RATIO, MUD_BAD_OPTION, MUD_MINIMUM_STEP, MUD_TOO_MANY_SUBSTEPS, &
             MUD_NO_DIRECTION, MUD_VOID_RATIO_LIMIT, MUD_NOT_FINITE, MUD_INCREMENT_TOO_LARGE, MUD_NOT_WRITTEN, &
             MUD_NOT_PREPARED
   public :: ON_NOTHING, ON_PROPS, ON_STATEV, ON_STRESS, ON_STRAIN, ON_SUCTION, ON_VOID_RATIO, ON_ARGUMENT, &
             ON_ROTATION

   integer, parameter :: MUD_OK = 0
   integer, parameter :: MUD_BAD_NPROPS = -1          !< NPROPS is not the number of PROPS.
   integer, parameter :: MUD_BAD_NSTATV = -2          !< NSTATV is smaller than the number of STATEV.
   integer, parameter :: MUD_BAD_NTENS = -3           !< NTENS is neither 6 nor 4.
   integer, parameter :: MUD_BAD_PROPS = -4           !< A parameter is not finite or out of its range.
   integer, parameter :: MUD_BAD_STATE = -5           !< A state variable is not finite or impossible.
   integer, parameter :: MUD_BAD_INPUT = -6           !< Stress, strain or suction is not finite or absurdly large.
   integer, parameter :: MUD_NULL_ARGUMENT = -7       !< A pointer that must be given is NULL.
   integer, parameter :: MUD_BAD_VOID_RATIO = -8      !< The void ratio given is outside (0.01, 5).
   integer, parameter :: MUD_BAD_OPTION = -9          !< An option (list, field, tangent kind) is unknown.
   integer, parameter :: MUD_NOT_WRITTEN = -10        !< A file that was asked for could not be written.
   integer, parameter :: MUD_NOT_PREPARED = -11        !< Storage not filled by mud_prepare, or too small.
   integer, parameter :: MUD_MINIMUM_STEP = 1         !< The substep fell to its minimum.
   integer, parameter :: MUD_TOO_MANY_SUBSTEPS = 2    !< The limit of substeps is used up.
   integer, parameter :: MUD_NO_DIRECTION = 3         !< Again no admissible loading direction (guards off).
   integer, parameter :: MUD_VOID_RATIO_LIMIT = 4     !< The increment would drive e outside (0.01, 5).
   integer, parameter :: MUD_NOT_FINITE = 5           !< The result is not finite.
   integer, parameter :: MUD_INCREMENT_TOO_LARGE = 6  !< A strain component or a suction change beyond its limit.

   integer, parameter :: ON_NOTHING = 0, ON_PROPS = 1, ON_STATEV = 2, ON_STRESS = 3, ON_STRAIN = 4, ON_SUCTION = 5, &
                         ON_VOID_RATIO = 6, ON_ARGUMENT = 7, ON_ROTATION = 8

   !> A status with what a message needs: where, value and allowed range.
   type :: mud_status_t
      integer :: code = MUD_OK       !< One of the codes above.
      integer :: subject = ON_NOTHING !< Array or quantity that is meant, one of ON_*.
      integer :: index = 0           !< Entry of that array, from 1; 0 if it has none.
      real(wp) :: value = 0.0_wp     !< The offending value.
      real(wp) :: lower = 0.0_wp     !< Allowed range.
      real(wp) :: upper = 0.0_wp     !< Allowed range.
   end type mud_status_t
contains
   !> A status that says what is wrong and where. A value that is not finite is carried as it is. value, lower and upper
   !> have the unit of what subject and index name; what is not given stays zero.
   pure function fail(code, subject, index, value, lower, upper) result(status)
      integer, intent(in) :: code
      integer, intent(in), optional :: subject, index
      real(wp), intent(in), optional :: value, lower, upper
      type(mud_status_t) :: status

      status%code = code
      if (present(subject)) status%subject = subject
      if (present(index)) status%index = index
      if (present(value)) status%value = value
      if (present(lower)) status%lower = lower
      if (present(upper)) status%upper = upper
   end function fail
end module mud_status
