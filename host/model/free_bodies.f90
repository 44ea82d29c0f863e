! SPDX-License-Identifier: MIT
!> Bodies that no support holds in a stage without inertia: what is connected by elements, ties and plates, and the
!> rigid motions that its supports leave. docs/theory/host.md section 7.1.
module free_bodies
   use kinds, only: wp
   use contact_friction, only: has_friction
   use exit_codes, only: EXIT_FREE_BODY
   use faults, only: fault_t, raise
   use generalised_alpha, only: DYNAMIC
   use model_types, only: model_t
   use scene_types, only: acts_in, stage_t
   use texts, only: short, whole
   use unknown_fields, only: DISPLACEMENTS, AT_U_R, AT_U_Z
   implicit none (type, external)
   private
   public :: check_bodies, bodies_on_contact

   integer, parameter :: TURN = 3, MOTIONS = 3                !< Along r, along z, and the rotation of plane strain.
   real(wp), parameter :: NOTHING = 1.0e-10_wp                !< Pivot that is none, of a matrix with entries up to 1.
   integer, parameter :: MOST_NAMES = 3
contains
   !> Refuses a static or quasi-static stage in which neither a support nor a contact holds a body. Fault
   !> EXIT_FREE_BODY: it names a group of the body and the motion.
   subroutine check_bodies(model, fault)
      type(model_t), intent(in) :: model
      type(fault_t), intent(inout) :: fault
      integer, allocatable :: body_of(:)
      logical, allocatable :: touched(:)
      integer :: s, b, i, motion

      if (.not. any(model%stages%kind /= DYNAMIC)) return
      body_of = bodies_of(model)
      do s = 1, size(model%stages)
         associate (stage => model%stages(s))
            if (stage%kind == DYNAMIC) cycle
            touched = in_contact(model, stage)
            do b = 1, size(body_of)
               ! The first node of a body stands for it; one without an element has no stiffness, and no equation.
               if (body_of(b) /= b .or. any(touched .and. body_of == b)) cycle
               motion = free_motion(model, stage, body_of == b)
               if (motion == 0) cycle
               call raise(fault, EXIT_FREE_BODY, 'Stage '//trim(stage%name)//': nothing holds '// &
                          described(model, body_of == b)//' against '//named(motion)//'; add a &fix of '// &
                          trim(merge('u_r', 'u_z', motion == AT_U_R))//trim(merge(' or u_r', '       ', &
                          motion == TURN))//' on a group of it, or a contact.')
               return
            end do
            do i = 1, size(model%plates)
               if (model%plates(i)%group > 0) cycle
               if (model%plates(i)%turns .and. .not. holds_along_r(model, stage, i)) then
                  call raise(fault, EXIT_FREE_BODY, 'Stage '//trim(stage%name)//': nothing holds the plate '''// &
                             trim(model%plates(i)%name)//''' against moving along r (x): no &contact of it that '// &
                             'acts has friction; give one friction, or a &fix of u_r with the plate as its group.')
                  return
               end if
               if (touched(model%plates(i)%node)) cycle
               if (is_fixed(model, stage, AT_U_Z, model%plates(i)%node)) cycle
               call raise(fault, EXIT_FREE_BODY, 'Stage '//trim(stage%name)//': nothing holds the plate '''// &
                          trim(model%plates(i)%name)//''': no &contact of it acts; add one, or a &fix of u_z with '// &
                          'the plate as its group.')
               return
            end do
         end associate
      end do
   contains
      pure function named(motion) result(text)
         integer, intent(in) :: motion
         character(:), allocatable :: text

         select case (motion)
         case (AT_U_R)
            text = 'moving along r (x)'
         case (AT_U_Z)
            text = 'moving along z (y)'
         case default
            text = 'turning'
         end select
      end function named
   end subroutine check_bodies

   !> Whether a &fix or the friction of a contact may hold a plate in its plane along r.
   pure logical function holds_along_r(model, stage, plate) result(holds)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      integer, intent(in) :: plate   !< Its number.
      integer :: i

      holds = is_fixed(model, stage, AT_U_R, model%plates(plate)%node)
      do i = 1, size(model%contacts)
         associate (one => model%contacts(i))
            holds = holds .or. one%plate == plate .and. has_friction(one%options) .and. acts_in(one%stages, stage%name)
         end associate
      end do
   end function holds_along_r

   !> Bodies that contacts alone hold in a stage, as the end of a sentence; empty if there are none.
   function bodies_on_contact(model, stage) result(text)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      character(:), allocatable :: text
      integer :: body_of(size(model%domain%mesh%x, 2)), b, i
      logical :: touched(size(model%domain%mesh%x, 2))

      text = ''
      if (stage%kind == DYNAMIC) return
      body_of = bodies_of(model)
      touched = in_contact(model, stage)
      do b = 1, size(body_of)
         if (body_of(b) /= b .or. .not. any(touched .and. body_of == b)) cycle
         if (free_motion(model, stage, body_of == b) == 0) cycle
         text = text//'; contact alone holds '//described(model, body_of == b)
      end do
      do i = 1, size(model%plates)
         if (model%plates(i)%group > 0 .or. (is_fixed(model, stage, AT_U_Z, model%plates(i)%node) .and. .not. &
                                             model%plates(i)%turns)) cycle
         text = text//'; contact alone holds the plate '''//trim(model%plates(i)%name)//''''
      end do
   end function bodies_on_contact

   !> For every node the first node of its body, 0 for nodes without an element. (nodes)
   function bodies_of(model) result(body)
      type(model_t), intent(in) :: model
      integer :: body(size(model%domain%mesh%x, 2))
      integer :: e, i, k, n

      body = 0
      associate (mesh => model%domain%mesh)
         do e = 1, size(mesh%t6, 2)
            do k = 1, 6
               if (body(mesh%t6(k, e)) == 0) body(mesh%t6(k, e)) = mesh%t6(k, e)
            end do
         end do
         do e = 1, size(mesh%t6, 2)
            do k = 2, 6
               call join(mesh%t6(1, e), mesh%t6(k, e))
            end do
         end do
         do i = 1, size(model%ties)
            do k = 1, size(model%ties(i)%pairs, 2)
               call join(model%ties(i)%pairs(1, k), model%ties(i)%pairs(2, k))
            end do
         end do
         do i = 1, size(model%plates)
            if (model%plates(i)%group == 0) cycle
            associate (nodes => mesh%groups(model%plates(i)%group)%nodes, plate => model%plates(i))
               do k = 2, size(nodes)
                  call join(nodes(1), nodes(k))
               end do
               if (.not. plate%turns) cycle
               body([plate%node, plate%turn_node]) = [plate%node, plate%turn_node]
               call join(nodes(1), plate%node)
               call join(nodes(1), plate%turn_node)
            end associate
         end do
      end associate
      do n = 1, size(body)
         if (body(n) > 0) body(n) = root(n)
      end do
   contains
      subroutine join(a, b)
         integer, intent(in) :: a, b
         integer :: first, second

         if (body(a) == 0 .or. body(b) == 0) return
         first = root(a)
         second = root(b)
         body(max(first, second)) = min(first, second)
      end subroutine join

      integer function root(node)
         integer, intent(in) :: node
         integer :: at, next

         root = node
         do while (body(root) /= root)
            root = body(root)
         end do
         ! The way is shortened for those who come after.
         at = node
         do while (body(at) /= root)
            next = body(at)
            body(at) = root
            at = next
         end do
      end function root
   end function bodies_of

   !> Nodes that a contact of a stage may hold. (nodes)
   function in_contact(model, stage) result(touched)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      logical :: touched(size(model%domain%mesh%x, 2))
      integer :: i

      touched = .false.
      do i = 1, size(model%contacts)
         associate (one => model%contacts(i))
            if (.not. acts_in(one%stages, stage%name)) cycle
            touched(model%domain%mesh%groups(one%slave)%nodes) = .true.
            if (one%plate == 0) touched(model%domain%mesh%groups(one%master)%nodes) = .true.
            if (one%plate > 0) touched(model%plates(one%plate)%node) = .true.
         end associate
      end do
   end function in_contact

   !> Whether a stage prescribes a displacement of a node.
   pure logical function is_fixed(model, stage, field, node)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      integer, intent(in) :: field, node
      integer :: i

      is_fixed = .false.
      do i = 1, size(model%fixes)
         if (model%fixes(i)%field /= field .or. .not. acts_in(model%fixes(i)%stages, stage%name)) cycle
         is_fixed = is_fixed .or. any(model%domain%mesh%groups(model%fixes(i)%group)%nodes == node)
      end do
   end function is_fixed

   !> A rigid motion that the supports of a stage leave to a body, 0 if there is none. In axial symmetry that along z
   !> alone strains nothing.
   function free_motion(model, stage, mine) result(motion)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      logical, intent(in) :: mine(:)   !< Nodes of the body.
      integer :: motion
      real(wp) :: gram(MOTIONS, MOTIONS), middle(2), far, factor
      logical :: open(MOTIONS)
      integer :: i, k, n, pivot

      gram = 0.0_wp
      associate (x => model%domain%mesh%x)
         middle = [(sum(x(i, :), mask=mine)/count(mine), i=1, 2)]
         far = max(maxval(abs(x(1, :) - middle(1)), mask=mine), maxval(abs(x(2, :) - middle(2)), mask=mine))
         do i = 1, size(model%fixes)
            if (model%fixes(i)%field > DISPLACEMENTS .or. .not. acts_in(model%fixes(i)%stages, stage%name)) cycle
            associate (nodes => model%domain%mesh%groups(model%fixes(i)%group)%nodes)
               do k = 1, size(nodes)
                  if (.not. mine(nodes(k))) cycle
                  if (model%fixes(i)%turns) then
                     call hold([0.0_wp, 0.0_wp, 1.0_wp])
                  else
                     call hold(row_of(model%fixes(i)%field, nodes(k)))
                  end if
               end do
            end associate
         end do
         do i = 1, size(model%ties)
            do k = 1, size(model%ties(i)%pairs, 2)
               associate (a => model%ties(i)%pairs(1, k), b => model%ties(i)%pairs(2, k))
                  if (.not. mine(a)) cycle
                  call hold(row_of(AT_U_R, a) - row_of(AT_U_R, b))
                  call hold(row_of(AT_U_Z, a) - row_of(AT_U_Z, b))
               end associate
            end do
         end do
         do i = 1, size(model%plates)
            ! What is tied to a plate in the plane moves as any rigid body does.
            if (model%plates(i)%group == 0 .or. model%plates(i)%turns) cycle
            associate (nodes => model%domain%mesh%groups(model%plates(i)%group)%nodes)
               if (.not. mine(nodes(1))) cycle
               do k = 2, size(nodes)
                  call hold(row_of(AT_U_Z, nodes(1)) - row_of(AT_U_Z, nodes(k)))
               end do
            end associate
         end do
      end associate
      if (model%domain%axisymmetric) then
         motion = merge(0, AT_U_Z, gram(AT_U_Z, AT_U_Z) > 0.0_wp)
         return
      end if
      ! Elimination with the largest pivot: what is left without one is free. A free rotation may leave the first row
      ! that it is mixed with; the translations come first, for their names say more.
      gram = gram/max(maxval(abs(gram)), tiny(1.0_wp))
      open = .true.
      do n = 1, MOTIONS
         pivot = 1
         do k = 1, MOTIONS
            if (open(k) .and. (.not. open(pivot) .or. gram(k, k) > gram(pivot, pivot))) pivot = k
         end do
         if (gram(pivot, pivot) <= NOTHING) exit
         open(pivot) = .false.
         do k = 1, MOTIONS
            if (.not. open(k)) cycle
            factor = gram(k, pivot)/gram(pivot, pivot)
            gram(k, :) = gram(k, :) - factor*gram(pivot, :)
         end do
      end do
      motion = findloc(open, .true., dim=1)
   contains
      pure function row_of(field, node) result(row)
         integer, intent(in) :: field, node
         real(wp) :: row(MOTIONS)

         row = 0.0_wp
         row(field) = 1.0_wp
         associate (at => (model%domain%mesh%x(:, node) - middle)/max(far, tiny(1.0_wp)))
            row(TURN) = merge(-at(2), at(1), field == AT_U_R)
         end associate
      end function row_of

      subroutine hold(row)
         real(wp), intent(in) :: row(MOTIONS)
         integer :: j

         do j = 1, MOTIONS
            gram(:, j) = gram(:, j) + row*row(j)
         end do
      end subroutine hold
   end function free_motion

   !> A body by its groups: boundaries that belong to it, else groups of elements; where it is.
   function described(model, mine) result(text)
      type(model_t), intent(in) :: model
      logical, intent(in) :: mine(:)   !< Its nodes.
      character(:), allocatable :: text
      integer :: i, n, kind

      text = ''
      associate (mesh => model%domain%mesh)
         do kind = 1, 3
            n = 0
            do i = 1, size(mesh%groups)
               associate (group => mesh%groups(i))
                  if (size(group%nodes) == 0 .or. group%name == 'all' .or. n == MOST_NAMES) cycle
                  ! Boundaries, then what has elements, then groups that the body shares with others.
                  if (kind == 1 .and. size(group%edges, 2) == 0) cycle
                  if (kind < 3 .and. .not. all(mine(group%nodes))) cycle
                  if (kind == 3 .and. .not. any(mine(group%nodes))) cycle
                  text = text//trim(merge(', ', '  ', n > 0))//' '''//trim(group%name)//''''
                  n = n + 1
               end associate
            end do
            if (n > 0) exit
         end do
         if (n > 1) text = 's'//text
         if (n > 0) text = ' with the group'//text
         text = 'the body'//text//' ('//whole(count(mine))//' nodes from ('//short(minval(mesh%x(1, :), mask=mine))// &
                ', '//short(minval(mesh%x(2, :), mask=mine))//') to ('//short(maxval(mesh%x(1, :), mask=mine))//', '// &
                short(maxval(mesh%x(2, :), mask=mine))//') m)'
      end associate
   end function described
end module free_bodies
