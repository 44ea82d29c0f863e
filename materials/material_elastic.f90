! SPDX-License-Identifier: MIT
!> Isotropic linear elasticity of the effective stress, beside a retention curve.
module material_elastic
   use kinds, only: wp
   use key_schema, only: REQUIRED, UNBOUNDED
   use key_table, only: key_table_t
   use faults, only: fault_t
   use material_point, only: material_t, response_t, batch_report_t, swollen, NAME_LENGTH
   use retention_curves, only: saturation_t
   implicit none (type, external)
   private
   public :: elastic_t, new_elastic, isotropic

   integer, parameter :: PLACE_E = 1, PLACE_S_W = 2   !< Places in the state.

   type, extends(material_t) :: elastic_t
      real(wp) :: young = 0.0_wp     !< [kPa]
      real(wp) :: poisson = 0.0_wp   !< [-]
   contains
      procedure :: initial_state
      procedure :: update
      procedure :: message
   end type elastic_t
contains
   !> The law of a group. title and fault stay as they are. Young's modulus in kPa.
   subroutine new_elastic(k, law, title, fault)
      type(key_table_t), intent(inout) :: k
      class(material_t), allocatable, intent(out) :: law
      character(*), intent(inout) :: title
      type(fault_t), intent(inout) :: fault
      real(wp) :: young, poisson

      young = 0.0_wp
      poisson = -1.0_wp
      call k%number('young', young, 1.0e-30_wp, UNBOUNDED, 'Young''s modulus [kPa]', REQUIRED)
      call k%number('poisson', poisson, -0.99_wp, 0.4999_wp, 'Poisson''s ratio [-]', REQUIRED)
      allocate (law, source=isotropic(young, poisson))
   end subroutine new_elastic

   !> The law with Young's modulus [kPa] and Poisson's ratio [-]; saturated unless a retention curve is added. Law of
   !> Hooke; neither number is checked.
   pure function isotropic(young, poisson) result(law)
      real(wp), intent(in) :: young, poisson
      type(elastic_t) :: law

      law%young = young
      law%poisson = poisson
      law%has_energy = .true.
      law%state_names = [character(NAME_LENGTH) :: 'void_ratio', 'saturation']
      law%n_state = size(law%state_names)
      law%place_e = PLACE_E
      law%place_s_w = PLACE_S_W
   end function isotropic

   subroutine initial_state(self, stress, suction, void_ratio, state, text)
      class(elastic_t), intent(in) :: self
      real(wp), intent(inout) :: stress(6)
      real(wp), intent(in) :: suction, void_ratio
      real(wp), intent(inout) :: state(:)
      character(*), intent(out) :: text
      type(saturation_t) :: sat

      text = ''
      sat = self%retention(suction, void_ratio)
      state(PLACE_E) = void_ratio
      state(PLACE_S_W) = sat%s
   end subroutine initial_state

   subroutine update(self, n, stress, state, strain, suction, d_suction, with_tangent, response, new_state, &
                     report)
      class(elastic_t), intent(in) :: self
      integer, intent(in) :: n
      real(wp), intent(in), contiguous :: stress(:, :), state(:, :), strain(:, :), suction(:), d_suction(:)
      logical, intent(in) :: with_tangent
      type(response_t), intent(inout) :: response
      real(wp), intent(inout), contiguous :: new_state(:, :)
      type(batch_report_t), intent(out) :: report
      type(saturation_t) :: sat
      real(wp) :: lame, shear, slope(6, 6), e
      integer :: i, g

      shear = self%young/(2*(1 + self%poisson))
      lame = 2*shear*self%poisson/(1 - 2*self%poisson)
      slope = 0.0_wp
      slope(1:3, 1:3) = lame
      do i = 1, 3
         slope(i, i) = lame + 2*shear
         slope(i + 3, i + 3) = shear
      end do
      do g = 1, n
         response%stress(1:3, g) = stress(1:3, g) + lame*sum(strain(1:3, g)) + 2*shear*strain(1:3, g)
         response%stress(4:6, g) = stress(4:6, g) + shear*strain(4:6, g)
         e = swollen(state(PLACE_E, g), sum(strain(1:3, g)))
         sat = self%retention(suction(g) + d_suction(g), e)
         new_state(PLACE_E, g) = e
         new_state(PLACE_S_W, g) = sat%s
         response%void_ratio(g) = e
         response%s_w(g) = sat%s
         if (.not. with_tangent) cycle
         response%dsig_deps(:, :, g) = slope
         response%dsig_dpc(:, g) = 0.0_wp
         response%dsw_dev(g) = sat%ds_de*(1 + e)
         response%dsw_dpc(g) = sat%ds_dpc
      end do
   end subroutine update

   subroutine message(self, report, text)
      class(elastic_t), intent(in) :: self
      type(batch_report_t), intent(in) :: report
      character(*), intent(out) :: text

      write (text, '(a,i0,a,es9.2,a)') 'the elastic law never fails (code ', report%code, ', E = ', self%young, ' kPa)'
   end subroutine message
end module material_elastic
