! SPDX-License-Identifier: MIT
!> Nanoseconds and rate evaluations per update: scheme x tolerance x tangent x path x threads, as CSV on the screen.
!>
!> mud_benchmark [ROUNDS]                                    everything; medians of so many rounds
!> mud_benchmark PATH STRAIN SCHEME TOLERANCE TANGENT WALKS  one variant, for a profiler; nothing is timed; a further
!>                                                           argument, plain, takes the elastic domain away; one
!>                                                           more names a parameter that is 0 (- or plain before it)
!>
!> A round walks every variant once, one after the other, so that a disturbance of the machine falls on all alike; a
!> ratio is the median of the rounds' own ratios. A batch is timed by the clock on the wall, which other programs on the
!> same processors lengthen at will: of its rounds the least counts.
program mud_benchmark
   use benchmark_walk, only: wp, path_t, PATHS, path_named, tally_t, walk, walk_batch, evaluate_rates, &
      met_rates_t, meet_rates, evaluate_met_rates
   implicit none (type, external)

   !> One row of the table and what its rounds took.
   type :: variant_t
      character(8) :: door              !< update, batch, or rate
      type(path_t) :: path
      real(wp) :: strain = 0.0_wp, tolerance = 0.0_wp
      integer :: scheme = 0, tangent = 0, threads = 1
      integer :: reference = 0          !< the row that the ratio refers to
      type(tally_t) :: tally
      real(wp), allocatable :: ns(:)    !< per update
   end type variant_t

   character(*), parameter :: SCHEME_NAMES(0:3) = ['auto', 'ME21', 'BS32', 'DP54']
   character(*), parameter :: TANGENT_NAMES(0:3) = ['none      ', 'elastic   ', 'continuum ', 'consistent']
   !> Rates that random walks meet, by what their arc of directions crosses.
   character(24), parameter :: MET_KINDS(2) = ['walk_one_root           ', 'walk_floor_or_cap       ']
   character(*), parameter :: USAGE = 'usage: mud_benchmark [ROUNDS | PATH STRAIN SCHEME TOLERANCE TANGENT WALKS]'
   integer, parameter :: POINTS = 400, EVALUATIONS = 200
   type(variant_t), allocatable :: variants(:)
   type(met_rates_t) :: met(400, size(MET_KINDS))
   integer :: rounds

   rounds = 21
   if (command_argument_count() >= 6) then
      call walk_one()
   else
      if (command_argument_count() > 1) error stop USAGE
      if (command_argument_count() == 1) rounds = nint(number(1))
      call list_variants()
      call run()
      call print_table()
   end if
contains
   subroutine walk_one()
      type(tally_t) :: tally
      character(24) :: name, domain, zero
      integer :: i

      call get_command_argument(1, name)
      call get_command_argument(7, domain)
      call get_command_argument(8, zero)
      do i = 1, nint(number(6))
         call walk(path_named(name), number(2), nint(number(3)), number(4), nint(number(5)), tally, &
                   domain /= 'plain', trim(zero))
      end do
      print '(i0, a, i0, a)', tally%updates, ' updates and ', tally%rates, ' rates a walk'
   end subroutine walk_one

   real(wp) function number(argument)
      integer, intent(in) :: argument
      character(24) :: text
      integer :: status

      call get_command_argument(argument, text)
      read (text, *, iostat=status) number
      if (status /= 0) error stop USAGE
   end function number

   !> The variant without tangent (batch: with one thread) stands before those that are compared with it.
   subroutine list_variants()
      real(wp), parameter :: TOLERANCES(3) = [1.0e-3_wp, 1.0e-5_wp, 1.0e-7_wp], &
                             STRAINS(3) = [1.0e-5_wp, 1.0e-4_wp, 1.0e-3_wp]
      integer :: i, j, k, scheme, tangent, threads, first

      allocate (variants(0))
      do i = 1, size(PATHS)
         variants = [variants, variant_t('rate', PATHS(i), reference=size(variants) + 1)]
      end do
      do i = 1, size(MET_KINDS)
         variants = [variants, variant_t('rate', path_t(MET_KINDS(i), 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp), &
                                         reference=size(PATHS) + 1)]
      end do
      do j = 1, size(STRAINS)
         do i = 1, size(PATHS)
            do scheme = 0, 3
               do k = 1, size(TOLERANCES)
                  first = size(variants) + 1
                  do tangent = 0, 3
                     variants = [variants, variant_t('update', PATHS(i), STRAINS(j), TOLERANCES(k), scheme, tangent, &
                                                     reference=first)]
                  end do
               end do
            end do
         end do
      end do
      do i = 1, size(PATHS)
         do tangent = 0, 3
            first = size(variants) + 1
            do threads = 1, 2
               variants = [variants, variant_t('batch', PATHS(i), 1.0e-5_wp, 1.0e-5_wp, 0, tangent, threads, first)]
            end do
         end do
      end do
   end subroutine list_variants

   subroutine run()
      integer :: i, round

      call meet_rates(met)
      do i = 1, size(variants)
         allocate (variants(i)%ns(rounds))
      end do
      do round = 0, rounds          ! the first one only warms up
         do i = 1, size(variants)
            associate (v => variants(i))
               select case (v%door)
               case ('rate')
                  if (any(v%path%name == MET_KINDS)) then
                     call evaluate_met_rates(met(:, findloc(MET_KINDS, v%path%name, dim=1)), v%tally)
                  else
                     call evaluate_rates(v%path, EVALUATIONS, v%tally)
                  end if
               case ('batch')
                  call walk_batch(v%path, v%strain, v%scheme, v%tolerance, v%tangent, v%threads, POINTS, v%tally)
               case default
                  call walk(v%path, v%strain, v%scheme, v%tolerance, v%tangent, v%tally, .true.)
               end select
               if (round > 0) v%ns(round) = real(v%tally%nanoseconds, wp)/v%tally%updates
            end associate
         end do
      end do
   end subroutine run

   subroutine print_table()
      real(wp) :: typical, ratio
      integer :: i

      print '(a)', 'call,path,strain,scheme,tolerance,tangent,threads,rates_per_update,ns,ns_lower_quartile,'// &
         'ns_upper_quartile,ratio'
      do i = 1, size(variants)
         associate (v => variants(i), reference => variants(variants(i)%reference))
            typical = quantile(v%ns, 0.5_wp)
            ratio = quantile(v%ns/reference%ns, 0.5_wp)
            if (v%door == 'batch') then
               typical = minval(v%ns)
               ratio = typical/minval(reference%ns)
            end if
            print '(2(a, ","), es7.1, ",", a, ",", es7.1, ",", a, ",", i0, ",", f0.2, 3(",", i0), ",", f0.3)', &
               trim(v%door), trim(v%path%name), v%strain, trim(SCHEME_NAMES(v%scheme)), v%tolerance, &
               trim(TANGENT_NAMES(v%tangent)), v%threads, real(v%tally%rates, wp)/v%tally%updates, &
               nint(typical), nint(quantile(v%ns, 0.25_wp)), nint(quantile(v%ns, 0.75_wp)), ratio
         end associate
      end do
   end subroutine print_table

   !> The value below which a share of the numbers lies, by counting: the lists are short.
   pure real(wp) function quantile(values, share)
      real(wp), intent(in) :: values(:)
      real(wp), intent(in) :: share
      integer :: i, rank

      rank = nint(share*(size(values) - 1))
      quantile = values(1)
      do i = 1, size(values)
         if (count(values < values(i)) <= rank .and. count(values <= values(i)) > rank) quantile = values(i)
      end do
   end function quantile
end program mud_benchmark
