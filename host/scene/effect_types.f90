! SPDX-License-Identifier: MIT
!> Effects that a scene may or may not need: their names, and the row of their table.
module effect_types
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: effect_t, EFFECT_NAMES, EFFECT_WORDS, EFFECTS, EFFECT_LENGTH, UNKNOWN, NEVER, indicator_place
   public :: OF_INERTIA, OF_SEEPAGE, OF_P_W, OF_P_C, OF_GRAVITY, OF_CONTACT, OF_DAMPING, OF_ABSORBING, OF_DRAINAGE, &
             OF_LIMITS, OF_FRICTION, OF_STRENGTH, OF_VOID_RATIO, OF_HYSTERESIS, OF_BONDING, OF_FABRIC, OF_ISOTROPIC, &
             OF_LODE, OF_MEMORY, OF_ELASTIC_DOMAIN, OF_FLOW

   integer, parameter :: EFFECTS = 20, EFFECT_LENGTH = 26
   integer, parameter :: OF_INERTIA = 1, OF_SEEPAGE = 2, OF_P_W = 3, OF_P_C = 4, OF_GRAVITY = 5, OF_CONTACT = 6, &
      OF_DAMPING = 7, OF_ABSORBING = 8, OF_DRAINAGE = 9, OF_LIMITS = 10, OF_FRICTION = 11, &
      OF_STRENGTH = 12, OF_VOID_RATIO = 13, OF_HYSTERESIS = 14, OF_BONDING = 15, OF_FABRIC = 16, OF_ISOTROPIC = 17, &
      OF_LODE = 18, OF_MEMORY = 19, OF_ELASTIC_DOMAIN = 20
   integer, parameter :: OF_FLOW = EFFECTS + 1   !< Of water and air in one region: `drainage` of &region says it.
   !> The word of every effect: in tables, and in the key `without` of &scene (which takes those of the list below).
   character(EFFECT_LENGTH), parameter :: EFFECT_NAMES(EFFECTS) = [character(EFFECT_LENGTH) :: 'inertia', &
      'relative_acceleration', 'p_w', 'p_c', 'gravity', 'contact', 'damping', 'absorbing', 'contact_drainage', &
      'seepage_face', 'friction', 'strength', 'void_ratio_in_retention', 'hysteresis', 'bonding', 'fabric', &
      'isotropic', 'lode', 'memory_rule', 'elastic_domain']
   !> The same as one list of words.
   character(*), parameter :: EFFECT_WORDS = &
      trim(EFFECT_NAMES(1))//'|'//trim(EFFECT_NAMES(2))//'|'// &
      trim(EFFECT_NAMES(3))//'|'//trim(EFFECT_NAMES(4))//'|'// &
      trim(EFFECT_NAMES(5))//'|'//trim(EFFECT_NAMES(6))//'|'// &
      trim(EFFECT_NAMES(7))//'|'//trim(EFFECT_NAMES(8))//'|'// &
      trim(EFFECT_NAMES(9))//'|'//trim(EFFECT_NAMES(10))//'|'// &
      trim(EFFECT_NAMES(11))//'|'//trim(EFFECT_NAMES(12))//'|'// &
      trim(EFFECT_NAMES(13))//'|'//trim(EFFECT_NAMES(14))//'|'// &
      trim(EFFECT_NAMES(15))//'|'//trim(EFFECT_NAMES(16))//'|'// &
      trim(EFFECT_NAMES(17))//'|'//trim(EFFECT_NAMES(18))//'|'// &
      trim(EFFECT_NAMES(19))//'|'//trim(EFFECT_NAMES(20))
   real(wp), parameter :: UNKNOWN = -1.0_wp    !< No number: it was not tried, or has no meaning.
   real(wp), parameter :: NEVER = -1.0e30_wp   !< A time.

   type :: effect_t
      integer :: kind = 0                      !< One of OF_...
      integer :: stage = 0                     !< Number of the stage, of the inertia; 0: all.
      integer :: region = 0                    !< Number of the region, of the flow; 0: all.
      character(96) :: name = ''
      logical :: present = .false.             !< In the scene as it was given.
      logical :: by_hand = .true.              !< A key sets it, so that nothing else decides.
      logical :: on = .false.                  !< In the run.
      logical :: tried_in = .false.            !< In the pilots that others are compared with.
      logical :: added = .false.               !< In the run, and not in the scene as it was given.
      real(wp) :: influence = UNKNOWN          !< Largest change of an answer without it (or with it) [-].
      real(wp) :: change = 0.0_wp              !< The largest change with its sign, in the unit of the answer.
      character(72) :: answer = ''             !< The answer that changes most.
      integer :: unknowns = 0                  !< Fewer (more) without (with) it, in the pilot.
      real(wp) :: seconds = UNKNOWN            !< Processor time of its pilot over that of the whole scene's [-].
      character(200) :: why = ''
      ! Monitored during the run where a pilot removed it.
      real(wp) :: limit = UNKNOWN              !< Of the indicator, see effect_monitor.
      real(wp) :: largest = 0.0_wp             !< Largest value of the indicator so far.
      real(wp) :: crossed = NEVER              !< Time when the indicator passed the limit [s].
   end type effect_t
contains
   !> Place of an effect among the indicators of a run: those of the list, then one a region for its flow.
   pure integer function indicator_place(effect) result(place)
      type(effect_t), intent(in) :: effect

      place = effect%kind
      if (effect%kind == OF_FLOW) place = EFFECTS + effect%region
   end function indicator_place
end module effect_types
