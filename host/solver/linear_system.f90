! SPDX-License-Identifier: MIT
!> The linear system of an iteration: contacts in its pattern, factors that are kept while they serve, and where the
!> time goes. docs/theory/host.md section 6.
module linear_system
   use archive, only: archive_t
   use kinds, only: wp
   use wall_clock, only: clock, add_elapsed
   use convergence, only: field_scales, water_scale, water_of, body_scale, is_body
   use degrees_of_freedom, only: dofs_t
   use solution, only: solution_t, T_FACTORISATION, T_SOLUTION
   use sparse_factors, only: analyse, factorise, solve_by_factors, SOLVED, INACCURATE
   use sparsity_pattern, only: make_pattern
   use unknown_fields, only: FIELDS, DISPLACEMENTS, AT_P_W
   implicit none (type, external)
   private
   public :: solve_step, solve_anew, asked_for, update_contacts, join_unknowns, exchange_factors

   !> [kN] or [m3/s]: a field in which nothing acts yet is not refined to less.
   real(wp), parameter :: LEAST_SCALE = 1.0e-12_wp
   integer, parameter :: MOST_STEPS = 6               !< Most steps of a solution with factors of an earlier matrix.
   integer, parameter :: WORN_STEPS = 5               !< After so many steps the next matrix is factorised again.
contains
   !> Solves to a tolerance, a small share of Newton's: by the factors of an earlier matrix as long as these serve and
   !> nothing has been fixed, released or come into contact, otherwise by new ones. docs/theory/host.md section 6.
   !> status: SOLVED; SINGULAR or FAILED as of factorise; NOT_FINITE as of solve_by_factors.
   subroutine solve_step(s, tolerance, rhs, dx, status)
      class(solution_t), intent(inout) :: s
      real(wp), intent(in) :: tolerance   !< Tolerance of the errors of the fields [-]; 0: what rounding leaves.
      real(wp), intent(in) :: rhs(:)   !< (unknowns) [kN, m3/s]
      real(wp), intent(out) :: dx(:)   !< (unknowns) [m, kPa]
      integer, intent(out) :: status
      real(wp) :: weight(s%dofs%n), scales(FIELDS), t0
      integer :: steps, i

      t0 = clock()
      associate (system => s%system, constraint => s%constraint)
         scales = max(field_scales(s, system%largest), LEAST_SCALE)
         ! What a step changes is not known before its first solution: the forces that it asks for tell.
         if (s%assembly%with_change) scales = max(scales, asked_for(s%dofs, rhs))
         if (allocated(s%assembly%water)) scales(AT_P_W:) = min(scales(AT_P_W:), max(LEAST_SCALE, &
            water_scale(s, system%largest), norm2(water_of(s%dofs, constraint%air, rhs))))
         weight = 1/scales(s%dofs%field)
         do i = 1, s%dofs%n
            if (is_body(constraint, i)) weight(i) = 1/max(body_scale(s, system%largest, i), LEAST_SCALE)
         end do
         if (system%factored) system%factored = system%reuse .and. active_nodes(s) == system%active &
            .and. all(constraint%fixed .eqv. system%fixed) .and. all(constraint%air .eqv. system%air)
         if (system%factored) then
            call solve_by_factors(system%sparse, s%assembly%values, rhs, weight, tolerance, MOST_STEPS, dx, steps, &
                                  status)
            call add_elapsed(system%seconds(T_SOLUTION), t0)
            system%factored = status == SOLVED .and. steps < WORN_STEPS
            if (status == SOLVED) return
         end if
         call solve_anew(s, weight, tolerance, rhs, dx, status)
      end associate
   end subroutine solve_step

   !> Solves by new factors, |W (rhs - A dx)| <= tolerance. status: as of solve_step.
   subroutine solve_anew(s, weight, tolerance, rhs, dx, status)
      class(solution_t), intent(inout) :: s
      real(wp), intent(in) :: weight(:), tolerance, rhs(:)   !< (unknowns) Diagonal of W; [-]; (unknowns) [kN, m3/s].
      real(wp), intent(out) :: dx(:)   !< (unknowns) [m, kPa]
      integer, intent(out) :: status
      real(wp) :: t0
      integer :: steps

      t0 = clock()
      associate (system => s%system)
         if (.not. system%analysed) call analyse(system%sparse, s%pattern%row, s%pattern%col, status)
         system%analysed = .true.
         call factorise(system%sparse, s%assembly%values, status)
         call add_elapsed(system%seconds(T_FACTORISATION), t0)
         system%factored = status == SOLVED
         if (status /= SOLVED) return
         system%fixed = s%constraint%fixed
         system%air = s%constraint%air
         system%active = active_nodes(s)
         system%made_of = s%assembly%values
         call solve_by_factors(system%sparse, s%assembly%values, rhs, weight, tolerance, MOST_STEPS, dx, steps, status)
         ! What rounding leaves is Newton's to judge.
         if (status == INACCURATE) status = SOLVED
         call add_elapsed(system%seconds(T_SOLUTION), t0)
      end associate
   end subroutine solve_anew

   !> Counts the nodes in contact.
   pure integer function active_nodes(s)
      class(solution_t), intent(in) :: s

      active_nodes = 0
      if (allocated(s%system%contacts)) active_nodes = s%system%contacts%active
   end function active_nodes

   !> Exchanges with an archive what the first solution of the next step depends on. Factors are made again of the same
   !> matrix, so that they are the same.
   subroutine exchange_factors(s, archive)
      class(solution_t), intent(inout) :: s
      class(archive_t), intent(inout) :: archive
      integer, allocatable :: fixed(:), air(:)
      integer :: status

      associate (system => s%system)
         call archive%enter('factors')
         call archive%exchange('first_error', system%first_error, '-', &
                               'error of the last step after its first correction')
         call archive%exchange('known', system%factored, 'whether factors of an earlier matrix serve the next step')
         if (system%factored) then
            if (.not. archive%reading) then
               fixed = merge(1, 0, system%fixed)
               air = merge(1, 0, system%air)
            end if
            call archive%exchange_allocatable('made_of', system%made_of, 'mixed', 'values of that matrix')
            call archive%exchange_allocatable('fixed', fixed, '-', 'unknowns that were fixed in it')
            call archive%exchange_allocatable('air', air, '-', 'nodes whose air pressure was given in it')
            call archive%exchange('active', system%active, '-', 'nodes that were in contact in it', least=0)
         end if
         call archive%leave('factors')
         if (.not. (archive%reading .and. archive%good .and. system%factored)) return
         if (size(system%made_of) /= size(s%pattern%col) .or. size(fixed) /= s%dofs%n .or. &
             size(air) /= size(s%dofs%of, 2)) then
            call archive%refuse()
            return
         end if
         system%fixed = fixed == 1
         system%air = air == 1
         call analyse(system%sparse, s%pattern%row, s%pattern%col, status)
         system%analysed = .true.
         call factorise(system%sparse, system%made_of, status)
         if (status /= SOLVED) call archive%refuse()
      end associate
   end subroutine exchange_factors

   !> Finds the magnitude of the right side of every field, rows of prescribed values included; that of the
   !> displacements is one. docs/theory/host.md section 5.1.
   pure function asked_for(dofs, rhs) result(magnitude)
      type(dofs_t), intent(in) :: dofs
      real(wp), intent(in) :: rhs(:)   !< (unknowns) [kN, m3/s]
      real(wp) :: magnitude(FIELDS)
      integer :: f

      do f = 1, FIELDS
         magnitude(f) = norm2(pack(rhs, dofs%field == f))
      end do
      magnitude(:DISPLACEMENTS) = norm2(magnitude(:DISPLACEMENTS))
   end function asked_for

   !> Contacts at given displacements, and room for them in the matrix; false if they refuse these. The pattern grows
   !> only: a contact that opens leaves it alone.
   logical function update_contacts(s, x, slopes) result(good)
      class(solution_t), intent(inout) :: s
      real(wp), intent(in) :: x(:, :)   !< (FIELDS, nodes) [m, kPa]
      logical, intent(in) :: slopes
      integer, allocatable :: missing(:, :)

      good = .true.
      if (.not. allocated(s%system%contacts)) return
      good = s%system%contacts%evaluate(x, s%log%iterations, slopes)
      if (.not. good .or. .not. slopes) return
      missing = s%system%contacts%missing(s%pattern)
      if (size(missing) > 0) call join_unknowns(s, missing)
   end function update_contacts

   !> Makes room in the matrix for pairs of unknowns that meet from now on.
   subroutine join_unknowns(s, pairs)
      class(solution_t), intent(inout) :: s
      integer, intent(in) :: pairs(:, :)   !< (2, pairs), each listed one way round.

      associate (extra => s%system%extra)
         s%system%extra = reshape([extra, pairs, pairs(2:1:-1, :)], [2, size(extra, 2) + 2*size(pairs, 2)])
      end associate
      call make_pattern(s%dofs%n, s%dofs%element, s%system%extra, s%pattern)
      deallocate (s%assembly%values)
      allocate (s%assembly%values(size(s%pattern%col)), source=0.0_wp)
      s%system%analysed = .false.
      s%system%factored = .false.
   end subroutine join_unknowns
end module linear_system
