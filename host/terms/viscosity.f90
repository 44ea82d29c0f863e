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
      procedure, nopass :: declare
      procedure :: build
   end type viscosity_t
contains
   subroutine declare(k)
      type(key_table_t), intent(inout) :: k
      real(wp) :: eta

      call take(k, eta)
   end subroutine declare

   subroutine take(k, eta)
      type(key_table_t), intent(inout) :: k
      real(wp), intent(out) :: eta

      eta = 0.0_wp
      call k%number('viscosity', eta, 0.0_wp, UNBOUNDED, &
                    'shear viscosity beside the skeleton, not in static stages [kPa s]', ':time')
   end subroutine take

   !> What the points of regions have against the rate of strain. Raises no fault.
   subroutine build(self, tables, model, there, fault)
      class(viscosity_t), intent(inout) :: self
      type(key_table_t), intent(inout) :: tables(:)
      type(model_t), intent(inout) :: model
      logical, intent(out) :: there
      type(fault_t), intent(inout) :: fault
      real(wp) :: eta
      integer :: i

      there = .false.
      do i = 1, size(tables)
         call take(tables(i), eta)
         if (.not. eta > 0.0_wp) cycle
         there = .true.
         model%domain%regions(i)%against_rate = eta*DEVIATOR
      end do
   end subroutine build
end module viscosity
