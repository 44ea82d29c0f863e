! SPDX-License-Identifier: MIT
!> Runs of a scene with another mesh, other steps or another tolerance of Newton's method: how one is made.
!> docs/theory/host.md section 12.
module level_runs
   use kinds, only: wp
   use pilot_runs, only: pilot_t
   use scene_types, only: scene_t
   implicit none (type, external)
   private
   public :: level_key_t, level_run_t, level_runner_t

   !> A run by what was changed of the scene.
   type :: level_key_t
      real(wp) :: mesh = 0.0_wp       !< Times its cells along each axis.
      real(wp) :: fineness = 1.0_wp   !< Times its accuracy, or its steps.
      real(wp) :: newton = 1.0_wp     !< Times Newton's tolerance.
      integer :: level = 0            !< Number of its mesh; 0: a pilot of steps or of Newton's method.
   end type level_key_t

   type, extends(level_key_t) :: level_run_t
      type(pilot_t) :: pilot
   end type level_run_t

   type, abstract :: level_runner_t
   contains
      procedure(run_i), deferred :: run
   end type level_runner_t

   abstract interface
      !> One run of a scene on a mesh.
      subroutine run_i(self, scene, level, most_seconds, pilot)
         import :: level_runner_t, scene_t, pilot_t, wp
         class(level_runner_t), intent(inout) :: self
         type(scene_t), intent(in) :: scene
         integer, intent(in) :: level           !< Number of its mesh.
         real(wp), intent(in) :: most_seconds   !< Wall time that it may take [s].
         type(pilot_t), intent(out) :: pilot
      end subroutine run_i
   end interface
end module level_runs
