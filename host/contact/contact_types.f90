! SPDX-License-Identifier: MIT
!> Options and status of the contact kernels, and what a status says in words.
module contact_types
   use kinds, only: wp, PI
   use texts, only: whole
   implicit none (type, external)
   private
   public :: TWO_PI, NODAL_GAP, POINTWISE_GAP, COMBINED_GAP
   public :: contact_options_t, has_friction, contact_status_t, contact_message
   public :: CONTACT_OK, CONTACT_BAD_EDGE, CONTACT_NOT_FINITE, CONTACT_BAD_RADIUS, CONTACT_DISTORTED_EDGE, &
             CONTACT_NO_PROJECTION

   real(wp), parameter :: TWO_PI = 2.0_wp*PI

   ! Which gap is penalised.
   integer, parameter :: NODAL_GAP = 1        !< The mean gap under each hat.
   integer, parameter :: POINTWISE_GAP = 2    !< The gap itself, paper eq. (18).
   integer, parameter :: COMBINED_GAP = 3     !< Half the penalty on each: smooth pressures, and no corner gets through.

   integer, parameter :: CONTACT_OK = 0
   integer, parameter :: CONTACT_BAD_EDGE = -1        !< An edge names a node that is not there or is used too often.
   ! Positive: a configuration that a smaller step may avoid.
   integer, parameter :: CONTACT_NOT_FINITE = 1       !< A coordinate is NaN or infinite.
   integer, parameter :: CONTACT_BAD_RADIUS = 2       !< A slave node lies at a negative radius.
   integer, parameter :: CONTACT_DISTORTED_EDGE = 3   !< An edge folds back on itself or has no length.
   integer, parameter :: CONTACT_NO_PROJECTION = 4    !< A normal of the slave misses the master edge opposite.

   type :: contact_options_t
      real(wp) :: penalty = 1.0e8_wp          !< eps [kN/m3], > 0
      real(wp) :: search_radius = 0.0_wp      !< Edges farther apart do not meet [m]; 0: length of each slave edge
      logical :: axisymmetric = .true.        !< 2 pi r, otherwise plane strain of unit thickness
      integer :: gap = COMBINED_GAP           !< NODAL_GAP, POINTWISE_GAP or COMBINED_GAP
      real(wp) :: friction = 0.0_wp           !< Coefficient mu [-], >= 0
      real(wp) :: cohesion = 0.0_wp           !< Shear stress of a contact without pressure [kPa], >= 0
      real(wp) :: tangential_penalty = 0.0_wp !< eps_T [kN/m3]; 0: a tenth of the penalty
   end type contact_options_t

   type :: contact_status_t
      integer :: code = CONTACT_OK    !< One of the codes above.
      integer :: index = 0            !< Edge or node concerned, from 1; 0 if there is none.
      logical :: master = .false.     !< The edge or node is one of the master.
      real(wp) :: value = 0.0_wp      !< Value that was found.
   end type contact_status_t
contains
   !> Whether a contact has friction.
   pure logical function has_friction(options)
      type(contact_options_t), intent(in) :: options

      has_friction = options%friction > 0.0_wp .or. options%cohesion > 0.0_wp
   end function has_friction

   !> Puts a status into words: what, where, the value, what is allowed and what to do.
   pure function contact_message(status) result(text)
      type(contact_status_t), intent(in) :: status
      character(:), allocatable :: text
      character(:), allocatable :: value
      character(13) :: digits

      write (digits, '(es13.6)') status%value
      value = trim(adjustl(digits))
      text = 'contact: '//merge('node', 'edge', any(status%code == [CONTACT_NOT_FINITE, CONTACT_BAD_RADIUS]))// &
             ' '//whole(status%index)//' of the '//trim(merge('master', 'slave ', status%master))//' surface'
      select case (status%code)
      case (CONTACT_BAD_EDGE)
         text = text//' names node '//value//': it must be one of the surface, in at most two edges, '// &
                'and a middle node in one'
      case (CONTACT_NOT_FINITE)
         text = text//' has a coordinate that is not finite: cut the step'
      case (CONTACT_BAD_RADIUS)
         text = text//' lies at radius '//value//' m, it must be >= 0: hold the nodes on the axis, or '// &
                'cut the step'
      case (CONTACT_DISTORTED_EDGE)
         text = text//' is folded or has no length (least stretch '//value//', must be > 0): keep '// &
                'the middle node within the middle half, or cut the step'
      case default
         text = text//' has a normal that misses the master edge opposite by '//value//' of its '// &
                'length: the surfaces are too strongly curved for their distance; refine the edges, lower the '// &
                'search radius or cut the step'
      end select
   end function contact_message
end module contact_types
