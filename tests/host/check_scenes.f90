! SPDX-License-Identifier: MIT
!> What mud_host --check --quiet does, for every scene that standard input names, in one process: a hundred thousand
!> scenes then take minutes. Names each scene before it is read, so that a crash has a name; then exit code and message.
program check_scenes
   use, intrinsic :: iso_fortran_env, only: input_unit, output_unit
   use faults, only: fault_t
   use files, only: limits_are_errors
   use model_builder, only: build_model
   use model_types, only: model_t
   use process_settings, only: apply_process_settings
   use run_setup, only: prepare_run
   use run_state, only: run_t
   use scene_reader, only: read_scene
   use scene_types, only: scene_t
   implicit none (type, external)
   character(1000) :: file
   integer :: iostat

   call limits_are_errors()
   call apply_process_settings()
   do
      read (input_unit, '(a)', iostat=iostat) file
      if (iostat /= 0) exit
      write (output_unit, '(a)') 'scene '//trim(file)
      flush (output_unit)
      call check(trim(file))
   end do
contains
   subroutine check(file)
      character(*), intent(in) :: file
      type(scene_t) :: scene
      type(model_t), target :: model
      type(run_t) :: run
      type(fault_t) :: fault

      call read_scene(file, scene, fault)
      if (fault%code == 0) call build_model(scene, model, fault)
      if (fault%code == 0) call prepare_run(model, run, fault)
      write (output_unit, '(i0,1x,a)') fault%code, trim(fault%text)
   end subroutine check
end program check_scenes
