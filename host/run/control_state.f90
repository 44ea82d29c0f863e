! SPDX-License-Identifier: MIT
!> What the control of the time step carries from one step to the next, and what it has seen so far.
module control_state
   use kinds, only: wp
   use error_norms, only: rate_memory_t, new_memory
   use step_control, only: controller_t
   use unknown_fields, only: FIELDS
   implicit none (type, external)
   private
   public :: control_state_t, new_control_state
   public :: LIMITS, LIMIT_NAMES, BY_TIMES, BY_LARGEST, BY_SMALLEST, BY_GROWTH

   !> What kept a step from being longer: the first three in the order of the fields.
   integer, parameter :: LIMITS = 7, BY_TIMES = 4, BY_LARGEST = 5, BY_SMALLEST = 6, BY_GROWTH = 7
   character(30), parameter :: LIMIT_NAMES(LIMITS) = [character(30) :: 'error of the displacements', 'error of p_w', &
      'error of p_c', 'times that steps end at', 'dt_max', 'smallest step', 'growth of the step']

   type :: control_state_t
      type(controller_t) :: controller
      type(rate_memory_t) :: memory
      real(wp) :: t_sudden = 0.0_wp              !< Time of the last sudden change [s].
      integer :: fresh = 0                       !< Accepted steps since then.
      real(wp) :: start_up = 0.0_wp              !< Span in which changes are expected to grow yet [s].
      integer :: rejected = 0                    !< Steps repeated because of their error, in the whole run.
      real(wp) :: error = 0.0_wp                 !< Of the last controlled step, share of the change of its field [-].
      real(wp) :: scale(FIELDS) = 0.0_wp         !< Largest change of the fields in the run [m, kPa].
      real(wp) :: limits(LIMITS) = 0.0_wp        !< Steps by what kept them short.
      logical :: located = .false.               !< The attempt before was repeated to end where a contact closes.
      real(wp), allocatable :: touching(:)       !< 1: the contact was closed at the start of the step, else 0.
      real(wp), allocatable :: x_first(:, :)     !< Unknowns at the start of the stage.
   end type control_state_t
contains
   !> State of a control that has taken no step; what `before` has counted goes on.
   pure function new_control_state(nodes, points, contacts, before) result(state)
      integer, intent(in) :: nodes, points, contacts   !< Nodes, quadrature points, contacts.
      type(control_state_t), intent(in), optional :: before
      type(control_state_t) :: state

      state%memory = new_memory(FIELDS, nodes, points)
      allocate (state%x_first(FIELDS, nodes), source=0.0_wp)
      allocate (state%touching(contacts), source=0.0_wp)
      if (.not. present(before)) return
      state%rejected = before%rejected
      state%limits = before%limits
   end function new_control_state
end module control_state
