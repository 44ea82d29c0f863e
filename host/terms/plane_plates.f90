! SPDX-License-Identifier: MIT
!> Plates that move in the plane, motion = 'plane' of &plate: along r and z, and turning. Their face moves exactly on
!> circles; a boundary is tied to them by springs; supports may prescribe the rotation, loads be moments.
!> docs/theory/host.md section 7.3, contact.md section 4.
module plane_plates
   use boundary_builder, only: add_body
   use exit_codes, only: EXIT_GROUP
   use faults, only: fault_t, raise, EXIT_INPUT
   use key_schema, only: UNBOUNDED
   use key_table, only: key_table_t
   use kinds, only: wp
   use model_types, only: model_t, acting_t, plate_t, coordinate_t
   use plate_motion, only: plate_motion_t
   use scene_parts, only: place_of
   use scene_term, only: scene_term_t
   use triangle_mesh, only: find_group
   use unknown_fields, only: AT_U_R, AT_U_Z
   implicit none (type, external)
   private
   public :: plane_plates_t, plane_motion_t

   character(*), parameter :: SUFFIX = '.turn'   !< Ends the group of a rotation.
   real(wp), parameter :: LEAST = 1/UNBOUNDED
   integer, parameter :: VERTICAL = 1, ALONG_R = 2, TURN = 3   !< Places of the unknowns of a motion.

   type, extends(scene_term_t) :: plane_plates_t
   contains
      procedure :: build_group, build
   end type plane_plates_t

   !> u_z and u_r of the centre, and the lever times the angle, from r to z.
   type, extends(plate_motion_t) :: plane_motion_t
      real(wp) :: center(2) = 0.0_wp   !< At the start [m].
      real(wp) :: lever = 1.0_wp       !< [m]
   contains
      procedure :: displacements, slopes, bending
   end type plane_motion_t

   !> What a group of the scene says.
   type :: given_t
      logical :: in_plane = .false.
      real(wp), allocatable :: center(:)
      real(wp) :: inertia = 0.0_wp, force_r = 0.0_wp, moment = 0.0_wp
      real(wp) :: penalty = 1.0e9_wp
   end type given_t
contains
   !> Gives a plate its motion in the plane. Fault EXIT_INPUT: a motion that axial symmetry has no place for, or that
   !> lacks centre or inertia. EXIT_GROUP: the name of its group is taken, or no edges could move with the plate.
   subroutine build_group(self, k, number, model, fault)
      class(plane_plates_t), intent(inout) :: self
      type(key_table_t), intent(inout) :: k
      integer, intent(in) :: number
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(given_t) :: given

      call k%flag('motion', given%in_plane, 'vertical|plane', 'plane', &
                  'plane: along r and z, and turning (plane strain)')
      call k%numbers('center', given%center, -UNBOUNDED, UNBOUNDED, &
                     'r, z of the centre of mass at the start [m]', 'motion=plane')
      call k%number('inertia', given%inertia, LEAST, UNBOUNDED, 'moment of inertia about it [Mg m2]', 'motion=plane')
      call k%number('force_r', given%force_r, -UNBOUNDED, UNBOUNDED, 'force along r, at the centre of mass [kN]', &
                    'motion=plane')
      call k%number('moment', given%moment, -UNBOUNDED, UNBOUNDED, 'moment, from r to z [kN m]', 'motion=plane')
      call k%number('penalty', given%penalty, LEAST, UNBOUNDED, &
                    'traction of a unit of distance between a group and its place on the plate [kN/m3]', &
                    'motion=plane')
      if (k%lists .or. .not. given%in_plane) return
      associate (plate => model%plates(number))
         if (model%domain%axisymmetric) then
            call raise(fault, EXIT_INPUT, place_of(plate)//'motion = ''plane'' turns the plate, which axial '// &
                       'symmetry has no place for; set geometry = ''plane_strain'' in &scene, or '// &
                       'motion = ''vertical''.')
         else if (.not. (k%given('center') .and. k%given('inertia'))) then
            call raise(fault, EXIT_INPUT, place_of(plate)//'a plate that moves in the plane needs '// &
                       'center = r, z of its centre of mass [m] and inertia, its moment of inertia about it '// &
                       '[Mg m2].')
         else if (size(given%center) /= 2) then
            call raise(fault, EXIT_INPUT, place_of(plate)//'center = r, z are two numbers.')
         else
            call free_in_plane(given, number, model, fault)
         end if
      end associate
   end subroutine build_group

   !> Gives supports and loads their rotation; a body with other unknowns is all that a run sees. Fault EXIT_INPUT:
   !> something else has a rotation or moment.
   subroutine build(self, model, fault)
      class(plane_plates_t), intent(inout) :: self
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      integer :: i

      do i = 1, size(model%fixes)
         call act_on_rotation(model%plates, .true., model%fixes(i)%acting_t, fault)
      end do
      do i = 1, size(model%loads)
         call act_on_rotation(model%plates, .false., model%loads(i)%acting_t, fault)
      end do
   end subroutine build

   !> A plate that moves in the plane has two nodes: one with its displacements, one with its rotation.
   subroutine free_in_plane(given, number, model, fault)
      type(given_t), intent(in) :: given
      integer, intent(in) :: number   !< Of the plate.
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(coordinate_t) :: along_r, rotation
      real(wp), allocatable :: touched(:, :)
      real(wp) :: lever
      type(plate_t) :: plate
      integer :: own

      plate = model%plates(number)
      own = find_group(model%domain%mesh, trim(plate%name))
      associate (mesh => model%domain%mesh)
         if (find_group(mesh, trim(plate%name)//SUFFIX) > 0) then
            call raise(fault, EXIT_GROUP, place_of(plate)//'the mesh has a group '''//trim(plate%name)//SUFFIX// &
                       ''' already; give the plate another name.')
            return
         end if
         if (plate%group == 0) then
            touched = plate%corners
            mesh%x(:, plate%node) = given%center
         else
            associate (boundary => mesh%groups(plate%group))
               if (size(boundary%edges, 2) == 0) then
                  call raise(fault, EXIT_GROUP, place_of(plate)//'group '''//trim(boundary%name)// &
                             ''' has no edges that could move with the plate; name a boundary.')
                  return
               end if
               touched = mesh%x(:, boundary%nodes)
            end associate
            plate%penalty = given%penalty
            call add_body(model, given%center, plate%node)
            mesh%groups(own)%nodes = [plate%node]
         end if
         lever = maxval(norm2(touched - spread(given%center, 2, size(touched, 2)), dim=1))
      end associate
      plate%coordinates(VERTICAL)%node = plate%node
      along_r = coordinate_t(AT_U_R, plate%node, mass=plate%mass, load=given%force_r, &
                             names=[character(8) :: 'u_r', 'v_r', 'a_r', 'load_r'])
      rotation = coordinate_t(AT_U_Z, unit=lever, mass=given%inertia, load=given%moment, &
                              names=[character(8) :: 'turn', 'v_turn', 'a_turn', 'moment'])
      call add_body(model, given%center, rotation%node, trim(plate%name)//SUFFIX)
      rotation%group = size(model%domain%mesh%groups)
      plate%coordinates = [plate%coordinates, along_r, rotation]
      deallocate (plate%motion)
      allocate (plate%motion, source=plane_motion_t(center=given%center, lever=lever))
      model%plates(number) = plate
      model%domain%bodies_along_r = [model%domain%bodies_along_r, plate%node]
   end subroutine free_in_plane

   !> Lets a rotation or a moment act on the unknown of the plate that it names. Fault EXIT_INPUT: there is none.
   subroutine act_on_rotation(plates, moves, one, fault)
      type(plate_t), intent(in) :: plates(:)
      logical, intent(in) :: moves   !< A rotation, else a moment.
      type(acting_t), intent(inout) :: one
      type(fault_t), intent(inout) :: fault
      integer :: i

      if (.not. one%of_body) return
      do i = 1, size(plates)
         if (plates(i)%name /= one%group_name .or. size(plates(i)%coordinates) < TURN) cycle
         associate (rotation => plates(i)%coordinates(TURN))
            one%group = rotation%group
            one%value = merge(one%value*rotation%unit, one%value/rotation%unit, moves)
            one%value_slope = merge(one%value_slope*rotation%unit, one%value_slope/rotation%unit, moves)
         end associate
         return
      end do
      if (fault%code == 0) call raise(fault, EXIT_INPUT, place_of(one)//'a rotation and a moment are those of a '// &
                                      '&plate with motion = ''plane'', and '''//trim(one%group_name)//''' is none.')
   end subroutine act_on_rotation

   !> Rotations are exact, and small ones do not vanish beside coordinates. docs/theory/contact.md section 4.
   pure function displacements(self, x0, q) result(u)
      class(plane_motion_t), intent(in) :: self
      real(wp), intent(in) :: x0(:, :), q(:)
      real(wp) :: u(2, size(x0, 2)), arm(2), less, s
      integer :: i

      s = sin(q(TURN)/self%lever)
      less = 2*sin(0.5_wp*q(TURN)/self%lever)**2   ! 1 - cos
      do i = 1, size(x0, 2)
         arm = x0(:, i) - self%center
         u(:, i) = q([ALONG_R, VERTICAL]) + [-less*arm(1) - s*arm(2), s*arm(1) - less*arm(2)]
      end do
   end function displacements

   pure function slopes(self, x0, q)
      class(plane_motion_t), intent(in) :: self
      real(wp), intent(in) :: x0(:, :), q(:)
      real(wp) :: slopes(size(q), 2*size(x0, 2)), arms(2, size(x0, 2))
      integer :: i

      arms = turned_arms(self, x0, q)
      slopes = 0.0_wp
      slopes(VERTICAL, 2::2) = 1.0_wp
      slopes(ALONG_R, 1::2) = 1.0_wp
      do i = 1, size(x0, 2)
         slopes(TURN, 2*i - 1:2*i) = [-arms(2, i), arms(1, i)]/self%lever
      end do
   end function slopes

   !> Forces turn about the centre as their arms do: a face turns on a circle.
   pure function bending(self, x0, q, force)
      class(plane_motion_t), intent(in) :: self
      real(wp), intent(in) :: x0(:, :), q(:), force(:)
      real(wp) :: bending(size(q), size(q)), arms(2, size(x0, 2))

      arms = turned_arms(self, x0, q)
      bending = 0.0_wp
      bending(TURN, TURN) = -dot_product(force, reshape(arms, [size(arms)]))/self%lever**2
   end function bending

   !> Arms from the centre to the nodes of the face, where they are now (2, nodes) [m].
   pure function turned_arms(motion, x0, q) result(arms)
      type(plane_motion_t), intent(in) :: motion
      real(wp), intent(in) :: x0(:, :), q(:)
      real(wp) :: arms(2, size(x0, 2))

      arms = x0 + motion%displacements(x0, q) - spread(motion%center + q([ALONG_R, VERTICAL]), 2, size(x0, 2))
   end function turned_arms
end module plane_plates
