! SPDX-License-Identifier: MIT
!> Strength in time: which parameter follows which history, checked before a run, and the laws of a step.
!> docs/theory/host.md section 15.
module strength_builder
   use kinds, only: wp
   use faults, only: fault_t, raise, EXIT_INPUT
   use material_point, only: material_t
   use model_types, only: model_t, factor_at
   use name_search, only: defined_name
   use porous_domain, only: state_t
   use scene_types, only: place_of
   use texts, only: short
   implicit none (type, external)
   private
   public :: build_strengths, follow_strengths

   real(wp), parameter :: START = 0.0_wp       !< Of a run [s].
   real(wp), parameter :: SAME = 1.0e-12_wp    !< Relative difference that is none.
   integer, parameter :: SENTENCE = 600
contains
   !> Places of what the groups &strength name, and whether the laws allow what their histories ask. Fault EXIT_GROUP: a
   !> material or history that is not defined; EXIT_INPUT: a parameter that cannot change, two histories of one, a
   !> factor that is not 1 at the start, a value that the law refuses.
   subroutine build_strengths(model, fault)
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      integer :: i, k

      do i = 1, size(model%strengths)
         associate (s => model%strengths(i))
            s%amplitude = defined_name('history', s%amplitude_name, model%amplitudes%name, place_of(s), fault)
            if (fault%code == 0) k = defined_name('material', s%material_name, model%materials%name, place_of(s), fault)
            if (fault%code /= 0) return
            call check_history(model, i, fault)
            do k = 1, size(model%regions)
               if (fault%code /= 0) return
               if (model%regions(k)%material_name == s%material_name) &
                  call check_law(model, i, model%domain%regions(k)%law, s%place, fault)
            end do
         end associate
      end do
   end subroutine build_strengths

   !> A parameter follows one history, and the ground begins with the parameter as its material has it.
   subroutine check_history(model, number, fault)
      type(model_t), intent(in) :: model
      integer, intent(in) :: number   !< Of the group.
      type(fault_t), intent(inout) :: fault
      real(wp) :: first

      associate (s => model%strengths(number), before => model%strengths(:number - 1))
         first = factor_at(model, s%amplitude, START)
         if (any(before%material_name == s%material_name .and. before%parameter_name == s%parameter_name)) then
            call raise(fault, EXIT_INPUT, place_of(s)//trim(s%parameter_name)//' of '''//trim(s%material_name)// &
                       ''' follows a history already; one &strength names it once.')
         else if (abs(first - 1) > SAME) then
            call raise(fault, EXIT_INPUT, place_of(s)//'history '''//trim(s%amplitude_name)//''' is '//short(first)// &
                       ' at the start of the run; it must be 1 there: the ground begins with the parameter of its '// &
                       'material.')
         end if
      end associate
   end subroutine check_history

   !> Whether a law has the parameter, and takes the smallest and the largest value of its history.
   subroutine check_law(model, number, law, place, fault)
      type(model_t), intent(in) :: model
      integer, intent(in) :: number   !< Of the group.
      class(material_t), intent(in) :: law
      integer, intent(out) :: place   !< Of the parameter in the law.
      type(fault_t), intent(inout) :: fault
      class(material_t), allocatable :: changed
      character(SENTENCE) :: text
      real(wp) :: factors(2)
      integer :: i

      associate (s => model%strengths(number))
         call law%find_varying(trim(s%parameter_name), place, text)
         if (place == 0) then
            call raise(fault, EXIT_INPUT, place_of(s)//'parameter = '''//trim(s%parameter_name)//''' of material '''// &
                       trim(s%material_name)//''' cannot follow a history: '//trim(text)//'.')
            return
         end if
         factors = [minval(model%amplitudes(s%amplitude)%values), maxval(model%amplitudes(s%amplitude)%values)]
         do i = 1, size(factors)
            allocate (changed, source=law)
            call changed%change_over_step([place], [1.0_wp], factors(i:i), text)
            if (text /= '' .and. fault%code == 0) call raise(fault, EXIT_INPUT, place_of(s)//'with the factor '// &
               short(factors(i))//' of history '''//trim(s%amplitude_name)//''': '//trim(text))
            deallocate (changed)
         end do
      end associate
   end subroutine check_law

   !> The laws of a step, which ends with the state `next`. Nothing where no strength changes with time.
   subroutine follow_strengths(model, from, until, next, changes)
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: from, until     !< Start and end of the step [s].
      type(state_t), intent(inout) :: next
      logical, intent(out) :: changes         !< Whether a factor differs at its end.
      real(wp), dimension(size(model%strengths)) :: before, after
      logical :: own(size(model%strengths))
      character(SENTENCE) :: text
      integer :: i

      changes = .false.
      if (size(model%strengths) == 0) return
      before = [(factor_at(model, model%strengths(i)%amplitude, from), i=1, size(before))]
      after = [(factor_at(model, model%strengths(i)%amplitude, until), i=1, size(after))]
      changes = any(abs(after - before) > 0.0_wp)
      if (allocated(next%laws)) deallocate (next%laws)
      allocate (next%laws(size(model%domain%regions)))
      do i = 1, size(next%laws)
         allocate (next%laws(i)%law, source=model%domain%regions(i)%law)
         own = model%strengths%material_name == model%regions(i)%material_name
         ! What the law refuses was refused before the run.
         call next%laws(i)%law%change_over_step(pack(model%strengths%place, own), pack(before, own), pack(after, own), &
                                                text)
      end do
   end subroutine follow_strengths
end module strength_builder
