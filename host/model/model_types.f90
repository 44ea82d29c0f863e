! SPDX-License-Identifier: MIT
!> A model: mesh, unknowns, materials, loads, supports, plates and contacts of a scene, its names resolved to places. A
!> model is built once (model_builder); a run reads it and changes nothing in it.
module model_types
   use kinds, only: wp
   use degrees_of_freedom, only: dofs_t
   use porous_domain, only: domain_t
   use scene_types, only: scene_t, amplitude_at
   implicit none (type, external)
   private
   public :: model_t, factor_at, gravity_at

   !> The scene with the places of what it names, and what is made of it.
   type, extends(scene_t) :: model_t
      type(domain_t) :: domain
      type(dofs_t) :: dofs
      integer :: gravity_amplitude = 0
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
