! SPDX-License-Identifier: MIT
!> Changes of the part of the strain rate that loads, with the strain and the elastic domain; derivative of
!> docs/theory/memory-rules.md sections 4.1, 4.2.
module mud_loading_changes
   use mud_elastic_domain, only: decay_at
   use mud_increment, only: increment_t, has_elastic_part, volume_from_centre, since_centre
   use mud_kinds, only: wp
   use mud_loading, only: loading_t, whole_strain
   use mud_rates, only: MODE_ELASTIC
   use mud_tensor, only: DIRECTIONS, ddot, trace, traces, tensors_t, contracted, ANY_TENSORS
   use mud_turning, only: turning_t, turning_at, combination_t, combination_of_turning
   implicit none (type, external)
   private
   public :: changes_of_loading_strain
contains
   !> Changes of the part that loads with the strain rate and the elastic domain at the start, at a pseudo-time that
   !> itself changes by dt, and those of the volumetric strain from its centre. All [-]; derivative of
   !> docs/theory/memory-rules.md sections 4.1, 4.2.
   pure subroutine changes_of_loading_strain(inc, mode, time, strain, centre, dt, loading)
      type(increment_t), intent(in) :: inc
      integer, intent(in) :: mode
      real(wp), intent(in) :: time             !< a share of inc
      type(tensors_t), intent(in) :: strain, centre   !< changes of both
      real(wp), intent(in) :: dt(DIRECTIONS)        !< changes of the pseudo-time since the exit
      type(loading_t), intent(inout) :: loading
      type(turning_t) :: turning
      type(combination_t) :: by
      real(wp) :: along, per_rho, nu(2), nu_rate(2), turn_rate, turn, on_d, on_length, d_on_u
      integer :: j

      if (.not. has_elastic_part(inc, mode)) then
         call whole_strain(inc%d_strain, loading)
         return
      else if (mode == MODE_ELASTIC) then
         call whole_strain(inc%d_strain, loading)
         loading%part = 0.0_wp   ! nothing of it
         loading%of_strain = 0.0_wp
         loading%beside = .true.
         loading%aside = .true.
         loading%from_centre = volume_from_centre(inc, time)
         loading%of_volume = since_centre(inc, time)*traces(strain) + inc%d_v*dt
         if (centre%kind == ANY_TENSORS) loading%of_volume = loading%of_volume + traces(centre)
         return
      else if (inc%straight) then
         call changes_of_straight_strain(inc, time, strain, loading)
         return
      end if
      turning = turning_at(inc%rho, inc%from_centre, inc%d_strain, time - inc%exit)
      call combination_of_turning(turning, centre, strain, by)
      along = ddot(turning%nu, inc%d_strain)
      ! nu as a sum of d and u
      nu(1) = 2.0_wp*turning%decay/(turning%rho*turning%divisor)
      nu(2) = turning%share/turning%divisor
      loading%basis(:, 1) = turning%d
      loading%basis(:, 2) = turning%u
      loading%turns = .true.
      loading%beside = .true.
      loading%aside = .true.
      loading%part = along*nu
      loading%whole = [0.0_wp, turning%length]
      loading%of_strain = along*by%of_increment
      loading%of_centre = along*by%of_d
      ! the domain turns with the pseudo-time, nu' = (a - (nu:a) nu)/rho: rate of (nu:a) nu
      per_rho = 1.0_wp/turning%rho
      turn_rate = (turning%length**2 - 2.0_wp*along**2)*per_rho
      nu_rate(1) = turn_rate*nu(1)
      nu_rate(2) = turn_rate*nu(2) + along*turning%length*per_rho
      on_d = turning%length*by%of_d
      on_length = turning%length*by%of_increment + nu(2)
      d_on_u = turning%length*ddot(turning%d, turning%u)
      do j = 1, DIRECTIONS
         ! (dnu:a + nu:da) nu + (nu:a) dnu with a along u
         turn = on_d*by%d_on_u(j) + on_length*by%length(j) + d_on_u*by%along_d(j) + turning%length*by%along_u(j) &
                + nu(1)*by%increment_on_d(j)
         loading%along(j, 1) = along*by%along_d(j) + nu(1)*turn + nu_rate(1)*dt(j)
         loading%along(j, 2) = along*by%along_u(j) + nu(2)*turn + nu_rate(2)*dt(j)
      end do
      ! d = rho nu
      loading%from_centre = inc%rho*trace(turning%nu)
      on_d = inc%rho*trace(turning%d)
      on_length = inc%rho*inc%d_v/turning%length
      turn_rate = inc%d_v - along*(loading%from_centre/inc%rho)
      do j = 1, DIRECTIONS
         loading%of_volume(j) = on_d*by%along_d(j) + on_length*by%along_u(j) + turn_rate*dt(j)
      end do
      loading%of_volume = loading%of_volume + (inc%rho*by%of_increment)*traces(strain)
      if (centre%kind == ANY_TENSORS) loading%of_volume = loading%of_volume + (inc%rho*by%of_d)*traces(centre)
   end subroutine changes_of_loading_strain

   !> Changes of the loading part of a strain a along nu, all of which loads: (nu:a) nu changes with a by 1 - q across
   !> nu and by 1 along it, with the centre by q |a|/rho, where q, the tractrix's decay, is what is left of nu's first
   !> direction. All [-]; limit of docs/theory/memory-rules.md section 4.2 for d along a.
   pure subroutine changes_of_straight_strain(inc, time, strain, loading)
      type(increment_t), intent(in) :: inc
      real(wp), intent(in) :: time
      type(tensors_t), intent(in) :: strain
      type(loading_t), intent(inout) :: loading
      real(wp) :: decay

      decay = decay_at(inc%rho, inc%length, time - inc%exit)
      call whole_strain(inc%d_strain, loading)
      loading%of_strain = 1.0_wp - decay
      loading%of_centre = decay*inc%length/inc%rho
      loading%along(:, 1) = (decay/inc%length**2)*contracted(strain, inc%d_strain)
      loading%beside = .true.
      loading%from_centre = inc%rho*inc%d_v/inc%length
   end subroutine changes_of_straight_strain
end module mud_loading_changes
