! SPDX-License-Identifier: MIT
!> What `fpm test` runs: a path by two entries, the retention curve and a refusal against numbers known from elsewhere.
program known_numbers
   use, intrinsic :: iso_c_binding, only: c_int, c_double, c_char, c_null_char, c_loc
   use mud_interface, only: mud_count, mud_index, mud_default_props, mud_prepared_size, mud_prepare, mud_init, &
      mud_update, mud_update_points, mud_saturation, mud_blocks, mud_points, mud_report, MUD_PROPS, MUD_STATEV, &
      MUD_TANGENT_CONSISTENT, MUD_LANES
   implicit none (type, external)
   integer, parameter :: STEPS = 100
   real(c_double), parameter :: STRAIN = 0.01_c_double
   real(c_double), allocatable :: props(:), before(:), material(:)
   real(c_double), allocatable, target :: statev(:)
   real(c_double), target :: stress(6), d_strain(6)
   real(c_double) :: s_w, slope_p, slope_v, closed
   type(mud_points) :: points
   integer(c_int) :: status
   character(kind=c_char) :: text(200)
   integer :: i, failed

   allocate (props(mud_count(MUD_PROPS)), statev(mud_count(MUD_STATEV)), material(mud_prepared_size()))
   failed = 0
   status = mud_default_props(props, size(props))
   props(mud_index(MUD_PROPS, 'e_0'//c_null_char) + 1) = 0.735_c_double
   status = mud_prepare(props, size(props), material, size(material), text, size(text))
   call begin()
   do i = 1, STEPS
      call shear(STRAIN/STEPS)
   end do
   call check_end('p'' and q of the undrained path')

   ! Asked for lanes, which only the build by CMake has: the points go one by one.
   call begin()
   d_strain = [-1.0_c_double, 0.5_c_double, 0.5_c_double, 0.0_c_double, 0.0_c_double, 0.0_c_double]*STRAIN/STEPS
   points = mud_points(n=1, nstatev=size(statev), tangent=MUD_TANGENT_CONSISTENT + MUD_LANES, dstrain=c_loc(d_strain), &
                       stress0=c_loc(stress), statev0=c_loc(statev), stress1=c_loc(stress), statev1=c_loc(statev))
   do i = 1, STEPS
      status = mud_update_points(material, 1, points)
   end do
   call check_end('the same path by mud_update_points')

   ! Eq. (24) with the defaults: Omega 2, n_x 2, m_x 1, P_a 5 kPa.
   status = mud_saturation(material, 10.0_c_double, 0.8_c_double, s_w, slope_p, slope_v)
   closed = 1/log(exp(1.0_c_double) + (10*0.8_c_double**2/5)**2)
   call check('the retention curve is its formula', status == 0 .and. abs(s_w - closed) < 1e-14_c_double)

   before = [stress, statev]
   call shear(2.0_c_double)
   call check('an increment beyond every range is refused and changes nothing', &
              status > 0 .and. all(before >= [stress, statev] .and. before <= [stress, statev]))
   if (failed > 0) error stop 1
contains
   !> The point at p' 100 kPa, before any strain.
   subroutine begin()
      stress = -[100, 100, 100, 0, 0, 0]
      status = mud_init(material, stress, 0.0_c_double, 0.0_c_double, 0.0_c_double, statev, size(statev), text, &
                        size(text))
   end subroutine begin

   !> An independent integration of the equations, at 1 % of axial strain without change of volume.
   subroutine check_end(sentence)
      character(*), intent(in) :: sentence
      real(c_double) :: p, q

      p = -sum(stress(1:3))/3
      q = stress(2) - stress(1)
      call check(sentence, status == 0 .and. abs(p/147.354_c_double - 1) < 1e-4_c_double &
                 .and. abs(q/219.587_c_double - 1) < 1e-4_c_double)
   end subroutine check_end

   !> One increment of axial strain [-] without change of volume, in place.
   subroutine shear(d)
      real(c_double), intent(in) :: d
      type(mud_blocks) :: blocks
      type(mud_report) :: report

      status = mud_update(material, stress, statev, size(statev), [-d, d/2, d/2, 0*d, 0*d, 0*d], 0.0_c_double, &
                          MUD_TANGENT_CONSISTENT, stress, statev, blocks, report)
   end subroutine shear

   subroutine check(sentence, good)
      character(*), intent(in) :: sentence
      logical, intent(in) :: good

      print '(2a)', merge('passed ', 'FAILED ', good), sentence
      if (.not. good) failed = failed + 1
   end subroutine check
end program known_numbers
