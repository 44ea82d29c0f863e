! SPDX-License-Identifier: MIT
!> Effects that a scene may or may not call for: the row of their table.
module effect_types
   use kinds, only: wp
   use scene_types, only: NAME_LENGTH
   implicit none (type, external)
   private
   public :: effect_t, effect_options_t, OF_P_W, OF_P_C, OF_INERTIA, OF_SEEPAGE, OF_GRAVITY, UNBOUNDED, UNKNOWN, NEVER

   integer, parameter :: OF_P_W = 1, OF_P_C = 2, OF_INERTIA = 3, OF_SEEPAGE = 4, OF_GRAVITY = 5
   real(wp), parameter :: UNBOUNDED = 1.0e30_wp   !< An estimate without a bound.
   real(wp), parameter :: UNKNOWN = -1.0_wp       !< No estimate: it has no meaning here.
   real(wp), parameter :: NEVER = -1.0e30_wp      !< A time.

   type :: effect_t
      integer :: kind = 0                         !< One of OF_...
      integer :: stage = 0                        !< Number of the stage, of the inertia.
      character(NAME_LENGTH + 16) :: name = ''
      logical :: on = .false., by_hand = .false.
      real(wp) :: estimate = UNKNOWN, threshold = 0.0_wp
      character(8) :: unit = '-'
      integer :: unknowns = 0, entries = 0        !< It costs so many, also of the matrix.
      character(128) :: why = ''
      ! Monitored during the run where it is off.
      logical :: monitored = .false.
      real(wp) :: scale = 1.0_wp                  !< What the indicator is measured with, see effect_monitor.
      real(wp) :: largest = 0.0_wp                !< Indicator so far,
      real(wp) :: crossed = NEVER                 !< time when it crossed the threshold [s].
   end type effect_t

   !> What is to be derived, and how small an effect must be to be left out.
   type :: effect_options_t
      logical :: auto = .false.
      logical :: fields_by_hand = .true., gravity_by_hand = .true., seepage_by_hand = .true.
      real(wp) :: tolerance = 0.01_wp             !< Share [-]
   end type effect_options_t
end module effect_types
