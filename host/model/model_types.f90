!> A scene in memory: the model and everything that acts on it in the course of its stages.
module model_types
   use kinds, only: wp
   use contact_types, only: contact_options_t
   use porous_domain, only: domain_t
   use scene_fingerprint, only: FINGERPRINT_LENGTH
   use triangle_mesh, only: NAME_LENGTH
   use namelists, only: LENGTH
   implicit none (type, external)
   private
   public :: model_t, stage_t, fix_t, load_t, rigid_t, history_t, initial_t, point_t, plate_t, touching_t
   public :: effect_t, effects_t
   public :: factor_at, acts_in, P_A, LOAD_KINDS
   public :: OF_P_W, OF_P_C, OF_INERTIA, OF_SEEPAGE, OF_GRAVITY, UNBOUNDED, UNKNOWN, NEVER

   integer, parameter :: P_A = 5   !< "Field" of a prescribed air pressure.
   character(8), parameter :: LOAD_KINDS(7) = [character(8) :: 'pressure', 'shear_r', 'shear_z', 'water', 'air', &
      'force_r', 'force_z']

   ! Effects that a scene may or may not call for.
   integer, parameter :: OF_P_W = 1, OF_P_C = 2, OF_INERTIA = 3, OF_SEEPAGE = 4, OF_GRAVITY = 5
   real(wp), parameter :: UNBOUNDED = 1.0e30_wp   !< An estimate without a bound.
   real(wp), parameter :: UNKNOWN = -1.0_wp       !< No estimate: it has no meaning here.
   real(wp), parameter :: NEVER = -1.0e30_wp      !< A time.

   !> A row of the table of effects.
   type :: effect_t
      integer :: kind = 0
      integer :: stage = 0                       !< Number of the stage, of the inertia.
      character(NAME_LENGTH + 16) :: name = ''
      logical :: on = .false., by_hand = .false.
      real(wp) :: estimate = UNKNOWN, threshold = 0.0_wp
      character(8) :: unit = '-'
      integer :: unknowns = 0, entries = 0       !< It costs so many, also of the matrix.
      character(128) :: why = ''
      ! Watched during the run where it is off.
      logical :: watched = .false.
      real(wp) :: scale = 1.0_wp                 !< What the indicator is measured with, see host_watch.
      real(wp) :: largest = 0.0_wp               !< Indicator so far,
      real(wp) :: crossed = NEVER                !< time when it crossed the threshold [s].
   end type effect_t

   type :: effects_t
      logical :: auto = .false.
      logical :: fields_by_hand = .true., gravity_by_hand = .true., seepage_by_hand = .true.
      real(wp) :: tolerance = 0.01_wp
   end type effects_t

   type :: history_t
      character(NAME_LENGTH) :: name = ''
      real(wp), allocatable :: times(:), values(:)
   end type history_t

   type :: initial_t
      integer :: group = 0
      real(wp) :: p_w = 0.0_wp, p_w_slope = 0.0_wp, p_c = 0.0_wp, p_c_slope = 0.0_wp, datum = 0.0_wp
      real(wp) :: v_z = 0.0_wp, wave = 0.0_wp, wave_number = 0.0_wp
      logical :: uniform = .false., geostatic = .false.
      real(wp) :: sigma(3) = 0.0_wp
      real(wp) :: surface = 0.0_wp, surcharge = 0.0_wp, k_0 = 0.5_wp
      logical :: net = .true.
   end type initial_t

   type :: stage_t
      character(NAME_LENGTH) :: name = ''
      integer :: kind = 0
      real(wp) :: duration = 0.0_wp, dt = 0.0_wp, dt_growth = 1.0_wp, dt_max = 0.0_wp
      integer :: cuts = 10
      real(wp) :: rho_inf = 0.8_wp, tolerance = 1.0e-3_wp
      integer :: measure = 0, max_iterations = 12, every = 1, fields = 0
      logical :: still = .false., solve_start = .true., zero_displacements = .false.
      logical :: derived = .false.   !< Its kind is not given but derived.
   end type stage_t

   type :: fix_t
      integer :: group = 0, field = 0, history = 0
      real(wp) :: value = 0.0_wp
      logical :: hold = .false.
      character(LENGTH), allocatable :: stages(:)
      real(wp) :: from = -huge(1.0_wp), until = huge(1.0_wp)
   end type fix_t

   type :: load_t
      integer :: group = 0, kind = 0, history = 0
      real(wp) :: value = 0.0_wp
      character(LENGTH), allocatable :: stages(:)
      real(wp), allocatable :: shape(:)   !< Vector of a unit value.
   end type load_t

   type :: rigid_t
      integer :: group = 0, history = 0
      real(wp) :: mass = 0.0_wp, force = 0.0_wp
   end type rigid_t

   !> A rigid plate: a node of its own (group `name` of the mesh) that moves vertically.
   type :: plate_t
      character(NAME_LENGTH) :: name = ''
      integer :: node = 0, history = 0
      real(wp) :: r(2) = 0.0_wp, z = 0.0_wp       !< Where its face begins and ends, and how high [m].
      logical :: up = .false.                     !< The face looks upwards.
      real(wp) :: mass = 0.0_wp, force = 0.0_wp   !< [Mg], upwards [kN]
      logical :: heavy = .false.                  !< Its weight acts.
   end type plate_t

   !> Two surfaces that may touch: groups of the mesh, or a group and a plate.
   type :: touching_t
      character(NAME_LENGTH) :: name = ''
      integer :: slave = 0, master = 0, plate = 0
      type(contact_options_t) :: options
      logical :: drains_by_state = .false.        !< Covered nodes are impervious, see host_drainage.
      character(LENGTH), allocatable :: stages(:)
   end type touching_t

   type :: point_t
      character(NAME_LENGTH) :: name = ''
      integer :: node = 0, gauss = 0      !< Nearest ones.
   end type point_t

   type :: model_t
      character(NAME_LENGTH) :: name = ''
      type(domain_t) :: domain
      type(effects_t) :: effects
      logical :: subtract_flow = .false.
      logical :: reuse_factors = .true.
      integer :: ordering = 1                !< See solve_sparse.
      integer :: checkpoint_steps = 0
      real(wp) :: checkpoint_seconds = 0.0_wp
      character(FINGERPRINT_LENGTH) :: fingerprint = ''
      type(history_t), allocatable :: histories(:)
      type(initial_t), allocatable :: initials(:)
      type(stage_t), allocatable :: stages(:)
      type(fix_t), allocatable :: fixes(:)
      type(load_t), allocatable :: loads(:)
      type(rigid_t), allocatable :: rigids(:)
      type(point_t), allocatable :: points(:)
      type(plate_t), allocatable :: plates(:)
      type(touching_t), allocatable :: contacts(:)
   end type model_t
contains
   !> Factor of a history at a time; history 0 is 1 throughout.
   pure real(wp) function factor_at(model, history, time) result(factor)
      type(model_t), intent(in) :: model
      integer, intent(in) :: history
      real(wp), intent(in) :: time
      integer :: i

      factor = 1.0_wp
      if (history == 0) return
      associate (t => model%histories(history)%times, v => model%histories(history)%values)
         factor = v(1)
         if (time <= t(1)) return
         do i = 2, size(t)
            if (time > t(i)) cycle
            factor = v(i - 1) + (v(i) - v(i - 1))*(time - t(i - 1))/(t(i) - t(i - 1))
            return
         end do
         factor = v(size(v))
      end associate
   end function factor_at

   !> An empty list means every stage.
   pure logical function acts_in(stages, name)
      character(*), intent(in) :: stages(:), name

      acts_in = size(stages) == 0 .or. any(stages == name)
   end function acts_in
end module model_types
