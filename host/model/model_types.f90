! SPDX-License-Identifier: MIT
!> A model: mesh, unknowns, materials, loads, supports, plates and contacts of a scene, its names resolved to places. A
!> model is built once (model_builder); a run reads it and changes nothing in it.
module model_types
   use kinds, only: wp
   use contact_types, only: contact_options_t
   use degrees_of_freedom, only: dofs_t
   use namelists, only: group_t
   use effect_types, only: effect_t
   use convergence, only: BY_STAGE
   use porous_domain, only: domain_t
   use unknown_fields, only: FIELDS
   use scene_types, only: scene_amplitude_t, scene_initial_t, scene_stage_t, scene_fix_t, scene_load_t, scene_plate_t, &
                          scene_contact_t, scene_point_t, scene_absorber_t, scene_tie_t, amplitude_at, &
                           NAME_LENGTH, FINGERPRINT_LENGTH
   implicit none (type, external)
   private
   public :: model_t, initial_t, stage_t, fix_t, load_t, plate_t, contact_pair_t, point_t, factor_at, gravity_at
   public :: PRESCRIBED_P_A, absorber_t, tie_t

   integer, parameter :: PRESCRIBED_P_A = FIELDS + 1   !< "Field" of a prescribed air pressure.

   ! What a scene says, with the places of what it names. Group: of the mesh; amplitude: 0 is 1 throughout.
   type, extends(scene_initial_t) :: initial_t
      integer :: group = 0
   end type initial_t

   type, extends(scene_stage_t) :: stage_t
      integer :: kind = 0                   !< STATIC, QUASI_STATIC or DYNAMIC of generalised_alpha.
      integer :: measure = BY_STAGE          !< See convergence.
   end type stage_t

   type, extends(scene_fix_t) :: fix_t
      integer :: group = 0, amplitude = 0
      integer :: field = 0                  !< U_R, U_Z, P_W, P_C of unknown_fields, or PRESCRIBED_P_A.
   end type fix_t

   type, extends(scene_load_t) :: load_t
      integer :: group = 0, amplitude = 0
      real(wp), allocatable :: shape(:)     !< Load vector of a unit value.
      real(wp), allocatable :: rise(:)      !< Load vector of the value z - datum, where the value changes with z.
   end type load_t

   type, extends(scene_plate_t) :: plate_t
      integer :: amplitude = 0
      integer :: node = 0                   !< It carries the plate's motion: one of its own, or of the boundary.
      integer :: group = 0                  !< Boundary that it is joined to, 0: none.
   end type plate_t

   !> Two boundaries, or a boundary and a plate, that may come into contact.
   type, extends(scene_contact_t) :: contact_pair_t
      integer :: slave = 0, master = 0      !< Groups of the mesh.
      integer :: plate = 0                  !< The master as a plate with a face of its own, 0: it is none.
      type(contact_options_t) :: options
   end type contact_pair_t

   type, extends(scene_absorber_t) :: absorber_t
      integer :: group = 0, amplitude = 0
   end type absorber_t

   type, extends(scene_tie_t) :: tie_t
      integer, allocatable :: pairs(:, :)   !< (2, n) nodes of the first and the second boundary.
   end type tie_t

   type, extends(scene_point_t) :: point_t
      integer :: node = 0, gauss = 0        !< Nearest ones.
   end type point_t

   type :: model_t
      character(NAME_LENGTH) :: name = ''
      character(FINGERPRINT_LENGTH) :: fingerprint = ''   !< Of the scene.
      type(group_t), allocatable :: groups(:)             !< Its words, see scene_past.
      type(domain_t) :: domain
      type(dofs_t) :: dofs
      type(effect_t), allocatable :: effects(:)           !< What pilots have found; not allocated: none ran.
      logical :: stop_on_warning = .false.                !< See scene_types.
      logical :: subtract_flow = .false.
      logical :: reuse_factors = .true.
      integer :: ordering = 1                             !< See sparse_factors.
      integer :: checkpoint_steps = 0                     !< 0: none.
      real(wp) :: checkpoint_seconds = 0.0_wp             !< 0: none.
      logical :: checkpoint_end = .false.                 !< When the last stage ends.
      type(scene_amplitude_t), allocatable :: amplitudes(:)
      integer :: gravity_amplitude = 0
      type(initial_t), allocatable :: initials(:)
      type(stage_t), allocatable :: stages(:)
      type(fix_t), allocatable :: fixes(:)
      type(load_t), allocatable :: loads(:)
      type(plate_t), allocatable :: plates(:)
      type(contact_pair_t), allocatable :: contacts(:)
      type(absorber_t), allocatable :: absorbers(:)
      type(tie_t), allocatable :: ties(:)
      type(point_t), allocatable :: points(:)
   end type model_t
contains
   !> Factor of an amplitude at a time; amplitude 0 is 1 throughout. [-]
   pure real(wp) function factor_at(model, amplitude, time) result(factor)
      type(model_t), intent(in) :: model
      integer, intent(in) :: amplitude
      real(wp), intent(in) :: time   !< [s]

      factor = 1.0_wp
      if (amplitude > 0) factor = amplitude_at(model%amplitudes(amplitude), time)
   end function factor_at

   !> Gravity at a time, towards -z [m/s2].
   pure real(wp) function gravity_at(model, time)
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: time   !< [s]

      gravity_at = factor_at(model, model%gravity_amplitude, time)*model%domain%gravity
   end function gravity_at
end module model_types
