! SPDX-License-Identifier: MIT
!> Parts of a model that are as the scene says them: where a group stands, histories and stages. Defaults are those of
!> the keys; a value outside of the range of its key says that it is not given.
module scene_parts
   use kinds, only: wp
   use faults, only: at_line
   use generalised_alpha, only: analysis_t
   use history_shapes, only: arc_at
   use solution, only: BY_STAGE
   use texts, only: LENGTH, PATH_LENGTH
   use unknown_fields, only: FIELDS, FIELD_NAMES
   implicit none (type, external)
   private
   public :: origin_t, scene_item_t, amplitude_t, stage_t
   public :: NAME_LENGTH, NEVER, place_of, amplitude_at
   public :: PRESCRIBED_P_A, PRESCRIBED_WORDS, PRESCRIBED_OF_BODY
   public :: LOAD_PRESSURE, LOAD_SHEAR_R, LOAD_SHEAR_Z, LOAD_WATER, LOAD_RAIN, LOAD_AIR, LOAD_FORCE_R, LOAD_FORCE_Z, &
             LOAD_OF_BODY

   integer, parameter :: NAME_LENGTH = 64         !< Longest name that a scene gives.
   integer, parameter :: FINGERPRINT_LENGTH = 16

   ! Numbers of words, in the order of those of the key (a test holds the two together).
   integer, parameter :: PRESCRIBED_P_A = FIELDS + 1   !< &fix field, after those of unknown_fields: air pressure.
   character(3), parameter :: PRESCRIBED_WORDS(*) = [FIELD_NAMES, 'p_a']   !< Of &fix field, but for the next one.
   integer, parameter :: PRESCRIBED_OF_BODY = FIELDS + 2  !< &fix field: coordinate of a plate alone; read as u_z.
   integer, parameter :: LOAD_PRESSURE = 1    !< &load kind: against the outward normal [kPa].
   integer, parameter :: LOAD_SHEAR_R = 2, LOAD_SHEAR_Z = 3   !< &load kind: along the axes [kPa].
   integer, parameter :: LOAD_WATER = 4, LOAD_AIR = 6         !< &load kind: inflow [m/s].
   integer, parameter :: LOAD_RAIN = 5        !< &load kind: inflow until the surface ponds [m/s].
   integer, parameter :: LOAD_FORCE_R = 7, LOAD_FORCE_Z = 8   !< &load kind: on every node of a group [kN].
   integer, parameter :: LOAD_OF_BODY = 9     !< &load kind: on a coordinate of a plate alone; LOAD_FORCE_Z.
   real(wp), parameter :: NEVER = huge(1.0_wp)   !< A limit of times or values that is none.

   !> Which scene a model is of, for files of results and sentences.
   type :: origin_t
      character(PATH_LENGTH) :: file = ''
      character(NAME_LENGTH) :: name = ''
      character(FINGERPRINT_LENGTH) :: fingerprint = ''
      integer, allocatable :: hashes(:)              !< Two for every group, see scene_fingerprint.
      character(LENGTH), allocatable :: groups(:)    !< Where each stands, as '&load in line 7'.
   end type origin_t

   !> Where a group of the scene begins, for sentences about it.
   type :: scene_item_t
      character(PATH_LENGTH) :: file = ''
      integer :: line = 0
   end type scene_item_t

   !> How a value changes with time.
   type, extends(scene_item_t) :: amplitude_t
      character(NAME_LENGTH) :: name = ''
      real(wp), allocatable :: times(:), values(:)
      integer, allocatable :: arcs(:)                !< Ways between the pairs (history_shapes); none: straight.
      character(LENGTH), allocatable :: stages(:)    !< From whose starts the times count; none: that of the run.
   end type amplitude_t

   type, extends(analysis_t) :: stage_t
      character(NAME_LENGTH) :: name = ''
      real(wp) :: start = 0.0_wp                     !< When the stages before it end [s].
      real(wp) :: duration = 0.0_wp, dt = 0.0_wp, dt_growth = 1.0_wp, dt_max = NEVER
      logical :: controlled = .false.                !< Steps are chosen from their error.
      real(wp) :: step_tolerance = 0.0_wp            !< Of those steps [-].
      real(wp) :: output_dt = 0.0_wp
      real(wp), allocatable :: ends(:)               !< Given steps end here, after the start of the stage [s].
      integer :: cuts = 10, max_iterations = 12, every = 1, fields = 0
      real(wp) :: rho_inf = -1.0_wp, tolerance = 1.0e-3_wp, created_energy = 0.01_wp
      integer :: measure = BY_STAGE                  !< See solution.
      logical :: film = .true.                       !< No key says when fields are written.
      logical :: no_predictor = .false., solve_start = .true., zero_displacements = .false.
   end type stage_t
contains
   !> Says where a group of the scene begins, as "FILE:LINE: ".
   pure function place_of(item) result(place)
      class(scene_item_t), intent(in) :: item
      character(:), allocatable :: place

      place = at_line(item%file, item%line)
   end function place_of

   !> Evaluates an amplitude at a time: straight lines or arcs join its pairs, outside it is constant. [-]
   pure real(wp) function amplitude_at(amplitude, time) result(factor)
      type(amplitude_t), intent(in) :: amplitude
      real(wp), intent(in) :: time   !< [s]
      real(wp) :: share
      integer :: low, high, i

      associate (t => amplitude%times, v => amplitude%values)
         high = size(t)
         factor = v(1)
         if (time <= t(1)) return
         factor = v(high)
         if (time > t(high)) return
         ! By halves: an earthquake has thousands of pairs.
         low = 1
         do while (high - low > 1)
            i = (low + high)/2
            if (time > t(i)) then
               low = i
            else
               high = i
            end if
         end do
         share = (time - t(low))/(t(high) - t(low))
         if (size(amplitude%arcs) > 0) share = arc_at(amplitude%arcs(low), share)
         factor = v(low) + (v(high) - v(low))*share
      end associate
   end function amplitude_at
end module scene_parts
