! SPDX-License-Identifier: MIT
!> A scene as its file says it, checked one by one. What is set here is the default of its key (scene_keys has range and
!> meaning); a value outside of the range says that the key is not given. A scene is read once and never changes. Its
!> names are resolved when the model is built, which keeps no more of a scene than its parts (scene_parts).
module scene_types
   use kinds, only: wp
   use namelists, only: group_t
   use texts, only: LENGTH
   use permeability_laws, only: permeability_t
   use porous_domain, only: fluids_t, COUPLED
   use scene_parts, only: scene_item_t, amplitude_t, stage_t, initial_values_t, fix_values_t, load_values_t, &
                          plate_values_t, contact_values_t, named_point_t, NAME_LENGTH, FINGERPRINT_LENGTH
   implicit none (type, external)
   private
   public :: scene_t, scene_mesh_t, scene_law_t, scene_region_t, scene_fix_t, scene_load_t, scene_plate_t, &
             scene_contact_t, scene_tie_t
   public :: item_of, groups_named
   public :: WITH_U, WITH_P_W, WITH_P_C

   ! Numbers of words, in the order in which scene_keys lists those of the key (a test holds the two together); those of
   ! drainage, analysis, measure, gap, relative permeability and fields stand where they act.
   integer, parameter :: WITH_U = 1, WITH_P_W = 2, WITH_P_C = 3                         !< &scene fields

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
      integer :: drainage = COUPLED
      logical :: rest = .false.         !< Without a group: the elements that no other region has.
   end type scene_region_t

   type, extends(fix_values_t) :: scene_fix_t
      character(LENGTH) :: amplitude_name = ''
   end type scene_fix_t

   type, extends(load_values_t) :: scene_load_t
      character(LENGTH) :: amplitude_name = ''
   end type scene_load_t

   type, extends(plate_values_t) :: scene_plate_t
      character(LENGTH) :: amplitude_name = ''
      character(LENGTH) :: joined_name = ''          !< Boundary that moves with it; empty: it has a face of its own.
   end type scene_plate_t

   type, extends(contact_values_t) :: scene_contact_t
      character(LENGTH) :: slave_name = '', master_name = ''
   end type scene_contact_t

   !> Two boundaries whose nodes at equal heights move as one.
   type, extends(scene_item_t) :: scene_tie_t
      character(LENGTH) :: first_name = '', second_name = ''
      logical :: pressures = .false.                 !< They have one pressure, too.
   end type scene_tie_t

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
      type(initial_values_t), allocatable :: initials(:)
      type(amplitude_t), allocatable :: amplitudes(:)
      type(stage_t), allocatable :: stages(:)
      type(scene_fix_t), allocatable :: fixes(:)
      type(scene_load_t), allocatable :: loads(:)
      type(scene_plate_t), allocatable :: plates(:)
      type(scene_contact_t), allocatable :: contacts(:)
      type(scene_tie_t), allocatable :: ties(:)
      type(named_point_t), allocatable :: points(:)
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
end module scene_types
