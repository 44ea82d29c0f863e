! SPDX-License-Identifier: MIT
!> The VUMAT of Abaqus/Explicit, symbol vumat_, in double precision: a block of points in one call. Arrays have the
!> points first: (nblock, components 11, 22, 33, 12, 23, 13); shear strain is that of the tensor.
!> Stress is effective and corotational, as the host gives it, and the tensors of the state with it: nothing is rotated.
module mud_vumat
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_associated, c_f_pointer
   use, intrinsic :: iso_fortran_env, only: int64
   use mud_arguments, only: integer_at, real_at, has_past
   use mud_kernel, only: report_t, output_t, kernel_point, failed_report
   use mud_kinds, only: wp
   use mud_once, only: environment_is, report_at_exit
   use mud_params, only: params_t, read_params, completed, is_length
   use mud_pieces, only: update_in_pieces
   use mud_refusals, only: place_t, say_refusal, remark_on_props, remark_on_start, remark_on_end, save_if_asked, &
      KEEP_VARIABLE
   use mud_registry, only: NPROPS, NPROPS_BASE, NSTATV, &
      NSTATV_BASE, S_SUCTION
   use mud_state, only: statev_size
   use mud_status, only: mud_status_t, fail, MUD_OK, MUD_NULL_ARGUMENT, MUD_BAD_NTENS, MUD_BAD_NSTATV, MUD_BAD_NPROPS, &
      ON_ARGUMENT, ON_STATEV, ON_PROPS
   use mud_tensor, only: is_finite
   implicit none (type, external)
   private
   public :: vumat

   integer, parameter :: CHUNK = 32                      !< Points that are copied and updated together.
   integer, parameter :: ORDER(6) = [1, 2, 3, 4, 6, 5]   !< Order of the host's components; its own inverse.
   real(wp), parameter :: ENGINEERING(6) = [1.0_wp, 1.0_wp, 1.0_wp, 2.0_wp, 2.0_wp, 2.0_wp]
   integer, parameter :: NONE = 0, ELASTIC = 1           !< Kinds of tangent.

   !> The arrays of a block.
   type :: block_t
      integer :: n, n_shear
      real(c_double), pointer, contiguous :: props(:), density(:), strain(:, :), stress0(:, :), stress1(:, :), &
                                             state0(:, :), state1(:, :), field0(:, :), field1(:, :), energy0(:), &
                                             energy1(:)
   end type block_t

   !> Some points of it, component by component.
   type :: chunk_t
      real(c_double) :: stress(6, CHUNK), state(NSTATV, CHUNK), strain(6, CHUNK), suction(CHUNK), d_suction(CHUNK)
      integer(c_int) :: status(CHUNK)
   end type chunk_t
contains
   !> The first call, at time 0, asks for the elastic response to a strain made up by the host; its state is not kept. A
   !> point that fails is taken in pieces; what fails then has a NaN in stressNew, to stop the analysis
   !> (MUD_NO_PNEWDT=keep leaves the old stress), and its old state. Stress in the unit of p_atm, tension positive.
   !> Where the arguments or PROPS are wrong nothing is computed, a sentence says so, and the first number of stressNew
   !> is NaN.
   subroutine vumat(nblock, ndir, nshr, nstatev, nfieldv, n_props, lanneal, step_time, total_time, dt, cmname, &
                    coord_mp, char_length, props, density, strain_inc, rel_spin_inc, temp_old, stretch_old, &
                    defgrad_old, field_old, stress_old, state_old, ener_intern_old, ener_inelas_old, temp_new, &
                    stretch_new, defgrad_new, field_new, stress_new, state_new, ener_intern_new, ener_inelas_new) &
      bind(c, name='vumat_')
      type(c_ptr), value :: nblock, ndir, nshr, nstatev, nfieldv, n_props, lanneal, step_time, total_time, dt, cmname, &
                            coord_mp, char_length, props, density, strain_inc, rel_spin_inc, temp_old, stretch_old, &
                            defgrad_old, field_old, stress_old, state_old, ener_intern_old, ener_inelas_old, temp_new, &
                            stretch_new, defgrad_new, field_new, stress_new, state_new, ener_intern_new, &
                            ener_inelas_new
      type(mud_status_t) :: status
      type(block_t) :: points
      type(params_t) :: par
      integer :: first

      call find_block([nblock, ndir, nshr, nstatev, n_props], [props, strain_inc, stress_old, stress_new, state_old, &
                                                               state_new], points, status)
      if (status%code == MUD_OK) then
         nullify (points%density, points%energy0, points%energy1, points%field0, points%field1)
         if (c_associated(density)) call c_f_pointer(density, points%density, [points%n])
         if (c_associated(ener_intern_old)) call c_f_pointer(ener_intern_old, points%energy0, [points%n])
         if (c_associated(ener_intern_new)) call c_f_pointer(ener_intern_new, points%energy1, [points%n])
         if (integer_at(nfieldv) > 0) then
            if (c_associated(field_old)) call c_f_pointer(field_old, points%field0, [points%n, integer_at(nfieldv)])
            if (c_associated(field_new)) call c_f_pointer(field_new, points%field1, [points%n, integer_at(nfieldv)])
         end if
         call read_params(points%props, par, status)
      end if
      if (status%code == MUD_OK) then
         do first = 1, points%n, CHUNK
            call update_chunk(points, par, first, min(CHUNK, points%n - first + 1), &
                              max(real_at(step_time), real_at(total_time)) <= 0.0_wp)
         end do
      else
         call say_refusal(failed_report(status), place_t('vumat_'), '. Nothing was computed')
         if (c_associated(stress_new)) call set_first_to_nan(stress_new, integer_at(nblock))
         call report_at_exit()
      end if
      call copy_energy(ener_inelas_old, ener_inelas_new, integer_at(nblock))

      ! What the model does not use.
      associate (a => [c_associated(lanneal), c_associated(dt), c_associated(cmname), c_associated(coord_mp), &
                       c_associated(char_length), c_associated(rel_spin_inc), c_associated(temp_old), &
                       c_associated(stretch_old), c_associated(defgrad_old), c_associated(temp_new), &
                       c_associated(stretch_new), c_associated(defgrad_new)])
      end associate
   end subroutine vumat

   !> Finds the counts and arrays of a call, in the host's order, and refuses what is missing or does not fit.
   subroutine find_block(counts, arrays, points, status)
      type(c_ptr), intent(in) :: counts(5), arrays(6)
      type(block_t), intent(out) :: points
      type(mud_status_t), intent(out) :: status
      integer :: i, n_state

      do i = 1, 5
         if (.not. c_associated(counts(i))) status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
      end do
      do i = 1, 6
         if (.not. c_associated(arrays(i))) status = fail(MUD_NULL_ARGUMENT, ON_ARGUMENT)
      end do
      if (status%code /= MUD_OK) return
      points%n = integer_at(counts(1))
      points%n_shear = integer_at(counts(3))
      n_state = integer_at(counts(4))
      if (integer_at(counts(2)) /= 3) then
         status = fail(MUD_BAD_NTENS, ON_ARGUMENT, 0, real(integer_at(counts(2)), wp), 3.0_wp, 3.0_wp)
      else if (points%n_shear /= 1 .and. points%n_shear /= 3) then
         status = fail(MUD_BAD_NTENS, ON_ARGUMENT, 0, real(points%n_shear + 3, wp), 4.0_wp, 6.0_wp)
      else if (n_state < NSTATV_BASE) then
         status = fail(MUD_BAD_NSTATV, ON_STATEV, 0, real(n_state, wp), real(NSTATV_BASE, wp), &
                       huge(1.0_wp))
      else if (.not. is_length(integer_at(counts(5)))) then
         status = fail(MUD_BAD_NPROPS, ON_PROPS, 0, real(integer_at(counts(5)), wp), &
                       real(NPROPS_BASE, wp), real(NPROPS, wp))
      else
         call c_f_pointer(arrays(1), points%props, [integer_at(counts(5))])
         call c_f_pointer(arrays(2), points%strain, [points%n, 3 + points%n_shear])
         call c_f_pointer(arrays(3), points%stress0, [points%n, 3 + points%n_shear])
         call c_f_pointer(arrays(4), points%stress1, [points%n, 3 + points%n_shear])
         call c_f_pointer(arrays(5), points%state0, [points%n, n_state])
         call c_f_pointer(arrays(6), points%state1, [points%n, n_state])
      end if
   end subroutine find_block

   subroutine update_chunk(points, par, first, n, elastic_only)
      type(block_t), intent(in) :: points
      type(params_t), intent(in) :: par
      integer, intent(in) :: first, n
      logical, intent(in) :: elastic_only
      type(chunk_t) :: old
      real(wp) :: stress(6, CHUNK), state(NSTATV, CHUNK)
      type(output_t) :: output
      type(report_t) :: report
      integer :: i, k, m

      m = min(size(points%state0, 2), statev_size(par%options_t))
      do i = 1, n
         k = first + i - 1
         old%stress(:, i) = read_six(points%stress0(k, :))
         old%strain(:, i) = read_six(points%strain(k, :))*ENGINEERING
         old%state(:m, i) = points%state0(k, 1:m)
         call read_suction(points, k, old%state(:m, i), old%suction(i), old%d_suction(i))
      end do
      do i = 1, n
         call remark_on_start(par, old%stress(:, i), old%state(:m, i), old%suction(i), place_t('vumat_'))
         if (elastic_only) then
            call kernel_point(par, old%stress(:, i), old%state(:m, i), spread(0.0_wp, 1, 6), old%suction(i), 0.0_wp, &
                              ELASTIC, output, report)
            if (report%status == MUD_OK) stress(:, i) = old%stress(:, i) + matmul(output%dsig_deps, old%strain(:, i))
            state(:m, i) = old%state(:m, i)
         else
            call kernel_point(par, old%stress(:, i), old%state(:m, i), old%strain(:, i), old%suction(i), &
                              old%d_suction(i), NONE, output, report)
            if (report%status == MUD_OK) then
               stress(:, i) = output%stress
               state(:m, i) = output%statev(:m)
            end if
         end if
         old%status(i) = report%status
      end do
      do i = 1, n
         if (old%status(i) /= MUD_OK) call try_in_pieces(points, par, old, i, stress(:, i), &
                                                            state(:m, i))
         if (.not. has_past(old%state(:m, i))) call remark_on_props(completed(points%props), place_t('vumat_'))
         if (.not. elastic_only) call remark_on_end(stress(:, i), state(:m, i), place_t('vumat_'))
         call write_point(points, first + i - 1, old%strain(:, i), stress(:, i), state(:m, i))
      end do
   end subroutine update_chunk

   !> Suction is field variable 1. As in umat_, it does not jump: a state with a past goes on from its own.
   subroutine read_suction(points, k, state, start, change)
      type(block_t), intent(in) :: points
      integer, intent(in) :: k
      real(wp), intent(in) :: state(:)
      real(wp), intent(out) :: start, change

      start = state(S_SUCTION)
      change = 0.0_wp
      if (associated(points%field0) .and. .not. has_past(state)) start = points%field0(k, 1)
      if (.not. associated(points%field1)) return
      change = points%field1(k, 1)
      if (is_finite(start) .and. is_finite(change)) change = change - start
   end subroutine read_suction

   !> A point whose increment was refused: in pieces, or not at all, which is said.
   subroutine try_in_pieces(points, par, old, i, stress, state)
      type(block_t), intent(in) :: points
      type(params_t), intent(in) :: par
      type(chunk_t), intent(in) :: old
      integer, intent(in) :: i
      real(wp), intent(out) :: stress(6)
      real(wp), intent(inout) :: state(:)   !< State variables, as many as a point has.
      type(output_t) :: output
      type(report_t) :: report
      integer :: m

      m = size(state)
      call update_in_pieces(par, old%stress(:, i), old%state(:m, i), old%strain(:, i), old%suction(i), &
                            old%d_suction(i), NONE, output, report)
      if (report%status == MUD_OK) then
         stress = output%stress
         state = output%statev(:m)
         return
      end if
      call save_if_asked(completed(points%props), old%stress(:, i), old%state(:m, i), old%strain(:, i), &
                         old%suction(i), old%d_suction(i), place_t('vumat_'), report)
      state = old%state(:m, i)
      if (environment_is(KEEP_VARIABLE, 'keep')) then
         stress = old%stress(:, i)
         call say_refusal(report, place_t('vumat_'), '. The old stress is kept: what the host computes from here '// &
                          'is wrong')
      else
         stress = transfer(int(z'7FF8000000000000', int64), 1.0_wp)
         call say_refusal(report, place_t('vumat_'), '. Its stress is NaN, to stop the analysis')
         call report_at_exit()
      end if
   end subroutine try_in_pieces

   !> Stress, state and internal energy per mass, which grows by the mean stress times the strain.
   subroutine write_point(points, k, strain, stress, state)
      type(block_t), intent(in) :: points
      integer, intent(in) :: k
      real(wp), intent(in) :: strain(6), stress(6), state(:)
      real(wp) :: before(6), host(6)

      before = read_six(points%stress0(k, :))
      host = stress(ORDER)
      points%state1(k, 1:size(state)) = state
      if (associated(points%energy0) .and. associated(points%energy1)) points%energy1(k) = points%energy0(k)
      if (associated(points%energy0) .and. associated(points%energy1) .and. associated(points%density)) then
         if (all(is_finite(stress)) .and. points%density(k) > 0.0_wp) points%energy1(k) = points%energy0(k) &
            + 0.5_wp*dot_product(before + stress, strain)/points%density(k)
      end if
      points%stress1(k, :) = host(1:3 + points%n_shear)
   end subroutine write_point

   !> Components of a point in the order of MUD.
   pure function read_six(given) result(six)
      real(wp), intent(in) :: given(:)
      real(wp) :: six(6)

      six = 0.0_wp
      six(1:size(given)) = given
      six = six(ORDER)
   end function read_six

   !> The first number of an array of unknown length becomes a NaN.
   subroutine set_first_to_nan(array, n)
      type(c_ptr), intent(in) :: array
      integer, intent(in) :: n   !< Points of the block.
      real(c_double), pointer :: number

      if (n < 1) return
      call c_f_pointer(array, number)
      number = transfer(int(z'7FF8000000000000', int64), 1.0_wp)
   end subroutine set_first_to_nan

   !> Inelastic energy is not computed: it stays.
   subroutine copy_energy(old, new, n)
      type(c_ptr), intent(in) :: old, new
      integer, intent(in) :: n
      real(c_double), pointer, contiguous :: from(:), into(:)

      if (.not. (c_associated(old) .and. c_associated(new)) .or. n < 1) return
      call c_f_pointer(old, from, [n])
      call c_f_pointer(new, into, [n])
      into = from
   end subroutine copy_energy
end module mud_vumat
