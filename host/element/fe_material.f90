!> What an element needs of a skeleton: a strain and a change of suction in, effective stress and its slopes out.
!> Conventions are those of mud.h: tension positive, components 11, 22, 33, 12, 13, 23 = rr, zz, tt, rz, 0, 0,
!> engineering shear, suction p_c = p_a - p_w. A new law extends material_t; the element code does not change.
module fe_material
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: material_t, slot_t, answer_t, TOO_LARGE

   integer, parameter :: TOO_LARGE = 1000   !< Code of a strain beyond 1 in a step: no law is asked.

   !> Answer to one increment. On failure (code /= 0) only code, factor and text are of use.
   type :: answer_t
      real(wp) :: stress(6) = 0.0_wp          !< Effective stress at the end [kPa].
      real(wp) :: slope(4, 4) = 0.0_wp        !< d stress/d strain of rr, zz, tt, rz [kPa].
      real(wp) :: slope_suction(4) = 0.0_wp   !< d stress/d suction [-].
      integer :: code = 0
      real(wp) :: factor = 0.5_wp             !< Suggested factor on the time step after a failure.
      integer :: rate_evaluations = 0                   !< Rate evaluations.
   end type answer_t

   type, abstract :: material_t
      integer :: n_state = 0   !< State variables a point.
      logical :: stored = .false.   !< True if the stress has an energy (elastic laws).
   contains
      procedure(start_i), deferred :: start
      procedure(update_i), deferred :: update
      procedure(explain_i), deferred :: explain
      procedure(check_void_i), deferred :: initial_void_ratio
   end type material_t

   !> Holds one law of a list of different ones.
   type :: slot_t
      character(64) :: name = ''
      class(material_t), allocatable :: law
   end type slot_t

   abstract interface
      !> State of a point at rest; the stress may be lifted to what the law can carry. `text` is empty on success.
      subroutine start_i(self, stress, suction, void_ratio, state, text)
         import :: material_t, wp
         class(material_t), intent(in) :: self
         real(wp), intent(inout) :: stress(6)
         real(wp), intent(in) :: suction, void_ratio
         real(wp), intent(inout) :: state(:)
         character(*), intent(out) :: text
      end subroutine start_i

      !> One increment from (stress, state, suction); thread safe. `with_slope`: the slopes are wanted too.
      subroutine update_i(self, stress, state, strain, suction, d_suction, with_slope, answer, new_state)
         import :: material_t, answer_t, wp
         class(material_t), intent(in) :: self
         real(wp), intent(in) :: stress(6), state(:), strain(6), suction, d_suction
         logical, intent(in) :: with_slope
         type(answer_t), intent(out) :: answer
         real(wp), intent(inout) :: new_state(:)
      end subroutine update_i

      !> A sentence about a failed update.
      subroutine explain_i(self, answer, text)
         import :: material_t, answer_t
         class(material_t), intent(in) :: self
         type(answer_t), intent(in) :: answer
         character(*), intent(out) :: text
      end subroutine explain_i

      !> Void ratio the law would start with if the region names none, 0 if it has no opinion.
      pure real(wp) function check_void_i(self)
         import :: material_t, wp
         class(material_t), intent(in) :: self
      end function check_void_i
   end interface
end module fe_material
