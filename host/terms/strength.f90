! SPDX-License-Identifier: MIT
!> Strength in time: parameters of materials that follow histories, &strength. docs/theory/host.md section 15.
module strength
   use kinds, only: wp
   use faults, only: fault_t, raise, EXIT_INPUT
   use key_schema, only: REQUIRED
   use key_table, only: key_table_t
   use material_point, only: material_t
   use model_types, only: model_t, problem_t, factor_at, factors_of
   use name_search, only: defined_name
   use porous_domain, only: model_state_t
   use scene_parts, only: scene_item_t, place_of
   use scene_term, only: scene_term_t
   use scene_types, only: item_of
   use texts, only: short, LENGTH
   implicit none (type, external)
   private
   public :: strength_t

   real(wp), parameter :: START = 0.0_wp       !< Of a run [s].
   real(wp), parameter :: SAME = 1.0e-12_wp    !< Relative difference that is none.
   integer, parameter :: SENTENCE = 600

   !> A parameter of a material that follows a history.
   type, extends(scene_item_t) :: change_t
      character(LENGTH) :: material_name = '', parameter_name = '', amplitude_name = ''
      integer :: place = 0, amplitude = 0            !< In the law, in the histories.
      logical, allocatable :: in_region(:)           !< (regions) Whether it is of that material.
   end type change_t

   type, extends(scene_term_t) :: strength_t
      type(change_t), allocatable :: changes(:)
   contains
      procedure :: build_group, begin_stage, before_step, remark
   end type strength_t
contains
   !> Places of what a group names, and whether the laws allow what its history asks. Fault EXIT_GROUP: a material or
   !> history that is not defined; EXIT_INPUT: a parameter that cannot change, two histories of one, a factor that is
   !> not 1 at the start, a value that the law refuses.
   subroutine build_group(self, k, number, model, fault)
      class(strength_t), intent(inout) :: self
      type(key_table_t), intent(inout) :: k
      integer, intent(in) :: number
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(change_t) :: change
      integer :: i

      call k%text('material', change%material_name, 'name of the material whose strength changes with time', REQUIRED)
      call k%text('parameter', change%parameter_name, &
                  'what changes: M_c of a &mud; of a &umat props(1), props(2), ...', REQUIRED)
      call k%text('history', change%amplitude_name, 'factor on the parameter, 1 at the start', REQUIRED, &
                  refers='history')
      if (k%lists) return
      change%scene_item_t = item_of(k%group)
      change%amplitude = defined_name('history', change%amplitude_name, model%amplitudes%name, place_of(change), fault)
      if (fault%code == 0) i = defined_name('material', change%material_name, model%materials%name, place_of(change), &
                                            fault)
      if (fault%code /= 0) return
      if (.not. allocated(self%changes)) allocate (self%changes(0))
      call check_history(model, self%changes, change, fault)
      change%in_region = model%regions%material_name == change%material_name
      do i = 1, size(change%in_region)
         if (fault%code /= 0) return
         if (change%in_region(i)) call check_law(model, change, model%domain%regions(i)%law, fault)
      end do
      self%changes = [self%changes, change]
      self%wanted = .true.
   end subroutine build_group

   !> A parameter follows one history, and the ground begins with the parameter as its material has it.
   subroutine check_history(model, before, s, fault)
      type(model_t), intent(in) :: model
      type(change_t), intent(in) :: before(:), s   !< The others, and this one.
      type(fault_t), intent(inout) :: fault
      real(wp) :: first

      first = factor_at(model, s%amplitude, START)
      if (any(before%material_name == s%material_name .and. before%parameter_name == s%parameter_name)) then
         call raise(fault, EXIT_INPUT, place_of(s)//trim(s%parameter_name)//' of '''//trim(s%material_name)// &
                    ''' follows a history already; one &strength names it once.')
      else if (abs(first - 1) > SAME) then
         call raise(fault, EXIT_INPUT, place_of(s)//'history '''//trim(s%amplitude_name)//''' is '//short(first)// &
                    ' at the start of the run; it must be 1 there: the ground begins with the parameter of its '// &
                    'material.')
      end if
   end subroutine check_history

   !> Whether a law has the parameter, and takes the smallest and the largest value of its history.
   subroutine check_law(model, s, law, fault)
      type(model_t), intent(in) :: model
      type(change_t), intent(inout) :: s   !< Gets the place of the parameter in the law.
      class(material_t), intent(in) :: law
      type(fault_t), intent(inout) :: fault
      class(material_t), allocatable :: changed
      character(SENTENCE) :: text
      real(wp) :: factors(2)
      integer :: i

      call law%find_varying(trim(s%parameter_name), s%place, text)
      if (s%place == 0) then
         call raise(fault, EXIT_INPUT, place_of(s)//'parameter = '''//trim(s%parameter_name)//''' of material '''// &
                    trim(s%material_name)//''' cannot follow a history: '//trim(text)//'.')
         return
      end if
      factors = factors_of(model, s%amplitude)
      do i = 1, size(factors)
         allocate (changed, source=law)
         call changed%change_over_step([s%place], [1.0_wp], factors(i:i), text)
         if (text /= '' .and. fault%code == 0) call raise(fault, EXIT_INPUT, place_of(s)//'with the factor '// &
            short(factors(i))//' of history '''//trim(s%amplitude_name)//''': '//trim(text))
         deallocate (changed)
      end do
   end subroutine check_law

   !> Makes the laws of a stage at its start.
   subroutine begin_stage(self, begins, problem, fault)
      class(strength_t), intent(inout) :: self
      logical, intent(in) :: begins
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault
      logical :: changes

      call change_laws(self%changes, problem%model, problem%at%t_start, problem%at%t_start, problem%next, changes)
   end subroutine begin_stage

   !> Makes the laws of a step. Slopes that were carried along know nothing of a strength that changes.
   subroutine before_step(self, dt, problem, fault)
      class(strength_t), intent(inout) :: self
      real(wp), intent(in) :: dt
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault
      logical :: changes

      call change_laws(self%changes, problem%model, problem%state%time, problem%state%time + dt, problem%next, changes)
      if (changes) problem%assembly%slopes%known = .false.
   end subroutine before_step

   !> How much of a strength is left: a body without equilibrium has no other step, and a step whose tangent is not that
   !> of the law may fail long before.
   function remark(self, model, time) result(text)
      class(strength_t), intent(in) :: self
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: time
      character(:), allocatable :: text
      integer :: i, k

      text = ''
      do i = 1, size(self%changes)
         associate (s => self%changes(i))
            ! What it was made for it still is.
            if (.not. abs(factor_at(model, s%amplitude, time) - 1) > SAME) cycle
            text = text//'. By &strength '//trim(s%parameter_name)//' of '''//trim(s%material_name)//''' is at '// &
                   short(factor_at(model, s%amplitude, time))//' of its value: it may have failed'
            do k = 1, size(s%in_region)
               if (.not. s%in_region(k) .or. model%domain%regions(k)%law%exact_tangent) cycle
               text = text//', or not yet: its tangent is approximate (key tangent), and no factor of safety '// &
                      'follows from a run that ends with one'
               exit
            end do
         end associate
      end do
   end function remark

   !> Makes the laws of a step, which ends with the state `next`.
   subroutine change_laws(list, model, from, until, next, changes)
      type(change_t), intent(in) :: list(:)
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: from, until     !< Start and end of the step [s].
      type(model_state_t), intent(inout) :: next
      logical, intent(out) :: changes         !< Whether a factor differs at its end.
      real(wp), dimension(size(list)) :: before, after
      logical :: own(size(list))
      character(SENTENCE) :: text
      integer :: i, k

      before = [(factor_at(model, list(i)%amplitude, from), i=1, size(before))]
      after = [(factor_at(model, list(i)%amplitude, until), i=1, size(after))]
      changes = any(abs(after - before) > 0.0_wp)
      if (allocated(next%laws)) deallocate (next%laws)
      allocate (next%laws(size(model%domain%regions)))
      do i = 1, size(next%laws)
         allocate (next%laws(i)%law, source=model%domain%regions(i)%law)
         own = [(list(k)%in_region(i), k=1, size(list))]
         ! What the law refuses was refused before the run.
         call next%laws(i)%law%change_over_step(pack(list%place, own), pack(before, own), pack(after, own), text)
      end do
   end subroutine change_laws
end module strength
