!> Load vectors and prescribed values of a moment.
module boundary_loads
   use kinds, only: wp, PI
   use contact_drainage, only: drainage_t, is_released
   use model_types, only: model_t, stage_t, plate_t, factor_at, acts_in, P_A
   use degrees_of_freedom, only: dofs_t, tie
   use shape_functions, only: edge_quadratic, edge_rule
   use newton_step, only: constraint_t
   use generalised_alpha, only: STATIC
   implicit none (type, external)
   private
   public :: shape_loads, ties_of, load_at, constrain_step, new_constraint, plate_load
contains
   !> Nodes that rigid bodies make move together.
   function ties_of(model) result(ties)
      type(model_t), intent(in) :: model
      integer, allocatable :: ties(:, :)
      integer :: i

      allocate (ties(4, size(model%domain%mesh%x, 2)), source=0)
      do i = 1, size(model%rigids)
         call tie(model%domain%mesh%groups(model%rigids(i)%group)%nodes, 2, ties)
      end do
   end function ties_of

   !> Vectors of unit loads.
   subroutine shape_loads(model, dofs)
      type(model_t), intent(inout) :: model
      type(dofs_t), intent(in) :: dofs
      integer :: i, e, k, f

      do i = 1, size(model%loads)
         associate (load => model%loads(i), group => model%domain%mesh%groups(model%loads(i)%group))
            allocate (load%shape(dofs%n), source=0.0_wp)
            if (load%kind <= 5) then
               do e = 1, size(group%edges, 2)
                  call add_edge(model, dofs, group%edges(:, e), load%kind, load%shape)
               end do
            else
               f = load%kind - 5
               do k = 1, size(group%nodes)
                  associate (at => dofs%of(f, group%nodes(k)))
                     if (at > 0) load%shape(at) = load%shape(at) + 1.0_wp
                  end associate
               end do
            end if
         end associate
      end do
   end subroutine shape_loads

   !> A unit load on an edge; its body lies on the left, so that the outward normal is the tangent turned right.
   subroutine add_edge(model, dofs, edge, kind, shape)
      type(model_t), intent(in) :: model
      type(dofs_t), intent(in) :: dofs
      integer, intent(in) :: edge(3), kind
      real(wp), intent(inout) :: shape(:)
      real(wp) :: points(3), weights(3), n(3), dn(3), m(3), x(2, 3), at(2), tangent(2), weight
      integer :: g, i

      x = model%domain%mesh%x(:, edge)
      call edge_rule(points, weights)
      do g = 1, 3
         call edge_quadratic(points(g), n, dn)
         m = n
         if (model%domain%n_p == 3) m = [0.5_wp*(1 - points(g)), 0.5_wp*(1 + points(g)), 0.0_wp]
         at = matmul(x, n)
         tangent = matmul(x, dn)
         weight = weights(g)
         if (model%domain%axisymmetric) weight = weight*2*PI*at(1)
         do i = 1, 3
            select case (kind)
            case (1)
               call add(1, i, -n(i)*tangent(2)*weight)
               call add(2, i, n(i)*tangent(1)*weight)
            case (2, 3)
               call add(kind - 1, i, n(i)*norm2(tangent)*weight)
            case (4)
               call add(3, i, m(i)*norm2(tangent)*weight)
            case (5)
               call add(3, i, m(i)*norm2(tangent)*weight)
               call add(4, i, m(i)*norm2(tangent)*weight)
            end select
         end do
      end do
   contains
      subroutine add(field, i, value)
         integer, intent(in) :: field, i
         real(wp), intent(in) :: value

         associate (place => dofs%of(field, edge(i)))
            if (place > 0) shape(place) = shape(place) + value
         end associate
      end subroutine add
   end subroutine add_edge

   !> Loads of a stage at a time.
   function load_at(model, stage, dofs, time) result(load)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(dofs_t), intent(in) :: dofs
      real(wp), intent(in) :: time
      real(wp), allocatable :: load(:)
      integer :: i, at

      allocate (load(dofs%n), source=0.0_wp)
      do i = 1, size(model%loads)
         associate (one => model%loads(i))
            if (acts_in(one%stages, stage%name)) load = load + factor_at(model, one%history, time)*one%value*one%shape
         end associate
      end do
      do i = 1, size(model%rigids)
         associate (one => model%rigids(i))
            at = dofs%of(2, model%domain%mesh%groups(one%group)%nodes(1))
            load(at) = load(at) + factor_at(model, one%history, time)*one%force
         end associate
      end do
      do i = 1, size(model%plates)
         associate (one => model%plates(i))
            load(dofs%of(2, one%node)) = load(dofs%of(2, one%node)) + plate_load(model, one, time)
         end associate
      end do
   end function load_at

   !> Force on a plate and its weight, upwards [kN].
   pure real(wp) function plate_load(model, plate, time)
      type(model_t), intent(in) :: model
      type(plate_t), intent(in) :: plate
      real(wp), intent(in) :: time

      plate_load = factor_at(model, plate%history, time)*plate%force
      if (plate%heavy) plate_load = plate_load - plate%mass*model%domain%gravity
   end function plate_load

   !> Nothing prescribed, nothing loaded; rigid bodies have their mass.
   function new_constraint(model, dofs) result(constraint)
      type(model_t), intent(in) :: model
      type(dofs_t), intent(in) :: dofs
      type(constraint_t) :: constraint
      integer :: i, nodes, at

      nodes = size(model%domain%mesh%x, 2)
      allocate (constraint%fixed(dofs%n), source=.false.)
      allocate (constraint%air(nodes), source=.false.)
      allocate (constraint%target(dofs%n), constraint%load_0(dofs%n), constraint%load_1(dofs%n), &
                constraint%offset(dofs%n), constraint%mass(dofs%n), source=0.0_wp)
      allocate (constraint%air_target(nodes), source=0.0_wp)
      do i = 1, size(model%rigids)
         at = dofs%of(2, model%domain%mesh%groups(model%rigids(i)%group)%nodes(1))
         constraint%mass(at) = model%rigids(i)%mass
      end do
      do i = 1, size(model%plates)
         constraint%mass(dofs%of(2, model%plates(i)%node)) = model%plates(i)%mass
      end do
   end function new_constraint

   !> Prescribed values at the end of a step; x_start: unknowns at the start of the stage, which some are held at.
   subroutine constrain_step(model, stage, dofs, drainage, time, x_start, constraint)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      type(dofs_t), intent(in) :: dofs
      type(drainage_t), intent(in) :: drainage
      real(wp), intent(in) :: time, x_start(:, :)
      type(constraint_t), intent(inout) :: constraint
      real(wp) :: value
      integer :: i, k, node, at

      constraint%fixed = .false.
      constraint%air = .false.
      do i = 1, size(model%fixes)
         associate (fix => model%fixes(i))
            if (.not. acts_in(fix%stages, stage%name)) cycle
            if (time <= fix%from .or. time > fix%until + 1.0e-12_wp*abs(time)) cycle
            value = fix%value*factor_at(model, fix%history, time)
            do k = 1, size(model%domain%mesh%groups(fix%group)%nodes)
               node = model%domain%mesh%groups(fix%group)%nodes(k)
               if (is_released(drainage, i, node)) cycle
               if (fix%field == P_A) then
                  if (dofs%of(4, node) == 0) cycle
                  constraint%air(node) = .true.
                  constraint%air_target(node) = value
                  if (fix%hold) constraint%air_target(node) = x_start(3, node) + x_start(4, node)
               else
                  at = dofs%of(fix%field, node)
                  if (at == 0) cycle
                  constraint%fixed(at) = .true.
                  constraint%target(at) = value
                  if (fix%hold) constraint%target(at) = x_start(fix%field, node)
               end if
            end do
         end associate
      end do
      ! Air pressure and one of the others: then the third is known too.
      do node = 1, size(constraint%air)
         if (.not. constraint%air(node)) cycle
         associate (w => dofs%of(3, node), c => dofs%of(4, node))
            if (constraint%fixed(c)) then
               constraint%target(w) = constraint%air_target(node) - constraint%target(c)
            else if (constraint%fixed(w)) then
               constraint%target(c) = constraint%air_target(node) - constraint%target(w)
            else
               cycle
            end if
            constraint%fixed([w, c]) = .true.
            constraint%air(node) = .false.
         end associate
      end do
      if (stage%kind /= STATIC) return
      do i = 1, dofs%n
         if (dofs%field(i) < 3) cycle
         constraint%fixed(i) = .true.
         constraint%target(i) = x_start(dofs%field(i), dofs%node(i))
      end do
      constraint%air = .false.
   end subroutine constrain_step
end module boundary_loads
