! SPDX-License-Identifier: MIT
!> A scene as its file says it, checked one by one. What is set here is the default of its key (scene_keys has range and
!> meaning); a value outside of the range says that the key is not given. A scene is read once and never changes; the
!> model that is built from it fills the places of what it names, 0 until then.
module scene_types
   use kinds, only: wp
   use contact_types, only: contact_options_t
   use convergence, only: BY_STAGE
   use faults, only: at_line
   use history_shapes, only: arc_at
   use namelists, only: group_t, LENGTH
   use permeability_laws, only: permeability_t
   use porous_domain, only: fluids_t, COUPLED
   use unknown_fields, only: FIELDS
   implicit none (type, external)
   private
   public :: scene_t, scene_item_t, scene_mesh_t, scene_law_t, scene_region_t
   public :: initial_t, amplitude_t, stage_t, fix_t, load_t, plate_t, contact_pair_t, tie_t, point_t
   public :: NAME_LENGTH, FINGERPRINT_LENGTH, acts_in, item_of, place_of, groups_named, amplitude_at
   public :: WITH_U, WITH_P_W, WITH_P_C, PRESCRIBED_P_A, PRESCRIBED_TURN
   public :: LOAD_PRESSURE, LOAD_SHEAR_R, LOAD_SHEAR_Z, LOAD_WATER, LOAD_RAIN, LOAD_AIR, LOAD_FORCE_R, LOAD_FORCE_Z, &
             LOAD_MOMENT

   integer, parameter :: NAME_LENGTH = 64         !< Longest name that a scene gives.
   integer, parameter :: FINGERPRINT_LENGTH = 16

   ! Numbers of words, in the order in which scene_keys lists those of the key (a test holds the two together); those of
   ! drainage, analysis, measure, gap, relative permeability and fields stand where they act.
   integer, parameter :: WITH_U = 1, WITH_P_W = 2, WITH_P_C = 3                         !< &scene fields
   integer, parameter :: PRESCRIBED_P_A = FIELDS + 1   !< &fix field, after those of unknown_fields: air pressure.
   integer, parameter :: PRESCRIBED_TURN = FIELDS + 2  !< &fix field: rotation of a plate; read as u_z.
   integer, parameter :: LOAD_PRESSURE = 1    !< &load kind: against the outward normal [kPa].
   integer, parameter :: LOAD_SHEAR_R = 2, LOAD_SHEAR_Z = 3   !< &load kind: along the axes [kPa].
   integer, parameter :: LOAD_WATER = 4, LOAD_AIR = 6         !< &load kind: inflow [m/s].
   integer, parameter :: LOAD_RAIN = 5        !< &load kind: inflow until the surface ponds [m/s].
   integer, parameter :: LOAD_FORCE_R = 7, LOAD_FORCE_Z = 8   !< &load kind: on every node of a group [kN].
   integer, parameter :: LOAD_MOMENT = 9      !< &load kind: on a plate that turns; read as LOAD_FORCE_Z [kN m].
   real(wp), parameter :: NEVER = huge(1.0_wp)

   !> Where a group of the scene begins, for sentences about it.
   type :: scene_item_t
      character(LENGTH) :: file = ''
      integer :: line = 0
   end type scene_item_t

   !> A file, or the breaks of a built-in mesh of graded blocks.
   type, extends(scene_item_t) :: scene_mesh_t
      character(LENGTH) :: mesh_file = ''           !< Empty: built in.
      real(wp) :: scale = 1.0_wp
      logical :: scale_given = .false.
      real(wp), allocatable :: r(:), z(:), r_ratio(:), z_ratio(:)
      integer, allocatable :: r_cells(:), z_cells(:)
      real(wp) :: fineness = -1.0_wp                !< Times the cells along each axis.
      integer :: splits = 0                         !< How often every triangle of a file is split into four.
   end type scene_mesh_t

   !> A material or a retention curve: whoever builds it reads its own keys.
   type :: scene_law_t
      character(NAME_LENGTH) :: name = ''
      type(group_t) :: group
   end type scene_law_t

   type, extends(scene_item_t) :: scene_region_t
      character(LENGTH) :: group_name = 'all', material_name = '', retention_name = '', permeability_name = ''
      real(wp) :: rho_s = 2.65_wp, void_ratio = -1.0_wp, damping = 0.0_wp, stiffness_damping = 0.0_wp
      real(wp) :: viscosity = 0.0_wp
      integer :: drainage = COUPLED
      logical :: rest = .false.         !< Without a group: the elements that no other region has.
   end type scene_region_t

   type, extends(scene_item_t) :: initial_t
      character(LENGTH) :: group_name = 'all'
      integer :: group = 0                           !< Of the mesh.
      real(wp) :: p_w = 0.0_wp, p_w_slope = 0.0_wp, p_c = 0.0_wp, p_c_slope = 0.0_wp, datum = 0.0_wp
      logical :: with_table = .false.                !< Pressures are those of water at rest.
      real(wp) :: water_table = 0.0_wp               !< [m]
      real(wp) :: water_weight = 0.0_wp              !< Of it, in the gravity of the start [kN/m3].
      real(wp) :: largest_suction = NEVER            !< Above a water table [kPa].
      real(wp) :: saturation = 0.0_wp, v_z = 0.0_wp, wave = 0.0_wp, wave_number = 0.0_wp
      logical :: uniform = .false., geostatic = .false.
      logical :: follows = .false.      !< Columns end at the top of the ground above a point, not at `surface`.
      real(wp) :: sigma(3) = 0.0_wp, surface = 0.0_wp, surcharge = 0.0_wp, k_0 = 0.5_wp
      logical :: net = .true.           !< K_0 acts on the net stress where p_c > 0.
   end type initial_t

   !> How a value changes with time.
   type, extends(scene_item_t) :: amplitude_t
      character(NAME_LENGTH) :: name = ''
      real(wp), allocatable :: times(:), values(:)
      integer, allocatable :: arcs(:)                !< Ways between the pairs (history_shapes); none: straight.
      character(LENGTH), allocatable :: stages(:)    !< From whose starts the times count; none: that of the run.
   end type amplitude_t

   type :: stage_t
      character(NAME_LENGTH) :: name = ''
      integer :: kind = 0                            !< Of generalised_alpha.
      real(wp) :: duration = 0.0_wp, dt = 0.0_wp, dt_growth = 1.0_wp, dt_max = NEVER
      logical :: controlled = .false.                !< Steps are chosen from their error.
      real(wp) :: step_tolerance = 0.0_wp            !< Of those steps [-].
      real(wp) :: output_dt = 0.0_wp
      real(wp), allocatable :: ends(:)               !< Given steps end here, after the start of the stage [s].
      integer :: cuts = 10, max_iterations = 12, every = 1, fields = 0
      real(wp) :: rho_inf = -1.0_wp, tolerance = 1.0e-3_wp, created_energy = 0.01_wp
      integer :: measure = BY_STAGE                  !< See convergence.
      logical :: film = .true.                       !< No key says when fields are written.
      logical :: no_predictor = .false., solve_start = .true., zero_displacements = .false.
   end type stage_t

   ! Of what follows: groups of the mesh; places of amplitudes, 0 is 1 throughout; no stages are all.
   type, extends(scene_item_t) :: fix_t
      character(LENGTH) :: group_name = '', amplitude_name = ''
      integer :: group = 0, amplitude = 0
      integer :: field = 0                           !< AT_... of unknown_fields, or PRESCRIBED_P_A.
      real(wp) :: value = 0.0_wp, value_slope = 0.0_wp, datum = 0.0_wp, from = -NEVER, until = NEVER
      logical :: hold = .false., acceleration = .false.
      logical :: limits = .false.                    !< The value is the largest p_w: water leaves, none enters.
      logical :: turns = .false.                     !< Of a plate its rotation, the value an angle.
      character(LENGTH), allocatable :: stages(:)
   end type fix_t

   type, extends(scene_item_t) :: load_t
      character(LENGTH) :: group_name = '', amplitude_name = ''
      integer :: group = 0, amplitude = 0
      integer :: kind = 0                            !< LOAD_...
      real(wp) :: value = 0.0_wp, value_slope = 0.0_wp, datum = 0.0_wp
      real(wp) :: ponding = 0.0_wp                   !< Depth of water that stays on the surface, of rain [m].
      logical :: turns = .false.                     !< A moment on a plate.
      character(LENGTH), allocatable :: stages(:)
      real(wp), allocatable :: shape(:)              !< Load vector of a unit value.
      real(wp), allocatable :: rise(:)               !< Load vector of the value z - datum, where it changes with z.
   end type load_t

   !> A rigid plate: one with a face of its own that presses through a contact, or one that is joined to a boundary of
   !> the mesh. It moves vertically, or in its plane: along r and z, and turning.
   type, extends(scene_item_t) :: plate_t
      character(NAME_LENGTH) :: name = ''
      character(LENGTH) :: amplitude_name = '', joined_name = ''   !< Boundary that moves with it; empty: own face.
      integer :: group = 0, amplitude = 0
      integer :: node = 0                            !< It carries the plate's motion: its own, or of the boundary.
      integer :: turn_node = 0, turn_group = 0       !< Its u_z is the lever times the angle, of a plate that turns.
      real(wp), allocatable :: corners(:, :)         !< (2, corners) of its own face, body on the left [m].
      real(wp) :: mass = 0.0_wp, force = 0.0_wp
      logical :: heavy = .false.
      ! In the plane:
      logical :: turns = .false.
      real(wp) :: center(2) = 0.0_wp, inertia = 0.0_wp, force_r = 0.0_wp, moment = 0.0_wp
      real(wp) :: penalty = 1.0e9_wp                !< Traction of a unit of distance of what is joined to it [kN/m3].
      real(wp) :: lever = 1.0_wp                     !< Largest distance of what it touches from its centre [m].
   end type plate_t

   !> Two boundaries, or a boundary and a plate, that may come into contact.
   type, extends(scene_item_t) :: contact_pair_t
      character(NAME_LENGTH) :: name = ''
      character(LENGTH) :: slave_name = '', master_name = ''
      integer :: slave = 0, master = 0               !< Groups of the mesh.
      integer :: plate = 0                           !< The master as a plate with a face of its own, 0: it is none.
      type(contact_options_t) :: options
      character(LENGTH), allocatable :: stages(:)
   end type contact_pair_t

   !> Two boundaries whose nodes at equal heights move as one.
   type, extends(scene_item_t) :: tie_t
      character(LENGTH) :: first_name = '', second_name = ''
      logical :: pressures = .false.                 !< They have one pressure, too.
      integer, allocatable :: pairs(:, :)            !< (2, n) nodes of the first and the second boundary.
   end type tie_t

   type :: point_t
      character(NAME_LENGTH) :: name = ''
      real(wp) :: x(2) = 0.0_wp
      integer :: nodes(6) = 0, gauss = 0             !< Of its element; nearest quadrature point.
      real(wp) :: weights(6) = 0.0_wp, pressure_weights(6) = 0.0_wp   !< Of the nodes.
   end type point_t

   type :: scene_t
      character(LENGTH) :: file = ''
      character(NAME_LENGTH) :: name = ''
      character(FINGERPRINT_LENGTH) :: fingerprint = ''
      integer, allocatable :: hashes(:)              !< Two for every group, see scene_fingerprint.
      type(group_t), allocatable :: groups(:)        !< As they were read.
      logical, allocatable :: kept(:)                !< Whether `without` leaves a group in. (groups)
      logical :: axisymmetric = .true., linear_pressures = .true.
      integer :: fields = WITH_U, quadrature = 6, threads = 0
      real(wp) :: gravity = 0.0_wp
      character(LENGTH) :: gravity_history = ''
      logical :: seepage_inertia = .false., full_saturation_rate = .true., subtract_flow = .false.
      logical :: reuse_factors = .true.
      integer :: ordering = 1                        !< See sparse_factors.
      real(wp) :: step_tolerance = 0.0_wp            !< 0: not given.
      character(LENGTH), allocatable :: goals(:)     !< Answers that mud_study measures; a run takes no notice.
      integer :: checkpoint_steps = 0
      real(wp) :: checkpoint_seconds = 0.0_wp
      character(LENGTH), allocatable :: without(:)   !< Effects that are taken out by hand.
      character(LENGTH), allocatable :: absent(:)    !< Those of them that the scene did not have.
      type(scene_mesh_t) :: mesh
      type(fluids_t) :: fluids
      type(permeability_t), allocatable :: permeabilities(:)
      type(scene_law_t), allocatable :: materials(:), retentions(:)
      type(scene_region_t), allocatable :: regions(:)
      type(initial_t), allocatable :: initials(:)
      type(amplitude_t), allocatable :: amplitudes(:)
      type(stage_t), allocatable :: stages(:)
      type(fix_t), allocatable :: fixes(:)
      type(load_t), allocatable :: loads(:)
      type(plate_t), allocatable :: plates(:)
      type(contact_pair_t), allocatable :: contacts(:)
      type(tie_t), allocatable :: ties(:)
      type(point_t), allocatable :: points(:)
   end type scene_t
contains
   !> Where a group stands.
   pure function item_of(group) result(item)
      type(group_t), intent(in) :: group
      type(scene_item_t) :: item

      item = scene_item_t(group%file, group%line)
   end function item_of

   !> Groups of a name as they were read, without those that `without` has taken out.
   pure function groups_named(scene, name) result(groups)
      type(scene_t), intent(in) :: scene
      character(*), intent(in) :: name
      type(group_t), allocatable :: groups(:)

      groups = pack(scene%groups, scene%groups%name == name .and. scene%kept)
   end function groups_named

   !> "FILE:LINE: " of a group of the scene.
   pure function place_of(item) result(place)
      class(scene_item_t), intent(in) :: item
      character(:), allocatable :: place

      place = at_line(item%file, item%line)
   end function place_of

   !> Factor of an amplitude at a time: straight lines or arcs between its pairs, constant outside. [-]
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

   !> Whether something limited to stages takes part in one; an empty list means every stage.
   pure logical function acts_in(stages, name)
      character(*), intent(in) :: stages(:), name   !< Names of stages. (stages named) or (0).

      acts_in = size(stages) == 0 .or. any(stages == name)
   end function acts_in
end module scene_types
