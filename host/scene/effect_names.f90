! SPDX-License-Identifier: MIT
!> Effects that a scene may or may not need, by name: the words of the key `without`.
module effect_names
   implicit none (type, external)
   private
   public :: EFFECTS, EFFECT_WORDS, term_switch_t, TERM_SWITCHES
   public :: OF_INERTIA, OF_SEEPAGE, OF_P_W, OF_P_C, OF_GRAVITY, OF_CONTACT, OF_DAMPING, OF_LIMITS, OF_VOID_RATIO, &
             OF_HYSTERESIS, OF_ELASTIC_DOMAIN

   integer, parameter :: NAMES = 20, LENGTH = 26
   integer, parameter :: OF_INERTIA = 1, OF_SEEPAGE = 2, OF_P_W = 3, OF_P_C = 4, OF_GRAVITY = 5, OF_CONTACT = 6, &
      OF_DAMPING = 7, OF_ABSORBING = 8, OF_DRAINAGE = 9, OF_LIMITS = 10, OF_FRICTION = 11, &
      OF_STRENGTH = 12, OF_VOID_RATIO = 13, OF_HYSTERESIS = 14, &
      OF_ELASTIC_DOMAIN = 20   ! What lies between: switches of the material.
   character(LENGTH), parameter :: EFFECTS(NAMES) = [character(LENGTH) :: 'inertia', &
      'relative_acceleration', 'p_w', 'p_c', 'gravity', 'contact', 'damping', 'absorbing', 'contact_drainage', &
      'seepage_face', 'friction', 'strength', 'void_ratio_in_retention', 'hysteresis', 'bonding', 'fabric', &
      'isotropic', 'lode', 'memory_rule', 'elastic_domain']
   !> Terms go with the groups, or the keys of groups, that ask for them.
   type :: term_switch_t
      integer :: effect
      character(12) :: group
      character(12) :: key    !< Empty: the groups themselves.
      character(8) :: none    !< Value of the key without the term.
      logical :: wet = .false.   !< It is about pore water, and goes with it.
   end type term_switch_t

   type(term_switch_t), parameter :: TERM_SWITCHES(*) = [ &
      term_switch_t(OF_DAMPING, 'region', 'viscosity', '0'), &
      term_switch_t(OF_ABSORBING, 'absorbing', '', ''), &
      term_switch_t(OF_DRAINAGE, 'contact', 'drainage', 'fixed', wet=.true.), &
      term_switch_t(OF_FRICTION, 'contact', 'friction', '0'), &
      term_switch_t(OF_FRICTION, 'contact', 'cohesion', '0'), &
      term_switch_t(OF_STRENGTH, 'strength', '', '')]

   !> The same as one list of words.
   character(*), parameter :: EFFECT_WORDS = &
      trim(EFFECTS(1))//'|'//trim(EFFECTS(2))//'|'//trim(EFFECTS(3))//'|'//trim(EFFECTS(4))//'|'// &
      trim(EFFECTS(5))//'|'//trim(EFFECTS(6))//'|'//trim(EFFECTS(7))//'|'//trim(EFFECTS(8))//'|'// &
      trim(EFFECTS(9))//'|'//trim(EFFECTS(10))//'|'//trim(EFFECTS(11))//'|'//trim(EFFECTS(12))//'|'// &
      trim(EFFECTS(13))//'|'//trim(EFFECTS(14))//'|'//trim(EFFECTS(15))//'|'//trim(EFFECTS(16))//'|'// &
      trim(EFFECTS(17))//'|'//trim(EFFECTS(18))//'|'//trim(EFFECTS(19))//'|'//trim(EFFECTS(20))
end module effect_names
