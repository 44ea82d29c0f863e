! SPDX-License-Identifier: MIT
!> Bodies that no support holds in a stage without inertia: what is connected by elements, ties and plates, and the
!> rigid motions that its supports leave. docs/theory/host.md section 7.1.
module free_bodies
   use kinds, only: wp
   use contact_types, only: has_friction
   use exit_codes, only: EXIT_FREE_BODY
   use faults, only: fault_t, raise
   use generalised_alpha, only: has_inertia
   use model_types, only: model_t
   use scene_parts, only: acts_in, stage_t
   use texts, only: short, whole
   use unknown_fields, only: DISPLACEMENTS, AT_U_R, AT_U_Z
   implicit none (type, external)
   private
   public :: check_bodies

   integer, parameter :: TURN = 3   !< Motion beside AT_U_R and AT_U_Z: the rotation of plane strain.
   character(*), parameter :: MOTIONS(TURN) = [character(18) :: 'moving along r (x)', 'moving along z (y)', 'turning']
   character(*), parameter :: REMEDIES(TURN) = [character(10) :: 'u_r', 'u_z', 'u_z or u_r']
   !> Nodes nearer than this share of the size of a body are at one place, as far as its rotation is concerned.
   real(wp), parameter :: NEAR_SHARE = 1.0e-5_wp
   integer, parameter :: MOST_NAMES = 3   !< Number of groups by which a body is named.
contains
   !> Refuses a static or quasi-static stage in which neither a support nor a contact holds a body, and notes which
   !> bodies contacts alone hold. Fault EXIT_FREE_BODY: it names a group of the body and the motion.
   subroutine check_bodies(model, fault)
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      character(:), allocatable :: free
      integer :: s

      allocate (model%on_contact(size(model%stages)))
      do s = 1, size(model%stages)
         call look_for_bodies(model, model%stages(s), free, model%on_contact(s)%words)
         if (free /= '' .and. fault%code == 0) call raise(fault, EXIT_FREE_BODY, 'Stage '// &
            trim(model%stages(s)%name)//': nothing holds '//free)
      end do
   end subroutine check_bodies

   !> Ends of sentences about bodies that no support of a stage holds: the first of those that no contact holds either,
   !> with the remedy, and all that a contact may hold. Empty if there are none, as in a stage with inertia.
   subroutine look_for_bodies(model, stage, free, on_contact)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      character(:), allocatable, intent(out) :: free, on_contact
      integer :: body_of(size(model%domain%mesh%x, 2)), b, i, motion
      logical :: touched(size(model%domain%mesh%x, 2)), fixed

      free = ''
      on_contact = ''
      if (has_inertia(stage%kind)) return
      body_of = bodies_of(model)
      touched = in_contact(model, stage)
      do b = 1, size(body_of)
         ! The first node of a body stands for it; one without an element has no stiffness, and no equation.
         if (body_of(b) /= b) cycle
         motion = free_motion(model, stage, body_of == b)
         if (motion == 0) cycle
         if (any(touched .and. body_of == b)) then
            on_contact = on_contact//'; contact alone holds '//described(model, body_of == b)
         else if (free == '') then
            free = described(model, body_of == b)//' against '//trim(MOTIONS(motion))//'; add a &fix of '// &
                   trim(REMEDIES(motion))//' on a group of it, or a contact.'
         end if
      end do
      do i = 1, size(model%plates)
         associate (plate => model%plates(i))
            if (plate%group > 0) cycle
            fixed = is_fixed(model, stage, AT_U_Z, plate%node)
            if (size(plate%coordinates) > 1 .or. .not. fixed) on_contact = on_contact//'; contact alone holds the '// &
                                                                           'plate '''//trim(plate%name)//''''
            if (free /= '') cycle
            if (any(plate%coordinates%field == AT_U_R) .and. .not. holds_along_r(model, stage, i)) then
               free = 'the plate '''//trim(plate%name)//''' against moving along r (x): no &contact of it that '// &
                      'acts has friction; give one friction, or a &fix of u_r with the plate as its group.'
            else if (.not. (touched(plate%node) .or. fixed)) then
               free = 'the plate '''//trim(plate%name)//''': no &contact of it acts; add one, or a &fix of u_z '// &
                      'with the plate as its group.'
            end if
         end associate
      end do
   end subroutine look_for_bodies

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

   !> For every node the first node of its body, 0 for nodes without an element. (nodes)
   function bodies_of(model) result(body)
      type(model_t), intent(in) :: model
      integer :: body(size(model%domain%mesh%x, 2))
      integer :: e, i, k, n

      body = 0
      associate (mesh => model%domain%mesh)
         do e = 1, size(mesh%t6, 2)
            body(mesh%t6(:, e)) = mesh%t6(:, e)
         end do
         do e = 1, size(mesh%t6, 2)
            call join(mesh%t6(:, e))
         end do
         do i = 1, size(model%ties)
            do k = 1, size(model%ties(i)%pairs, 2)
               call join(model%ties(i)%pairs(:, k))
            end do
         end do
         do i = 1, size(model%plates)
            associate (plate => model%plates(i))
               if (plate%group == 0) cycle
               call join(mesh%groups(plate%group)%nodes)
               if (.not. plate%penalty > 0.0_wp) cycle
               body(plate%coordinates%node) = plate%coordinates%node
               call join([mesh%groups(plate%group)%nodes(1), plate%coordinates%node])
            end associate
         end do
      end associate
      do n = 1, size(body)
         if (body(n) > 0) body(n) = root(n)
      end do
   contains
      subroutine join(nodes)
         integer, intent(in) :: nodes(:)
         integer :: j, first, second

         do j = 2, size(nodes)
            if (body(nodes(1)) == 0 .or. body(nodes(j)) == 0) cycle
            first = root(nodes(1))
            second = root(nodes(j))
            body(max(first, second)) = min(first, second)
         end do
      end subroutine join

      !> The way is shortened for those who come after.
      integer function root(node)
         integer, intent(in) :: node

         root = node
         do while (body(root) /= root)
            body(root) = body(body(root))
            root = body(root)
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

   !> A rigid motion that the supports of a stage leave to a body, 0 if there is none. Supports hold along r or along z:
   !> a body that both hold can but turn, unless nodes that are held along r differ in z, or those held along z in r.
   !> In axial symmetry the motion along z alone strains nothing.
   function free_motion(model, stage, mine) result(motion)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: stage
      logical, intent(in) :: mine(:)   !< Nodes of the body.
      integer :: motion
      ! Range of z of the nodes that are held along r, and of r of those held along z.
      real(wp) :: low(2), high(2), near
      logical :: turn_held
      integer :: i, k

      low = huge(low)
      high = -huge(high)
      turn_held = .false.
      associate (x => model%domain%mesh%x, groups => model%domain%mesh%groups)
         near = NEAR_SHARE*maxval([(maxval(x(i, :), mask=mine) - minval(x(i, :), mask=mine), i=1, 2)])
         do i = 1, size(model%fixes)
            associate (fix => model%fixes(i))
               if (fix%field > DISPLACEMENTS .or. .not. acts_in(fix%stages, stage%name)) cycle
               do k = 1, size(groups(fix%group)%nodes)
                  associate (node => groups(fix%group)%nodes(k), field => fix%field)
                     if (.not. mine(node)) cycle
                     turn_held = turn_held .or. fix%of_body
                     if (fix%of_body) cycle
                     low(field) = min(low(field), x(3 - field, node))
                     high(field) = max(high(field), x(3 - field, node))
                  end associate
               end do
            end associate
         end do
         do i = 1, size(model%ties)
            do k = 1, size(model%ties(i)%pairs, 2)
               associate (pair => model%ties(i)%pairs(:, k))
                  if (mine(pair(1))) turn_held = turn_held .or. any(abs(x(:, pair(1)) - x(:, pair(2))) > near)
               end associate
            end do
         end do
         do i = 1, size(model%plates)
            ! What springs tie to a plate moves as any rigid body does.
            if (model%plates(i)%group == 0 .or. model%plates(i)%penalty > 0.0_wp) cycle
            associate (nodes => groups(model%plates(i)%group)%nodes)
               if (mine(nodes(1))) turn_held = turn_held .or. any(abs(x(1, nodes) - x(1, nodes(1))) > near)
            end associate
         end do
      end associate
      motion = 0
      if (.not. (turn_held .or. any(high > low + near) .or. model%domain%axisymmetric)) motion = TURN
      if (low(AT_U_Z) > high(AT_U_Z)) motion = AT_U_Z
      if (low(AT_U_R) > high(AT_U_R) .and. .not. model%domain%axisymmetric) motion = AT_U_R
   end function free_motion

   !> A body by groups that belong to it, and by where it is.
   function described(model, mine) result(text)
      type(model_t), intent(in) :: model
      logical, intent(in) :: mine(:)   !< Its nodes.
      character(:), allocatable :: text
      integer :: i, n

      text = ''
      n = 0
      associate (mesh => model%domain%mesh)
         do i = 1, 2*size(mesh%groups)
            associate (group => mesh%groups(mod(i - 1, size(mesh%groups)) + 1))
               ! Boundaries first, then groups of elements.
               if (size(group%edges, 2) > 0 .neqv. i <= size(mesh%groups)) cycle
               if (size(group%nodes) == 0 .or. group%name == 'all' .or. n == MOST_NAMES) cycle
               if (.not. all(mine(group%nodes))) cycle
               text = text//trim(merge(', ', '  ', n > 0))//' '''//trim(group%name)//''''
               n = n + 1
            end associate
         end do
         if (n > 0) text = ' with the group'//trim(merge('s', ' ', n > 1))//text
         text = 'the body'//text//' ('//whole(count(mine))//' nodes from ('//short(minval(mesh%x(1, :), mask=mine))// &
                ', '//short(minval(mesh%x(2, :), mask=mine))//') to ('//short(maxval(mesh%x(1, :), mask=mine))//', '// &
                short(maxval(mesh%x(2, :), mask=mine))//') m)'
      end associate
   end function described
end module free_bodies
