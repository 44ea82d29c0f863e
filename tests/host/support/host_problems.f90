! SPDX-License-Identifier: MIT
!> Small scenes for the tests of the host, written as text so that the reader of scenes takes part.
module host_problems
   use, intrinsic :: iso_fortran_env, only: int64
   use contact_interfaces, only: contacts_t
   use energy_ledger, only: ledger_t
   use kinds, only: wp
   use ledger_observer, only: ledger_observer_t
   use model_builder, only: build_model
   use scene_reader, only: read_scene
   use scene_types, only: scene_t
   use run_observer, only: observers_t
   use run_setup, only: prepare_run
   use run_state, only: run_t
   use model_types, only: model_t
   use faults, only: fault_t
   use time_stepping, only: run_stages
   implicit none (type, external)
   private
   public :: build, ask, contacts_of, run_unseen, run_with_ledger, sand, soil_laws, square

   character(*), parameter, public :: NL = new_line('a')
contains
   !> A scene from its text; stops the test program if it is refused.
   subroutine build(text, model, run)
      character(*), intent(in) :: text
      type(model_t), intent(out) :: model
      type(run_t), intent(out) :: run
      type(fault_t) :: fault

      call ask(text, model, run, fault)
      if (fault%code /= 0) error stop 'a test scene was refused'
   end subroutine build

   !> Runs all stages without observers.
   subroutine run_unseen(model, run, fault)
      type(model_t), intent(inout), target :: model
      type(run_t), intent(inout) :: run
      type(fault_t), intent(inout) :: fault
      type(observers_t) :: nobody

      run%model => model
      call run_stages(run, nobody, fault)
   end subroutine run_unseen

   !> Runs all stages; the ledger at their end.
   subroutine run_with_ledger(model, run, ledger, fault)
      type(model_t), intent(inout), target :: model
      type(run_t), intent(inout) :: run
      type(ledger_t), intent(out) :: ledger
      type(fault_t), intent(inout) :: fault
      type(observers_t) :: observers

      run%model => model
      call observers%add(ledger_observer_t())
      call run_stages(run, observers, fault)
      select type (observer => observers%list(1)%observer)
      type is (ledger_observer_t)
         ledger = observer%ledger
      end select
   end subroutine run_with_ledger

   !> The contacts of a run that has some.
   function contacts_of(run) result(contacts)
      type(run_t), target, intent(inout) :: run
      type(contacts_t), pointer :: contacts

      contacts => null()
      select type (forces => run%system%contacts)
      type is (contacts_t)
         contacts => forces
      end select
   end function contacts_of

   !> A scene from its text, with the fault for the caller.
   subroutine ask(text, model, run, fault)
      character(*), intent(in) :: text
      type(model_t), intent(out), target :: model
      type(run_t), intent(out) :: run
      type(fault_t), intent(inout) :: fault
      type(scene_t) :: scene
      character(64) :: file
      integer(int64) :: tick
      integer :: unit

      ! Nanoseconds: suites run at the same time.
      call system_clock(tick)
      write (file, '(a,i0,a)') '/tmp/mud_host_test_', tick, '.nml'
      open (newunit=unit, file=file, status='replace', action='write')
      write (unit, '(a)') text
      close (unit)
      call read_scene(trim(file), scene, fault)
      if (fault%code == 0) call build_model(scene, model, fault)
      if (fault%code == 0) call prepare_run(model, run, fault)
      if (fault%code /= 0) write (*, '(a)') trim(fault%text)
      open (newunit=unit, file=file, status='old')
      close (unit, status='delete')
   end subroutine ask

   !> The library's default sand, with more keys.
   pure function sand(keys) result(text)
      character(*), intent(in) :: keys
      character(:), allocatable :: text

      text = '&mud name = ''sand'' tangent = 3 '//keys//' /'//NL
   end function sand

   !> Retention and permeability of the paper's soil.
   pure function soil_laws(law) result(text)
      character(*), intent(in) :: law
      character(:), allocatable :: text

      text = '&retention name = ''curve'' /'//NL//'&permeability name = ''k'' intrinsic = 5e-10 law = '''// &
             law//''' /'//NL
   end function soil_laws

   !> A built-in mesh of n by n cells on a square of side 1 m beginning at r.
   pure function square(r, n) result(text)
      real(wp), intent(in) :: r
      integer, intent(in) :: n
      character(:), allocatable :: text
      character(100) :: line

      write (line, '(a,2(f6.2,","),a,i0,a,i0,a)') '&mesh r = ', r, r + 1, ' r_cells = ', n, &
         ' z = 0, 1 z_cells = ', n, ' /'
      text = trim(line)//NL
   end function square
end module host_problems
