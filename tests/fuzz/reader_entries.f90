! SPDX-License-Identifier: MIT
!> The readers of the programs as C functions for the fuzzer: 0 read, 1 refused; a refusal without a sentence ends the
!> process.
module reader_entries
   use, intrinsic :: iso_c_binding, only: c_int, c_char
   use faults, only: fault_t
   use gmsh_reader, only: read_gmsh
   use kinds, only: wp
   use model_builder, only: build_model
   use model_types, only: model_t
   use number_pairs, only: read_pairs
   use scene_reader, only: read_scene
   use scene_types, only: scene_t
   use triangle_mesh, only: mesh_t
   use triax_case, only: read_case, case_t
   implicit none (type, external)
   private
   public :: fuzz_scene, fuzz_case, fuzz_mesh, fuzz_pairs
contains
   integer(c_int) function outcome(fault)
      type(fault_t), intent(in) :: fault

      outcome = merge(1_c_int, 0_c_int, fault%code /= 0)
      if (fault%code /= 0 .and. len_trim(fault%text) < 12) error stop 'a refusal without a sentence'
   end function outcome

   function text_of(path, n) result(text)
      integer(c_int), intent(in) :: n
      character(kind=c_char), intent(in) :: path(n)
      character(n) :: text
      integer :: i

      do i = 1, n
         text(i:i) = path(i)
      end do
   end function text_of

   integer(c_int) function fuzz_scene(path, n) bind(c)
      integer(c_int), value :: n
      character(kind=c_char), intent(in) :: path(n)
      type(scene_t) :: scene
      type(model_t) :: model
      type(fault_t) :: fault

      call read_scene(text_of(path, n), scene, fault)
      if (fault%code == 0) call build_model(scene, model, fault)
      fuzz_scene = outcome(fault)
   end function fuzz_scene

   integer(c_int) function fuzz_case(path, n) bind(c)
      integer(c_int), value :: n
      character(kind=c_char), intent(in) :: path(n)
      type(case_t) :: test
      type(fault_t) :: fault

      call read_case(text_of(path, n), '', '', test, fault)
      fuzz_case = outcome(fault)
   end function fuzz_case

   integer(c_int) function fuzz_mesh(path, n) bind(c)
      integer(c_int), value :: n
      character(kind=c_char), intent(in) :: path(n)
      type(mesh_t) :: mesh
      type(fault_t) :: fault

      call read_gmsh(text_of(path, n), mesh, fault)
      fuzz_mesh = outcome(fault)
      if (fault%code /= 0) return
      if (any(mesh%t6 < 1) .or. any(mesh%t6 > size(mesh%x, 2))) error stop 'a mesh whose elements have no nodes'
   end function fuzz_mesh

   integer(c_int) function fuzz_pairs(path, n) bind(c)
      integer(c_int), value :: n
      character(kind=c_char), intent(in) :: path(n)
      real(wp), allocatable :: first(:), second(:)
      type(fault_t) :: fault

      call read_pairs(text_of(path, n), '/scene.nml', 1, 'a time and a factor', first, second, fault)
      fuzz_pairs = outcome(fault)
      if (fault%code /= 0) return
      if (size(first) /= size(second)) error stop 'pairs that are none'
   end function fuzz_pairs
end module reader_entries
