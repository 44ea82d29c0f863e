! SPDX-License-Identifier: MIT
!> A scene as its file says it: names, words and numbers, checked one by one, nothing resolved and nothing computed.
!> A scene is read once and never changes; the model that is built from it names its values again by extending these
!> types.
module scene_types
   use kinds, only: wp
   use effect_types, only: effect_t
   use faults, only: at_line
   use namelists, only: group_t, LENGTH
   implicit none (type, external)
   private
   public :: scene_t, scene_item_t, scene_mesh_t, scene_fluids_t, scene_law_t, scene_region_t, scene_initial_t
   public :: scene_amplitude_t
   public :: scene_absorber_t, scene_tie_t
   public :: scene_stage_t, scene_fix_t, scene_load_t, scene_plate_t, scene_contact_t, scene_point_t
   public :: NAME_LENGTH, FINGERPRINT_LENGTH, acts_in, place_of, amplitude_at
   public :: WITH_U, WITH_P_W, WITH_P_C, IS_STATIC, IS_QUASI_STATIC, IS_DYNAMIC, FIX_P_W, FIX_P_C, FIX_P_A
   public :: LOAD_PRESSURE, LOAD_SHEAR_R, LOAD_SHEAR_Z, LOAD_WATER, LOAD_AIR, LOAD_FORCE_R, LOAD_FORCE_Z
   public :: MEASURE_FORCES, MEASURE_RESIDUAL, MEASURE_CORRECTION, MEASURE_CHANGE, MEASURE_AUTO
   public :: GAP_NODAL, GAP_POINTWISE, GAP_COMBINED, IS_COUPLED, IS_DRAINED, IS_UNDRAINED, IS_DRY

   integer, parameter :: NAME_LENGTH = 64         !< Longest name that a scene gives.
   integer, parameter :: FINGERPRINT_LENGTH = 16

   ! Numbers of words, in the order in which scene_keys lists those of the key (a test holds the two together).
   integer, parameter :: WITH_U = 1, WITH_P_W = 2, WITH_P_C = 3                         !< &scene fields
   integer, parameter :: IS_STATIC = 1, IS_QUASI_STATIC = 2, IS_DYNAMIC = 3             !< &stage analysis
   integer, parameter :: MEASURE_FORCES = 1, MEASURE_RESIDUAL = 2, MEASURE_CORRECTION = 3, &
                         MEASURE_CHANGE = 4, MEASURE_AUTO = 5                           !< &stage measure
   integer, parameter :: GAP_NODAL = 1, GAP_POINTWISE = 2, GAP_COMBINED = 3             !< &contact gap
   integer, parameter :: IS_COUPLED = 1, IS_DRAINED = 2, IS_UNDRAINED = 3, IS_DRY = 4   !< &region drainage
   integer, parameter :: FIX_P_W = 3, FIX_P_C = 4, FIX_P_A = 5                          !< &fix field, after u_r, u_z
   integer, parameter :: LOAD_PRESSURE = 1    !< &load kind: against the outward normal [kPa].
   integer, parameter :: LOAD_SHEAR_R = 2, LOAD_SHEAR_Z = 3   !< &load kind: along the axes [kPa].
   integer, parameter :: LOAD_WATER = 4, LOAD_AIR = 5         !< &load kind: inflow [m/s].
   integer, parameter :: LOAD_FORCE_R = 6, LOAD_FORCE_Z = 7   !< &load kind: on every node of a group [kN].

   !> Where a group of the scene begins, for sentences about it.
   type :: scene_item_t
      character(LENGTH) :: file = ''
      integer :: line = 0
   end type scene_item_t

   !> A file, or the breaks of a built-in mesh of graded blocks.
   type, extends(scene_item_t) :: scene_mesh_t
      character(LENGTH) :: mesh_file = ''           !< Empty: built in.
      real(wp) :: scale = 1.0_wp                    !< Of the coordinates of the file [-].
      logical :: scale_given = .false.
      real(wp), allocatable :: r(:), z(:)           !< Breaks [m]
      integer, allocatable :: r_cells(:), z_cells(:)
      real(wp), allocatable :: r_ratio(:), z_ratio(:)
   end type scene_mesh_t

   !> Pore fluids.
   type :: scene_fluids_t
      real(wp) :: k_w = 2.2e6_wp, rho_w = 1.0_wp, eta_w = 1.0e-6_wp        !< [kPa, Mg/m3, kPa s]
      real(wp) :: k_a = 101.325_wp, rho_a = 1.2e-3_wp, eta_a = 1.8e-8_wp   !< The same of air.
      logical :: ideal_gas = .false.
      real(wp) :: p_ref = 101.325_wp    !< Absolute pressure where p_a = 0 [kPa].
   end type scene_fluids_t

   !> A material, a retention curve or a relative permeability: whoever builds it reads its own keys.
   type :: scene_law_t
      character(NAME_LENGTH) :: name = ''
      type(group_t) :: group
   end type scene_law_t

   type, extends(scene_item_t) :: scene_region_t
      character(LENGTH) :: group_name = '', material_name = '', retention_name = '', permeability_name = ''
      real(wp) :: rho_s = 0.0_wp        !< Density of the grains [Mg/m3]
      real(wp) :: void_ratio = -1.0_wp  !< Initially [-]; below zero: that of the material.
      real(wp) :: damping = 0.0_wp      !< [1/s]
      real(wp) :: stiffness_damping = 0.0_wp   !< [s]
      integer :: drainage = IS_COUPLED
      logical :: rest = .false.         !< Without a group: the elements that no other region has.
   end type scene_region_t

   type, extends(scene_item_t) :: scene_initial_t
      character(LENGTH) :: group_name = ''
      real(wp) :: p_w = 0.0_wp, p_w_slope = 0.0_wp, p_c = 0.0_wp, p_c_slope = 0.0_wp   !< [kPa, kPa/m]
      real(wp) :: saturation = 0.0_wp   !< Preset where the material has hysteresis [-]; 0: main drying curve.
      real(wp) :: datum = 0.0_wp                                                       !< [m]
      real(wp) :: v_z = 0.0_wp, wave = 0.0_wp, wave_number = 0.0_wp                    !< [m/s, m/s, 1/m]
      logical :: uniform = .false., geostatic = .false.
      real(wp) :: sigma(3) = 0.0_wp     !< rr, zz, tt, tension positive [kPa]
      real(wp) :: surface = 0.0_wp, surcharge = 0.0_wp, k_0 = 0.5_wp
      logical :: net = .true.           !< K_0 acts on the net stress where p_c > 0.
   end type scene_initial_t

   !> How a value changes with time.
   type :: scene_amplitude_t
      character(NAME_LENGTH) :: name = ''
      real(wp), allocatable :: times(:), values(:)   !< [s, -]
   end type scene_amplitude_t

   type :: scene_stage_t
      character(NAME_LENGTH) :: name = ''
      integer :: analysis = 0                        !< IS_...; 0: to be found by pilots.
      real(wp) :: duration = 0.0_wp, dt = 0.0_wp, dt_growth = 1.0_wp, dt_max = huge(1.0_wp)   !< [s, s, -, s]
      logical :: controlled = .false.                 !< Steps are chosen from their error.
      real(wp) :: accuracy = 0.0_wp                  !< Asked for, in the histories of the named points [-].
      real(wp) :: output_dt = 0.0_wp                 !< Steps end at its multiples [s]; 0: none.
      real(wp), allocatable :: ends(:)               !< Steps end here, after the start of the stage [s]: of pilots.
      integer :: cuts = 10
      real(wp) :: rho_inf = -1.0_wp, tolerance = 1.0e-3_wp   !< rho_inf below zero: not given.
      real(wp) :: created_energy = 0.01_wp           !< Share of the largest work that ends the run [-].
      integer :: measure_number = MEASURE_AUTO
      integer :: max_iterations = 12, every = 1, fields = 0
      logical :: film = .true.                       !< No key says when fields are written.
      logical :: no_predictor = .false., solve_start = .true., zero_displacements = .false.
   end type scene_stage_t

   type, extends(scene_item_t) :: scene_fix_t
      character(LENGTH) :: group_name = '', amplitude_name = ''   !< Amplitude empty: none.
      integer :: field_number = 0                    !< 1 u_r, 2 u_z, FIX_...
      real(wp) :: value = 0.0_wp                     !< At the datum [m, kPa]
      real(wp) :: value_slope = 0.0_wp, datum = 0.0_wp   !< Change with z [1/m of it], z of the datum [m].
      logical :: hold = .false.
      logical :: acceleration = .false.              !< The value is one [m/s2].
      character(LENGTH), allocatable :: stages(:)    !< None: all.
      real(wp) :: from = -huge(1.0_wp), until = huge(1.0_wp)    !< [s]
   end type scene_fix_t

   type, extends(scene_item_t) :: scene_load_t
      character(LENGTH) :: group_name = '', amplitude_name = ''
      integer :: kind = 0                            !< LOAD_...
      real(wp) :: value = 0.0_wp                     !< At the datum [kPa, m/s, kN]
      real(wp) :: value_slope = 0.0_wp, datum = 0.0_wp   !< Change with z [1/m of it], z of the datum [m].
      character(LENGTH), allocatable :: stages(:)
   end type scene_load_t

   !> A rigid plate that moves vertically: one with a face of its own that presses through a contact, or one that is
   !> joined to a boundary of the mesh.
   type, extends(scene_item_t) :: scene_plate_t
      character(NAME_LENGTH) :: name = ''
      character(LENGTH) :: amplitude_name = ''
      character(LENGTH) :: joined_name = ''          !< Boundary that moves with it; empty: a face of its own.
      real(wp) :: r(2) = 0.0_wp, z = 0.0_wp          !< Where its face begins and ends, and how high [m].
      logical :: up = .false.                        !< The face looks upwards.
      real(wp) :: mass = 0.0_wp, force = 0.0_wp      !< [Mg], upwards [kN]
      logical :: heavy = .false.                     !< Its weight acts.
   end type scene_plate_t

   type, extends(scene_item_t) :: scene_contact_t
      character(NAME_LENGTH) :: name = ''
      character(LENGTH) :: slave_name = '', master_name = ''
      real(wp) :: penalty = 1.0e8_wp                 !< [kN/m3]
      real(wp) :: search_radius = 0.0_wp             !< [m]
      integer :: gap_number = GAP_COMBINED
      logical :: drains_by_state = .false.           !< Covered nodes are impervious.
      character(LENGTH), allocatable :: stages(:)
   end type scene_contact_t

   !> A boundary through which waves leave, and may come in.
   type, extends(scene_item_t) :: scene_absorber_t
      character(LENGTH) :: group_name = '', amplitude_name = ''
      real(wp) :: rho = 0.0_wp, c_p = 0.0_wp, c_s = 0.0_wp   !< Of the ground behind it [Mg/m3, m/s]; 0: as the soil.
      real(wp) :: incoming(2) = 0.0_wp               !< Velocity of the wave that comes in [m/s].
      character(LENGTH), allocatable :: stages(:)
   end type scene_absorber_t

   !> Two boundaries whose nodes at equal heights move as one.
   type, extends(scene_item_t) :: scene_tie_t
      character(LENGTH) :: first_name = '', second_name = ''
      logical :: pressures = .false.                 !< They have one pressure, too.
   end type scene_tie_t

   type :: scene_point_t
      character(NAME_LENGTH) :: name = ''
      real(wp) :: x(2) = 0.0_wp                      !< [m]
   end type scene_point_t

   type :: scene_t
      character(LENGTH) :: file = ''
      character(NAME_LENGTH) :: name = ''
      character(FINGERPRINT_LENGTH) :: fingerprint = ''
      type(group_t), allocatable :: groups(:)        !< As they were read, files by their contents.
      logical :: axisymmetric = .true.
      integer :: fields = WITH_U
      logical :: linear_pressures = .false.
      integer :: quadrature = 6
      real(wp) :: gravity = 0.0_wp                   !< [m/s2]
      character(LENGTH) :: gravity_history = ''       !< Name of the factor on it; empty: none.
      logical :: seepage_inertia = .false., full_saturation_rate = .true., subtract_flow = .false.
      integer :: threads = 0
      logical :: reuse_factors = .true.
      integer :: ordering = 1                        !< Of the unknowns: 1 amd, 2 metis, 3 best.
      real(wp) :: accuracy = 0.0_wp                  !< Relative error wanted in the histories; 0: not asked for.
      integer :: checkpoint_steps = 0
      real(wp) :: checkpoint_seconds = 0.0_wp
      logical :: checkpoint_end = .false.
      logical :: derive_effects = .false.            !< Effects that the keys leave open are found by pilots.
      logical :: stop_on_warning = .false.           !< A warning about a removed effect ends the run.
      real(wp) :: effects_tolerance = 0.01_wp
      real(wp) :: effects_pilot_share = 0.1_wp       !< Of the work of the run [-].
      character(LENGTH), allocatable :: without(:)   !< Effects that are taken out by hand.
      character(LENGTH), allocatable :: absent(:)    !< Those of them that the scene did not have.
      type(effect_t), allocatable :: effects(:)      !< What pilots have found; not allocated: none ran.
      logical :: fields_by_hand = .true., gravity_by_hand = .true., seepage_by_hand = .true.   !< these say it.
      type(scene_mesh_t) :: mesh
      type(scene_fluids_t) :: fluids
      type(scene_law_t), allocatable :: materials(:), retentions(:), permeabilities(:)
      type(scene_region_t), allocatable :: regions(:)
      type(scene_initial_t), allocatable :: initials(:)
      type(scene_amplitude_t), allocatable :: amplitudes(:)
      type(scene_stage_t), allocatable :: stages(:)
      type(scene_fix_t), allocatable :: fixes(:)
      type(scene_load_t), allocatable :: loads(:)
      type(scene_plate_t), allocatable :: plates(:)
      type(scene_contact_t), allocatable :: contacts(:)
      type(scene_absorber_t), allocatable :: absorbers(:)
      type(scene_tie_t), allocatable :: ties(:)
      type(scene_point_t), allocatable :: points(:)
   end type scene_t
contains
   !> "FILE:LINE: " of a group of the scene.
   pure function place_of(item) result(place)
      class(scene_item_t), intent(in) :: item
      character(:), allocatable :: place

      place = at_line(item%file, item%line)
   end function place_of

   !> Factor of an amplitude at a time: straight lines between its pairs, constant outside. [-]
   pure real(wp) function amplitude_at(amplitude, time) result(factor)
      type(scene_amplitude_t), intent(in) :: amplitude
      real(wp), intent(in) :: time   !< [s]
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
         factor = v(low) + (v(high) - v(low))*(time - t(low))/(t(high) - t(low))
      end associate
   end function amplitude_at

   !> Whether something limited to stages takes part in one; an empty list means every stage.
   pure logical function acts_in(stages, name)
      character(*), intent(in) :: stages(:), name   !< Names of stages. (stages named) or (0).

      acts_in = size(stages) == 0 .or. any(stages == name)
   end function acts_in
end module scene_types
