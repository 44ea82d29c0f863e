! SPDX-License-Identifier: MIT
!> A mesh of other fineness: built-in meshes keep their mapping, triangles of a file are split.
!> docs/theory/host.md section 12.
module scene_refinement
   use kinds, only: wp
   use faults, only: fault_t, raise, EXIT_INPUT
   use scene_parts, only: place_of
   use scene_types, only: scene_mesh_t
   use texts, only: short
   implicit none (type, external)
   private
   public :: refine_mesh, MOST_ELEMENTS

   integer, parameter :: MOST_SPLITS = 3
   real(wp), parameter :: MOST_ELEMENTS = 5.0e6_wp   !< Of a built-in mesh: entries of the matrix stay countable.
contains
   !> The mesh that its key fineness asks for. Fault EXIT_INPUT: a mesh of a file cannot be had so.
   subroutine refine_mesh(mesh, fault)
      type(scene_mesh_t), intent(inout) :: mesh
      type(fault_t), intent(inout) :: fault

      if (mesh%mesh_file == '') then
         call refine_axis(mesh%fineness, mesh%r_cells, mesh%r_ratio)
         call refine_axis(mesh%fineness, mesh%z_cells, mesh%z_ratio)
         return
      end if
      mesh%splits = nint(log(mesh%fineness)/log(2.0_wp))
      if (mesh%splits < 0 .or. mesh%splits > MOST_SPLITS .or. &
          abs(mesh%fineness - 2.0_wp**mesh%splits) > 1.0e-9_wp) call raise(fault, EXIT_INPUT, place_of(mesh)// &
         'fineness = '//short(mesh%fineness)//' of &mesh with a file; its triangles can be split once, '// &
         'twice or three times: 1, 2, 4 or 8.')
   end subroutine refine_mesh

   !> `fineness` times the cells, at least one of a piece, their sizes on the same curve.
   pure subroutine refine_axis(fineness, cells, ratio)
      real(wp), intent(in) :: fineness
      integer, intent(inout) :: cells(:)
      real(wp), intent(inout) :: ratio(:)
      integer :: other(size(cells))

      other = max(1, nint(fineness*cells))
      ratio = ratio**(real(cells, wp)/other)
      cells = other
   end subroutine refine_axis
end module scene_refinement
