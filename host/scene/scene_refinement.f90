! SPDX-License-Identifier: MIT
!> A scene on a mesh of other fineness: built-in meshes keep their mapping, triangles of a file are split.
!> docs/theory/host.md section 12.
module scene_refinement
   use kinds, only: wp
   use faults, only: fault_t, raise, EXIT_INPUT
   use scene_types, only: scene_t, scene_mesh_t, place_of
   use texts, only: short
   implicit none (type, external)
   private
   public :: refine_scene, refinement, cells_allow, elements_at, finest_of, MOST_ELEMENTS

   integer, parameter :: MOST_SPLITS = 3
   real(wp), parameter :: MOST_FINENESS = 64.0_wp    !< Bound of the key.
   real(wp), parameter :: MOST_ELEMENTS = 5.0e6_wp   !< Of a built-in mesh: entries of the matrix stay countable.
   integer, parameter :: LEAST_CELLS = 4   !< Of a piece that keeps its grading with a quarter of them.
contains
   !> A scene on the mesh that its key fineness asks for. Fault EXIT_INPUT: a mesh of a file cannot be had so.
   subroutine refine_scene(scene, fault)
      type(scene_t), intent(inout) :: scene
      type(fault_t), intent(inout) :: fault

      associate (mesh => scene%mesh)
         if (mesh%mesh_file /= '') then
            mesh%splits = nint(log(mesh%fineness)/log(2.0_wp))
            if (mesh%splits < 0 .or. mesh%splits > MOST_SPLITS .or. &
                abs(mesh%fineness - 2.0_wp**mesh%splits) > 1.0e-9_wp) call raise(fault, EXIT_INPUT, place_of(mesh)// &
               'fineness = '//short(mesh%fineness)//' of &mesh with a file; its triangles can be split once, '// &
               'twice or three times: 1, 2, 4 or 8.')
            return
         end if
         call put_breaks_at_points(scene)
         call refine_axis(mesh%fineness, mesh%r_cells, mesh%r_ratio)
         call refine_axis(mesh%fineness, mesh%z_cells, mesh%z_ratio)
      end associate
   end subroutine refine_scene

   !> Elements of a scene's mesh with `fineness` times its cells, over those that it has. [-]
   pure real(wp) function elements_at(fineness, mesh) result(times)
      real(wp), intent(in) :: fineness
      type(scene_mesh_t), intent(in) :: mesh

      times = fineness**2
      if (mesh%mesh_file == '') times = real(sum(cells_at(fineness, mesh%r_cells)), wp)*sum(cells_at(fineness, &
         mesh%z_cells))/(real(sum(mesh%r_cells), wp)*sum(mesh%z_cells))
   end function elements_at

   !> Largest fineness that a mesh of the scene can have.
   pure real(wp) function finest_of(mesh)
      type(scene_mesh_t), intent(in) :: mesh

      finest_of = 2.0_wp**MOST_SPLITS
      if (mesh%mesh_file == '') finest_of = min(MOST_FINENESS, &
         sqrt(MOST_ELEMENTS/(2.0_wp*sum(mesh%r_cells)*sum(mesh%z_cells))))
   end function finest_of

   !> Breaks at the points of a scene, so that every mesh has nodes there; pieces keep their numbers. Meshes of files
   !> have the same nodes after splitting. Points outside the mesh stay as they are.
   subroutine put_breaks_at_points(scene)
      type(scene_t), intent(inout) :: scene
      integer :: i

      if (scene%mesh%mesh_file /= '') return
      do i = 1, size(scene%points)
         call put_break(scene%points(i)%x(1), scene%mesh%r, scene%mesh%r_cells, scene%mesh%r_ratio, scene%mesh%r_number)
         call put_break(scene%points(i)%x(2), scene%mesh%z, scene%mesh%z_cells, scene%mesh%z_ratio, scene%mesh%z_number)
      end do
   end subroutine put_breaks_at_points

   !> A break at x between two cells, where the mesh has its nearest end of a cell.
   subroutine put_break(x, breaks, cells, ratio, number)
      real(wp), intent(in) :: x   !< [m]
      real(wp), allocatable, intent(inout) :: breaks(:), ratio(:)
      integer, allocatable, intent(inout) :: cells(:), number(:)
      real(wp), parameter :: SAME = 1.0e-9_wp
      real(wp) :: share
      integer :: p, first

      if (size(cells) /= size(breaks) - 1) return
      if (any(abs(breaks - x) <= SAME*(maxval(breaks) - minval(breaks)))) return
      p = count(breaks < x)
      if (p == 0 .or. p == size(breaks)) return
      share = (x - breaks(p))/(breaks(p + 1) - breaks(p))
      ! Ends of cells: share = (ratio**k - 1)/(ratio**cells - 1).
      if (abs(ratio(p) - 1) > SAME) then
         first = nint(log(1 + share*(ratio(p)**cells(p) - 1))/log(ratio(p)))
      else
         first = nint(share*cells(p))
      end if
      first = max(1, min(cells(p) - 1, first))
      breaks = [breaks(:p), x, breaks(p + 1:)]
      ! A single cell becomes two: on finer meshes another node would be the nearest one.
      cells = [cells(:p - 1), first, max(1, cells(p) - first), cells(p + 1:)]
      ratio = [ratio(:p), ratio(p:)]
      number = [number(:p), number(p:)]
   end subroutine put_break

   !> Whether a quarter of the cells leaves every piece its grading.
   pure logical function cells_allow(mesh)
      type(scene_mesh_t), intent(in) :: mesh

      cells_allow = mesh%mesh_file == ''
      if (cells_allow) cells_allow = all(pack(mesh%r_cells, mesh%r_cells > 1) >= LEAST_CELLS) .and. &
                                     all(pack(mesh%z_cells, mesh%z_cells > 1) >= LEAST_CELLS)
   end function cells_allow

   !> Cells of a piece. At least one.
   elemental integer function cells_at(fineness, cells)
      real(wp), intent(in) :: fineness
      integer, intent(in) :: cells

      cells_at = max(1, nint(fineness*cells))
   end function cells_at

   !> `fineness` times the cells, their sizes on the same curve.
   pure subroutine refine_axis(fineness, cells, ratio)
      real(wp), intent(in) :: fineness
      integer, intent(inout) :: cells(:)
      real(wp), intent(inout) :: ratio(:)
      integer :: other(size(cells))

      other = cells_at(fineness, cells)
      ratio = ratio**(real(cells, wp)/other)
      cells = other
   end subroutine refine_axis

   !> How many times as many cells an axis of the finer mesh has: geometric mean of the pieces that differ, 1 where none
   !> does. [-]
   pure real(wp) function refinement(coarse, fine)
      type(scene_mesh_t), intent(in) :: coarse, fine
      real(wp), allocatable :: ratios(:)

      if (coarse%mesh_file /= '') then
         refinement = 2.0_wp**(fine%splits - coarse%splits)
         return
      end if
      ratios = real([fine%r_cells, fine%z_cells], wp)/[coarse%r_cells, coarse%z_cells]
      ratios = pack(ratios, [fine%r_cells, fine%z_cells] /= [coarse%r_cells, coarse%z_cells])
      refinement = 1.0_wp
      if (size(ratios) > 0) refinement = product(ratios)**(1.0_wp/size(ratios))
   end function refinement
end module scene_refinement
