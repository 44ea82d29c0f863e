! SPDX-License-Identifier: MIT
!> The mesh of a scene, &mesh: read from a file, or made of graded blocks; at another fineness built-in meshes keep
!> their mapping, triangles of a file are split. docs/theory/host.md section 12.
module mesh_builder
   use kinds, only: wp
   use exit_codes, only: EXIT_MESH
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use files, only: beside
   use gmsh_reader, only: read_gmsh
   use graded_rectangle, only: graded_mesh, blocks_t
   use key_schema, only: UNBOUNDED
   use key_table, only: key_table_t
   use model_types, only: model_t
   use split_triangles, only: split_mesh
   use texts, only: short, LENGTH
   use triangle_mesh, only: mesh_t
   implicit none (type, external)
   private
   public :: build_mesh

   integer, parameter :: MOST_SPLITS = 3
   real(wp), parameter :: MOST_ELEMENTS = 5.0e6_wp   !< Of a built-in mesh: entries of the matrix stay countable.
contains
   !> Builds the &mesh. Fault EXIT_INPUT: a mesh of a file cannot be had so fine. EXIT_MESH: as of read_gmsh; breaks
   !> that do not ascend or do not fit cells and ratios; more than MOST_ELEMENTS.
   subroutine build_mesh(k, model, fault)
      type(key_table_t), intent(inout) :: k
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(blocks_t) :: r, z
      character(LENGTH) :: file
      character(:), allocatable :: place
      real(wp) :: scale, fineness

      file = ''
      scale = 1.0_wp
      fineness = -1.0_wp
      call k%text('file', file, 'Gmsh 4.1 text mesh, relative to the scene; or r and z:')
      call k%number('scale', scale, 1.0e-9_wp, 1.0e9_wp, &
                    'factor on the coordinates of the file; 1e-3: they are in mm', '+file')
      call take_blocks('r', r)
      call take_blocks('z', z)
      call k%number('fineness', fineness, 0.01_wp, 64.0_wp, 'times as many cells along each axis; of a file 1, 2, 4, 8')
      if (k%lists) return
      place = at_line(k%group%file, k%group%line)
      if (file == '') then
         call make_blocks(place, fineness, r, z, model%domain%mesh, fault)
      else
         call read_file(place, beside(trim(k%group%file), trim(file)), scale, fineness, model%domain%mesh, fault)
      end if
   contains
      subroutine take_blocks(axis, blocks)
         character(1), intent(in) :: axis
         type(blocks_t), intent(out) :: blocks

         call k%numbers(axis, blocks%breaks, -UNBOUNDED, UNBOUNDED, 'breaks along '//axis//' [m], ascending', '-file')
         call k%wholes(axis//'_cells', blocks%cells, 1, 100000, 'cells between two breaks of '//axis, '-file')
         call k%numbers(axis//'_ratio', blocks%ratio, 0.01_wp, 100.0_wp, &
                        'size of a cell over that of the previous one; default 1', '-file')
         if (size(blocks%ratio) == 0) blocks%ratio = spread(1.0_wp, 1, size(blocks%cells))
      end subroutine take_blocks
   end subroutine build_mesh

   !> Reads the mesh of a file; fineness is that of the scene, if it is > 0.
   subroutine read_file(place, file, scale, fineness, mesh, fault)
      character(*), intent(in) :: place, file
      real(wp), intent(in) :: scale, fineness
      type(mesh_t), intent(out) :: mesh
      type(fault_t), intent(inout) :: fault
      type(mesh_t) :: finer
      integer :: splits, i

      splits = 0
      if (fineness > 0.0_wp) then
         splits = nint(log(fineness)/log(2.0_wp))
         if (splits < 0 .or. splits > MOST_SPLITS .or. abs(fineness - 2.0_wp**splits) > 1.0e-9_wp) then
            call raise(fault, EXIT_INPUT, place//'fineness = '//short(fineness)//' of &mesh with a file; its '// &
                       'triangles can be split once, twice or three times: 1, 2, 4 or 8.')
            return
         end if
      end if
      call read_gmsh(file, mesh, fault)
      if (fault%code /= 0) return
      mesh%x = scale*mesh%x
      do i = 1, splits
         call split_mesh(mesh, finer)
         mesh = finer
      end do
   end subroutine read_file

   !> Makes the built-in mesh; fineness is that of the scene, if it is > 0.
   subroutine make_blocks(place, fineness, r, z, mesh, fault)
      character(*), intent(in) :: place
      real(wp), intent(in) :: fineness
      type(blocks_t), intent(inout) :: r, z
      type(mesh_t), intent(out) :: mesh
      type(fault_t), intent(inout) :: fault
      real(wp) :: elements

      if (size(r%breaks) < 2 .or. size(z%breaks) < 2) then
         call raise(fault, EXIT_MESH, place//'&mesh needs a file, or r and z with at least two breaks each.')
      else if (.not. (fits(r) .and. fits(z))) then
         call raise(fault, EXIT_MESH, place//'between n breaks there are n - 1 pieces: '// &
                    'give r_cells, z_cells (and ratios) one value a piece.')
      else if (.not. (ascends(r%breaks) .and. ascends(z%breaks))) then
         call raise(fault, EXIT_MESH, place//'breaks of r and z must ascend.')
      end if
      if (fault%code /= 0) return
      if (fineness > 0.0_wp) call refine(fineness, r)
      if (fineness > 0.0_wp) call refine(fineness, z)
      elements = 2*sum(real(r%cells, wp))*sum(real(z%cells, wp))
      if (elements > MOST_ELEMENTS) then
         call raise(fault, EXIT_MESH, place//'r_cells, z_cells: '//short(elements)//' elements; at most '// &
                    short(MOST_ELEMENTS)//'.')
         return
      end if
      call graded_mesh(r, z, mesh)
   end subroutine make_blocks

   pure logical function fits(blocks)
      type(blocks_t), intent(in) :: blocks

      fits = all([size(blocks%cells), size(blocks%ratio)] == size(blocks%breaks) - 1)
   end function fits

   pure logical function ascends(breaks)
      real(wp), intent(in) :: breaks(:)

      ascends = all(breaks(2:) > breaks(:size(breaks) - 1))
   end function ascends

   !> Makes `fineness` times the cells, at least one of a piece, whose sizes stay on the same curve.
   pure subroutine refine(fineness, blocks)
      real(wp), intent(in) :: fineness
      type(blocks_t), intent(inout) :: blocks
      integer :: other(size(blocks%cells))

      other = max(1, nint(fineness*blocks%cells))
      blocks%ratio = blocks%ratio**(real(blocks%cells, wp)/other)
      blocks%cells = other
   end subroutine refine
end module mesh_builder
