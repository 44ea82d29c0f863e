! SPDX-License-Identifier: MIT
!> Message about a step that failed although it was cut as often as allowed.
module step_failure
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use kinds, only: wp
   use acting_places, only: location_of
   use faults, only: fault_t, raise
   use texts, only: place_text, short, whole
   use exit_codes, only: EXIT_CONVERGENCE, EXIT_MATERIAL, EXIT_FREE_BODY, EXIT_SOLVER
   use element_equations, only: STRAIN_TOO_LARGE
   use newton_step, only: MATERIAL_FAILED, BODY_FREE, SOLVER_FAILED, CONTACT_FAILED, EQUATIONS_LOST
   use run_state, only: run_t
   use solution, only: BY_RESIDUAL, BY_CORRECTION
   use sparse_factors, only: RCOND_SINGULAR
   use sparsity_pattern, only: entry_of
   use unknown_fields, only: FIELD_NAMES, DISPLACEMENTS
   implicit none (type, external)
   private
   public :: explain_failure, explain_short_step, LEAST_OF_STAGE

   real(wp), parameter :: LEAST_OF_STAGE = 1.0e-12_wp   !< Share of the stage: shorter steps are a crawl.
contains
   !> Raises the fault of a step that failed: exit code, place, cause and remedy. Fault EXIT_MATERIAL, EXIT_CONVERGENCE
   !> (also of contacts and of equations that are not finite), EXIT_FREE_BODY or EXIT_SOLVER, by the outcome of its log.
   subroutine explain_failure(run, dt, fault)
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: dt   !< Length of the step [s].
      type(fault_t), intent(inout) :: fault
      character(600) :: text
      character(:), allocatable :: place, alone
      real(wp) :: time
      integer :: e, i, node

      time = run%state%time + dt
      place = 'Stage '//trim(run%stage%name)//', time '//short(time)//' s, step '//short(dt)//' s: '
      associate (m => run%domain, log => run%log)
         select case (log%outcome)
         case (MATERIAL_FAILED)
            e = run%assembly%bad_element
            place = place//'the material of element '//whole(e)//', point '//whole(run%assembly%bad_point)
            ! No law was asked: that is a failure of the iteration.
            if (run%assembly%bad%code == STRAIN_TOO_LARGE) then
               call raise(fault, EXIT_CONVERGENCE, place//', is strained by more than 1 in the step: the iteration '// &
                          'did not converge, the step is far too long, or the load is far beyond the stiffness'// &
                          advice(run, time))
               return
            end if
            call m%regions(m%region_of(e))%law%message(run%assembly%bad, text)
            call raise(fault, EXIT_MATERIAL, place//', refuses: '//trim(text)//unstressed(run))
         case (CONTACT_FAILED)
            call raise(fault, EXIT_CONVERGENCE, place//run%system%contacts%message()//'.')
         case (BODY_FREE)
            alone = unequal_slopes(run)
            if (alone /= '') then
               call raise(fault, EXIT_FREE_BODY, place//'the equations are singular'//alone)
               return
            end if
            if (run%assembly%replaced > 0) then
               call raise(fault, EXIT_FREE_BODY, place//'the equations are singular'//soft_points(run)// &
                          unstressed(run)//run%model%on_contact(run%at%stage)%words//': add a surcharge or suction '// &
                          'there, load in smaller steps, or look for a missing &fix.')
               return
            end if
            if (.not. dt > 0.0_wp .and. m%rule == 3) then
               call raise(fault, EXIT_FREE_BODY, place//'the masses of elements with quadrature = 3 in &scene give '// &
                          'no accelerations at the start; take 6 points, or start = ''zero'' in &stage.')
               return
            end if
            alone = run%model%on_contact(run%at%stage)%words
            if (alone /= '') alone = alone//', and surfaces that only touch hold nothing: let them overlap by a '// &
               'millionth of an edge, give a &plate weight = ''yes'' beside gravity, or begin with a dynamic stage'
            call raise(fault, EXIT_FREE_BODY, place//'the equations are singular: a body can move or a pressure is '// &
                       'undetermined'//alone//'; add a &fix, or look for a region without stiffness or a plate '// &
                       'without contact.')
         case (SOLVER_FAILED)
            call raise(fault, EXIT_SOLVER, place//'the linear solver failed; is there enough memory for '// &
                       whole(run%dofs%n)//' unknowns?')
         case (EQUATIONS_LOST)
            ! The first entry that is not finite, else the largest.
            i = findloc(ieee_is_finite(run%assembly%values), .false., dim=1)
            if (i == 0) i = maxloc(abs(run%assembly%values), dim=1)
            node = run%dofs%node(count(run%pattern%row <= i))
            call raise(fault, EXIT_CONVERGENCE, place//'the equations have numbers that are not finite or too '// &
                       'large to be solved; the largest slope is '//short(run%assembly%values(i))//' at '// &
                       location_of(run%model, node)//': look at the tangent of the material there, and at the loads'// &
                       advice(run, time))
         case default
            node = 1
            if (log%worst_unknown > 0) node = run%dofs%node(log%worst_unknown)
            call raise(fault, EXIT_CONVERGENCE, place//'no convergence after '//whole(log%iterations)// &
                       ' iterations'//soft_points(run)//'; '//what_is_left(run)//' (allowed '// &
                       short(run%stage%tolerance)//'), worst at '//location_of(run%model, node)//advice(run, time))
         end select
      end associate
   end subroutine explain_failure

   !> Tells likely causes and advice where Newton's method does not converge: where shorter attempts have failed as
   !> well, none of them.
   function advice(run, time) result(text)
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: time   !< [s]
      character(:), allocatable :: text
      integer :: i

      text = unstressed(run)
      do i = 1, size(run%terms)
         text = text//run%terms(i)%term%remark(run%model, time)
      end do
      if (run%at%cuts <= 1) then
         text = text//'; use a smaller dt, more cuts or a better tangent.'
         return
      end if
      text = text//'. '//whole(run%at%cuts - 1)//' longer attempts failed before it: shorter steps do not help '// &
             'here. Try '
      if (run%stage%controlled) text = text//'a given dt (steps = ''given'' in &stage) of the length of the steps '// &
                                       'before, '
      text = text//'a better tangent (tangent of the material) or a larger tolerance.'
   end function advice

   !> Remarks that soil began without stress, where it did: the likely cause of a failure.
   function unstressed(run) result(text)
      type(run_t), intent(in) :: run
      character(:), allocatable :: text

      text = ''
      if (run%tension%bare > 0) text = '. '//whole(run%tension%bare)//' points of MUD began without effective '// &
         'stress, and so without stiffness: give them stress = ''geostatic'' or ''uniform'' in &initial'
   end function unstressed

   !> Raises the fault of a step that is too short before it is tried. Fault EXIT_CONVERGENCE.
   subroutine explain_short_step(run, dt, fault)
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: dt   !< [s]
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: cause

      cause = 'dt, dt_max or output_dt is too short for a stage of '//short(run%stage%duration)//' s.'
      if (dt > LEAST_OF_STAGE*run%stage%duration) &
         cause = 'it is the rounding of the time: divide the scene into runs that begin at 0 s.'
      if (run%at%factor < 1.0_wp) cause = 'steps before it failed and were cut to '//short(run%at%factor)// &
                                          ' of the given one.'
      call raise(fault, EXIT_CONVERGENCE, 'Stage '//trim(run%stage%name)//', time '//short(run%state%time)//' s: '// &
                 'the next step, '//short(dt)//' s, is below '//short(LEAST_OF_STAGE)//' of the stage or of the '// &
                 'time: '//cause)
   end subroutine explain_short_step

   !> Remarks on how many points were given the elastic stiffness in the last pass, and where most of them are; nothing
   !> if none.
   function soft_points(run) result(text)
      type(run_t), intent(in) :: run
      character(:), allocatable :: text
      real(wp) :: x(2)
      integer :: e

      text = ''
      if (run%assembly%replaced == 0) return
      e = maxloc(run%assembly%soft, dim=1)
      associate (mesh => run%domain%mesh)
         x = sum(mesh%x(:, mesh%t6(:3, e)), dim=2)/3
      end associate
      text = ', also with the elastic stiffness of '//whole(run%assembly%replaced)// &
             ' points that have no stiffness against some strain (tension cut-off or failure), '// &
             'most of them in element '//whole(e)//', '//place_text(x)
   end function soft_points

   !> Names the largest and the least slope of the free displacements, where the least are rounding beside the largest
   !> or sums of these overflow; else nothing.
   function unequal_slopes(run) result(text)
      type(run_t), intent(in) :: run
      character(:), allocatable :: text
      real(wp) :: slope(run%dofs%n)
      logical :: free(run%dofs%n)
      integer :: i, least, largest

      text = ''
      associate (dofs => run%dofs, values => run%assembly%values)
         slope = [(values(entry_of(run%pattern, i, i)), i=1, dofs%n)]
         if (.not. all(ieee_is_finite(slope))) return
         free = .not. run%constraint%fixed .and. dofs%field <= DISPLACEMENTS .and. slope > 0.0_wp
         if (.not. any(free)) return
         largest = maxloc(slope, 1, free)
         least = minloc(slope, 1, free)
         if (slope(least) >= RCOND_SINGULAR*slope(largest) .and. slope(largest) < sqrt(huge(1.0_wp))) return
         text = ' by rounding: the largest slope of a displacement is '//short(slope(largest))//' at '// &
                location_of(run%model, dofs%node(largest))//', the least '//short(slope(least))//' at '// &
                location_of(run%model, dofs%node(least))//'; look for a stiffness that is far too large or far too '// &
                'small.'
      end associate
   end function unequal_slopes

   !> Names the error that should have fallen below the tolerance, with its present value.
   function what_is_left(run) result(text)
      type(run_t), intent(in) :: run
      character(:), allocatable :: text

      associate (log => run%log)
         select case (run%stage%measure)
         case (BY_RESIDUAL)
            text = '|R|/|R_0| '//short(log%reduction)
         case (BY_CORRECTION)
            text = '|dx|/|x| '//short(log%correction)
         case default
            text = 'error of '//FIELD_NAMES(max(1, log%worst_field))//' '//short(log%error(max(1, log%worst_field)))
         end select
      end associate
   end function what_is_left
end module step_failure
