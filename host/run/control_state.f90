! SPDX-License-Identifier: MIT
!> What the control of the time step carries from one step to the next, and what it has seen so far.
module control_state
   use kinds, only: wp
   use error_norms, only: rate_memory_t, new_memory
   use step_control, only: controller_t
   use unknown_fields, only: FIELDS, DISPLACEMENTS
   implicit none (type, external)
   private
   public :: control_state_t, new_control_state, is_answer, numbers_of, set_numbers, count_of_numbers, LEAST_PRESSURE
   public :: LIMITS, LIMIT_NAMES, BY_DISPLACEMENTS, BY_PRESSURE, BY_SUCTION, BY_TIMES, BY_LARGEST, BY_SMALLEST, &
             BY_GROWTH

   !> What kept a step from being longer.
   integer, parameter :: LIMITS = 7
   integer, parameter :: BY_DISPLACEMENTS = 1, BY_PRESSURE = 2, BY_SUCTION = 3, BY_TIMES = 4, BY_LARGEST = 5, &
                         BY_SMALLEST = 6, BY_GROWTH = 7
   character(30), parameter :: LIMIT_NAMES(LIMITS) = [character(30) :: 'error of the displacements', 'error of p_w', &
      'error of p_c', 'times that steps end at', 'dt_max', 'smallest step', 'growth of the step']
   integer, parameter :: SCALARS = 12
   !> Share of the root mean square change of its field below which a change is no answer: triangles that are not
   !> symmetric make as much of a displacement across where there is none.
   real(wp), parameter :: LEAST_SHARE = 1.0e-3_wp
   real(wp), parameter :: LEAST_PRESSURE = 0.01_wp   !< Smaller changes of pressures are no answers [kPa].

   type :: control_state_t
      type(controller_t) :: controller
      type(rate_memory_t) :: memory
      real(wp) :: t_sudden = 0.0_wp              !< Time of the last sudden change [s].
      integer :: fresh = 0                       !< Accepted steps since then.
      real(wp) :: start_up = 0.0_wp              !< Span in which changes are expected to grow yet [s].
      integer :: rejected = 0                    !< Steps repeated because of their error, in the whole run.
      real(wp) :: scale(FIELDS) = 0.0_wp         !< Largest change of the fields in the run [m, kPa].
      real(wp) :: gathered(FIELDS) = 0.0_wp      !< Error of the fields that the steps have left [m, kPa].
      real(wp) :: ripple(FIELDS) = 0.0_wp        !< Of the largest that alternates, as far as it has not faded.
      real(wp) :: largest(FIELDS) = 0.0_wp       !< The largest so far.
      real(wp) :: unseen(FIELDS) = 0.0_wp        !< Change in steps whose error nothing estimates [m, kPa]: of
                                                 !< displacements where the material has a memory, of pressures
                                                 !< in a stage of one step.
      real(wp) :: limits(LIMITS) = 0.0_wp        !< Steps by what kept them short.
      real(wp) :: damped_0 = 0.0_wp              !< Dissipated by damping where the stage began [kJ].
      real(wp) :: motion = 0.0_wp                !< Kinetic energy over the time of the stage [kJ s].
      real(wp), allocatable :: touching(:)       !< 1: the contact was closed at the start of the step, else 0.
      logical :: located = .false.               !< The attempt before was repeated to end where a contact closes.
      ! Of the fields at the named points, (FIELDS, points).
      real(wp), allocatable :: low(:, :), high(:, :), point_gathered(:, :), point_largest(:, :)
      real(wp), allocatable :: point_ripple(:, :)   !< The same of what alternates.
      real(wp), allocatable :: error_before(:, :)   !< (FIELDS, nodes) of the last step of a motion [m, kPa].
      real(wp), allocatable :: newton(:, :)      !< What Newton's method has left at them [m, kPa].
      real(wp), allocatable :: x_first(:, :)     !< Unknowns at the start of the stage.
   end type control_state_t
contains
   !> State of a control that has taken no step.
   pure function new_control_state(nodes, points, named, contacts) result(state)
      integer, intent(in) :: nodes, points, named, contacts   !< Nodes, quadrature points, named points, contacts.
      type(control_state_t) :: state

      state%memory = new_memory(FIELDS, nodes, points)
      allocate (state%x_first(FIELDS, nodes), source=0.0_wp)
      allocate (state%touching(contacts), source=0.0_wp)
      allocate (state%low(FIELDS, named), source=huge(1.0_wp))
      allocate (state%high(FIELDS, named), source=-huge(1.0_wp))
      allocate (state%point_gathered(FIELDS, named), state%point_largest(FIELDS, named), source=0.0_wp)
      allocate (state%point_ripple(FIELDS, named), state%error_before(FIELDS, nodes), source=0.0_wp)
      allocate (state%newton(FIELDS, named), source=0.0_wp)
   end function new_control_state

   !> Whether a change is large enough to be judged.
   pure logical function is_answer(control, field, change)
      type(control_state_t), intent(in) :: control
      integer, intent(in) :: field
      real(wp), intent(in) :: change   !< [m or kPa]

      is_answer = change > LEAST_SHARE*control%scale(field) .and. (field <= DISPLACEMENTS .or. change > LEAST_PRESSURE)
   end function is_answer

   !> Length of the list of a checkpoint.
   pure integer function count_of_numbers(state) result(n)
      type(control_state_t), intent(in) :: state   !< After new_control_state.

      n = SCALARS + 5*FIELDS + LIMITS + size(state%x_first) + size(state%memory%rate) &
          + size(state%error_before) + size(state%memory%s_rate) + 6*size(state%low) + size(state%touching)
   end function count_of_numbers

   !> Everything as one list, for a checkpoint. Each number in its own unit, in the order that set_numbers reads.
   pure function numbers_of(state) result(list)
      type(control_state_t), intent(in) :: state
      real(wp) :: list(count_of_numbers(state))

      associate (c => state%controller, m => state%memory)
         list = [c%dt, c%last_ratio, merge(1.0_wp, 0.0_wp, c%held), state%t_sudden, real(state%fresh, wp), &
                 state%start_up, real(state%rejected, wp), merge(1.0_wp, 0.0_wp, m%known), m%dt, &
                 m%span, state%damped_0, state%motion, state%unseen, state%scale, state%gathered, &
                 state%ripple, state%largest, state%limits, state%touching, state%x_first, m%rate, m%s_rate, &
                 state%low, state%high, state%point_gathered, state%point_ripple, state%point_largest, state%newton, &
                 state%error_before]
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
         m%span = list(10)
         state%damped_0 = list(11)
         state%motion = list(12)
         at = SCALARS
         call take_row(state%unseen)
         call take_row(state%scale)
         call take_row(state%gathered)
         call take_row(state%ripple)
         call take_row(state%largest)
         call take_row(state%limits)
         call take_row(state%touching)
         call take(state%x_first)
         call take(m%rate)
         call take_row(m%s_rate)
         call take(state%low)
         call take(state%high)
         call take(state%point_gathered)
         call take(state%point_ripple)
         call take(state%point_largest)
         call take(state%newton)
         call take(state%error_before)
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
