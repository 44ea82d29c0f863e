! SPDX-License-Identifier: MIT
!> A model: mesh, unknowns, materials, loads, supports, plates and contacts of a scene, its names resolved to places,
!> and its terms. A model is built once (model_builder); a run reads it, and knows nothing of the scene.
!>
!> A term is a feature of the program with a place of its own. Its file has its keys, its building from the scene
!> (scene_term), its part of a stage, of a step and of a checkpoint, and what it says when a step fails. A scene that
!> does not ask for it has no object of it. Model and run know the type term_t alone. Procedures that a term leaves out
!> do nothing.
module model_types
   use archive, only: archive_t
   use contact_types, only: contact_options_t
   use degrees_of_freedom, only: dofs_t
   use faults, only: fault_t
   use kinds, only: wp
   use material_point, only: material_slot_t
   use plate_motion, only: plate_motion_t
   use porous_domain, only: domain_t
   use retention_curves, only: retention_t
   use scene_parts, only: origin_t, scene_item_t, amplitude_t, stage_t, amplitude_at, NAME_LENGTH, NEVER
   use solution, only: solution_t
   use texts, only: short, LENGTH
   use unknown_fields, only: AT_U_Z
   implicit none (type, external)
   private
   public :: model_t, problem_t, term_t, term_box_t
   public :: factor_at, factors_of, gravity_at, value_at, unknowns_of, share_over, now_in
   public :: action_t, acting_t, initial_t, fix_t, load_t, coordinate_t, plate_t, contact_pair_t, tie_t, point_t, &
             given_region_t, curve_t, SPACINGS

   real(wp), parameter :: SPACINGS = 8.0_wp   !< Of numbers, by which a sum of stages may miss a time; a step adds one.

   !> Something that acts on a group of the mesh, for checks and warnings that ask no more of it.
   type, extends(scene_item_t) :: action_t
      character(10) :: what = ''                     !< Its group of the scene, as '&load'.
      integer :: group = 0, amplitude = 0            !< Of the mesh, 0: a face of its own; 0 is 1 throughout.
      logical, allocatable :: in_stage(:)            !< (stages) Whether it acts in it.
      real(wp) :: from = -NEVER                      !< Not before this time [s].
      logical :: supports = .false.                  !< It prescribes values: where there is no ground it does nothing.
      logical :: along_normal = .false.              !< It needs ground on one side of its edges alone.
      logical :: bears = .false.                     !< It presses on the ground, or holds it.
      logical :: damps = .false.                     !< By dashpots: in dynamic stages alone, and it carries no weight.
   end type action_t

   ! Groups of what follows are those of the mesh, amplitudes are places among the histories, 0: the factor is 1.
   type, extends(scene_item_t) :: initial_t
      character(LENGTH) :: group_name = 'all'
      integer :: group = 0
      real(wp) :: p_w = 0.0_wp, p_w_slope = 0.0_wp, p_c = 0.0_wp, p_c_slope = 0.0_wp, datum = 0.0_wp
      logical :: with_table = .false.                !< Pressures are those of water at rest.
      real(wp) :: water_table = 0.0_wp               !< [m]
      real(wp) :: water_weight = 0.0_wp              !< Of a water table, in the gravity of the start [kN/m3].
      real(wp) :: largest_suction = NEVER            !< Above a water table [kPa].
      real(wp) :: saturation = 0.0_wp, v_z = 0.0_wp, wave = 0.0_wp, wave_number = 0.0_wp
      logical :: uniform = .false., geostatic = .false.
      logical :: follows = .false.      !< Columns end at the top of the ground above a point, not at `surface`.
      real(wp) :: sigma(3) = 0.0_wp, surface = 0.0_wp, surcharge = 0.0_wp, k_0 = 0.5_wp
      logical :: net = .true.           !< K_0 acts on the net stress where p_c > 0.
   end type initial_t

   !> A value that acts on a group, as it is or by a load.
   type, extends(action_t) :: acting_t
      character(LENGTH) :: group_name = ''
      real(wp) :: value = 0.0_wp, value_slope = 0.0_wp, datum = 0.0_wp
      logical :: of_body = .false.                   !< It acts on a coordinate of a plate alone.
      logical :: limits = .false.                    !< p_w has a largest value there, past which water leaves.
   end type acting_t

   type, extends(acting_t) :: fix_t
      integer :: field = 0                           !< AT_... of unknown_fields, or PRESCRIBED_P_A.
      real(wp) :: until = NEVER                      !< Not after this time [s].
      logical :: hold = .false., acceleration = .false.
   end type fix_t

   type, extends(acting_t) :: load_t
      integer :: kind = 0                            !< LOAD_...
      logical :: flows = .false.                     !< It is the inflow of a fluid.
      logical :: falls = .false.                     !< It comes from above, on what looks upwards.
      real(wp), allocatable :: vector(:)             !< (unknowns) At a factor of 1 [kN, m3/s].
   end type load_t

   !> A coordinate of a rigid plate: its unknown, what acts on it, and its names in tables.
   type :: coordinate_t
      integer :: field = AT_U_Z, node = 0            !< Field and node that its unknown is at.
      integer :: group = 0                           !< Of the mesh, that it has of its own; 0: that of the plate.
      real(wp) :: unit = 1.0_wp                      !< The unknown where the coordinate is 1.
      real(wp) :: mass = 0.0_wp, load = 0.0_wp       !< [Mg, or Mg m2], and at a factor of 1 [kN, or kN m].
      character(8) :: names(4) = ['u_z ', 'v_z ', 'a_z ', 'load']   !< Of it, its rates and its load.
   end type coordinate_t

   !> A rigid plate: one with a face of its own that presses through a contact, or one that is joined to a boundary of
   !> the mesh.
   type, extends(action_t) :: plate_t             !< Group: boundary that moves with it, 0: it has a face of its own.
      character(NAME_LENGTH) :: name = ''
      real(wp), allocatable :: corners(:, :)         !< (2, corners) of its own face, body on the left [m].
      real(wp) :: mass = 0.0_wp, force = 0.0_wp
      logical :: heavy = .false.
      logical :: on_buffer = .false.                 !< A &buffer may press it down.
      integer :: node = 0                            !< It carries the plate's u_z: its own, or of the boundary.
      real(wp) :: penalty = 0.0_wp                   !< Springs that tie the boundary to it [kN/m3]; 0: they share u_z.
      class(plate_motion_t), allocatable :: motion
      type(coordinate_t), allocatable :: coordinates(:)   !< Of the motion; the first is u_z.
   end type plate_t

   !> Two boundaries, or a boundary and a plate, that may come into contact.
   type, extends(action_t) :: contact_pair_t
      character(NAME_LENGTH) :: name = ''
      type(contact_options_t) :: options
      integer :: slave = 0, master = 0
      integer :: plate = 0                           !< The master as a plate with a face of its own, 0: it is none.
   end type contact_pair_t

   !> Two boundaries whose nodes at equal heights move as one.
   type :: tie_t
      logical :: pressures = .false.                 !< They have one pressure, too.
      integer, allocatable :: pairs(:, :)            !< (2, n) nodes of the first and the second boundary.
   end type tie_t

   type :: point_t
      character(NAME_LENGTH) :: name = ''
      real(wp) :: x(2) = 0.0_wp                      !< [m]
      integer :: nodes(6) = 0, gauss = 0             !< Of its element; nearest quadrature point.
      real(wp) :: weights(6) = 0.0_wp, pressure_weights(6) = 0.0_wp   !< Of the nodes.
   end type point_t

   !> A region as the scene names it, for sentences; the others are in the domain.
   type, extends(scene_item_t) :: given_region_t
      character(LENGTH) :: group_name = 'all', material_name = '', retention_name = ''
      logical :: rest = .false.         !< Without a group: the elements that no other region has.
   end type given_region_t

   !> A retention curve, or why its group gives none: that is told where a region asks for it.
   type :: curve_t
      character(NAME_LENGTH) :: name = ''
      class(retention_t), allocatable :: curve
      type(fault_t) :: fault
   end type curve_t

   type :: output_t
      type(point_t), allocatable :: points(:)
      integer :: checkpoint_steps = 0
      real(wp) :: checkpoint_seconds = 0.0_wp
   end type output_t

   type :: text_t
      character(:), allocatable :: words
   end type text_t

   type :: model_t
      type(origin_t) :: origin
      real(wp) :: step_tolerance = 0.0_wp            !< Of the scene, that of its stages and laws [-]; 0: not given.
      logical :: lanes = .false.                     !< Points go side by side where their law has lanes.
      type(material_slot_t), allocatable :: materials(:)
      type(curve_t), allocatable :: curves(:)
      type(given_region_t), allocatable :: regions(:)   !< In the order of those of the domain.
      type(domain_t) :: domain
      type(dofs_t) :: dofs
      type(amplitude_t), allocatable :: amplitudes(:)
      integer :: gravity_amplitude = 0
      type(stage_t), allocatable :: stages(:)
      type(initial_t), allocatable :: initials(:)
      logical :: subtract_flow = .false.             !< The flow of the start is maintained, and takes no part.
      type(fix_t), allocatable :: fixes(:)
      type(load_t), allocatable :: loads(:)
      type(plate_t), allocatable :: plates(:)
      type(contact_pair_t), allocatable :: contacts(:)
      type(tie_t), allocatable :: ties(:)
      type(action_t), allocatable :: actions(:)
      type(text_t), allocatable :: on_contact(:)     !< (stages) Bodies that contact alone holds: the end of a sentence.
      logical, allocatable :: ground(:, :)           !< (elements, stages) What a stage has; not allocated: all.
      type(term_box_t), allocatable :: terms(:)      !< Those that the scene has, in the order of their registry.
      type(output_t) :: output
      logical :: reuse_factors = .true.              !< Of the matrix, where they serve.
   end type model_t

   !> A model and the solution of its steps.
   type, extends(solution_t) :: problem_t
      type(model_t), pointer :: model => null()
      type(stage_t), pointer :: stage => null()   !< Stage of the model that is under way.
   end type problem_t

   type, abstract :: term_t
   contains
      procedure :: begin_run, begin_stage, before_step, prescribe, limit, choose, complete, accept, exchange, remark
   end type term_t

   !> An element of a list of terms.
   type :: term_box_t
      class(term_t), allocatable :: term
   end type term_box_t
contains
   !> Lists the unknowns of the coordinates of a plate.
   pure function unknowns_of(plate, dofs) result(unknowns)
      type(plate_t), intent(in) :: plate
      type(dofs_t), intent(in) :: dofs
      integer :: unknowns(size(plate%coordinates)), k

      unknowns = [(dofs%of(plate%coordinates(k)%field, plate%coordinates(k)%node), k=1, size(unknowns))]
   end function unknowns_of

   !> Evaluates an amplitude at a time; amplitude 0 is 1 throughout. [-]
   pure real(wp) function factor_at(model, amplitude, time) result(factor)
      type(model_t), intent(in) :: model
      integer, intent(in) :: amplitude
      real(wp), intent(in) :: time   !< [s]

      factor = 1.0_wp
      if (amplitude > 0) factor = amplitude_at(model%amplitudes(amplitude), time)
   end function factor_at

   !> Finds the least and largest value that factor_at has for an amplitude. [-]
   pure function factors_of(model, amplitude) result(factors)
      type(model_t), intent(in) :: model
      integer, intent(in) :: amplitude
      real(wp) :: factors(2)

      factors = 1.0_wp
      if (amplitude > 0) factors = [minval(model%amplitudes(amplitude)%values), &
                                    maxval(model%amplitudes(amplitude)%values)]
   end function factors_of

   !> Evaluates a support or load at a height, at a factor of 1.
   pure real(wp) function value_at(one, z) result(value)
      class(acting_t), intent(in) :: one
      real(wp), intent(in) :: z   !< [m]

      value = one%value + one%value_slope*(z - one%datum)
   end function value_at

   !> Scales gravity, which acts towards -z, by its history [m/s2].
   pure real(wp) function gravity_at(model, time)
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: time   !< [s]

      gravity_at = factor_at(model, model%gravity_amplitude, time)*model%domain%gravity
   end function gravity_at

   !> Finds the share of the stage under way that is over at a time. [-]
   pure real(wp) function share_over(problem, time) result(share)
      class(problem_t), intent(in) :: problem
      real(wp), intent(in) :: time   !< [s]

      share = min(1.0_wp, max(0.0_wp, (time - problem%at%t_start)/problem%stage%duration))
   end function share_over

   !> Where a run is at the end of the step under way, for a warning.
   function now_in(problem) result(text)
      class(problem_t), intent(in) :: problem
      character(:), allocatable :: text

      text = 'stage '//trim(problem%stage%name)//', time '//short(problem%next%time)//' s: '
   end function now_in

   !> Begins a run, with its initial state.
   subroutine begin_run(self, problem, fault)
      class(term_t), intent(inout) :: self
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault
   end subroutine begin_run

   !> Begins the stage problem%at%stage, from problem%state; also where a run is taken up within the stage.
   subroutine begin_stage(self, begins, problem, fault)
      class(term_t), intent(inout) :: self
      logical, intent(in) :: begins   !< Else the run is in the middle of it.
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault
   end subroutine begin_stage

   !> Acts before an attempt at a step of length dt from problem%state to problem%next; of length 0 where a stage
   !> begins. problem%constraint has the loads of the scene and of terms before this one in the registry.
   subroutine before_step(self, dt, problem, fault)
      class(term_t), intent(inout) :: self
      real(wp), intent(in) :: dt   !< [s]
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault
   end subroutine before_step

   !> Sets, behind the supports of the scene, the values at the end of the step that the term prescribes.
   subroutine prescribe(self, time, problem)
      class(term_t), intent(in) :: self
      real(wp), intent(in) :: time   !< At the end of the step [s].
      type(problem_t), intent(inout) :: problem
   end subroutine prescribe

   !> Sets, behind all that is prescribed, upper limits of unknowns, each held where it stands at its limit at the start
   !> of the step and free where it lies below.
   subroutine limit(self, time, problem)
      class(term_t), intent(inout) :: self
      real(wp), intent(in) :: time   !< At the end of the step [s].
      type(problem_t), intent(inout) :: problem
   end subroutine limit

   !> Holds or frees unknowns after an iteration of Newton's method. The step is solved only when no term changes one.
   subroutine choose(self, problem, residual, changed)
      class(term_t), intent(inout) :: self
      type(problem_t), intent(inout) :: problem
      real(wp), intent(in) :: residual(:)    !< (unknowns) With minus sign and all rows kept [kN, m3/s].
      logical, intent(inout) :: changed      !< Becomes true where this term changes one.
   end subroutine choose

   !> Sets, after a step that Newton's method has solved, values of problem%next that follow from its unknowns.
   subroutine complete(self, problem)
      class(term_t), intent(in) :: self
      type(problem_t), intent(inout) :: problem
   end subroutine complete

   !> Acts after an accepted step, which is booked and not yet taken over. Energies [kJ] of the step grow by what the
   !> term dissipated.
   subroutine accept(self, problem, dissipated)
      class(term_t), intent(inout) :: self
      type(problem_t), intent(inout) :: problem
      real(wp), intent(inout) :: dissipated   !< [kJ]
   end subroutine accept

   !> Exchanges what the term keeps from step to step, and does not find again from the scene.
   subroutine exchange(self, problem, archive)
      class(term_t), intent(inout) :: self
      type(problem_t), intent(inout) :: problem
      class(archive_t), intent(inout) :: archive
   end subroutine exchange

   !> Says what the term may have to do with a step that fails: the end of a sentence, or nothing.
   function remark(self, model, time) result(text)
      class(term_t), intent(in) :: self
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: time   !< At the end of the step [s].
      character(:), allocatable :: text

      text = ''
   end function remark
end module model_types
