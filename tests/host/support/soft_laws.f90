! SPDX-License-Identifier: MIT
!> Laws that are hard to solve for, for the tests of what the host does about it.
!>
!> One has no stiffness: it is elastic as long as an increment is short; one that is longer meets nine tenths of the
!> stress and a tangent of zero. It may refuse batches of many points, and no point of a shorter one. The other one has
!> a kink: behind it the stress grows with the root of the strain.
module soft_laws
   use kinds, only: wp
   use material_elastic, only: elastic_t, isotropic
   use material_point, only: response_t, batch_report_t
   use model_types, only: model_t
   implicit none (type, external)
   private
   public :: soft_t, soften, bend, BEND_AT, BEHIND_IT

   real(wp), parameter :: LEFT = 0.9_wp   !< Share of the elastic change of stress in a long increment [-].
   real(wp), parameter :: BEND_AT = 5.0e-4_wp    !< Compression along z at the kink [-].
   real(wp), parameter :: BEHIND_IT = 1.0e3_wp   !< Stress behind the kink over the root of the strain from there [kPa].

   type, extends(elastic_t) :: soft_t
      real(wp) :: limit = 0.0_wp        !< Largest strain of an increment that meets stiffness [-].
      logical :: knows_elastic = .true. !< Whether it has an elastic tangent to fall back on.
      integer :: most_points = huge(1)  !< Points of the longest batch that it does not refuse.
   contains
      procedure :: update => soft_update
      procedure :: elastic_tangent => soft_elastic_tangent
   end type soft_t

   !> Elastic without Poisson's ratio up to the kink, in one increment from rest that strains along z alone.
   type, extends(elastic_t) :: bent_t
   contains
      procedure :: update => bent_update
   end type bent_t
contains
   !> Makes the elastic law of a region a soft one.
   subroutine soften(model, region, limit, knows_elastic, most_points)
      type(model_t), intent(inout) :: model
      integer, intent(in) :: region
      real(wp), intent(in) :: limit
      logical, intent(in) :: knows_elastic
      integer, intent(in), optional :: most_points
      type(soft_t) :: soft

      soft%elastic_t = elastic_law(model, region)
      soft%limit = limit
      soft%knows_elastic = knows_elastic
      if (present(most_points)) soft%most_points = most_points
      deallocate (model%domain%regions(region)%law)
      allocate (model%domain%regions(region)%law, source=soft)
   end subroutine soften

   !> Gives the elastic law of a region a kink.
   subroutine bend(model, region)
      type(model_t), intent(inout) :: model
      integer, intent(in) :: region
      type(bent_t) :: bent

      bent%elastic_t = elastic_law(model, region)
      deallocate (model%domain%regions(region)%law)
      allocate (model%domain%regions(region)%law, source=bent)
   end subroutine bend

   function elastic_law(model, region) result(elastic)
      type(model_t), intent(in) :: model
      integer, intent(in) :: region
      type(elastic_t) :: elastic

      select type (law => model%domain%regions(region)%law)
      type is (elastic_t)
         elastic = law
      class default
         error stop 'only an elastic law can be changed'
      end select
   end function elastic_law

   subroutine bent_update(self, n, stress, state, strain, suction, d_suction, with_tangent, response, new_state, &
                          report)
      class(bent_t), intent(in) :: self
      integer, intent(in) :: n
      real(wp), intent(in), contiguous :: stress(:, :), state(:, :), strain(:, :), suction(:), d_suction(:)
      logical, intent(in) :: with_tangent
      type(response_t), intent(inout) :: response
      real(wp), intent(inout), contiguous :: new_state(:, :)
      type(batch_report_t), intent(out) :: report
      real(wp) :: past
      integer :: g

      call self%elastic_t%update(n, stress, state, strain, suction, d_suction, with_tangent, response, new_state, &
                                report)
      do g = 1, n
         past = -strain(2, g) - BEND_AT
         if (past <= 0.0_wp) cycle
         response%stress(2, g) = -(self%young*BEND_AT + BEHIND_IT*sqrt(past))
         if (with_tangent) response%dsig_deps(2, 2, g) = BEHIND_IT/(2*sqrt(past))
      end do
   end subroutine bent_update

   subroutine soft_update(self, n, stress, state, strain, suction, d_suction, with_tangent, response, new_state, &
                          report)
      class(soft_t), intent(in) :: self
      integer, intent(in) :: n
      real(wp), intent(in), contiguous :: stress(:, :), state(:, :), strain(:, :), suction(:), d_suction(:)
      logical, intent(in) :: with_tangent
      type(response_t), intent(inout) :: response
      real(wp), intent(inout), contiguous :: new_state(:, :)
      type(batch_report_t), intent(out) :: report
      integer :: g

      call self%elastic_t%update(n, stress, state, strain, suction, d_suction, with_tangent, response, new_state, &
                                report)
      if (n > self%most_points) report = batch_report_t(code=1, point=self%most_points + 3)
      do g = 1, n
         if (maxval(abs(strain(:, g))) < self%limit) cycle
         response%stress(:, g) = stress(:, g) + LEFT*(response%stress(:, g) - stress(:, g))
         if (with_tangent) response%dsig_deps(:, :, g) = 0.0_wp
      end do
   end subroutine soft_update

   subroutine soft_elastic_tangent(self, stress, state, suction, tangent)
      class(soft_t), intent(in) :: self
      real(wp), intent(in) :: stress(6), state(:), suction
      real(wp), intent(out) :: tangent(6, 6)
      type(elastic_t) :: law

      tangent = 0.0_wp
      if (.not. self%knows_elastic) return
      law = isotropic(self%young, self%poisson)
      call law%elastic_tangent(stress, state, suction, tangent)
   end subroutine soft_elastic_tangent
end module soft_laws
