! SPDX-License-Identifier: MIT
!> A substep inside the elastic domain, in closed form: the shear modulus is that at the centre, which rests, and p'
!> follows the void ratio. So a closed loop of strain leaves nothing but rounding; docs/theory/memory-rules.md
!> section 4.3.
module mud_inside_domain
   use mud_elastic, only: bulk_modulus, pressure_root, centre_modulus, compressed
   use mud_increment, only: increment_t, void_ratio_at, volume_from_centre
   use mud_kinds, only: wp
   use mud_options, only: move_numbers
   use mud_params, only: params_t
   use mud_rates, only: stress_ratio, p_follows, MODE_ELASTIC
   use mud_tensor, only: IDENTITY, deviator
   use mud_vector, only: NY
   implicit none (type, external)
   private
   public :: has_closed_form, move_inside
contains
   !> True of a substep h inside the domain during which suction does not act on the stress. Without the tension cut-off
   !> p' must not leave the range of the moduli. sigma' [kPa] is that of its start; time and h are shares of inc [-].
   !> docs/theory/memory-rules.md section 4.3.
   pure logical function has_closed_form(par, inc, mode, time, h, sigma) result(closed)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: mode
      real(wp), intent(in) :: time, h, sigma(6)
      real(wp) :: p, r(6), e

      closed = mode == MODE_ELASTIC .and. (abs(inc%d_pc) <= 0.0_wp .or. .not. inc%suction%bonds)
      if (.not. closed .or. par%cutoff) return
      call stress_ratio(par, sigma, p, r)
      e = void_ratio_at(inc, time)
      closed = p_follows(par, sigma) .and. &
               compressed(par%elastic, pressure_root(par%elastic, e, bulk_modulus(par%elastic, e, p)), &
                          log(e/void_ratio_at(inc, time + h))) >= par%p_min
   end function has_closed_form

   !> The integrated vector after such a substep. docs/theory/memory-rules.md section 4.3.
   pure subroutine move_inside(par, inc, time, h, y)
      type(params_t), intent(in) :: par
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time, h
      real(wp), intent(inout) :: y(NY)
      real(wp) :: p, r(6), e, k

      call stress_ratio(par, y(1:6), p, r)
      e = void_ratio_at(inc, time)
      k = bulk_modulus(par%elastic, e, p)
      y(1:6) = deviator(y(1:6)) + (2.0_wp*h*centre_modulus(par%elastic, e, k, volume_from_centre(inc, time))) &
               *deviator(inc%d_strain) &
               + compressed(par%elastic, pressure_root(par%elastic, e, k), log(e/void_ratio_at(inc, time + h)))*IDENTITY
      call move_numbers(par, inc%d_v, h, y)
   end subroutine move_inside
end module mud_inside_domain
