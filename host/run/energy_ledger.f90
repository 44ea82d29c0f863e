! SPDX-License-Identifier: MIT
!> Ledger of a run: energies, work and flow through the boundary, summed step by step.
!> Mechanical balance: loads + supports + gravity = change of kinetic + skeleton + pores + contact + damping
!> (+ algorithmic damping).
!> docs/theory/host.md section 9.
module energy_ledger
   use kinds, only: wp
   use unknown_fields, only: DISPLACEMENTS, AT_P_W, AT_P_C
   use dashpots, only: work_of_dashpots
   use degrees_of_freedom, only: dofs_t
   use porous_domain, only: domain_t, state_t, mixture_density
   use permeability_laws, only: relative_t, relative_permeability
   use prescribed_values, only: constraint_t
   use generalised_alpha, only: scheme_t, STATIC, DYNAMIC
   implicit none (type, external)
   private
   public :: ledger_t, book_step, book_creation, kinetic_energy, imbalance, ALARMING_SHARE

   !> Energy that a run creates out of nothing, as a share of the largest work done in it, beyond which its answers are
   !> not to be trusted: the balances of the verified scenes close to 1e-3 and better [-].
   real(wp), parameter :: ALARMING_SHARE = 0.01_wp

   type :: ledger_t
      real(wp) :: kinetic = 0.0_wp, kinetic_0 = 0.0_wp   !< Now, and at the start [kJ].
      real(wp) :: skeleton = 0.0_wp   !< Work done on the skeleton: stored and dissipated [kJ].
      real(wp) :: pores = 0.0_wp      !< Work of pore pressures against the change of volume [kJ].
      real(wp) :: gravity = 0.0_wp    !< Work of weight [kJ].
      real(wp) :: loads = 0.0_wp, supports = 0.0_wp      !< Work of loads and of prescribed displacements [kJ].
      real(wp) :: contact = 0.0_wp    !< Work done on the penalty of contacts [kJ].
      real(wp) :: seepage = 0.0_wp    !< Dissipated by seepage [kJ].
      real(wp) :: damping = 0.0_wp    !< Dissipated by the damping of regions [kJ].
      real(wp) :: outflow = 0.0_wp, outflow_air = 0.0_wp !< Through prescribed pressures: both fluids, air [m3].
      real(wp) :: largest_work = 0.0_wp !< Largest of the works and of the kinetic energy at the start, so far [kJ].
      real(wp) :: open_0 = 0.0_wp       !< What the balance left open where the present stage began [kJ].
      real(wp) :: most_created = 0.0_wp !< Largest energy that a dynamic stage has created, so far [kJ].
   end type ledger_t
contains
   subroutine book_step(domain, dofs, scheme, constraint, reaction, old, new, ledger)
      type(domain_t), intent(in) :: domain
      type(dofs_t), intent(in) :: dofs
      type(scheme_t), intent(in) :: scheme
      type(constraint_t), intent(in) :: constraint
      real(wp), intent(in) :: reaction(:)   !< Residual with every row kept.
      type(state_t), intent(in) :: old, new
      type(ledger_t), intent(inout) :: ledger
      real(wp) :: change
      integer :: e, i

      if (allocated(constraint%dashpots)) &
         ledger%damping = ledger%damping + work_of_dashpots(constraint%dashpots, dofs, old, new)
      ledger%kinetic = kinetic_energy(domain, dofs, constraint%mass, new)
      do e = 1, size(domain%mesh%t6, 2)
         call book_element(domain, e, scheme, old, new, ledger)
      end do
      do i = 1, dofs%n
         if (dofs%field(i) <= DISPLACEMENTS) then
            change = new%x(dofs%field(i), dofs%node(i)) - old%x(dofs%field(i), dofs%node(i))
            ledger%loads = ledger%loads + 0.5_wp*(constraint%load_0(i) + constraint%load_1(i))*change
            ledger%loads = ledger%loads - constraint%offset(i)*change
            if (constraint%fixed(i)) ledger%supports = ledger%supports + reaction(i)*change
         else if (scheme%kind /= STATIC) then
            if (dofs%field(i) == AT_P_W .and. constraint%fixed(i)) &
               ledger%outflow = ledger%outflow - scheme%dt*reaction(i)
            if (dofs%field(i) == AT_P_C .and. constraint%fixed(i)) &
               ledger%outflow_air = ledger%outflow_air - scheme%dt*reaction(i)
            if (dofs%field(i) == AT_P_C .and. constraint%air(dofs%node(i))) then
               ledger%outflow_air = ledger%outflow_air - scheme%dt*reaction(i)
               ledger%outflow = ledger%outflow - scheme%dt*reaction(i)
            end if
         end if
      end do
   end subroutine book_step

   subroutine book_element(domain, e, scheme, old, new, ledger)
      type(domain_t), intent(in) :: domain
      integer, intent(in) :: e
      type(scheme_t), intent(in) :: scheme
      type(state_t), intent(in) :: old, new
      type(ledger_t), intent(inout) :: ledger
      type(relative_t) :: rel
      real(wp) :: du(2, 6), strain(4), middle(4, 6), p_w, p_c, s, n, rho, drive(2), kappa
      integer :: g, p, node(6), n_p

      node = domain%mesh%t6(:, e)
      n_p = domain%n_p
      du = new%x(:DISPLACEMENTS, node) - old%x(:DISPLACEMENTS, node)
      middle = 0.5_wp*(old%x(:, node) + new%x(:, node))
      do g = 1, domain%rule
         p = (e - 1)*domain%rule + g
         associate (gp => domain%gauss(g, e), region => domain%regions(domain%region_of(e)), f => domain%fluids)
            strain = [dot_product(gp%dn(1, :), du(1, :)), dot_product(gp%dn(2, :), du(2, :)), &
                      dot_product(gp%n_over_r, du(1, :)), &
                      dot_product(gp%dn(2, :), du(1, :)) + dot_product(gp%dn(1, :), du(2, :))]
            ledger%skeleton = ledger%skeleton + 0.5_wp*gp%weight*dot_product(old%stress(1:4, p) + new%stress(1:4, p), &
                                                                              strain)
            if (region%stiffness_damping > 0.0_wp .and. scheme%kind == DYNAMIC) &
               ledger%damping = ledger%damping + gp%weight*region%stiffness_damping/scheme%dt &
                                *dot_product(new%stress(1:4, p) - old%stress(1:4, p), strain)
            s = 0.5_wp*(old%s(p) + new%s(p))
            n = 0.5_wp*(old%e(p)/(1 + old%e(p)) + new%e(p)/(1 + new%e(p)))
            p_w = dot_product(gp%m(:n_p), middle(AT_P_W, :n_p))
            p_c = dot_product(gp%m(:n_p), middle(AT_P_C, :n_p))
            ledger%pores = ledger%pores - gp%weight*(p_w + (1 - s)*p_c)*sum(strain(1:3))
            rho = mixture_density(domain, region%rho_s, n, s)
            ledger%gravity = ledger%gravity - gp%weight*rho*domain%gravity*dot_product(gp%n, du(2, :))
            if (region%damping > 0.0_wp .and. scheme%kind == DYNAMIC) &
               ledger%damping = ledger%damping + gp%weight*rho*region%damping &
                                *dot_product(matmul(du, gp%n), 0.5_wp*matmul(old%v(:DISPLACEMENTS, node) &
                                                                             + new%v(:DISPLACEMENTS, node), gp%n))
            if (.not. domain%with_w .or. scheme%kind == STATIC) cycle
            rel = relative_permeability(domain%permeabilities(region%permeability), s)
            kappa = domain%permeabilities(region%permeability)%intrinsic*rel%w/f%eta_w
            drive = matmul(gp%dm(:, :n_p), middle(AT_P_W, :n_p)) + [0.0_wp, f%rho_w*domain%gravity]
            ledger%seepage = ledger%seepage + scheme%dt*gp%weight*kappa*dot_product(drive, drive)
            if (.not. domain%with_c) cycle
            kappa = domain%permeabilities(region%permeability)%intrinsic*rel%a/f%eta_a
            drive = matmul(gp%dm(:, :n_p), middle(AT_P_W, :n_p) + middle(AT_P_C, :n_p)) + [0.0_wp, &
               f%rho_a*domain%gravity]
            ledger%seepage = ledger%seepage + scheme%dt*gp%weight*kappa*dot_product(drive, drive)
         end associate
      end do
   end subroutine book_element

   real(wp) function kinetic_energy(domain, dofs, mass, state) result(energy)
      type(domain_t), intent(in) :: domain
      type(dofs_t), intent(in) :: dofs
      real(wp), intent(in) :: mass(:)
      type(state_t), intent(in) :: state
      real(wp) :: nodal(DISPLACEMENTS, 6), v(DISPLACEMENTS), n
      integer :: e, g, p, i

      energy = 0.0_wp
      do e = 1, size(domain%mesh%t6, 2)
         nodal = state%v(:DISPLACEMENTS, domain%mesh%t6(:, e))
         do g = 1, domain%rule
            p = (e - 1)*domain%rule + g
            v = matmul(nodal, domain%gauss(g, e)%n)
            n = state%e(p)/(1 + state%e(p))
            energy = energy + 0.5_wp*domain%gauss(g, e)%weight*dot_product(v, v) &
                     *mixture_density(domain, domain%regions(domain%region_of(e))%rho_s, n, state%s(p))
         end do
      end do
      do i = 1, dofs%n
         energy = energy + 0.5_wp*mass(i)*state%v(dofs%field(i), dofs%node(i))**2
      end do
   end function kinetic_energy

   !> After a step is booked: the largest work so far and, in a dynamic stage, the most energy created, which is what
   !> the balance leaves open with the wrong sign.
   pure subroutine book_creation(scheme, ledger)
      type(scheme_t), intent(in) :: scheme
      type(ledger_t), intent(inout) :: ledger

      ledger%largest_work = max(ledger%largest_work, abs(ledger%loads), abs(ledger%supports), abs(ledger%gravity), &
                                ledger%kinetic_0, -ledger%skeleton)
      if (scheme%kind == DYNAMIC) ledger%most_created = max(ledger%most_created, ledger%open_0 - imbalance(ledger))
   end subroutine book_creation

   !> What the mechanical balance leaves open [kJ].
   pure real(wp) function imbalance(ledger)
      type(ledger_t), intent(in) :: ledger

      imbalance = ledger%loads + ledger%supports + ledger%gravity &
                  - (ledger%kinetic - ledger%kinetic_0) - ledger%skeleton - ledger%pores - ledger%contact &
                  - ledger%damping
   end function imbalance
end module energy_ledger
