!> Isotropic linear elasticity of the effective stress.
module fe_elastic
   use kinds, only: wp
   use fe_material, only: material_t, answer_t
   implicit none (type, external)
   private
   public :: elastic_t

   type, extends(material_t) :: elastic_t
      real(wp) :: young = 0.0_wp     !< [kPa]
      real(wp) :: poisson = 0.0_wp   !< [-]
   contains
      procedure :: start
      procedure :: update
      procedure :: explain
      procedure :: initial_void_ratio
   end type elastic_t
contains
   subroutine start(self, stress, suction, void_ratio, state, text)
      class(elastic_t), intent(in) :: self
      real(wp), intent(inout) :: stress(6)
      real(wp), intent(in) :: suction, void_ratio
      real(wp), intent(inout) :: state(:)
      character(*), intent(out) :: text

      ! Nothing to remember; the arguments are those of every law.
      associate (unused => [stress(1), suction, void_ratio, self%young])
      end associate
      state = 0.0_wp
      text = ''
   end subroutine start

   subroutine update(self, stress, state, strain, suction, d_suction, with_slope, answer, new_state)
      class(elastic_t), intent(in) :: self
      real(wp), intent(in) :: stress(6), state(:), strain(6), suction, d_suction
      logical, intent(in) :: with_slope
      type(answer_t), intent(out) :: answer
      real(wp), intent(inout) :: new_state(:)
      real(wp) :: lame, shear

      associate (unused => [suction, d_suction])
      end associate
      shear = self%young/(2*(1 + self%poisson))
      lame = 2*shear*self%poisson/(1 - 2*self%poisson)
      answer%stress(1:3) = stress(1:3) + lame*sum(strain(1:3)) + 2*shear*strain(1:3)
      answer%stress(4:6) = stress(4:6) + shear*strain(4:6)
      if (size(state) > 0) new_state = state
      if (.not. with_slope) return
      answer%slope(1:3, 1:3) = lame
      answer%slope(1, 1) = lame + 2*shear
      answer%slope(2, 2) = lame + 2*shear
      answer%slope(3, 3) = lame + 2*shear
      answer%slope(4, 4) = shear
   end subroutine update

   subroutine explain(self, answer, text)
      class(elastic_t), intent(in) :: self
      type(answer_t), intent(in) :: answer
      character(*), intent(out) :: text

      write (text, '(a,i0,a,es9.2,a)') 'the elastic law never fails (code ', answer%code, ', E = ', self%young, ')'
   end subroutine explain

   pure real(wp) function initial_void_ratio(self)
      class(elastic_t), intent(in) :: self

      initial_void_ratio = 0.0_wp*self%young
   end function initial_void_ratio
end module fe_elastic
