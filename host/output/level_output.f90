! SPDX-License-Identifier: MIT
!> Runs on finer and finer meshes with all their files: each in a folder of its own, a table of the meshes beside them.
!> docs/theory/host.md section 12.
module level_output
   use, intrinsic :: iso_fortran_env, only: output_unit
   use answer_errors, only: worst_unknown, write_answers
   use csv, only: csv_t, new_csv, write_row, close_csv, quoted
   use faults, only: fault_t
   use files, only: make_folder
   use force_answers, only: force_answer_t, list_forces
   use kinds, only: wp
   use level_store, only: write_levels
   use mesh_levels, only: level_reporter_t, words_of_error
   use model_types, only: model_t
   use pilot_runs, only: pilot_t, run_observed_pilot
   use price_estimates, only: answer_t, bound_of, worst_answer, STATE_WORDS
   use run_output, only: run_output_t
   use run_state, only: run_t
   use scene_price, only: price_t
   use scene_types, only: scene_t, FINGERPRINT_LENGTH
   use texts, only: whole
   use unknown_fields, only: DISPLACEMENTS
   implicit none (type, external)
   private
   public :: level_output_t, folder_of_mesh

   integer, parameter :: MOST_LEVELS = 20

   !> Runs with files: `folder`/mesh_1, mesh_2, and so on, levels.csv and levels.h5 in `folder`.
   type, extends(level_reporter_t) :: level_output_t
      character(:), allocatable :: folder
      character(FINGERPRINT_LENGTH) :: fingerprint = ''   !< Of the scene.
      logical :: quiet = .false.
      integer, private :: at = 0                    !< Level that model and run below belong to; 0: none.
      type(model_t), private :: model
      type(run_t), private :: run_of_level
      integer, private :: known = 0                 !< Levels of the table so far.
      type(answer_t), private :: worst(MOST_LEVELS)
   contains
      procedure :: run => run_with_files
      procedure :: judged => write_level
   end type level_output_t
contains
   !> Where the files of a mesh are.
   pure function folder_of_mesh(folder, level) result(path)
      character(*), intent(in) :: folder
      integer, intent(in) :: level
      character(:), allocatable :: path

      path = folder//'/mesh_'//whole(level)
   end function folder_of_mesh

   subroutine run_with_files(self, scene, level, most_seconds, pilot)
      class(level_output_t), intent(inout) :: self
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: level
      real(wp), intent(in) :: most_seconds
      type(pilot_t), intent(out) :: pilot
      type(run_output_t) :: output

      self%at = level
      output%folder = folder_of_mesh(self%folder, level)
      output%quiet = self%quiet
      call run_observed_pilot(scene, huge(1.0_wp), self%model, self%run_of_level, pilot, most_seconds, output)
   end subroutine run_with_files

   !> answers.csv of the last mesh, the table of meshes, and what a restart needs. Fault EXIT_OUTPUT: one cannot be
   !> written.
   subroutine write_level(self, price, fault)
      class(level_output_t), intent(inout) :: self
      type(price_t), intent(in) :: price
      type(fault_t), intent(inout) :: fault
      type(force_answer_t), allocatable :: forces(:)
      integer :: n

      n = size(price%levels)
      self%known = n
      self%worst(n) = price%answers(worst_answer(price%answers))
      if (self%at == n) then
         associate (control => self%run_of_level%control, model => self%model)
            call list_forces(folder_of_mesh(self%folder, n), model, worst_unknown(model, control), &
                             maxval(self%run_of_level%assembly%scale, mask=model%dofs%field <= DISPLACEMENTS), forces, &
                             fault)
            if (fault%code == 0) call write_answers(folder_of_mesh(self%folder, n), model, control, forces, &
                                                    price%answers, fault)
         end associate
      end if
      if (.not. self%quiet) write (output_unit, '(a)') 'So far '//words_of_error(price)//'.'
      if (fault%code == 0) call make_folder(self%folder)
      if (fault%code == 0) call write_table(self, price, fault)
      if (fault%code == 0) call write_levels(self%folder, self%fingerprint, price%made, fault)
   end subroutine write_level

   !> levels.csv: a row a mesh, with the worst goal; empty where nothing is known. Fault EXIT_OUTPUT: it cannot be
   !> written.
   subroutine write_table(self, price, fault)
      class(level_output_t), intent(in) :: self
      type(price_t), intent(in) :: price
      type(fault_t), intent(inout) :: fault
      type(csv_t) :: table
      integer :: k, at

      call new_csv(self%folder//'/levels.csv', 'level,mesh,steps_times,newton_times,elements,unknowns,steps,'// &
                   'iterations,cuts,seconds,error,mesh_error,steps_error,newton_error,answer,mesh_state', table, fault)
      do k = 1, self%known
         if (fault%code /= 0) exit
         associate (l => price%levels(k), p => price%levels(k)%pilot, a => self%worst(k))
            write (table%row, '(i0,3(",",es14.6e3),5(",",i0),",",es14.6e3)') k, l%mesh, l%fineness, l%newton, &
               p%elements, p%unknowns, p%steps, p%iterations, p%cuts, p%seconds
            at = len_trim(table%row)
            if (a%name == '') then
               table%row(at + 1:) = ',,,,,,not estimated'
            else
               write (table%row(at + 1:), '(4(",",es14.6e3),2(",",a))') bound_of(a), a%mesh, a%steps, a%newton, &
                  quoted(trim(a%name)), trim(STATE_WORDS(a%state))
            end if
         end associate
         call write_row(table, fault)
      end do
      call close_csv(table, fault)
   end subroutine write_table
end module level_output
