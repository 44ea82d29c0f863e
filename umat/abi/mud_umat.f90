!> The UMAT: Abaqus' signature, symbol umat_, every argument a C pointer that some host leaves NULL.
module mud_umat
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_associated, c_f_pointer
   use mud_kernel, only: report_t, output_t, kernel_update, rotate_statev, failed_report, TANGENT_FROM_PROPS
   use mud_kinds, only: wp
   use mud_registry, only: NPROPS, NSTATV, P_TANGENT, S_LAYOUT
   use mud_save, only: write_increment, PATH_LENGTH
   use mud_status, only: fail, mud_status_t, MUD_OK, MUD_BAD_NTENS, MUD_NULL_ARGUMENT, MUD_BAD_NPROPS, MUD_BAD_NSTATV, &
      MUD_BAD_INPUT, ON_ARGUMENT
   use mud_tensor, only: is_finite
   implicit none (type, external)
   private
   public :: umat

   !> DROT may differ from a rotation by this, rounding of single-precision hosts [-].
   real(wp), parameter :: ORTHOGONAL = 1.0e-6_wp
   !> Failed increments are saved here, if the environment names a folder, and no more of them than this.
   character(*), parameter :: SAVE_VARIABLE = 'MUD_SAVE_FAILED'
   integer, parameter :: MAX_SAVED = 20
contains
   !> Suction is PREDEF(1), its increment DPRED(1); STRESS is Bishop's effective stress. On failure only PNEWDT (a
   !> factor below 1) and SCD (the status code) are written. See umat/README.md for PROPS, STATEV and the pitfalls.
   subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, &
                   temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv_, props, nprops, coords, drot, &
                   pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, kstep, kinc) bind(c, name='umat_')
      type(c_ptr), value :: stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, &
                            dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv_, props, nprops, &
                            coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, kstep, kinc
      type(report_t) :: report
      type(mud_status_t) :: status

      call check_arguments(stress, statev, dstran, ndi, ntens, nstatv_, props, nprops, status)
      if (status%code == MUD_OK) then
         call update(stress, statev, ddsdde, dstran, integer_at(ntens), integer_at(nstatv_), props, &
                     integer_at(nprops), real_at(predef), real_at(dpred), drot, &
                     [integer_at(kstep), integer_at(kinc), integer_at(noel), integer_at(npt)], report)
      else
         report = failed_report(status)
      end if
      if (report%status /= MUD_OK) call ask_for_a_cut(report, pnewdt, scd)

      ! What the model does not use.
      associate (a => [c_associated(sse), c_associated(spd), c_associated(rpl), c_associated(ddsddt), &
                       c_associated(drplde), c_associated(drpldt), c_associated(stran), c_associated(time), &
                       c_associated(dtime), c_associated(temp), c_associated(dtemp), c_associated(cmname), &
                       c_associated(nshr), c_associated(coords), c_associated(celent), c_associated(dfgrd0), &
                       c_associated(dfgrd1), c_associated(layer), c_associated(kspt)])
      end associate
   end subroutine umat

   !> The update itself, once the arguments are known to be there.
   subroutine update(stress, statev, ddsdde, dstran, ntens, n_statev, props, n_props, suction, d_suction, drot, place, &
                     report)
      type(c_ptr), intent(in) :: stress, statev, ddsdde, dstran, props, drot
      integer, intent(in) :: ntens, n_statev, n_props
      real(wp), intent(in) :: suction, d_suction
      integer, intent(in) :: place(4)   !< Step, increment, element and point, for the record.
      type(report_t), intent(out) :: report
      type(output_t) :: output
      real(c_double), pointer, contiguous :: stress_in(:), statev_in(:), dstran_in(:), props_in(:), tangent_out(:, :)
      real(wp) :: stress6(6), dstran6(6), statev0(NSTATV), rotation(3, 3)
      type(mud_status_t) :: status

      call c_f_pointer(stress, stress_in, [ntens])
      call c_f_pointer(statev, statev_in, [n_statev])
      call c_f_pointer(dstran, dstran_in, [ntens])
      call c_f_pointer(props, props_in, [n_props])
      stress6 = 0.0_wp
      dstran6 = 0.0_wp
      stress6(1:ntens) = stress_in
      dstran6(1:ntens) = dstran_in
      statev0 = statev_in(1:NSTATV)
      call read_rotation(drot, rotation, status)
      if (status%code /= MUD_OK) then
         report = failed_report(status)
         return
      end if
      if (rotates(rotation, statev0)) call rotate_statev(rotation, statev0)

      call kernel_update(props_in, stress6, statev0, dstran6, suction, d_suction, TANGENT_FROM_PROPS, output, report)
      if (report%status /= MUD_OK) then
         if (n_props == NPROPS) then
            call save_if_asked(props_in, stress6, statev0, dstran6, suction, d_suction, place, report)
         end if
         return
      end if
      stress_in = output%stress(1:ntens)
      statev_in(1:NSTATV) = output%statev
      if (output%has_tangent .and. c_associated(ddsdde)) then
         call c_f_pointer(ddsdde, tangent_out, [ntens, ntens])
         tangent_out = output%dsig_deps(1:ntens, 1:ntens)
      end if
   end subroutine update

   !> Saves a failed increment under the first free name of mud_failed_01.txt and so on, if the user has named a folder.
   !> A user cannot be told of more: that nothing could be written leaves the failure as it is.
   subroutine save_if_asked(props, stress, statev, d_strain, suction, d_suction, place, report)
      real(wp), intent(in) :: props(NPROPS), stress(6), statev(NSTATV), d_strain(6), suction, d_suction
      integer, intent(in) :: place(4)
      type(report_t), intent(in) :: report
      character(PATH_LENGTH) :: folder, path
      character(200) :: problem
      character(120) :: origin
      integer :: length, code, i, tangent
      logical :: taken

      call get_environment_variable(SAVE_VARIABLE, folder, length, code)
      if (code /= 0 .or. length == 0 .or. length > PATH_LENGTH - len('/mud_failed_00.txt')) return
      tangent = 0   ! where PROPS have none, they fail before it matters
      if (is_finite(props(P_TANGENT))) tangent = nint(min(max(props(P_TANGENT), 0.0_wp), 3.0_wp))
      write (origin, '(4(a, i0))') 'umat_, step ', place(1), ', increment ', place(2), ', element ', place(3), &
         ', point ', place(4)
      ! The last name first: once it is taken, a thousand failures more cost no more than this look.
      path = name_of(MAX_SAVED)
      inquire (file=path, exist=taken)
      if (taken) return
      do i = 1, MAX_SAVED
         path = name_of(i)
         inquire (file=path, exist=taken)
         if (taken) cycle
         call write_increment(path, origin, props, stress, statev, d_strain, suction, d_suction, tangent, report, &
                              problem)
         if (problem == '') return
         inquire (file=path, exist=taken)   ! by another thread or process, a moment ago
         if (.not. taken) return
      end do
   contains
      function name_of(number) result(name)
         integer, intent(in) :: number
         character(PATH_LENGTH) :: name

         write (name, '(2a, i2.2, a)') folder(:length), '/mud_failed_', number, '.txt'
      end function name_of
   end subroutine save_if_asked

   !> NULL pointers, NTENS, and counts that would make the arrays unreadable.
   subroutine check_arguments(stress, statev, dstran, ndi, ntens, nstatv_, props, nprops, status)
      type(c_ptr), intent(in) :: stress, statev, dstran, ndi, ntens, nstatv_, props, nprops
      type(mud_status_t), intent(out) :: status
      integer :: n

      if (.not. (c_associated(stress) .and. c_associated(statev) .and. c_associated(dstran) .and. c_associated(ntens) &
                 .and. c_associated(nstatv_) .and. c_associated(props) .and. c_associated(nprops))) then
         status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
         return
      end if
      n = integer_at(ntens)
      if (n /= 6 .and. n /= 4) then
         status = fail(MUD_BAD_NTENS, ON_ARGUMENT, 0, real(n, wp), 4.0_wp, 6.0_wp)
         return
      end if
      if (c_associated(ndi)) then
         if (integer_at(ndi) /= 3) then
            status = fail(MUD_BAD_NTENS, ON_ARGUMENT, 0, real(integer_at(ndi), wp), 3.0_wp, 3.0_wp)
            return
         end if
      end if
      if (integer_at(nprops) < 1) status = fail(MUD_BAD_NPROPS, value=real(integer_at(nprops), wp))
      if (integer_at(nstatv_) < NSTATV) then
         status = fail(MUD_BAD_NSTATV, value=real(integer_at(nstatv_), wp), lower=real(NSTATV, wp), upper=huge(1.0_wp))
      end if
   end subroutine check_arguments

   !> DROT as a matrix; NULL or all zero (some hosts) means none. Anything but a rotation is refused.
   subroutine read_rotation(drot, rotation, status)
      type(c_ptr), intent(in) :: drot
      real(wp), intent(out) :: rotation(3, 3)
      type(mud_status_t), intent(out) :: status
      real(c_double), pointer, contiguous :: matrix(:, :)
      integer :: i

      rotation = 0.0_wp
      if (c_associated(drot)) then
         call c_f_pointer(drot, matrix, [3, 3])
         rotation = matrix
      end if
      if (.not. all(is_finite(rotation))) status = fail(MUD_BAD_INPUT, ON_ARGUMENT)
      if (status%code /= MUD_OK) return
      if (any(abs(rotation) > 1.0_wp + ORTHOGONAL)) status = fail(MUD_BAD_INPUT, ON_ARGUMENT)
      if (status%code /= MUD_OK) return
      if (all(abs(rotation) <= 0.0_wp)) then
         do i = 1, 3
            rotation(i, i) = 1.0_wp
         end do
      end if
      if (any(abs(matmul(rotation, transpose(rotation)) - unit_matrix()) > ORTHOGONAL)) then
         status = fail(MUD_BAD_INPUT, ON_ARGUMENT)
      else if (determinant(rotation) < 0.0_wp) then
         status = fail(MUD_BAD_INPUT, ON_ARGUMENT)
      end if
   end subroutine read_rotation

   pure real(wp) function determinant(a)
      real(wp), intent(in) :: a(3, 3)

      determinant = a(1, 1)*(a(2, 2)*a(3, 3) - a(2, 3)*a(3, 2)) - a(1, 2)*(a(2, 1)*a(3, 3) - a(2, 3)*a(3, 1)) &
                    + a(1, 3)*(a(2, 1)*a(3, 2) - a(2, 2)*a(3, 1))
   end function determinant

   !> True if there is something to rotate: a point with a past and a rotation that is not exactly none.
   pure logical function rotates(rotation, statev)
      real(wp), intent(in) :: rotation(3, 3), statev(NSTATV)

      rotates = .false.
      if (.not. all(is_finite(statev))) return
      rotates = abs(statev(S_LAYOUT)) > 0.0_wp .and. any(abs(rotation - unit_matrix()) > 0.0_wp)
   end function rotates

   pure function unit_matrix() result(unit)
      real(wp) :: unit(3, 3)
      integer :: i

      unit = 0.0_wp
      do i = 1, 3
         unit(i, i) = 1.0_wp
      end do
   end function unit_matrix

   !> PNEWDT is written only to ask for a cut, and never raised: another point may have asked for a smaller one. Hosts
   !> that enter with 0 or less have no request yet.
   subroutine ask_for_a_cut(report, pnewdt, scd)
      type(report_t), intent(in) :: report
      type(c_ptr), intent(in) :: pnewdt, scd
      real(c_double), pointer :: factor, code

      if (c_associated(pnewdt)) then
         call c_f_pointer(pnewdt, factor)
         if (.not. is_finite(factor)) then
            factor = report%pnewdt
         else if (factor <= 0.0_wp .or. factor > report%pnewdt) then
            factor = report%pnewdt
         end if
      end if
      if (c_associated(scd)) then
         call c_f_pointer(scd, code)
         code = real(report%status, c_double)
      end if
   end subroutine ask_for_a_cut

   !> First number of an optional array, 0 where the host gives none.
   integer function integer_at(pointer)
      type(c_ptr), intent(in) :: pointer
      integer(c_int), pointer :: value

      integer_at = 0
      if (.not. c_associated(pointer)) return
      call c_f_pointer(pointer, value)
      integer_at = value
   end function integer_at

   !> The same of a real array.
   real(wp) function real_at(pointer)
      type(c_ptr), intent(in) :: pointer
      real(c_double), pointer :: value

      real_at = 0.0_wp
      if (.not. c_associated(pointer)) return
      call c_f_pointer(pointer, value)
      real_at = value
   end function real_at
end module mud_umat
