! SPDX-License-Identifier: MIT
!> What the control of the time step carries from one step to the next, and what it has seen so far.
module control_state
   use kinds, only: wp
   use error_norms, only: rate_memory_t, new_memory
   use step_control, only: controller_t
   use unknown_fields, only: FIELDS
   implicit none (type, external)
   private
   public :: control_state_t, new_control_state, numbers_of, set_numbers, count_of_numbers
   public :: LIMITS, LIMIT_NAMES, BY_TIMES, BY_LARGEST, BY_SMALLEST, BY_GROWTH

   !> What kept a step from being longer: the first three in the order of the fields.
   integer, parameter :: LIMITS = 7, BY_TIMES = 4, BY_LARGEST = 5, BY_SMALLEST = 6, BY_GROWTH = 7
   character(30), parameter :: LIMIT_NAMES(LIMITS) = [character(30) :: 'error of the displacements', 'error of p_w', &
      'error of p_c', 'times that steps end at', 'dt_max', 'smallest step', 'growth of the step']
   integer, parameter :: SCALARS = 9

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

   !> Length of the list of a checkpoint.
   pure integer function count_of_numbers(state) result(n)
      type(control_state_t), intent(in) :: state   !< After new_control_state.

      n = SCALARS + FIELDS + LIMITS + size(state%x_first) + size(state%memory%rate) + size(state%memory%s_rate) &
          + size(state%touching)
   end function count_of_numbers

   !> Everything as one list, for a checkpoint. Each number in its own unit, in the order that set_numbers reads.
   pure function numbers_of(state) result(list)
      type(control_state_t), intent(in) :: state
      real(wp) :: list(count_of_numbers(state))

      associate (c => state%controller, m => state%memory)
         list = [c%dt, c%last_ratio, merge(1.0_wp, 0.0_wp, c%held), state%t_sudden, real(state%fresh, wp), &
                 state%start_up, real(state%rejected, wp), merge(1.0_wp, 0.0_wp, m%known), m%dt, state%scale, &
                 state%limits, state%touching, state%x_first, m%rate, m%s_rate]
      end associate
   end function numbers_of

   !> The state again; its arrays must have their sizes.
   subroutine set_numbers(list, state)
      real(wp), intent(in) :: list(:)   !< (count_of_numbers)
      type(control_state_t), intent(inout) :: state
      integer :: at

      associate (c => state%controller, m => state%memory)
         c%dt = list(1)
         c%last_ratio = list(2)
         c%held = list(3) > 0.5_wp
         state%t_sudden = list(4)
         state%fresh = nint(list(5))
         state%start_up = list(6)
         state%rejected = nint(list(7))
         m%known = list(8) > 0.5_wp
         m%dt = list(9)
         at = SCALARS
         call take_row(state%scale)
         call take_row(state%limits)
         call take_row(state%touching)
         call take(state%x_first)
         call take(m%rate)
         call take_row(m%s_rate)
      end associate
   contains
      subroutine take_row(values)
         real(wp), intent(inout) :: values(:)

         values = list(at + 1:at + size(values))
         at = at + size(values)
      end subroutine take_row

      subroutine take(values)
         real(wp), intent(inout) :: values(:, :)

         values = reshape(list(at + 1:at + size(values)), shape(values))
         at = at + size(values)
      end subroutine take
   end subroutine set_numbers
end module control_state
