! SPDX-License-Identifier: MIT
!> Bodies that no support holds in a stage without inertia. Elements, shared unknowns and plates connect nodes to
!> bodies. docs/theory/host.md section 7.1.
module free_bodies
   use acting_places, only: given_in, ground_of, nodes_of_ground, location_of
   use kinds, only: wp
   use contact_types, only: has_friction
   use element_sums, only: LAST_U
   use exit_codes, only: EXIT_FREE_BODY
   use faults, only: fault_t, raise
   use model_types, only: model_t, unknowns_of
   use scene_parts, only: PRESCRIBED_OF_BODY
   use unknown_fields, only: DISPLACEMENTS, AT_U_R, AT_U_Z
   implicit none (type, external)
   private
   public :: check_bodies

   integer, parameter :: TURN = 3   !< Motion beside AT_U_R and AT_U_Z: the rotation of plane strain.
   character(*), parameter :: MOTIONS(TURN) = [character(80) :: &
      'moving along r (x); add a &fix of u_r, or a contact, with friction along a plate', &
      'moving along z (y); add a &fix of u_z, or a contact', 'turning; add a &fix of u_z or u_r, or a contact']
   real(wp), parameter :: NEAR_SHARE = 1.0e-5_wp   !< Nodes nearer than this share of the mesh are at one place.
contains
   !> Refuses a static or quasi-static stage in which neither a support nor a contact holds a body, and notes which
   !> bodies contacts alone hold. The unknowns of the model are numbered. Fault EXIT_FREE_BODY: it names the body and
   !> the motion.
   subroutine check_bodies(model, fault)
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      integer :: body(size(model%domain%mesh%x, 2)), s, b, f
      logical, dimension(TURN, size(body)) :: held, touched, mine
      logical :: is_held(TURN)
      real(wp) :: near

      associate (x => model%domain%mesh%x)
         near = NEAR_SHARE*maxval(maxval(x, dim=2) - minval(x, dim=2))
         allocate (model%on_contact(size(model%stages)))
         do s = 1, size(model%stages)
            model%on_contact(s)%words = ''
            if (model%stages(s)%has_inertia) cycle
            body = bodies_of(model, s)
            held = held_in(model, s, near)
            touched = touched_in(model, s)
            do b = 1, size(body)
               if (body(b) /= b) cycle
               mine = spread(body == b, 1, TURN)
               is_held = any(held .and. mine, dim=2)
               do f = 1, DISPLACEMENTS
                  ! It does not turn where nodes that are held along r differ in z, or those held along z in r.
                  if (is_held(f)) is_held(TURN) = is_held(TURN) .or. near < &
                     maxval(x(3 - f, :), mask=held(f, :) .and. mine(f, :)) - &
                     minval(x(3 - f, :), mask=held(f, :) .and. mine(f, :))
               end do
               if (all(is_held)) cycle
               model%on_contact(s)%words = model%on_contact(s)%words//'; contact alone holds the body of '// &
                                           location_of(model, b)
               f = findloc(is_held .or. any(touched .and. mine, dim=2), .false., dim=1)
               if (f > 0 .and. fault%code == 0) call raise(fault, EXIT_FREE_BODY, 'Stage '// &
                  trim(model%stages(s)%name)//': nothing holds the body of '//location_of(model, b)//' against '// &
                  trim(MOTIONS(f))//'.')
            end do
         end do
      end associate
   end subroutine check_bodies

   !> Finds for every node the first node of its body, which stands for it; 0 where it has no displacement, or its
   !> ground is not there.
   function bodies_of(model, stage) result(body)
      type(model_t), intent(in) :: model
      integer, intent(in) :: stage   !< Number of the stage.
      integer :: body(size(model%domain%mesh%x, 2))
      logical :: there(size(body)), present(size(model%domain%region_of))
      integer, dimension(model%dofs%n) :: first, before   ! First unknowns of the bodies of unknowns.
      integer, allocatable :: joined(:)
      integer :: e, i

      associate (dofs => model%dofs)
         first = [(i, i=1, dofs%n)]
         before = 0
         present = ground_of(model, stage)
         there = nodes_of_ground(model, stage)
         do while (any(first /= before))
            before = first
            do e = 1, size(dofs%element, 2)
               if (.not. present(e)) cycle
               associate (own => dofs%element(:LAST_U, e))
                  first(own) = minval(first(own))
               end associate
            end do
            do i = 1, size(model%plates)
               joined = unknowns_of(model%plates(i), dofs)
               if (model%plates(i)%group > 0) &
                  joined = [joined, dofs%of(AT_U_Z, model%domain%mesh%groups(model%plates(i)%group)%nodes)]
               first(joined) = minval(first(joined))
            end do
         end do
         body = 0
         do i = 1, size(body)
            if (there(i) .and. dofs%of(AT_U_Z, i) > 0) body(i) = dofs%node(first(dofs%of(AT_U_Z, i)))
         end do
      end associate
   end function bodies_of

   !> Motions that nodes take from their bodies in a stage: by a support, or in axial symmetry. Nodes at different
   !> places with one displacement do not turn; nor does a plate with a face of its own that moves along z alone.
   function held_in(model, stage, near) result(held)
      type(model_t), intent(in) :: model
      integer, intent(in) :: stage    !< Number of the stage.
      real(wp), intent(in) :: near    !< [m]
      logical :: held(TURN, size(model%domain%mesh%x, 2))
      integer :: f, i

      associate (given => given_in(model, stage), x => model%domain%mesh%x, dofs => model%dofs)
         held = given([AT_U_R, AT_U_Z, PRESCRIBED_OF_BODY], :)
         if (model%domain%axisymmetric) held([AT_U_R, TURN], :) = .true.
         do i = 1, size(x, 2)
            do f = 1, DISPLACEMENTS
               if (dofs%of(f, i) == 0) cycle
               if (abs(x(3 - f, i) - x(3 - f, dofs%node(dofs%of(f, i)))) > near) held(TURN, i) = .true.
            end do
         end do
      end associate
      do i = 1, size(model%plates)
         if (model%plates(i)%group == 0 .and. size(model%plates(i)%coordinates) == 1) &
            held([AT_U_R, TURN], model%plates(i)%node) = .true.
      end do
   end function held_in

   !> Motions of nodes that the contacts of a stage may hold: a plate slides along one that has no friction.
   pure function touched_in(model, stage) result(touched)
      type(model_t), intent(in) :: model
      integer, intent(in) :: stage   !< Number of the stage.
      logical :: touched(TURN, size(model%domain%mesh%x, 2))
      integer :: i

      touched = .false.
      do i = 1, size(model%contacts)
         associate (one => model%contacts(i), groups => model%domain%mesh%groups)
            if (.not. one%in_stage(stage)) cycle
            touched(:, groups(one%slave)%nodes) = .true.
            if (one%plate == 0) touched(:, groups(one%master)%nodes) = .true.
            if (one%plate > 0) touched([AT_U_Z, TURN, merge(AT_U_R, TURN, has_friction(one%options))], &
                                       model%plates(one%plate)%node) = .true.
         end associate
      end do
   end function touched_in
end module free_bodies
