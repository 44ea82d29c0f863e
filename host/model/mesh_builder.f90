! SPDX-License-Identifier: MIT
!> The mesh of a scene: read from a file, or made of graded blocks.
module mesh_builder
   use kinds, only: wp
   use faults, only: fault_t, raise
   use texts, only: short
   use exit_codes, only: EXIT_MESH
   use gmsh_reader, only: read_gmsh
   use graded_rectangle, only: graded_mesh
   use scene_refinement, only: MOST_ELEMENTS
   use scene_parts, only: place_of
   use scene_types, only: scene_mesh_t
   use split_triangles, only: split_mesh
   use triangle_mesh, only: mesh_t
   implicit none (type, external)
   private
   public :: build_mesh

contains
   !> Reads or makes the mesh; a fault names what is wrong with the file or the breaks. Fault EXIT_MESH: as of
   !> read_gmsh; breaks that do not ascend or do not fit cells and ratios; more than MOST_ELEMENTS.
   subroutine build_mesh(scene, mesh, fault)
      type(scene_mesh_t), intent(in) :: scene
      type(mesh_t), intent(out) :: mesh
      type(fault_t), intent(inout) :: fault
      type(mesh_t) :: finer
      real(wp) :: elements
      integer :: k

      if (scene%mesh_file /= '') then
         call read_gmsh(trim(scene%mesh_file), mesh, fault)
         if (fault%code /= 0) return
         mesh%x = scene%scale*mesh%x
         do k = 1, scene%splits
            call split_mesh(mesh, finer)
            mesh = finer
         end do
         return
      end if
      elements = 2*sum(real(scene%r_cells, wp))*sum(real(scene%z_cells, wp))
      associate (r => scene%r, z => scene%z)
         if (size(r) < 2 .or. size(z) < 2) then
            call raise(fault, EXIT_MESH, place_of(scene)//'&mesh needs a file, or r and z with at least two '// &
                       'breaks each.')
         else if (any([size(scene%r_cells), size(scene%r_ratio)] /= size(r) - 1) .or. &
                  any([size(scene%z_cells), size(scene%z_ratio)] /= size(z) - 1)) then
            call raise(fault, EXIT_MESH, place_of(scene)//'between n breaks there are n - 1 pieces: '// &
                       'give r_cells, z_cells (and ratios) one value a piece.')
         else if (any(r(2:) <= r(:size(r) - 1)) .or. any(z(2:) <= z(:size(z) - 1))) then
            call raise(fault, EXIT_MESH, place_of(scene)//'breaks of r and z must ascend.')
         else if (elements > MOST_ELEMENTS) then
            call raise(fault, EXIT_MESH, place_of(scene)//'r_cells, z_cells: '//short(elements)//' elements; '// &
                       'at most '//short(MOST_ELEMENTS)//'.')
         else
            call graded_mesh(r, scene%r_cells, scene%r_ratio, z, scene%z_cells, scene%z_ratio, mesh)
         end if
      end associate
   end subroutine build_mesh
end module mesh_builder
