! SPDX-License-Identifier: MIT
!> Viscosity of regions, a key of &region: a stress beside the skeleton, against the rate of the deviator of the strain.
!> docs/theory/host.md section 16.2.
module viscosity
   use faults, only: fault_t
   use key_schema, only: UNBOUNDED
   use key_table, only: key_table_t
   use kinds, only: wp
   use model_types, only: model_t
   use scene_term, only: scene_term_t
   implicit none (type, external)
   private
   public :: viscosity_t

   !> Twice the deviator of a rate of strain with engineering shear.
   real(wp), parameter :: DEVIATOR(4, 4) = &
      reshape([4, -2, -2, 0, -2, 4, -2, 0, -2, -2, 4, 0, 0, 0, 0, 3], [4, 4])/3.0_wp

   type, extends(scene_term_t) :: viscosity_t
   contains
      procedure :: build_group
   end type viscosity_t
contains
   !> Reads what the points of a region have against the rate of strain, which is all that a run sees. Raises no fault.
   subroutine build_group(self, k, number, model, fault)
      class(viscosity_t), intent(inout) :: self
      type(key_table_t), intent(inout) :: k
      integer, intent(in) :: number
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      real(wp) :: eta

      eta = 0.0_wp
      call k%number('viscosity', eta, 0.0_wp, UNBOUNDED, &
                    'shear viscosity beside the skeleton, not in static stages [kPa s]', ':time')
      if (k%lists) return
      if (eta > 0.0_wp) model%domain%regions(number)%against_rate = eta*DEVIATOR
   end subroutine build_group
end module viscosity
