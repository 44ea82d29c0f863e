! SPDX-License-Identifier: MIT
!> Bodies that no support holds in a stage without inertia: what is connected by elements, ties and plates, and the
!> rigid motions that its supports leave. docs/theory/host.md section 7.1.
module free_bodies
   use acting_places, only: given_in
   use kinds, only: wp
   use contact_types, only: has_friction
   use exit_codes, only: EXIT_FREE_BODY
   use faults, only: fault_t, raise
   use load_shapes, only: ties_of
   use model_types, only: model_t
   use scene_parts, only: PRESCRIBED_OF_BODY
   use texts, only: joined, short, whole
   use triangle_mesh, only: NAME_LENGTH
   use unknown_fields, only: FIELDS, DISPLACEMENTS, AT_U_R, AT_U_Z
   implicit none (type, external)
   private
   public :: check_bodies

   integer, parameter :: TURN = 3   !< Motion beside AT_U_R and AT_U_Z: the rotation of plane strain.
   character(*), parameter :: MOTIONS(TURN) = [character(48) :: 'moving along r (x); add a &fix of u_r', &
      'moving along z (y); add a &fix of u_z', 'turning; add a &fix of u_z or u_r']
   character(*), parameter :: ALONG_PLATE = '; along a plate give one friction'
   real(wp), parameter :: NEAR_SHARE = 1.0e-5_wp   !< Nodes nearer than this share of the mesh are at one place.
   integer, parameter :: MOST_NAMES = 3            !< Number of groups by which a body is named.
contains
   !> Refuses a static or quasi-static stage in which neither a support nor a contact holds a body, and notes which
   !> bodies contacts alone hold. Fault EXIT_FREE_BODY: it names a group of the body and the motion.
   subroutine check_bodies(model, fault)
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      integer :: body(size(model%domain%mesh%x, 2)), s, b, f
      ! Motions that nodes take from their bodies: in every stage, in one, and those that a contact may take.
      logical, dimension(TURN, size(body)) :: always, held, touched
      logical :: is_held(TURN)
      real(wp) :: near

      associate (x => model%domain%mesh%x)
         near = NEAR_SHARE*maxval(maxval(x, dim=2) - minval(x, dim=2))
         call find_bodies(model, near, body, always)
         allocate (model%on_contact(size(model%stages)))
         do s = 1, size(model%stages)
            model%on_contact(s)%words = ''
            if (model%stages(s)%has_inertia) cycle
            associate (given => given_in(model, s))
               held = always .or. given([AT_U_R, AT_U_Z, PRESCRIBED_OF_BODY], :)
            end associate
            touched = touched_in(model, s)
            do b = 1, size(body)
               if (body(b) /= b) cycle
               is_held = [(any(held(f, :) .and. body == b), f=1, TURN)]
               do f = 1, DISPLACEMENTS
                  ! It does not turn where nodes that are held along r differ in z, or those held along z in r.
                  if (is_held(f)) is_held(TURN) = is_held(TURN) .or. near < &
                     maxval(x(3 - f, :), mask=held(f, :) .and. body == b) - &
                     minval(x(3 - f, :), mask=held(f, :) .and. body == b)
               end do
               if (all(is_held)) cycle
               model%on_contact(s)%words = model%on_contact(s)%words//'; contact alone holds '// &
                                           described(model, body == b)
               f = findloc(is_held .or. [(any(touched(f, :) .and. body == b), f=1, TURN)], .false., dim=1)
               if (f > 0 .and. fault%code == 0) call raise(fault, EXIT_FREE_BODY, 'Stage '// &
                  trim(model%stages(s)%name)//': nothing holds '//described(model, body == b)//' against '// &
                  trim(MOTIONS(f))//' on a group of it, or a contact'//ALONG_PLATE(:merge(len(ALONG_PLATE), 0, &
                                                                                         f == AT_U_R))//'.')
            end do
         end do
      end associate
   end subroutine check_bodies

   !> For every node the first node of its body, which stands for it; huge where there is none. Two nodes at different
   !> places with one displacement do not turn; nor does a plate with a face of its own, which moves along z alone,
   !> unless it has more coordinates.
   subroutine find_bodies(model, near, body, always)
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: near             !< [m]
      integer, intent(out) :: body(:)          !< (nodes)
      logical, intent(out) :: always(:, :)     !< (TURN, nodes)
      integer :: before(size(body)), leader(FIELDS, size(body)), e, f, i

      leader = ties_of(model)
      always = model%domain%axisymmetric
      always(AT_U_Z, :) = .false.
      body = huge(body)
      associate (mesh => model%domain%mesh, plates => model%plates)
         body(reshape(mesh%t6, [size(mesh%t6)])) = reshape(mesh%t6, [size(mesh%t6)])
         do i = 1, size(plates)
            body(plates(i)%coordinates%node) = plates(i)%node
            if (plates(i)%group == 0) always([AT_U_R, TURN], plates(i)%node) = size(plates(i)%coordinates) == 1
         end do
         before = 0
         do while (any(body /= before))
            before = body
            do e = 1, size(mesh%t6, 2)
               body(mesh%t6(:, e)) = minval(body(mesh%t6(:, e)))
            end do
            do i = 1, size(body)
               do f = 1, DISPLACEMENTS
                  if (leader(f, i) == 0) cycle
                  body([i, leader(f, i)]) = minval(body([i, leader(f, i)]))
                  if (abs(mesh%x(3 - f, i) - mesh%x(3 - f, leader(f, i))) > near) always(TURN, i) = .true.
               end do
            end do
            do i = 1, size(plates)
               if (plates(i)%group == 0) cycle
               associate (nodes => [mesh%groups(plates(i)%group)%nodes, plates(i)%coordinates%node])
                  body(nodes) = minval(body(nodes))
               end associate
            end do
         end do
      end associate
   end subroutine find_bodies

   !> Motions of nodes that the contacts of a stage may hold: a plate slides along one that has no friction.
   pure function touched_in(model, stage) result(touched)
      type(model_t), intent(in) :: model
      integer, intent(in) :: stage   !< Number of the stage.
      logical :: touched(TURN, size(model%domain%mesh%x, 2))
      integer :: i

      touched = .false.
      associate (groups => model%domain%mesh%groups)
         do i = 1, size(model%contacts)
            associate (one => model%contacts(i))
               if (.not. one%in_stage(stage)) cycle
               touched(:, groups(one%slave)%nodes) = .true.
               if (one%plate == 0) then
                  touched(:, groups(one%master)%nodes) = .true.
               else
                  touched(AT_U_Z:, model%plates(one%plate)%node) = .true.
                  if (has_friction(one%options)) touched(AT_U_R, model%plates(one%plate)%node) = .true.
               end if
            end associate
         end do
      end associate
   end function touched_in

   !> A plate by its name, another body by groups that belong to it, and by where it is.
   function described(model, mine) result(text)
      type(model_t), intent(in) :: model
      logical, intent(in) :: mine(:)   !< Its nodes.
      character(:), allocatable :: text
      character(NAME_LENGTH), allocatable :: names(:)
      logical, dimension(size(model%domain%mesh%groups)) :: within, boundary
      integer :: i, n

      do i = 1, size(model%plates)
         text = 'the plate '''//trim(model%plates(i)%name)//''''
         if (mine(model%plates(i)%node) .and. model%plates(i)%group == 0) return
      end do
      text = ''
      associate (mesh => model%domain%mesh, groups => model%domain%mesh%groups)
         within = [(groups(i)%name /= 'all' .and. size(groups(i)%nodes) > 0 .and. all(mine(groups(i)%nodes)), &
                    i=1, size(groups))]
         boundary = [(size(groups(i)%edges, 2) > 0, i=1, size(groups))]
         allocate (names, source=[pack(groups%name, within .and. boundary), &
                                  pack(groups%name, within .and. .not. boundary)])
         n = min(MOST_NAMES, size(names))
         if (n > 0) text = ' with the group'//trim(merge('s', ' ', n > 1))//' '''//joined(names(:n), ''', ''')//''''
         text = 'the body'//text//' ('//whole(count(mine))//' nodes from ('//short(minval(mesh%x(1, :), mask=mine))// &
                ', '//short(minval(mesh%x(2, :), mask=mine))//') to ('//short(maxval(mesh%x(1, :), mask=mine))//', '// &
                short(maxval(mesh%x(2, :), mask=mine))//') m)'
      end associate
   end function described
end module free_bodies
