! SPDX-License-Identifier: MIT
!> Air that cannot leave a sample whose water cannot leave either: its pressure follows from Boyle's law, what is
!> dissolved in the water from Henry's, and the water is compressible. docs/theory/host.md section 13.
module triax_air
   use, intrinsic :: iso_fortran_env, only: wp => real64
   implicit none (type, external)
   private
   public :: air_t, closed_air_t, air_now_t, closing, air_of

   !> Air and water of a sample.
   type :: air_t
      real(wp) :: atmosphere = 0.0_wp   !< Absolute pressure where the air pressure is 0 [unit of stress].
      real(wp) :: henry = 0.0_wp        !< Volume of air that a volume of water dissolves, at its pressure [-].
      real(wp) :: stiffness = 0.0_wp    !< Bulk modulus of the water [unit of stress]; 0: incompressible.
   end type air_t

   !> Quantities that stay while neither air nor water leaves, per volume of solids.
   type :: closed_air_t
      type(air_t) :: air
      real(wp) :: content = 0.0_wp      !< Absolute pressure times volume of all air [unit of stress].
      real(wp) :: water = 0.0_wp        !< Volume of the water where its pressure is p_w [-].
      real(wp) :: p_w = 0.0_wp          !< [unit of stress]
   end type closed_air_t

   !> Pressure of the air and volume of the water, with their slopes by void ratio and suction.
   type :: air_now_t
      real(wp) :: p_a, by_e, by_suction                    !< [unit of stress], the same, [-]
      real(wp) :: water, water_by_e, water_by_suction      !< [-], [-], [1/unit of stress]
   end type air_now_t

   integer, parameter :: MOST = 60                      !< Newton's method doubles the digits within ten iterations.
   real(wp), parameter :: SHARE = 4.0_wp*epsilon(1.0_wp)
contains
   !> Closes a sample as it is.
   pure function closing(air, e, s_w, p_a, suction) result(closed)
      type(air_t), intent(in) :: air
      real(wp), intent(in) :: e, s_w         !< Void ratio, degree of saturation [-].
      real(wp), intent(in) :: p_a, suction   !< [unit of stress]
      type(closed_air_t) :: closed

      closed%air = air
      closed%water = s_w*e
      closed%p_w = p_a - suction
      closed%content = (air%atmosphere + p_a)*(e - (1 - air%henry)*closed%water)
   end function closing

   !> Pressure of the air and volume of the water at a void ratio and a suction, with their slopes. No air is left as
   !> bubbles where e <= w: the caller looks. NaN: such a void ratio would need water that does not compress.
   pure function air_of(closed, e, suction) result(now)
      type(closed_air_t), intent(in) :: closed
      real(wp), intent(in) :: e, suction           !< [-], [unit of stress]
      type(air_now_t) :: now
      real(wp) :: free, room, slope, step, compliance
      integer :: i

      associate (top => closed%air%atmosphere, p_a => now%p_a, water => now%water)
         free = 1 - closed%air%henry
         compliance = 0.0_wp
         if (closed%air%stiffness > 0.0_wp) compliance = 1/closed%air%stiffness
         water = closed%water
         room = e - free*water
         ! Where the air has no room at the water's first pressure, the water has to make it: the least pressure of all.
         p_a = closed%p_w + suction
         if (room <= 0.0_wp .and. compliance > 0.0_wp) p_a = p_a + log(free*water/e)/compliance
         do i = 1, MOST
            water = closed%water*exp(-(p_a - suction - closed%p_w)*compliance)
            room = e - free*water
            slope = room + (top + p_a)*free*water*compliance
            step = (closed%content - (top + p_a)*room)/slope
            p_a = p_a + step
            if (abs(step) <= SHARE*abs(top + p_a)) exit
         end do
         water = closed%water*exp(-(p_a - suction - closed%p_w)*compliance)
         slope = e - free*water + (top + p_a)*free*water*compliance
         now%by_e = -(top + p_a)/slope
         now%by_suction = (top + p_a)*free*water*compliance/slope
         now%water_by_e = -water*compliance*now%by_e
         now%water_by_suction = -water*compliance*(now%by_suction - 1)
      end associate
   end function air_of
end module triax_air
