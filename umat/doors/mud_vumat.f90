! SPDX-License-Identifier: MIT
!> The VUMAT of Abaqus/Explicit, symbol vumat_, in double precision: a block of points in one call. Arrays have the
!> points first: (nblock, components 11, 22, 33, 12, 23, 13); shear strain is that of the tensor.
!> Stress is effective and corotational, as the host gives it, and the tensors of the state with it: nothing is rotated.
module mud_vumat
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use, intrinsic :: iso_c_binding, only: c_ptr, c_int, c_double, c_null_char, c_associated, c_f_pointer
   use mud_door, only: ORDER, place_of, statev_at, has_past, prepare
   use mud_interface, only: mud_report, mud_blocks, mud_place, mud_prepared_size, mud_prepared_statev, &
      mud_increment_at, mud_refuse, MUD_OK, MUD_NULL_ARGUMENT, MUD_BAD_NTENS, MUD_BAD_NSTATV, MUD_ON_ARGUMENT, &
      MUD_ON_STATEV, MUD_TANGENT_NONE, MUD_TANGENT_ELASTIC, MUD_IN_PIECES
   implicit none (type, external)
   private
   public :: vumat

   integer, parameter :: wp = c_double
   real(wp), parameter :: ENGINEERING(6) = [1.0_wp, 1.0_wp, 1.0_wp, 2.0_wp, 2.0_wp, 2.0_wp]

   !> The arrays of a block.
   type :: block_t
      integer :: n, n_shear
      integer :: suction, layout   !< Numbers of these in STATEV: names are looked up once a block.
      type(mud_place) :: place
      real(c_double), pointer, contiguous :: props(:) => null(), density(:) => null(), strain(:, :) => null(), &
         stress0(:, :) => null(), stress1(:, :) => null(), state0(:, :) => null(), state1(:, :) => null(), &
         field0(:, :) => null(), field1(:, :) => null(), energy0(:) => null(), energy1(:) => null()
   end type block_t
contains
   !> The first call, at time 0, asks for the elastic response to a strain made up by the host; its state is not kept. A
   !> point that fails is taken in pieces; what fails then has a NaN in stressNew, to stop the analysis
   !> (MUD_NO_PNEWDT=keep leaves the old stress), and its old state. Stress in the unit of p_atm, tension positive.
   !> Where the arguments or PROPS are wrong nothing is computed, a sentence says so, and the first number of stressNew
   !> is NaN likewise.
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
      type(block_t) :: points
      type(mud_report) :: report
      real(c_double) :: material(mud_prepared_size())
      real(c_double), allocatable :: states(:, :)   ! of a point, before and after, so that none allocates its own
      real(c_double), pointer, contiguous :: first(:)
      integer :: k
      integer(c_int) :: code

      call find_block([nblock, ndir, nshr, nstatev, n_props], [props, strain_inc, stress_old, stress_new, state_old, &
                                                               state_new], points, report)
      if (report%status == MUD_OK) call prepare(points%props, material, report)
      if (report%status == MUD_OK) then
         if (size(points%state0, 2) < mud_prepared_statev(material)) &
            report = mud_report(MUD_BAD_NSTATV, MUD_ON_STATEV, value=real(size(points%state0, 2), wp), &
                                lower=real(mud_prepared_statev(material), wp), upper=huge(1.0_wp))
      end if
      if (report%status == MUD_OK) then
         if (c_associated(density)) call c_f_pointer(density, points%density, [points%n])
         if (c_associated(ener_intern_old)) call c_f_pointer(ener_intern_old, points%energy0, [points%n])
         if (c_associated(ener_intern_new)) call c_f_pointer(ener_intern_new, points%energy1, [points%n])
         if (integer_at(nfieldv) > 0) then
            if (c_associated(field_old)) call c_f_pointer(field_old, points%field0, [points%n, integer_at(nfieldv)])
            if (c_associated(field_new)) call c_f_pointer(field_new, points%field1, [points%n, integer_at(nfieldv)])
         end if
         allocate (states(mud_prepared_statev(material), 2))
         do k = 1, points%n
            call update_one(points, material, k, states(:, 1), states(:, 2), &
                            max(real_at(step_time), real_at(total_time)) <= 0.0_wp)
         end do
      else
         nullify (first)
         if (c_associated(stress_new)) call c_f_pointer(stress_new, first, [1])
         code = mud_refuse(place_of('vumat_'), report, '. Nothing was computed'//c_null_char, first, &
                           min(integer_at(nblock), 1))
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
   subroutine find_block(counts, arrays, points, report)
      type(c_ptr), intent(in) :: counts(5), arrays(6)
      type(block_t), intent(out) :: points
      type(mud_report), intent(out) :: report
      integer :: i, n_state

      if (.not. all([(c_associated(counts(i)), i=1, 5), (c_associated(arrays(i)), i=1, 6)])) then
         report = mud_report(MUD_NULL_ARGUMENT, MUD_ON_ARGUMENT)
         return
      end if
      points%place = place_of('vumat_')
      points%suction = statev_at('suction')
      points%layout = statev_at('layout')
      points%n = integer_at(counts(1))
      points%n_shear = integer_at(counts(3))
      n_state = integer_at(counts(4))
      if (integer_at(counts(2)) /= 3) then
         report = mud_report(MUD_BAD_NTENS, MUD_ON_ARGUMENT, value=real(integer_at(counts(2)), wp), lower=3.0_wp, &
                             upper=3.0_wp)
      else if (points%n_shear /= 1 .and. points%n_shear /= 3) then
         report = mud_report(MUD_BAD_NTENS, MUD_ON_ARGUMENT, value=real(points%n_shear + 3, wp), lower=4.0_wp, &
                             upper=6.0_wp)
      else
         call c_f_pointer(arrays(1), points%props, [max(integer_at(counts(5)), 0)])
         call c_f_pointer(arrays(2), points%strain, [points%n, 3 + points%n_shear])
         call c_f_pointer(arrays(3), points%stress0, [points%n, 3 + points%n_shear])
         call c_f_pointer(arrays(4), points%stress1, [points%n, 3 + points%n_shear])
         call c_f_pointer(arrays(5), points%state0, [points%n, n_state])
         call c_f_pointer(arrays(6), points%state1, [points%n, n_state])
      end if
   end subroutine find_block

   !> A point; one that is refused keeps its state and, where the user wants that, its stress.
   subroutine update_one(points, material, k, state0, state, elastic_only)
      type(block_t), intent(in) :: points
      real(c_double), intent(in) :: material(:)
      integer, intent(in) :: k
      real(c_double), intent(out), contiguous :: state0(:), state(:)   !< Room for the state before and after. (STATEV)
      logical, intent(in) :: elastic_only
      type(mud_report) :: report
      type(mud_blocks) :: blocks
      real(wp) :: stress0(6), strain(6), stress(6), suction0, suction, still(6)
      integer(c_int) :: code, n_state

      n_state = size(state0)
      stress0 = read_six(points%stress0(k, :))
      strain = read_six(points%strain(k, :))*ENGINEERING
      state0 = points%state0(k, :n_state)
      stress = stress0
      state = state0
      call read_suction(points, k, state0, suction0, suction)
      if (elastic_only) then
         still = 0.0_wp
         code = mud_increment_at(points%place, material, stress0, state0, n_state, suction0, still, suction0, &
                                 MUD_TANGENT_ELASTIC, stress, state, blocks, report)
         if (code == MUD_OK) stress = stress0 + matmul(blocks%dsig_deps, strain)
         state = state0
      else
         code = mud_increment_at(points%place, material, stress0, state0, n_state, suction0, strain, suction, &
                                 MUD_TANGENT_NONE + MUD_IN_PIECES, stress, state, report=report)
      end if
      if (code /= MUD_OK) code = mud_refuse(points%place, report, c_null_char, stress, 6_c_int)
      call write_point(points, k, strain, stress, state)
   end subroutine update_one

   !> Suction is field variable 1. As in umat_, it does not jump: a state with a past goes on from its own.
   subroutine read_suction(points, k, state, suction0, suction)
      type(block_t), intent(in) :: points
      integer, intent(in) :: k
      real(wp), intent(in) :: state(:)
      real(wp), intent(out) :: suction0, suction   !< At the start and at the end.

      suction0 = state(points%suction)
      if (associated(points%field0)) then
         if (.not. has_past(state(points%layout))) suction0 = points%field0(k, 1)
      end if
      suction = suction0
      if (associated(points%field1)) suction = points%field1(k, 1)
   end subroutine read_suction

   !> Stress, state and internal energy per mass, which grows by the mean stress times the strain. Numbers of the state
   !> behind those of the point are the host's, who expects all of them: they stay.
   subroutine write_point(points, k, strain, stress, state)
      type(block_t), intent(in) :: points
      integer, intent(in) :: k
      real(wp), intent(in) :: strain(6), stress(6), state(:)
      real(wp) :: before(6), host(6)

      before = read_six(points%stress0(k, :))
      host = stress(ORDER)
      points%state1(k, :) = points%state0(k, :)
      points%state1(k, 1:size(state)) = state
      if (associated(points%energy0) .and. associated(points%energy1)) points%energy1(k) = points%energy0(k)
      if (associated(points%energy0) .and. associated(points%energy1) .and. associated(points%density)) then
         if (all(ieee_is_finite(stress)) .and. points%density(k) > 0.0_wp) points%energy1(k) = points%energy0(k) &
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

   !> Value of an integer argument, 0 where the host gives none.
   integer function integer_at(pointer)
      type(c_ptr), intent(in) :: pointer
      integer(c_int), pointer :: value

      integer_at = 0
      if (.not. c_associated(pointer)) return
      call c_f_pointer(pointer, value)
      integer_at = value
   end function integer_at

   !> Value of a real argument, 0 where the host gives none.
   real(wp) function real_at(pointer)
      type(c_ptr), intent(in) :: pointer
      real(c_double), pointer :: value

      real_at = 0.0_wp
      if (.not. c_associated(pointer)) return
      call c_f_pointer(pointer, value)
      real_at = value
   end function real_at

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
