! SPDX-License-Identifier: MIT
!> A minimal host: one point of dense sand, sheared without change of volume to 1 % axial strain.
program minimal_host
   use, intrinsic :: iso_c_binding, only: c_int, c_double, c_char, c_null_char
   use mud_interface, only: mud_report, mud_count, mud_index, mud_default_props, mud_prepared_size, mud_prepare, &
      mud_init, mud_update, mud_blocks, mud_message, MUD_PROPS, MUD_STATEV, MUD_TANGENT_CONSISTENT
   implicit none (type, external)
   real(c_double), parameter :: END_STRAIN = 0.01_c_double
   real(c_double), allocatable :: props(:), statev(:), material(:)
   real(c_double) :: stress(6), strain, step, d
   type(mud_blocks) :: blocks                                ! dsig_deps is the tangent
   type(mud_report) :: report
   integer(c_int) :: status, e_0
   character(kind=c_char) :: text(200)

   allocate (props(mud_count(MUD_PROPS)), statev(mud_count(MUD_STATEV)), material(mud_prepared_size()))
   status = mud_default_props(props, size(props))
   e_0 = mud_index(MUD_PROPS, 'e_0'//c_null_char) + 1        ! indices of the library are those of C
   props(e_0) = 0.735_c_double                               ! initial void ratio
   status = mud_prepare(props, size(props), material, size(material), text, size(text))
   if (status /= 0) call give_up()

   stress = [-100.0_c_double, -100.0_c_double, -100.0_c_double, 0.0_c_double, 0.0_c_double, 0.0_c_double]
   status = mud_init(material, stress, 0.0_c_double, 0.0_c_double, 0.0_c_double, statev, size(statev), text, size(text))
   if (status /= 0) call give_up()
   strain = 0.0_c_double                                     ! stress: effective [kPa], tension positive
   step = 1.0e-4_c_double
   do while (END_STRAIN - strain > 1.0e-12_c_double)
      d = min(step, END_STRAIN - strain)
      call update(d)
      if (status > 0 .and. d > 1.0e-9_c_double) then         ! hard increment: nothing was written, try a smaller one
         step = d*report%pnewdt
      else if (status /= 0) then
         status = mud_message(report, text, size(text))
         call give_up()
      else
         strain = strain + d
      end if
   end do
   print '(a,f0.3,a,f0.3,a)', "p' ", -sum(stress(1:3))/3.0_c_double, ' kPa, q ', stress(2) - stress(1), ' kPa'
contains
   !> One increment of undrained compression; components 11, 22, 33, 12, 13, 23, shear would be engineering shear.
   subroutine update(axial)
      real(c_double), intent(in) :: axial
      real(c_double) :: dstrain(6)

      dstrain = [-axial, axial/2, axial/2, 0.0_c_double, 0.0_c_double, 0.0_c_double]
      status = mud_update(material, stress, statev, size(statev), dstrain, 0.0_c_double, MUD_TANGENT_CONSISTENT, &
                          stress, statev, blocks, report)
   end subroutine update

   subroutine give_up()
      integer :: i

      do i = 1, size(text)
         if (text(i) == c_null_char) exit
      end do
      print '(*(a))', text(1:i - 1)
      error stop
   end subroutine give_up
end program minimal_host
