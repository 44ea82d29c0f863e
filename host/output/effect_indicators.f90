! SPDX-License-Identifier: MIT
!> Indicators of effects that a run does not have: columns of ledger.csv. A few sums over nodes and points; nothing
!> is asked of the material. docs/theory/host.md section 11.
module effect_indicators
   use kinds, only: wp
   use model_types, only: model_t
   use unknown_fields, only: AT_P_W
   use porous_domain, only: is_present
   use run_state, only: run_t
   use texts, only: whole
   implicit none (type, external)
   private
   public :: indicator_columns, indicators_of
contains
   !> Heads of the columns, in the order of indicators_of.
   pure function indicator_columns(model) result(head)
      type(model_t), intent(in) :: model
      character(:), allocatable :: head
      integer :: i

      head = 'speed,acceleration,tension,softness'
      do i = 1, size(model%domain%regions)
         head = head//',volume_rate_'//whole(i)
      end do
   end function indicator_columns

   !> Indicators of a step: the speed that inertia acts on, root of twice the kinetic energy [kJ**(1/2)]; the largest
   !> acceleration of a node [m/s2], for that of the skeleton in Darcy's law; the largest tension of the water [kPa],
   !> for suction; the inverse of the least mean effective stress of a material that yields [1/kPa], for gravity; of
   !> every region the largest rate of volume [1/s], for flow. 0 where there is none.
   function indicators_of(run, kinetic) result(values)
      type(run_t), intent(in) :: run   !< After a step.
      real(wp), intent(in) :: kinetic   !< Kinetic energy at its end [kJ].
      real(wp) :: values(4 + size(run%domain%regions)), least
      integer :: e, at

      values = 0.0_wp
      if (run%scheme%has_rates) values(1) = sqrt(2*kinetic)
      if (run%scheme%has_inertia) values(2) = sqrt(maxval(sum(run%next%a**2, dim=1)))
      values(3) = max(0.0_wp, maxval(-run%next%x(AT_P_W, :), mask=run%dofs%of(AT_P_W, :) > 0))
      least = huge(1.0_wp)
      associate (m => run%domain, old => run%state, new => run%next)
         do e = 1, size(m%region_of)
            if (.not. is_present(new, e)) cycle
            at = 4 + m%region_of(e)
            associate (points => [((e - 1)*m%rule + 1), (e*m%rule)])
               associate (one => old%e(points(1):points(2)), two => new%e(points(1):points(2)))
                  values(at) = max(values(at), maxval(abs(two - one)/(1 + two))/run%scheme%dt)
               end associate
               if (.not. m%regions(m%region_of(e))%law%has_energy) &
                  least = min(least, minval(-sum(new%stress(1:3, points(1):points(2)), dim=1)/3))
            end associate
         end do
      end associate
      if (least < huge(1.0_wp)) values(4) = 1/max(least, tiny(1.0_wp)/epsilon(1.0_wp))
   end function indicators_of
end module effect_indicators
