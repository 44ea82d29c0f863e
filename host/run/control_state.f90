! SPDX-License-Identifier: MIT
!> Control of the time step: its memory from one step to the next, and what it has seen so far.
module control_state
   use archive, only: archive_t
   use kinds, only: wp
   use error_norms, only: rate_memory_t, new_memory, exchange_memory
   use step_control, only: controller_t, exchange_controller
   use unknown_fields, only: FIELDS
   implicit none (type, external)
   private
   public :: control_state_t, new_control_state, exchange_control
   public :: LIMITS, LIMIT_NAMES, BY_TIMES, BY_LARGEST, BY_SMALLEST, BY_GROWTH

   !> Limits that keep a step from being longer: the first three in the order of the fields.
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
      real(wp) :: error = 0.0_wp                 !< Error of the last controlled step over the change of its field [-].
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

   !> Exchanges a control, made by new_control_state, with an archive.
   subroutine exchange_control(control, archive)
      type(control_state_t), intent(inout) :: control
      class(archive_t), intent(inout) :: archive

      call archive%enter('control')
      call exchange_controller(control%controller, archive)
      call exchange_memory(control%memory, archive)
      call archive%exchange('t_sudden', control%t_sudden, 's', 'time of the last sudden change')
      call archive%exchange('fresh', control%fresh, '-', 'accepted steps since then', least=0)
      call archive%exchange('start_up', control%start_up, 's', 'span in which changes are expected to grow yet')
      call archive%exchange('rejected', control%rejected, '-', &
                            'steps repeated because of their error, in the whole run', least=0)
      call archive%exchange('scale', control%scale, 'm, kPa', 'largest change of every field in the run')
      call archive%exchange('limits', control%limits, '-', 'steps by what kept them short')
      call archive%exchange('touching', control%touching, '-', 'whether a contact was closed at the start of the step')
      call archive%exchange('x_first', control%x_first, 'm, kPa', 'unknowns at the start of the stage')
      call archive%leave('control')
   end subroutine exchange_control
end module control_state
