! SPDX-License-Identifier: MIT
!> Runs the cases of standard input, a namelist &run each, and writes a line of CSV for each.
program mud_oscillation
   use, intrinsic :: iso_fortran_env, only: input_unit, output_unit, iostat_end, int64
   use oscillation_path, only: strain_at, direction_at, random_t, uniform, noise_steps, MAX_STEPS
   use kinds, only: wp
   use walk_point, only: point_t, prepare, set_property, start, lead_components, go, state_of
   implicit none (type, external)
   character(40) :: id
   character(10) :: path, noise
   integer :: rule, isotropic, scheme, events, seed
   real(wp) :: e, p, suction, from, to, last, top, size, growth, increment, tolerance, rho_e, eps_hat
   logical :: drained, random_events
   character(12) :: off(8)   !< Entries of PROPS that are 0, the rest is empty.
   integer :: code
   character(200) :: message
   namelist /run/ id, path, noise, rule, isotropic, scheme, events, seed, e, p, suction, from, to, last, top, size, &
      growth, increment, tolerance, rho_e, eps_hat, drained, random_events, off

   write (output_unit, '(a)') 'id,status,s11,s22,s33,s12,s13,s23,e,substeps,rejects,rates,resets,halvings'
   do
      call set_defaults()
      read (input_unit, nml=run, iostat=code, iomsg=message)
      if (code == iostat_end) exit
      if (code /= 0) then
         print '(a)', 'mud_oscillation: '//trim(message)
         error stop 1
      end if
      call run_case()
   end do
contains
   subroutine set_defaults()
      id = ''
      path = 'straight'
      noise = 'back'
      rule = 1
      isotropic = 2
      scheme = 1
      events = 0
      seed = 1
      e = 0.735_wp
      p = 100.0_wp
      suction = 0.0_wp
      from = 0.01_wp
      to = 0.05_wp
      last = 0.05_wp
      top = 0.05_wp
      size = 0.0_wp
      growth = 1.0_wp
      increment = 1.0e-5_wp
      tolerance = 1.0e-5_wp
      rho_e = 0.0_wp
      eps_hat = 1.0e-4_wp
      drained = .false.
      random_events = .false.
      off = ''
   end subroutine set_defaults

   !> Along the path to `last`, with events between `from` and `to`: equally spaced and sized, or at random places with
   !> exponentially distributed sizes of the same mean.
   subroutine run_case()
      type(point_t) :: soil
      type(random_t) :: random
      real(wp) :: place(max(events, 1)), steps(6, MAX_STEPS), s, event_size
      logical :: failed
      integer :: i, j, n

      random%seed = 7919_int64*seed
      call prepare(soil)
      call set_property(soil, 'memory_rule', real(rule, wp))
      call set_property(soil, 'isotropic', real(isotropic, wp))
      call set_property(soil, 'scheme', real(scheme, wp))
      call set_property(soil, 'tolerance', tolerance)
      call set_property(soil, 'rho_e', rho_e)
      call set_property(soil, 'eps_hat', eps_hat)
      do i = 1, count(off /= '')
         call set_property(soil, off(i), 0.0_wp)
      end do
      call start(soil, [p, p, p, 0.0_wp, 0.0_wp, 0.0_wp], suction, e)
      call lead_components(soil, [.false., drained, drained, .false., drained .and. noise /= 'shear', drained])
      do i = 1, events
         place(i) = from + (to - from)*real(i - 1, wp)/events
         if (random_events) place(i) = from + (to - from)*uniform(random)
      end do
      if (random_events) call sort(place(1:events))
      s = 0.0_wp
      failed = .false.
      event_size = size
      do i = 1, events
         call move_along(soil, s, place(i), failed)
         if (failed) exit
         event_size = size*growth**(i - 1)
         if (random_events) event_size = -size*log(uniform(random))
         call noise_steps(noise, event_size, direction_at(path, s, top), random, steps, n)
         do j = 1, n
            call advance(soil, steps(:, j), failed)
            if (failed) exit
         end do
         if (failed) exit
      end do
      if (.not. failed) call move_along(soil, s, last, failed)
      write (output_unit, '(a, ",", i0, 7(",", es14.7), 5(",", i0))') trim(id), merge(1, 0, failed), soil%stress, &
         state_of(soil, 'void_ratio'), nint(state_of(soil, 'n_substep')), nint(state_of(soil, 'n_reject')), &
         nint(state_of(soil, 'n_rate')), nint(state_of(soil, 'n_reset')), soil%halvings
   end subroutine run_case

   !> Along the path to s = goal, in increments that end on multiples of the increment.
   subroutine move_along(soil, s, goal, failed)
      type(point_t), intent(inout) :: soil
      real(wp), intent(inout) :: s
      real(wp), intent(in) :: goal
      logical, intent(inout) :: failed
      real(wp) :: next

      do while (goal - s > 1.0e-13_wp .and. .not. failed)
         next = min(goal, increment*(anint(s/increment) + 1.0_wp))
         if (anint(s/increment)*increment > s*(1.0_wp + 1.0e-9_wp)) next = min(goal, increment*anint(s/increment))
         if (path == 'unloading' .and. s < top .and. next > top) next = top
         call step(soil, strain_at(path, next, top) - strain_at(path, s, top), failed)
         s = next
      end do
   end subroutine move_along

   !> A straight strain step in increments of the increment's length.
   subroutine advance(soil, way, failed)
      type(point_t), intent(inout) :: soil
      real(wp), intent(in) :: way(6)
      logical, intent(out) :: failed
      integer :: i, n

      n = max(1, ceiling(maxval(abs(way))/increment - 1.0e-9_wp))
      do i = 1, n
         call step(soil, way/n, failed)
         if (failed) return
      end do
   end subroutine advance

   !> An increment of strain with tensor shear; components that are led by their stress keep it.
   subroutine step(soil, strain, failed)
      type(point_t), intent(inout) :: soil
      real(wp), intent(in) :: strain(6)
      logical, intent(out) :: failed

      call go(soil, 1, merge(0.0_wp, strain*[1, 1, 1, 2, 2, 2], soil%control%by_stress), 0.0_wp, failed)
   end subroutine step

   pure subroutine sort(values)
      real(wp), intent(inout) :: values(:)
      real(wp) :: value
      integer :: i, j

      do i = 2, ubound(values, 1)
         value = values(i)
         j = i - 1
         do while (j >= 1)
            if (values(j) <= value) exit
            values(j + 1) = values(j)
            j = j - 1
         end do
         values(j + 1) = value
      end do
   end subroutine sort
end program mud_oscillation
