! SPDX-License-Identifier: MIT
!> The body at the start of a scene, taken as linear with its drained stiffness and its supports of a stage: the
!> slowest free vibration.
module linearised_body
   use kinds, only: wp
   use load_histories, only: start_of
   use contact_drainage, only: drainage_t
   use initial_conditions, only: initial_state
   use boundary_conditions, only: constrain_step, new_constraint
   use boundary_loads, only: shape_loads, ties_of
   use model_types, only: model_t, stage_t
   use equation_assembly, only: assembly_t, make_assembly, assemble
   use degrees_of_freedom, only: dofs_t, number_unknowns
   use porous_domain, only: state_t, mixture_density
   use sparsity_pattern, only: pattern_t, make_pattern
   use prescribed_values, only: constraint_t
   use sparse_factors, only: sparse_t, analyse, factorise, backsolve, release, SOLVED
   use generalised_alpha, only: make_scheme, STATIC
   use faults, only: fault_t
   implicit none (type, external)
   private
   public :: linearised_body_t, prepare_body, support, mass_times, mass_of_nodes, release_body

   integer, parameter :: MOST_TURNS = 60              !< Of the inverse iteration;
   real(wp), parameter :: ENOUGH = 1.0e-4_wp          !< it ends when the square of the frequency changes less.

   type :: linearised_body_t
      type(dofs_t) :: dofs
      type(pattern_t) :: pattern
      type(state_t) :: state
      real(wp) :: omega = 0.0_wp                      !< Slowest free vibration [rad/s]; 0: nothing holds the body.
      type(assembly_t) :: assembly
      type(constraint_t) :: constraint
      type(sparse_t) :: sparse
      real(wp), allocatable :: matrix(:), held(:)   !< Without and with the supports.
      logical, allocatable :: free(:)
      logical :: refused = .false.           !< The material gives no stiffness.
   end type linearised_body_t
contains
   !> Unknowns, initial state and stiffness.
   subroutine prepare_body(model, body, fault)
      type(model_t), intent(inout) :: model
      type(linearised_body_t), intent(out) :: body
      type(fault_t), intent(inout) :: fault
      type(state_t) :: work
      integer :: status

      call number_unknowns(model%domain, ties_of(model), body%dofs)
      call make_pattern(body%dofs%n, body%dofs%element, reshape([integer ::], [2, 0]), body%pattern)
      call make_assembly(model%domain, body%dofs, body%pattern, body%assembly)
      call shape_loads(model, body%dofs)
      body%constraint = new_constraint(model, body%dofs)
      call initial_state(model, body%state, fault)
      if (fault%code /= 0) return
      work = body%state
      call assemble(model%domain, body%dofs, body%pattern, make_scheme(STATIC, 1.0_wp, 1.0_wp), body%state, work, &
                    .true., body%assembly)
      body%refused = body%assembly%bad_element > 0
      body%matrix = body%assembly%values
      call analyse(body%sparse, body%pattern%row, body%pattern%col, status)
   end subroutine prepare_body

   !> Supports of a stage, factors and the slowest vibration under them.
   subroutine support(model, stage, body)
      type(model_t), intent(in) :: model
      integer, intent(in) :: stage
      type(linearised_body_t), intent(inout) :: body
      type(stage_t) :: at_rest
      type(drainage_t) :: fixed   ! It follows no contact.
      real(wp) :: x(body%dofs%n), y(body%dofs%n), square, last, work
      integer :: i, k, status

      body%omega = 0.0_wp
      if (body%refused) return
      at_rest = model%stages(stage)
      at_rest%kind = STATIC   ! Pressures held: the skeleton alone.
      call constrain_step(model, at_rest, body%dofs, fixed, start_of(model, stage) + at_rest%dt, body%state%x, &
                          body%constraint)
      body%free = .not. body%constraint%fixed
      body%held = body%matrix
      do i = 1, body%dofs%n
         if (body%free(i)) cycle
         do k = body%pattern%row(i), body%pattern%row(i + 1) - 1
            if (body%pattern%col(k) == i) then
               body%held(k) = merge(abs(body%held(k)), 1.0_wp, abs(body%held(k)) > 0.0_wp)
            else
               body%held(k) = 0.0_wp
            end if
         end do
      end do
      call factorise(body%sparse, body%held, status)
      if (status /= SOLVED) return
      ! A start that is no mode and no symmetry.
      x = merge([(1 + 0.5_wp*sin(real(i, wp)), i=1, size(x))], 0.0_wp, body%free)
      last = 0.0_wp
      do i = 1, MOST_TURNS
         y = mass_times(model, body, x)
         call backsolve(body%sparse, body%held, merge(y, 0.0_wp, body%free), x, status)
         x = merge(x, 0.0_wp, body%free)
         work = dot_product(x, y)
         y = mass_times(model, body, x)
         square = work/max(dot_product(x, y), tiny(1.0_wp))
         if (status /= SOLVED .or. .not. square > 0.0_wp) return
         x = x/norm2(x)
         if (abs(square - last) <= ENOUGH*square) exit
         last = square
      end do
      ! Rayleigh's quotient comes from above.
      body%omega = sqrt(square*(1 - ENOUGH*MOST_TURNS))
   end subroutine support

   function mass_times(model, body, x) result(y)
      type(model_t), intent(in) :: model
      type(linearised_body_t), intent(in) :: body
      real(wp), intent(in) :: x(:)
      real(wp) :: y(size(x)), at(2), mass
      integer :: e, g, i, f, p

      y = body%constraint%mass*x
      associate (m => model%domain, dofs => body%dofs)
         do e = 1, size(m%mesh%t6, 2)
            do g = 1, m%rule
               p = (e - 1)*m%rule + g
               mass = m%gauss(g, e)%weight*mixture_density(m, m%regions(m%region_of(e))%rho_s, &
                                                   body%state%e(p)/(1 + body%state%e(p)), body%state%s(p))
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
               part = m%gauss(g, e)%weight/6*mixture_density(m, m%regions(m%region_of(e))%rho_s, &
                      state%e(p)/(1 + state%e(p)), &
                                                     state%s(p))
               mass(m%mesh%t6(:, e)) = mass(m%mesh%t6(:, e)) + part
            end do
         end do
      end associate
   end function mass_of_nodes

   !> The model as it was.
   subroutine release_body(model, body)
      type(model_t), intent(inout) :: model
      type(linearised_body_t), intent(inout) :: body
      integer :: i

      call release(body%sparse)
      do i = 1, size(model%loads)
         if (allocated(model%loads(i)%shape)) deallocate (model%loads(i)%shape)
         if (allocated(model%loads(i)%rise)) deallocate (model%loads(i)%rise)
      end do
   end subroutine release_body
end module linearised_body
