! SPDX-License-Identifier: MIT
!> A second law for the test of "how to add a law" (CONTRIBUTING.md): isotropic hypoelasticity whose stiffness is
!> proportional to the mean stress where the increment begins, saturated unless there is a retention curve.
module material_hypoelastic
   use faults, only: fault_t
   use key_schema, only: REQUIRED, UNBOUNDED
   use key_table, only: key_table_t
   use kinds, only: wp
   use material_point, only: material_t, response_t, batch_report_t, swollen, NAME_LENGTH
   use retention_curves, only: saturation_t
   implicit none (type, external)
   private
   public :: hypoelastic_t, new_hypoelastic

   integer, parameter :: PLACE_E = 1, PLACE_S_W = 2   !< Places in the state.
   integer, parameter :: NO_PRESSURE = 1              !< Code: the mean stress is tension.

   type, extends(material_t) :: hypoelastic_t
      real(wp) :: stiffness = 0.0_wp   !< K/p' [-]
      real(wp) :: poisson = 0.25_wp    !< [-]
   contains
      procedure :: initial_state
      procedure :: update
      procedure :: message
   end type hypoelastic_t
contains
   !> The law of a group.
   subroutine new_hypoelastic(k, law, title, fault)
      type(key_table_t), intent(inout) :: k
      class(material_t), allocatable, intent(out) :: law
      character(*), intent(inout) :: title
      type(fault_t), intent(inout) :: fault
      type(hypoelastic_t) :: made

      call k%number('stiffness', made%stiffness, 1.0e-3_wp, UNBOUNDED, 'bulk modulus over mean stress [-]', REQUIRED)
      call k%number('poisson', made%poisson, -0.99_wp, 0.49_wp, 'Poisson''s ratio [-]')
      made%exact_tangent = .true.
      made%state_names = [character(NAME_LENGTH) :: 'void_ratio', 'saturation']
      made%n_state = size(made%state_names)
      made%place_e = PLACE_E
      made%place_s_w = PLACE_S_W
      allocate (law, source=made)
   end subroutine new_hypoelastic

   subroutine initial_state(self, stress, suction, void_ratio, state, text)
      class(hypoelastic_t), intent(in) :: self
      real(wp), intent(inout) :: stress(6)
      real(wp), intent(in) :: suction, void_ratio
      real(wp), intent(inout) :: state(:)
      character(*), intent(out) :: text
      type(saturation_t) :: sat

      text = ''
      if (sum(stress(1:3)) >= 0.0_wp) text = 'a hypoelastic point needs a mean stress that is pressure.'
      sat = self%retention(suction, void_ratio)
      state(PLACE_E) = void_ratio
      state(PLACE_S_W) = sat%s
   end subroutine initial_state

   subroutine update(self, n, stress, state, strain, suction, d_suction, with_tangent, response, new_state, report)
      class(hypoelastic_t), intent(in) :: self
      integer, intent(in) :: n
      real(wp), intent(in), contiguous :: stress(:, :), state(:, :), strain(:, :), suction(:), d_suction(:)
      logical, intent(in) :: with_tangent
      type(response_t), intent(inout) :: response
      real(wp), intent(inout), contiguous :: new_state(:, :)
      type(batch_report_t), intent(out) :: report
      type(saturation_t) :: sat
      real(wp) :: bulk, shear, slope(6, 6), e
      integer :: i, g

      do g = 1, n
         bulk = -self%stiffness*sum(stress(1:3, g))/3
         if (.not. bulk > 0.0_wp) then
            report%code = NO_PRESSURE
            report%point = g
            report%factor = 0.5_wp
            report%value = -sum(stress(1:3, g))/3
            return
         end if
         shear = 1.5_wp*bulk*(1 - 2*self%poisson)/(1 + self%poisson)
         slope = 0.0_wp
         slope(1:3, 1:3) = bulk - 2*shear/3
         do i = 1, 3
            slope(i, i) = bulk + 4*shear/3
            slope(i + 3, i + 3) = shear
         end do
         e = swollen(state(PLACE_E, g), sum(strain(1:3, g)))
         sat = self%retention(suction(g) + d_suction(g), e)
         new_state(PLACE_E, g) = e
         new_state(PLACE_S_W, g) = sat%s
         response%stress(:, g) = stress(:, g) + matmul(slope, strain(:, g))
         response%void_ratio(g) = e
         response%s_w(g) = sat%s
         report%n_rate = report%n_rate + 1
         if (.not. with_tangent) cycle
         response%dsig_deps(:, :, g) = slope
         response%dsig_dpc(:, g) = 0.0_wp
         response%dsw_dev(g) = sat%ds_de*(1 + e)
         response%dsw_dpc(g) = sat%ds_dpc
      end do
   end subroutine update

   subroutine message(self, report, text)
      class(hypoelastic_t), intent(in) :: self
      type(batch_report_t), intent(in) :: report
      character(*), intent(out) :: text

      write (text, '(a,es10.2,a)') 'the hypoelastic law needs pressure; the mean stress is ', report%value, ' kPa.'
   end subroutine message
end module material_hypoelastic
