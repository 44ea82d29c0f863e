! SPDX-License-Identifier: MIT
!> A material point, the interface between programs and laws: host and drivers use this type only, a law extends it.
!> Conventions are those of a UMAT: tension positive, components 11, 22, 33, 12, 13, 23, engineering shear; stress is
!> effective; suction p_c = p_a - p_w is positive where unsaturated. Degree of saturation and void ratio come from the
!> law alone.
module material_point
   use kinds, only: wp
   use retention_curves, only: retention_t, saturation_t
   use stress_units, only: stress_unit_t
   use texts, only: short
   implicit none (type, external)
   private
   public :: material_t, material_slot_t, response_t, batch_report_t, remark_t, retention_by_curve, state_index, swollen
   public :: lost_pressure, PRESSURE_LOST, CYCLES_UNTRUSTED, MANY_REVERSALS, range_t, untested
   public :: MOST_POINTS, MOST_ELEMENTS, MOST_GUARDS, NAME_LENGTH, DOUBT_LENGTH, WITH_TANGENT, NO_PRESET

   integer, parameter :: MOST_ELEMENTS = 8                !< Most elements whose points are one batch.
   integer, parameter :: MOST_POINTS = 12*MOST_ELEMENTS   !< Most points of a batch: of elements with 12 each.
   integer, parameter :: MOST_GUARDS = 16   !< Counters of a law beside the three that every law has.
   integer, parameter :: NAME_LENGTH = 24
   integer, parameter :: DOUBT_LENGTH = 500
   logical, parameter :: WITH_TANGENT = .true.
   !> Refusal of a degree of saturation at the start by a law in which it has no history.
   character(*), parameter :: NO_PRESET = 'the degree of saturation of this material follows from the suction: '// &
      'leave saturation out of &initial, or give the material hysteresis = 1 (&mud)'

   !> Sentence on a point without mean effective stress. The library says it to hosts of umat_.
   character(*), parameter :: PRESSURE_LOST = 'the model has no meaning below 0, and its tension cut-off is off. '// &
      'Do not use the results from here on; set cutoff = 1.'

   !> Sentence on a load that has turned more often than MANY_REVERSALS.
   character(*), parameter :: CYCLES_UNTRUSTED = 'settlement that cycles accumulate is not to be trusted. After '// &
      'hundreds of drained cycles this soil model strains 40 to 90 times as much as tests do '// &
      '(verification/material/drained_cycles/README.md).'
   integer, parameter :: MANY_REVERSALS = 20

   !> Report of a batch of updates.
   type :: batch_report_t
      integer :: code = 0         !< 0: done; negative: the caller's mistake; positive: a hard increment.
      integer :: point = 0        !< The first point that failed.
      real(wp) :: factor = 1.0_wp !< Suggested factor on the increment, below 1 after a failure.
      integer :: n_rate = 0       !< Rate evaluations, of all points.
      integer :: n_substep = 0    !< Accepted substeps.
      integer :: n_reject = 0     !< Rejected substeps.
      integer :: guards(MOST_GUARDS) = 0   !< Number of times that each guard of the law acted; their names are in the
                                           !< law.
      integer :: subject = 0, entry = 0    !< Subject of a failure, by the law's own count.
      real(wp) :: value = 0.0_wp, lower = 0.0_wp, upper = 0.0_wp   !< Offending value and its allowed range.
      real(wp) :: reached = 1.0_wp         !< Share of the increment that was integrated.
   end type batch_report_t

   !> Answers of a batch, as many columns as there are points. Tangent blocks only where they were asked for. No
   !> component has a default: it would be paid for with the whole of the type at every batch.
   type :: response_t
      real(wp) :: stress(6, MOST_POINTS)          !< sigma' [kPa]
      real(wp) :: dsig_deps(6, 6, MOST_POINTS)    !< d sigma'/d strain [kPa]
      real(wp) :: dsig_dpc(6, MOST_POINTS)        !< d sigma'/d p_c [-]
      real(wp) :: s_w(MOST_POINTS)                !< Degree of saturation [-]
      real(wp) :: dsw_dev(MOST_POINTS)            !< d S_w/d volumetric strain, expansion positive [-]
      real(wp) :: dsw_dpc(MOST_POINTS)            !< d S_w/d p_c [1/kPa]
      real(wp) :: void_ratio(MOST_POINTS)         !< [-]
   end type response_t

   !> A fact about a law, for the head of a file of results.
   type :: remark_t
      character(64) :: name = ''
      character(200) :: text = ''
   end type remark_t

   !> The least and the largest of something.
   type :: range_t
      real(wp) :: least = -huge(1.0_wp), most = huge(1.0_wp)
   end type range_t

   type, abstract :: material_t
      integer :: n_state = 0                !< State variables a point.
      integer :: place_e = 0, place_s_w = 0      !< Places of the void ratio and of the saturation in the state.
      real(wp) :: e_0 = 0.0_wp              !< Void ratio where a start gives none, 0: the law has none [-].
      logical :: has_energy = .false.       !< The stress has a potential: an elastic law.
      logical :: has_retention = .false.    !< The law computes its saturation itself, without a curve beside it.
      logical :: saturation_is_state = .false.   !< The saturation has a history: retention() is where it starts, no
                                                 !< more.
      logical :: unguarded = .false.        !< Made for a mean effective stress above 0, and nothing keeps it there.
      logical :: overcounts_cycles = .false.     !< It strains far more in many cycles than tests do: CYCLES_UNTRUSTED.
      logical :: cohesionless = .false.     !< It bears no tension, and without stress it has no stiffness.
      logical :: exact_tangent = .false.    !< d sigma'/d strain is the derivative of the update itself.
      logical :: has_lanes = .false.        !< Points of a batch can go side by side, on this processor, ...
      logical :: lanes = .false.            !< ... and do: in less time, with numbers that differ by rounding.
      integer :: n_guards = 0
      real(wp) :: tolerance = 0.0_wp        !< Tolerance of the stress integration, relative; 0: the law has none.
      logical :: given_tolerance = .false., given_scheme = .false.   !< Not the defaults: set by hand.
      character(NAME_LENGTH) :: guard_names(MOST_GUARDS) = ''
      character(NAME_LENGTH), allocatable :: state_names(:)
      character(NAME_LENGTH), allocatable :: suction_keys(:)   !< Keys of its group that act with suction alone.
      character(DOUBT_LENGTH) :: doubt = ''      !< Sentence on parameters that are allowed and most often a mistake.
      type(stress_unit_t) :: unit                !< Unit of its stresses; kPa in the comments of this module.
      type(range_t) :: tested_e, tested_p        !< Void ratios, stresses [kPa] of the tests behind it; without: any.
      class(retention_t), allocatable :: curve   !< Curve of a law that has no retention of its own; without: saturated.
   contains
      procedure(initial_state_i), deferred :: initial_state
      procedure(update_i), deferred :: update
      procedure(message_i), deferred :: message
      procedure, non_overridable :: void_ratio
      procedure, non_overridable :: saturation
      procedure :: retention => retention_by_curve
      procedure :: preset_saturation => cannot_preset
      procedure :: elastic_tangent => tangent_at_rest
      procedure :: save_update => cannot_save
      procedure :: remarks => no_remarks
      procedure :: integrate_to => no_tolerance
      procedure :: find_varying => none_varies
      procedure :: change_over_step => cannot_change
   end type material_t

   !> One law of a list of different ones.
   type :: material_slot_t
      character(64) :: name = ''
      class(material_t), allocatable :: law
   end type material_slot_t

   abstract interface
      !> State of a point at rest. The stress may be lifted to what the law can carry; a void ratio of 0 means that of
      !> the law. `text` says why not, and is blank on success.
      subroutine initial_state_i(self, stress, suction, void_ratio, state, text)
         import :: material_t, wp
         class(material_t), intent(in) :: self
         real(wp), intent(inout) :: stress(6)            !< [kPa]
         real(wp), intent(in) :: suction, void_ratio     !< [kPa, -]
         real(wp), intent(inout) :: state(:)   !< n_state
         character(*), intent(out) :: text
      end subroutine initial_state_i

      !> One increment at n points, from (stress, state, suction); thread safe. Where a point fails, new states and
      !> answers of it and of those behind it are of no use.
      subroutine update_i(self, n, stress, state, strain, suction, d_suction, with_tangent, response, new_state, &
                          report)
         import :: material_t, response_t, batch_report_t, wp
         class(material_t), intent(in) :: self
         integer, intent(in) :: n                                !< 1 .. MOST_POINTS
         real(wp), intent(in), contiguous :: stress(:, :)        !< (6, n) [kPa]
         real(wp), intent(in), contiguous :: state(:, :)         !< (n_state or more, n)
         real(wp), intent(in), contiguous :: strain(:, :)        !< (6, n) increments [-]
         real(wp), intent(in), contiguous :: suction(:)          !< (n) before the increment [kPa]
         real(wp), intent(in), contiguous :: d_suction(:)        !< (n) increments [kPa]
         logical, intent(in) :: with_tangent
         type(response_t), intent(inout) :: response
         real(wp), intent(inout), contiguous :: new_state(:, :)  !< State at the end, as state.
         type(batch_report_t), intent(out) :: report
      end subroutine update_i

      !> A sentence about a failed batch.
      subroutine message_i(self, report, text)
         import :: material_t, batch_report_t
         class(material_t), intent(in) :: self
         type(batch_report_t), intent(in) :: report
         character(*), intent(out) :: text
      end subroutine message_i
   end interface
contains
   !> Void ratio that a state holds [-].
   pure real(wp) function void_ratio(self, state)
      class(material_t), intent(in) :: self
      real(wp), intent(in) :: state(:)   !< n_state or more

      void_ratio = state(self%place_e)
   end function void_ratio

   !> Degree of saturation that a state holds [-].
   pure real(wp) function saturation(self, state)
      class(material_t), intent(in) :: self
      real(wp), intent(in) :: state(:)   !< n_state or more

      saturation = state(self%place_s_w)
   end function saturation

   !> Sentence on the void ratios and mean effective stresses that are outside the tests behind a law; blank: none is.
   pure function untested(law, e, p) result(text)
      class(material_t), intent(in) :: law
      type(range_t), intent(in) :: e, p   !< Ranges in which the law is used [-, kPa].
      character(:), allocatable :: text

      text = ''
      if (outside(e, law%tested_e)) text = 'the void ratio is '//said(e)//', in its tests '//said(law%tested_e)
      if (.not. outside(p, law%tested_p)) return
      if (text /= '') text = text//'; '
      text = text//'the mean effective stress is '//said(p)//' '//trim(law%unit%name)//', in its tests '// &
             said(law%tested_p)
   contains
      pure logical function outside(used, tested)
         type(range_t), intent(in) :: used, tested

         outside = used%least < tested%least .or. used%most > tested%most
      end function outside

      pure function said(range) result(words)
         type(range_t), intent(in) :: range
         character(:), allocatable :: words

         words = short(range%least)
         if (range%most > range%least) words = words//' to '//short(range%most)
      end function said
   end function untested

   !> Sets the tolerance and the scheme of the stress integration, where the law has such; scheme 0 leaves it.
   subroutine no_tolerance(self, tolerance, scheme)
      class(material_t), intent(inout) :: self
      real(wp), intent(in) :: tolerance   !< Relative, > 0
      integer, intent(in) :: scheme       !< Scheme, as the parameter of that name.

      if (self%tolerance > 0.0_wp .and. scheme >= 0) self%tolerance = tolerance
   end subroutine no_tolerance

   !> Place of a parameter that may change during a run, for change_over_step; 0, and a sentence, where the law has none
   !> of this name. Laws with such parameters override both. docs/theory/host.md section 15.
   subroutine none_varies(self, name, place, text)
      class(material_t), intent(in) :: self
      character(*), intent(in) :: name
      integer, intent(out) :: place
      character(*), intent(out) :: text

      associate (u1 => self, u2 => name)
      end associate
      place = 0
      text = 'the law has no strength that could change: it is for &mud (M_c) and &umat (props(1), props(2), ...)'
   end subroutine none_varies

   !> Makes a law as it was built the law of one step, at whose start and end parameters are `before` and `after` times
   !> what they are in it; `text` says why not, and the law is then of no use.
   subroutine cannot_change(self, places, before, after, text)
      class(material_t), intent(inout) :: self
      integer, intent(in) :: places(:)                 !< Places by find_varying, each once.
      real(wp), intent(in) :: before(:), after(:)      !< (places) [-]
      character(*), intent(out) :: text

      associate (u1 => self, u2 => before, u3 => after)
      end associate
      text = ''
      if (size(places) > 0) text = 'the law has no strength that could change'
   end subroutine cannot_change

   !> Degree of saturation, and its slopes, at a suction [kPa] and a void ratio [-]; a law with a retention of its own
   !> overrides it.
   function retention_by_curve(self, p_c, e) result(sat)
      class(material_t), intent(in) :: self
      real(wp), intent(in) :: p_c, e
      type(saturation_t) :: sat

      sat = saturation_t()
      if (allocated(self%curve)) sat = self%curve%at(p_c, e)
   end function retention_by_curve

   !> Sets the degree of saturation that initial_state is to start from, in a state that is still zero; `text` says why
   !> not. Laws whose saturation has a history, and that can start from any, override it.
   subroutine cannot_preset(self, s_w, state, text)
      class(material_t), intent(in) :: self
      real(wp), intent(in) :: s_w              !< [-]
      real(wp), intent(inout) :: state(:)      !< n_state
      character(*), intent(out) :: text

      associate (u1 => self, u2 => s_w, u3 => state)
      end associate
      text = NO_PRESET
   end subroutine cannot_preset

   !> d stress/d strain [kPa] of a point that would respond elastically: the stiffness to fall back on where the true
   !> one vanishes. Of laws that do not know it, that of an increment without strain; zero where the law refuses.
   subroutine tangent_at_rest(self, stress, state, suction, tangent)
      class(material_t), intent(in) :: self
      real(wp), intent(in) :: stress(6), state(:), suction   !< [kPa], n_state or more, [kPa]
      real(wp), intent(out) :: tangent(6, 6)
      type(response_t) :: response
      type(batch_report_t) :: report
      real(wp) :: new_state(size(state), 1), no_strain(6, 1)

      tangent = 0.0_wp
      no_strain = 0.0_wp
      call self%update(1, reshape(stress, [6, 1]), reshape(state, [size(state), 1]), no_strain, [suction], [0.0_wp], &
                       WITH_TANGENT, response, new_state, report)
      if (report%code == 0) tangent = response%dsig_deps(:, :, 1)
   end subroutine tangent_at_rest

   !> Writes an update to a new file that can be run alone; `text` says why not. Laws that can override it.
   subroutine cannot_save(self, path, origin, stress, state, strain, suction, d_suction, text)
      class(material_t), intent(in) :: self
      character(*), intent(in) :: path, origin   !< Name of the file, and a remark for its reader.
      real(wp), intent(in) :: stress(6), state(:), strain(6), suction, d_suction   !< Arguments as update has them.
      character(*), intent(out) :: text

      associate (u1 => self, u2 => path, u3 => origin, u4 => stress, u5 => state, u6 => strain, u7 => suction, &
                 u8 => d_suction)
      end associate
      text = 'this law cannot write its updates to a file; only those of MUD can be run alone'
   end subroutine cannot_save

   !> Remarks of a law in a file of results, beside its name: none.
   subroutine no_remarks(self, list)
      class(material_t), intent(in) :: self
      type(remark_t), allocatable, intent(out) :: list(:)

      allocate (list(0))
   end subroutine no_remarks

   !> Whether a law that is made for compression has been left by its mean effective stress.
   pure logical function lost_pressure(law, stress)
      class(material_t), intent(in) :: law
      real(wp), intent(in) :: stress(6)   !< Effective, tension positive [kPa].

      lost_pressure = law%unguarded .and. sum(stress(:3)) > 0.0_wp
   end function lost_pressure

   !> Place of a state variable, from 1; 0 if the law has none of that name. Case counts.
   pure integer function state_index(law, name) result(place)
      class(material_t), intent(in) :: law
      character(*), intent(in) :: name

      do place = 1, size(law%state_names)
         if (law%state_names(place) == name) return
      end do
      place = 0
   end function state_index

   !> Void ratio after a volumetric strain, expansion positive: grains keep their volume, strain is natural. Both [-];
   !> docs/theory/material.md section 1.2, with the other sign of strain.
   pure real(wp) function swollen(e, volumetric_strain)
      real(wp), intent(in) :: e, volumetric_strain

      swollen = (1.0_wp + e)*exp(volumetric_strain) - 1.0_wp
   end function swollen
end module material_point
