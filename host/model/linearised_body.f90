!> The body at the start of a scene, taken as linear with its drained stiffness and its supports of a stage: the
!> slowest free vibration, and the strain energy of what acts on it.
module linearised_body
   use kinds, only: wp
   use load_histories, only: action_t, start_of, FORCE, MOTION
   use contact_drainage, only: drainage_t
   use energy_ledger, only: density
   use initial_conditions, only: initial_state
   use boundary_loads, only: shape_loads, ties_of, load_at, constrain_step, new_constraint
   use model_types, only: model_t, stage_t, UNBOUNDED
   use equation_assembly, only: assembly_t, make_assembly, assemble
   use degrees_of_freedom, only: dofs_t, number_unknowns
   use porous_domain, only: state_t
   use sparsity_pattern, only: pattern_t, make_pattern
   use newton_step, only: constraint_t
   use sparse_factors, only: sparse_t, analyse, factorise, backsolve, times, release, SOLVED
   use generalised_alpha, only: make_scheme, STATIC
   use faults, only: fault_t
   implicit none (type, external)
   private
   public :: trial_t, prepare_trial, support, mass_of_nodes, response_of, imbalance_of, end_trial

   integer, parameter :: MOST_TURNS = 60              !< Of the inverse iteration;
   real(wp), parameter :: ENOUGH = 1.0e-4_wp          !< it ends when the square of the frequency changes less.

   real(wp), parameter :: NO_STRAIN = 1.0e-6_wp       !< Below it a motion carries the body along as a whole.

   type :: trial_t
      type(dofs_t) :: dofs
      type(pattern_t) :: pattern
      type(state_t) :: state
      real(wp) :: omega = 0.0_wp                      !< Slowest free vibration [rad/s]; 0: nothing holds the body.
      type(assembly_t), private :: assembly
      type(constraint_t), private :: constraint
      type(sparse_t), private :: sparse
      real(wp), allocatable, private :: matrix(:), held(:)   !< Without and with the supports.
      logical, allocatable, private :: free(:)
      logical, private :: refused = .false.           !< The material gives no stiffness.
   end type trial_t
contains
   !> Unknowns, initial state and stiffness.
   subroutine prepare_trial(model, trial, fault)
      type(model_t), intent(inout) :: model
      type(trial_t), intent(out) :: trial
      type(fault_t), intent(inout) :: fault
      type(state_t) :: work
      integer :: i, status

      call number_unknowns(model%domain, ties_of(model), trial%dofs)
      call make_pattern(trial%dofs%n, trial%dofs%element, reshape([integer ::], [2, 0]), trial%pattern)
      call make_assembly(model%domain, trial%dofs, trial%pattern, trial%assembly)
      do i = 1, size(model%loads)
         if (allocated(model%loads(i)%shape)) deallocate (model%loads(i)%shape)
      end do
      call shape_loads(model, trial%dofs)
      trial%constraint = new_constraint(model, trial%dofs)
      call initial_state(model, trial%state, fault)
      if (fault%code /= 0) return
      work = trial%state
      call assemble(model%domain, trial%dofs, trial%pattern, make_scheme(STATIC, 1.0_wp, 1.0_wp), trial%state, work, &
                    .true., trial%assembly)
      trial%refused = trial%assembly%bad_element > 0
      trial%matrix = trial%assembly%values
      call analyse(trial%sparse, trial%pattern%row, trial%pattern%col, status)
   end subroutine prepare_trial

   !> Supports of a stage, factors and the slowest vibration under them.
   subroutine support(model, stage, trial)
      type(model_t), intent(in) :: model
      integer, intent(in) :: stage
      type(trial_t), intent(inout) :: trial
      type(stage_t) :: still
      type(drainage_t) :: fixed   ! It follows no contact.
      real(wp) :: x(trial%dofs%n), y(trial%dofs%n), square, last, work
      integer :: i, k, status

      trial%omega = 0.0_wp
      if (trial%refused) return
      still = model%stages(stage)
      still%kind = STATIC   ! Pressures held: the skeleton alone.
      call constrain_step(model, still, trial%dofs, fixed, start_of(model, stage) + still%dt, trial%state%x, &
                          trial%constraint)
      trial%free = .not. trial%constraint%fixed
      trial%held = trial%matrix
      do i = 1, trial%dofs%n
         if (trial%free(i)) cycle
         do k = trial%pattern%row(i), trial%pattern%row(i + 1) - 1
            if (trial%pattern%col(k) == i) then
               trial%held(k) = merge(abs(trial%held(k)), 1.0_wp, abs(trial%held(k)) > 0.0_wp)
            else
               trial%held(k) = 0.0_wp
            end if
         end do
      end do
      call factorise(trial%sparse, trial%held, status)
      if (status /= SOLVED) return
      ! A start that is no mode and no symmetry.
      x = merge([(1 + 0.5_wp*sin(real(i, wp)), i=1, size(x))], 0.0_wp, trial%free)
      last = 0.0_wp
      do i = 1, MOST_TURNS
         y = mass_times(model, trial, x)
         call backsolve(trial%sparse, trial%held, merge(y, 0.0_wp, trial%free), x, status)
         x = merge(x, 0.0_wp, trial%free)
         work = dot_product(x, y)
         y = mass_times(model, trial, x)
         square = work/max(dot_product(x, y), tiny(1.0_wp))
         if (status /= SOLVED .or. .not. square > 0.0_wp) return
         x = x/norm2(x)
         if (abs(square - last) <= ENOUGH*square) exit
         last = square
      end do
      ! Rayleigh's quotient comes from above.
      trial%omega = sqrt(square*(1 - ENOUGH*MOST_TURNS))
   end subroutine support

   !> Square root of twice the strain energy under the largest change of an action, and how much of the response to a
   !> prescribed motion is carried along without strain: at least 1, and the bound of its vibration grows with it.
   subroutine response_of(model, action, trial, energy, carried)
      type(model_t), intent(in) :: model
      type(action_t), intent(in) :: action
      type(trial_t), intent(inout) :: trial
      real(wp), intent(out) :: energy, carried   !< [kJ**(1/2)], [-]
      real(wp) :: b(trial%dofs%n), x(trial%dofs%n), y(trial%dofs%n)
      integer :: k, at, status

      energy = 0.0_wp
      carried = 1.0_wp
      if (.not. trial%omega > 0.0_wp .or. .not. action%change > 0.0_wp) return
      b = 0.0_wp
      if (action%kind == FORCE .and. action%load > 0) then
         b = merge(model%loads(action%load)%shape, 0.0_wp, trial%free)
         call backsolve(trial%sparse, trial%held, b, x, status)
         energy = sqrt(max(dot_product(x, b), 0.0_wp))*action%change
      else if (action%kind == FORCE) then
         k = -action%load
         if (k <= size(model%rigids)) then
            at = trial%dofs%of(2, model%domain%mesh%groups(model%rigids(k)%group)%nodes(1))
         else
            at = trial%dofs%of(2, model%plates(k - size(model%rigids))%node)
         end if
         if (trial%free(at)) b(at) = 1.0_wp
         call backsolve(trial%sparse, trial%held, b, x, status)
         energy = sqrt(max(dot_product(x, b), 0.0_wp))*action%change
      else if (action%kind == MOTION) then
         x = 0.0_wp
         do k = 1, size(model%domain%mesh%groups(action%group)%nodes)
            at = trial%dofs%of(action%field, model%domain%mesh%groups(action%group)%nodes(k))
            if (at > 0) x(at) = 1.0_wp
         end do
         call times(trial%sparse, trial%matrix, x, y)
         b = merge(-y, 0.0_wp, trial%free)
         call backsolve(trial%sparse, trial%held, b, y, status)
         x = x + merge(y, 0.0_wp, trial%free)
         where (trial%dofs%field >= 3) x = 0.0_wp
         call times(trial%sparse, trial%matrix, x, y)
         energy = sqrt(max(dot_product(x, y), 0.0_wp))
         b = mass_times(model, trial, x)
         carried = trial%omega*sqrt(dot_product(x, b))
         carried = merge(UNBOUNDED, max(1.0_wp, carried/max(energy, NO_STRAIN*carried)), energy <= NO_STRAIN*carried)
         energy = energy*action%change
      end if
   end subroutine response_of

   !> The same of the forces that nothing balances when a stage begins with the initial state.
   real(wp) function imbalance_of(model, stage, trial) result(energy)
      type(model_t), intent(in) :: model
      integer, intent(in) :: stage
      type(trial_t), intent(inout) :: trial
      real(wp), parameter :: ROUNDING = 1.0e-9_wp
      real(wp) :: b(trial%dofs%n), x(trial%dofs%n), y(trial%dofs%n)
      integer :: status

      energy = 0.0_wp
      if (.not. trial%omega > 0.0_wp) return
      b = load_at(model, model%stages(stage), trial%dofs, start_of(model, stage))
      y = merge(abs(b) + trial%assembly%scale, 0.0_wp, trial%free)
      b = merge(b - trial%assembly%residual, 0.0_wp, trial%free)
      if (norm2(b) <= ROUNDING*norm2(y)) return
      call backsolve(trial%sparse, trial%held, b, x, status)
      energy = sqrt(max(dot_product(x, b), 0.0_wp))
   end function imbalance_of

   function mass_times(model, trial, x) result(y)
      type(model_t), intent(in) :: model
      type(trial_t), intent(in) :: trial
      real(wp), intent(in) :: x(:)
      real(wp) :: y(size(x)), at(2), mass
      integer :: e, g, i, f, p

      y = trial%constraint%mass*x
      associate (m => model%domain, dofs => trial%dofs)
         do e = 1, size(m%mesh%t6, 2)
            do g = 1, m%rule
               p = (e - 1)*m%rule + g
               mass = m%gauss(g, e)%weight*density(m, m%regions(m%region_of(e))%rho_s, &
                                                   trial%state%e(p)/(1 + trial%state%e(p)), trial%state%s(p))
               do f = 1, 2
                  at(f) = mass*dot_product(m%gauss(g, e)%n, x(dofs%of(f, m%mesh%t6(:, e))))
               end do
               do i = 1, 6
                  do f = 1, 2
                     associate (place => y(dofs%of(f, m%mesh%t6(i, e))))
                        place = place + m%gauss(g, e)%n(i)*at(f)
                     end associate
                  end do
               end do
            end do
         end do
      end associate
   end function mass_times

   !> The mass of the mixture shared among the nodes [Mg].
   function mass_of_nodes(model, state) result(mass)
      type(model_t), intent(in) :: model
      type(state_t), intent(in) :: state
      real(wp) :: mass(size(model%domain%mesh%x, 2)), part
      integer :: e, g, p

      mass = 0.0_wp
      associate (m => model%domain)
         do e = 1, size(m%mesh%t6, 2)
            do g = 1, m%rule
               p = (e - 1)*m%rule + g
               part = m%gauss(g, e)%weight/6*density(m, m%regions(m%region_of(e))%rho_s, state%e(p)/(1 + state%e(p)), &
                                                     state%s(p))
               mass(m%mesh%t6(:, e)) = mass(m%mesh%t6(:, e)) + part
            end do
         end do
      end associate
   end function mass_of_nodes

   !> The scene as it was.
   subroutine end_trial(model, trial)
      type(model_t), intent(inout) :: model
      type(trial_t), intent(inout) :: trial
      integer :: i

      call release(trial%sparse)
      do i = 1, size(model%loads)
         if (allocated(model%loads(i)%shape)) deallocate (model%loads(i)%shape)
      end do
   end subroutine end_trial
end module linearised_body
