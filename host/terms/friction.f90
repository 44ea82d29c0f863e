! SPDX-License-Identifier: MIT
!> Friction of contacts, keys of &contact: what it starts a step from, and what it has dissipated in one. The law of a
!> node is in contact_friction. docs/theory/contact.md section 9.
module friction
   use archive, only: archive_t
   use exit_codes, only: EXIT_CONVERGENCE
   use kinds, only: wp
   use key_schema, only: UNBOUNDED
   use key_table, only: key_table_t
   use model_types, only: model_t, problem_t
   use contact_interfaces, only: contacts_t
   use contact_types, only: contact_options_t, has_friction
   use faults, only: fault_t, raise
   use scene_term, only: scene_term_t
   implicit none (type, external)
   private
   public :: friction_t

   type, extends(scene_term_t) :: friction_t
   contains
      procedure :: build_group, before_step, accept, exchange
   end type friction_t
contains
   !> Sets the options of a contact. Raises no fault.
   subroutine build_group(self, k, number, model, fault)
      class(friction_t), intent(inout) :: self
      type(key_table_t), intent(inout) :: k
      integer, intent(in) :: number
      type(model_t), intent(inout) :: model
      type(fault_t), intent(inout) :: fault
      type(contact_options_t) :: options

      if (.not. k%lists) options = model%contacts(number)%options
      call k%number('friction', options%friction, 0.0_wp, 100.0_wp, 'coefficient of Coulomb friction [-]')
      call k%number('cohesion', options%cohesion, 0.0_wp, UNBOUNDED, 'shear stress that friction adds to [kPa]')
      call k%number('tangential_penalty', options%tangential_penalty, 0.0_wp, UNBOUNDED, &
                    'shear stress of a unit of slip before it slides [kN/m3]; 0: a tenth of the penalty', &
                    '+friction|cohesion')
      if (k%lists) return
      model%contacts(number)%options = options
      if (has_friction(options)) self%wanted = .true.
   end subroutine build_group

   !> Displacements and gaps that the friction of a step starts from. Fault EXIT_CONVERGENCE: a kernel refuses them.
   subroutine before_step(self, dt, problem, fault)
      class(friction_t), intent(inout) :: self
      real(wp), intent(in) :: dt
      type(problem_t), intent(inout) :: problem
      type(fault_t), intent(inout) :: fault

      select type (contacts => problem%system%contacts)
      type is (contacts_t)
         if (.not. contacts%begin_friction(problem%state%x)) &
            call raise(fault, EXIT_CONVERGENCE, 'Friction at the start of a step: '//contacts%message()//'.')
      end select
   end subroutine before_step

   !> Takes over the tractions at the end of the step, and what sliding has dissipated.
   subroutine accept(self, problem, dissipated)
      class(friction_t), intent(inout) :: self
      type(problem_t), intent(inout) :: problem
      real(wp), intent(inout) :: dissipated
      real(wp) :: by_sliding

      select type (contacts => problem%system%contacts)
      type is (contacts_t)
         call contacts%accept_friction(problem%next%x, by_sliding)
         dissipated = dissipated + by_sliding
      end select
   end subroutine accept

   subroutine exchange(self, problem, archive)
      class(friction_t), intent(inout) :: self
      type(problem_t), intent(inout) :: problem
      class(archive_t), intent(inout) :: archive

      select type (contacts => problem%system%contacts)
      type is (contacts_t)
         call contacts%exchange_friction(archive)
      end select
   end subroutine exchange
end module friction
