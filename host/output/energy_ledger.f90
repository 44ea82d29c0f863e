! SPDX-License-Identifier: MIT
!> Ledger of a run: energies, work and flow through the boundary, summed step by step.
!> Mechanical balance: loads + supports + gravity = change of kinetic + skeleton + pores + contact + damping
!> (+ algorithmic damping).
!> docs/theory/host.md section 9.
module energy_ledger
   use archive, only: archive_t
   use degrees_of_freedom, only: at_nodes, of_unknowns
   use kinds, only: wp
   use unknown_fields, only: DISPLACEMENTS, AT_P_W, AT_P_C
   use springs, only: work_of_linear_forces
   use porous_domain, only: region_t, model_state_t, means_t, means_over, strain_of, mixture_density, pressures_at, &
                            is_present, gravity_on, COUPLED, OUTFLOWS
   use permeability_laws, only: relative_t, relative_permeability
   use generalised_alpha, only: scheme_t
   use run_state, only: run_t
   use step_balance, only: mean_outflow
   implicit none (type, external)
   private
   public :: ledger_t, exchange_ledger, book_step, book_creation, allowed_creation, kinetic_energy, &
             imbalance, ALARMING_SHARE

   !> Energy that a run creates out of nothing, as a share of the largest work done in it, beyond which its results are
   !> unreliable: the balances of the verified scenes close to 1e-3 and better [-].
   real(wp), parameter :: ALARMING_SHARE = 0.01_wp

   type :: ledger_t
      real(wp) :: kinetic = 0.0_wp, kinetic_0 = 0.0_wp   !< Now, and at the start [kJ].
      real(wp) :: skeleton = 0.0_wp   !< Work done on the skeleton and on springs: stored and dissipated [kJ].
      real(wp) :: pores = 0.0_wp      !< Work of pore pressures against the change of volume [kJ].
      real(wp) :: gravity = 0.0_wp    !< Work of weight [kJ].
      real(wp) :: loads = 0.0_wp, supports = 0.0_wp      !< Work of loads and of prescribed displacements [kJ].
      real(wp) :: contact = 0.0_wp    !< Work done on contacts: on their penalty, and by friction [kJ].
      real(wp) :: dissipated = 0.0_wp   !< Work that terms dissipated, as sliding does [kJ].
      real(wp) :: seepage = 0.0_wp    !< Dissipated by seepage [kJ].
      real(wp) :: damping = 0.0_wp    !< Dissipated by damping of regions [kJ].
      real(wp) :: outflow = 0.0_wp, outflow_air = 0.0_wp !< Through prescribed pressures, less rain: both, air [m3].
      real(wp) :: largest_work = 0.0_wp !< Largest of the works and of the kinetic energy at the start, so far [kJ].
      real(wp) :: open_0 = 0.0_wp       !< Imbalance where the present stage began [kJ].
      real(wp) :: most_created = 0.0_wp !< Largest energy that a dynamic stage has created, so far [kJ].
      real(wp) :: overdue = 0.0_wp      !< Steps in a row, to the last, with more created energy than the stage allows.
      !> Most that residuals within Newton's tolerance can have done: in all steps before a work exceeds it, then in one
      !> step [kJ].
      real(wp) :: tolerated = 0.0_wp
      !> (4, points) Stress of the damping in proportion to the stiffness at the end of the last step [kPa]; not
      !> allocated: no region has such.
      real(wp), allocatable :: damping_stress(:, :)
   end type ledger_t

   !> Works of the mean forces of a step [kJ].
   type :: work_t
      real(wp) :: skeleton = 0.0_wp, pores = 0.0_wp, gravity = 0.0_wp, damping = 0.0_wp
      real(wp) :: inertia = 0.0_wp   !< By the mean acceleration, the change of velocity over the step.
   end type work_t
contains
   !> All works are those of mean forces of a step times its displacements. So is that of the supports: what they hold
   !> is formed anew from the mean forces, since the reactions of the scheme hold at its own level, not half-way.
   !> docs/theory/host.md section 9. All are in [kJ], the outflow is in [m3].
   subroutine book_step(run, ledger)
      type(run_t), intent(in) :: run   !< After a step.
      type(ledger_t), intent(inout) :: ledger
      type(work_t) :: work
      real(wp), allocatable :: change(:, :), held(:, :)
      integer :: e

      associate (domain => run%domain, old => run%state, new => run%next)
         ledger%kinetic = kinetic_energy(run, new)
         allocate (change, source=new%x(:DISPLACEMENTS, :) - old%x(:DISPLACEMENTS, :))
         allocate (held, source=moved_by_supports(run, change))
         do e = 1, size(domain%mesh%t6, 2)
            if (.not. is_present(new, e)) cycle
            associate (node => domain%mesh%t6(:, e))
               call add_work_of_element(e, run, ledger%damping_stress, change(:, node), work)
               ledger%supports = ledger%supports + work_to_move_element(e, run, ledger%damping_stress, held(:, node))
               if (.not. domain%with_w .or. .not. run%scheme%has_rates) cycle
               if (domain%regions(domain%region_of(e))%drainage == COUPLED) call book_seepage(e, run, ledger)
            end associate
         end do
         work%damping = work%damping + work_of_linear_forces(run, .true., change)
         work%skeleton = work%skeleton + work_of_linear_forces(run, .false., change)
         ledger%supports = ledger%supports + work_of_linear_forces(run, .true., held) &
                           + work_of_linear_forces(run, .false., held)
         ledger%skeleton = ledger%skeleton + work%skeleton
         ledger%pores = ledger%pores + work%pores
         ledger%gravity = ledger%gravity + work%gravity
         ledger%damping = ledger%damping + work%damping
         call book_forces(run, change, ledger)
         call book_outflow(run, ledger)
         if (allocated(ledger%damping_stress)) call follow_damping(run, ledger%damping_stress)
      end associate
   end subroutine book_step

   !> Stress that the damping in proportion to the stiffness has in the equations of a step: there it stands at the
   !> level of values, although the increment over the step gives it. [kPa] docs/theory/host.md sections 2.1 and 9.
   pure function damping_in(region, scheme, increment) result(stress)
      type(region_t), intent(in) :: region
      type(scheme_t), intent(in) :: scheme
      real(wp), intent(in) :: increment(4)   !< Increment of the effective stress [kPa].
      real(wp) :: stress(4)

      stress = region%stiffness_damping/scheme%dt*increment
   end function damping_in

   !> Takes the stress of the damping to the end of the step: such that the one of the equations lies between both at
   !> the level of values, as every other force does. A step without inertia has none. docs/theory/host.md section 9.
   subroutine follow_damping(run, damping_stress)
      type(run_t), intent(in) :: run
      real(wp), intent(inout) :: damping_stress(:, :)
      integer :: e, p

      if (.not. run%scheme%has_inertia) then
         damping_stress = 0.0_wp
         return
      end if
      do e = 1, size(run%domain%region_of)
         associate (domain => run%domain, region => run%domain%regions(run%domain%region_of(e)))
            do p = (e - 1)*domain%rule + 1, e*domain%rule
               damping_stress(:, p) = damping_stress(:, p) &
                  + (damping_in(region, run%scheme, run%next%stress(1:4, p) - run%state%stress(1:4, p)) &
                     - damping_stress(:, p))/run%scheme%l_f
            end do
         end associate
      end do
   end subroutine follow_damping

   !> Finds the displacements of a step that supports prescribe, zero elsewhere [m].
   pure function moved_by_supports(run, change) result(held)
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: change(:, :)   !< (2, nodes) of all [m]
      real(wp) :: held(DISPLACEMENTS, size(change, 2))

      associate (fixed => at_nodes(run%dofs, merge(1.0_wp, 0.0_wp, run%constraint%fixed)))
         held = merge(change, 0.0_wp, fixed(:DISPLACEMENTS, :) > 0.0_wp)
      end associate
   end function moved_by_supports

   !> Books the forces on nodes: loads, contacts, and the inertia of bodies that supports move.
   subroutine book_forces(run, change, ledger)
      type(run_t), intent(in) :: run
      real(wp), intent(in) :: change(:, :)
      type(ledger_t), intent(inout) :: ledger
      real(wp) :: load
      integer :: i

      do i = 1, run%dofs%n
         associate (f => run%dofs%field(i), k => run%dofs%node(i), constraint => run%constraint, &
                    scheme => run%scheme, touch => run%mean_force(i))
            if (f > DISPLACEMENTS) cycle
            load = 0.5_wp*(constraint%load_0(i) + constraint%load_1(i)) - constraint%offset(i)
            ledger%loads = ledger%loads + load*change(f, k)
            ledger%contact = ledger%contact + touch*change(f, k)
            if (.not. constraint%fixed(i)) cycle
            ledger%supports = ledger%supports + (touch - load)*change(f, k)
            if (scheme%has_inertia) ledger%supports = ledger%supports &
               + constraint%mass(i)*(run%next%v(f, k) - run%state%v(f, k))/scheme%dt*change(f, k)
         end associate
      end do
   end subroutine book_forces

   !> Books the flow out through prescribed pressures and past limits, less the rain. docs/theory/host.md section 9.
   subroutine book_outflow(run, ledger)
      type(run_t), intent(in) :: run
      type(ledger_t), intent(inout) :: ledger
      real(wp) :: left(OUTFLOWS)

      if (.not. run%scheme%has_rates) return
      left = run%scheme%dt*mean_outflow(run)
      ledger%outflow = ledger%outflow + left(1)
      ledger%outflow_air = ledger%outflow_air + left(2)
   end subroutine book_outflow

   !> Sums the work that moves an element as a step does, inertia included [kJ].
   real(wp) function work_to_move_element(e, run, damping_stress, du) result(total)
      integer, intent(in) :: e
      type(run_t), intent(in) :: run
      real(wp), allocatable, intent(in) :: damping_stress(:, :)
      real(wp), intent(in) :: du(DISPLACEMENTS, 6)   !< [m]
      type(work_t) :: work

      total = 0.0_wp
      if (.not. any(abs(du) > 0.0_wp)) return
      call add_work_of_element(e, run, damping_stress, du, work)
      total = work%skeleton + work%pores + work%damping + work%inertia - work%gravity
   end function work_to_move_element

   !> Adds the work of the mean forces in an element at displacements of its nodes.
   subroutine add_work_of_element(e, run, damping_stress, du, work)
      integer, intent(in) :: e
      type(run_t), intent(in) :: run
      real(wp), allocatable, intent(in) :: damping_stress(:, :)
      real(wp), intent(in) :: du(DISPLACEMENTS, 6)   !< [m]
      type(work_t), intent(inout) :: work
      type(means_t) :: mean
      real(wp) :: damping(4), strain(4), p(2), middle(2, 6), rho, gravity, push(DISPLACEMENTS)
      real(wp) :: dv(DISPLACEMENTS, 6), v(DISPLACEMENTS, 6)
      integer :: g, at, node(6)

      associate (domain => run%domain, scheme => run%scheme, old => run%state, new => run%next)
         gravity = 0.5_wp*(gravity_on(old, e) + gravity_on(new, e))
         node = domain%mesh%t6(:, e)
         dv = new%v(:DISPLACEMENTS, node) - old%v(:DISPLACEMENTS, node)
         v = (new%x(:DISPLACEMENTS, node) - old%x(:DISPLACEMENTS, node))/scheme%dt
         associate (carriers => domain%carriers(:domain%n_carriers(e), e))
            middle(:, :size(carriers)) = 0.5_wp*(old%x(AT_P_W:, carriers) + new%x(AT_P_W:, carriers))
         end associate
         do g = 1, domain%rule
            at = (e - 1)*domain%rule + g
            associate (gp => domain%gauss(g, e), region => domain%regions(domain%region_of(e)))
               strain = strain_of(gp, du)
               mean = means_over(old, new, at)
               work%skeleton = work%skeleton + gp%weight*dot_product(mean%stress, strain)
               p = pressures_at(domain, e, g, middle)
               work%pores = work%pores - gp%weight*(p(1) + (1 - mean%s)*p(2))*sum(strain(1:3))
               rho = mixture_density(domain, region, mean%n, mean%s)
               work%gravity = work%gravity - gp%weight*rho*gravity*dot_product(gp%n, du(2, :))
               if (allocated(region%against_rate) .and. scheme%has_rates) work%damping = work%damping &
                  + gp%weight*dot_product(matmul(region%against_rate, strain_of(gp, v)), strain)
               if (.not. scheme%has_inertia) cycle
               push = gp%weight*rho*matmul(du, gp%n)
               work%inertia = work%inertia + dot_product(push, matmul(dv, gp%n))/scheme%dt
               if (region%damping > 0.0_wp) work%damping = work%damping + region%damping &
                  *dot_product(push, 0.5_wp*matmul(old%v(:DISPLACEMENTS, node) + new%v(:DISPLACEMENTS, node), gp%n))
               if (.not. region%stiffness_damping > 0.0_wp) cycle
               damping = damping_in(region, scheme, new%stress(1:4, at) - old%stress(1:4, at))
               damping = damping_stress(:, at) + 0.5_wp/scheme%l_f*(damping - damping_stress(:, at))
               work%damping = work%damping + gp%weight*dot_product(damping, strain)
            end associate
         end do
      end associate
   end subroutine add_work_of_element

   !> Books the energy that seepage dissipates in an element.
   subroutine book_seepage(e, run, ledger)
      integer, intent(in) :: e
      type(run_t), intent(in) :: run
      type(ledger_t), intent(inout) :: ledger
      type(relative_t) :: rel
      real(wp) :: middle(AT_P_W:AT_P_C, 6), drive(2), kappa, gravity, rho_a
      type(means_t) :: mean
      integer :: g, n_p

      gravity = 0.5_wp*(gravity_on(run%state, e) + gravity_on(run%next, e))
      n_p = run%domain%n_p
      associate (node => run%domain%mesh%t6(:, e))
         middle = 0.5_wp*(run%state%x(AT_P_W:AT_P_C, node) + run%next%x(AT_P_W:AT_P_C, node))
      end associate
      do g = 1, run%domain%rule
         mean = means_over(run%state, run%next, (e - 1)*run%domain%rule + g)
         associate (gp => run%domain%gauss(g, e), f => run%domain%fluids, &
                    law => run%domain%permeabilities(run%domain%regions(run%domain%region_of(e))%permeability))
            rel = relative_permeability(law, mean%s)
            kappa = law%intrinsic*rel%w/f%eta_w
            drive = matmul(middle(AT_P_W, :n_p), gp%dm(:n_p, :)) + [0.0_wp, f%rho_w*gravity]
            ledger%seepage = ledger%seepage + run%scheme%dt*gp%weight*kappa*dot_product(drive, drive)
            if (.not. run%domain%with_c) cycle
            kappa = law%intrinsic*rel%a/f%eta_a
            rho_a = f%air_density(dot_product(sum(middle(:, :n_p), 1), gp%m(:n_p)))
            drive = matmul(middle(AT_P_W, :n_p) + middle(AT_P_C, :n_p), gp%dm(:n_p, :)) + [0.0_wp, rho_a*gravity]
            ledger%seepage = ledger%seepage + run%scheme%dt*gp%weight*kappa*dot_product(drive, drive)
         end associate
      end do
   end subroutine book_seepage

   !> Sums the kinetic energy of the soil and of the bodies with a mass [kJ]. docs/theory/host.md section 9.
   real(wp) function kinetic_energy(run, state) result(energy)
      type(run_t), intent(in) :: run
      type(model_state_t), intent(in) :: state   !< State of the run before or after a step.
      real(wp) :: nodal(DISPLACEMENTS, 6), v(DISPLACEMENTS), n
      integer :: e, g, p, i

      energy = 0.0_wp
      associate (domain => run%domain, dofs => run%dofs, mass => run%constraint%mass)
         do e = 1, size(domain%mesh%t6, 2)
            if (.not. is_present(state, e)) cycle
            nodal = state%v(:DISPLACEMENTS, domain%mesh%t6(:, e))
            do g = 1, domain%rule
               p = (e - 1)*domain%rule + g
               v = matmul(nodal, domain%gauss(g, e)%n)
               n = state%e(p)/(1 + state%e(p))
               energy = energy + 0.5_wp*domain%gauss(g, e)%weight*dot_product(v, v) &
                        *mixture_density(domain, domain%regions(domain%region_of(e)), n, state%s(p))
            end do
         end do
         do i = 1, dofs%n
            energy = energy + 0.5_wp*mass(i)*state%v(dofs%field(i), dofs%node(i))**2
         end do
      end associate
   end function kinetic_energy

   !> Notes, after a step is booked, the largest work so far and, in a dynamic stage, the most energy created, which is
   !> what the balance leaves open with the wrong sign. docs/theory/host.md section 9.
   pure subroutine book_creation(run, ledger)
      type(run_t), intent(in) :: run
      type(ledger_t), intent(inout) :: ledger
      real(wp) :: work

      ledger%largest_work = max(ledger%largest_work, abs(ledger%loads), abs(ledger%supports), abs(ledger%gravity), &
                                ledger%kinetic_0, -ledger%skeleton, -ledger%pores)
      ! A residual may be that share of the forces, whose magnitudes are the scale.
      work = run%stage%tolerance*sum(run%assembly%scale*abs(of_unknowns(run%dofs, run%next%x - run%state%x)), &
                                     mask=run%dofs%field <= DISPLACEMENTS)
      ! Before any load has done more than that, such steps add up: nothing tells their energy from none.
      if (ledger%largest_work < ledger%tolerated + work) then
         ledger%tolerated = ledger%tolerated + work
      else
         ledger%tolerated = max(ledger%tolerated, work)
      end if
      if (run%scheme%has_inertia) ledger%most_created = max(ledger%most_created, ledger%open_0 - imbalance(ledger))
   end subroutine book_creation

   !> Finds the created energy up to which nothing is said: a share of the largest work, and what no balance can tell
   !> from zero. Of a body at rest the work is as small as that. [kJ] docs/theory/host.md section 9.
   pure real(wp) function allowed_creation(share, ledger)
      real(wp), intent(in) :: share   !< [-]
      type(ledger_t), intent(in) :: ledger

      allowed_creation = share*ledger%largest_work + ledger%tolerated
   end function allowed_creation

   !> Finds the energy that the mechanical balance leaves open [kJ]. docs/theory/host.md section 9; positive: energy is
   !> lost.
   pure real(wp) function imbalance(ledger)
      type(ledger_t), intent(in) :: ledger

      imbalance = ledger%loads + ledger%supports + ledger%gravity &
                  - (ledger%kinetic - ledger%kinetic_0) - ledger%skeleton - ledger%pores - ledger%contact &
                  - ledger%damping
   end function imbalance

   !> Exchanges a ledger with an archive.
   subroutine exchange_ledger(ledger, archive)
      type(ledger_t), intent(inout) :: ledger
      class(archive_t), intent(inout) :: archive

      call archive%enter('ledger')
      call archive%exchange('kinetic', ledger%kinetic, 'kJ', 'kinetic energy')
      call archive%exchange('kinetic_0', ledger%kinetic_0, 'kJ', 'kinetic energy at the start')
      call archive%exchange('skeleton', ledger%skeleton, 'kJ', 'work done on the skeleton')
      call archive%exchange('pores', ledger%pores, 'kJ', 'work of pore pressures')
      call archive%exchange('gravity', ledger%gravity, 'kJ', 'work of weight')
      call archive%exchange('loads', ledger%loads, 'kJ', 'work of loads')
      call archive%exchange('supports', ledger%supports, 'kJ', 'work of prescribed displacements')
      call archive%exchange('contact', ledger%contact, 'kJ', 'work done on contacts')
      call archive%exchange('dissipated', ledger%dissipated, 'kJ', 'energy that terms dissipated, as by sliding')
      call archive%exchange('seepage', ledger%seepage, 'kJ', 'energy dissipated by seepage')
      call archive%exchange('damping', ledger%damping, 'kJ', 'energy dissipated by damping')
      call archive%exchange('outflow', ledger%outflow, 'm3', 'outflow of both fluids, less rain')
      call archive%exchange('outflow_air', ledger%outflow_air, 'm3', 'outflow of air')
      call archive%exchange('largest_work', ledger%largest_work, 'kJ', 'largest of the works so far')
      call archive%exchange('open_0', ledger%open_0, 'kJ', 'what the balance left open where the stage began')
      call archive%exchange('most_created', ledger%most_created, 'kJ', 'largest energy created so far')
      call archive%exchange('overdue', ledger%overdue, '-', &
                            'steps in a row with more created energy than the stage allows')
      call archive%exchange('tolerated', ledger%tolerated, 'kJ', &
                            'most that residuals within the tolerance can have done')
      call archive%exchange_allocatable('damping_stress', ledger%damping_stress, 'kPa', &
                                        'stress of the damping in proportion to the stiffness')
      call archive%leave('ledger')
   end subroutine exchange_ledger
end module energy_ledger
