# SPDX-License-Identifier: MIT
"""The mutations: (title, (file below umat, text that stands there once, its replacement), ...)."""

TENSOR, RATES, POINT = "core/base/mud_tensor.f90", "core/rates/mud_rates.f90", "core/integration/mud_point.f90"
DIRECTION = "core/rates/mud_direction.f90"
INCREMENT, REVERSAL = "core/integration/mud_increment.f90", "core/integration/mud_reversal.f90"
SUBSTEP, TRIAL = "core/integration/mud_substep.f90", "core/integration/mud_trial.f90"
RETURN_POINT, EVENTS = "core/integration/mud_return_point.f90", "core/integration/mud_events.f90"
TRANSITIONS, PHASES = "core/integration/mud_transitions.f90", "core/integration/mud_phases.f90"
BOUNDING, EVENT_TIME = "core/rates/mud_bounding.f90", "core/integration/mud_event_time.f90"
CUTOFF = "core/integration/mud_cutoff.f90"
FLOW, HARDENING, CRITICAL = "core/laws/mud_flow.f90", "core/laws/mud_hardening.f90", "core/laws/mud_critical_state.f90"
RETENTION, BONDING, ELASTIC = "core/laws/mud_retention.f90", "core/laws/mud_bonding.f90", "core/laws/mud_elastic.f90"
PARAMS, REGISTRY, STATE = "core/base/mud_params.f90", "core/base/mud_registry.f90", "core/base/mud_state.f90"
CONSISTENT = "core/integration/mud_consistent.f90"
SUBSTEPPING = "core/integration/mud_substepping.f90"
DRIVING = "core/integration/mud_driving.f90"

MUTATIONS = [
    # those the issue names
    ("halve the shear weight of the contraction",
     (TENSOR, "+ 2.0_wp*(a(4)*b(4) + a(5)*b(5) + a(6)*b(6))", "+ (a(4)*b(4) + a(5)*b(5) + a(6)*b(6))")),
    ("drop the -r of the hardening direction",
     (RATES, "w%t = 2.0_wp*w%g*d_e - w%r*volumetric", "w%t = 2.0_wp*w%g*d_e")),
    ("swap two shear components in square()",
     (TENSOR, "c(5) = a(5)*(a(1) + a(3)) + a(4)*a(6)", "c(6) = a(5)*(a(1) + a(3)) + a(4)*a(6)"),
     (TENSOR, "c(6) = a(6)*(a(2) + a(3)) + a(4)*a(5)", "c(5) = a(6)*(a(2) + a(3)) + a(4)*a(5)")),
    ("swap two shear components in rotate()",
     (TENSOR, "full(1, 2), full(1, 3), full(2, 3)]", "full(1, 3), full(1, 2), full(2, 3)]")),
    ("freeze the fabric", (TRIAL, "dy(7:12) = w%d_z", "dy(7:12) = 0.0_wp*w%d_z")),
    # tensors and elasticity
    ("transpose the rotation",
     (TENSOR, "matmul(r, matmul(full, transpose(r)))", "matmul(transpose(r), matmul(full, r))")),
    ("bulk modulus with the exponent of the shear modulus", (ELASTIC, "(2.0_wp/3.0_wp)", "0.5_wp")),
    ("shear modulus without the square", (ELASTIC, "(2.97_wp - e)**2", "(2.97_wp - e)")),
    ("no smallest mean stress in the stress ratio",
     (RATES, "p = max(trace(sigma)/3.0_wp, par%p_min)", "p = trace(sigma)/3.0_wp + 0.0_wp*par%p_min")),
    # critical state and flow
    ("sign of the dilatancy", (FLOW, "d = a_d*(r_d - r_n)", "d = -a_d*(r_d - r_n)")),
    ("dilatancy without the Lode factor", (DIRECTION, "r_d = SQRT_2_3*w%lode*w%m_d", "r_d = SQRT_2_3*w%m_d")),
    ("fabric also grows in contraction", (FLOW, ".and. d < 0.0_wp) dz", ") dz")),
    ("fabric acts in every direction", (FLOW, "max(z_n, 0.0_wp)", "z_n")),
    ("drop the Lode slope", (CRITICAL, "slope = par%lode_bend*g**5", "slope = 0.0_wp*par%lode_bend*g**5")),
    ("Lode factor with c squared", (PARAMS, "params%c4 = params%c**4", "params%c4 = params%c**2")),
    ("no Macaulay brackets in the bounding ratio",
     (CRITICAL, "min(max(-par%n_b*psi, 0.0_wp), EXPONENT_LIMIT)", "min(-par%n_b*psi, EXPONENT_LIMIT)")),
    ("dilatancy ratio with n_b", (CRITICAL, "min(max(par%n_d*psi", "min(max(par%n_b*psi")),
    ("compression line without f", (CRITICAL, "(par%n_l*f/e)", "(par%n_l/e + 0.0_wp*f)")),
    ("critical state line without f", (CRITICAL, "e_c = par%n_c*f*", "e_c = par%n_c*")),
    # hardening
    ("kinematic hardening without the void ratio",
     (HARDENING, "max(1.0_wp - par%c_h*e, SMALLEST_VOID_TERM)", "1.0_wp")),
    ("isotropic mechanism without its weight",
     (HARDENING, "iso%share = weight*e/(1.0_wp + e)", "iso%share = e/(1.0_wp + e)")),
    ("isotropic mechanism without the change of f with suction",
     (HARDENING, "iso%b = -iso%share", "iso%b = -0.0_wp*iso%share")),
    ("isotropic mechanism with twice kappa",
     (HARDENING, "(par%lambda - kappa)*iso%f", "(par%lambda - 2.0_wp*kappa)*iso%f")),
    ("wrong sign of df/de", (BONDING, "bond%df_de = -bond%slope", "bond%df_de = bond%slope")),
    ("meniscus force without suction in the divisor",
     (BONDING, "divisor = FORCE_A + FORCE_B*t", "divisor = FORCE_A + 0.0_wp*FORCE_B*t")),
    ("retention without Omega in dS_w/de", (RETENTION, "sat%ds_de = slope*par%omega/e", "sat%ds_de = slope/e")),
    ("retention without the void ratio",
     (RETENTION, "log_suction + par%omega*log(e)", "log_suction + 0.0_wp*log(e)")),
    # rates and guards
    ("isotropic mechanism never rejected", (RATES, "w%b_rate < 0.0_wp) then", "w%b_rate < -huge(1.0_wp)) then")),
    ("isotropic mechanism acts in extension too",
     (RATES, "if (w%iso_drive > 0.0_wp) then", "if (abs(w%iso_drive) > 0.0_wp) then")),
    ("no floor", (DIRECTION, "w%h_b = max(w%x, par%x_floor)/w%b_0", "w%h_b = max(w%x, 1.0e-15_wp)/w%b_0")),
    ("no contraction cap", (DIRECTION, "w%d = limit", "w%d = w%d")),
    ("softening cap twice as large", (DIRECTION, "w%h_b = limit\n", "w%h_b = 2.0_wp*limit\n")),
    ("first root found taken",
     (DIRECTION, "if (.not. w%several) return", "if (.not. w%several .or. last > 0.0_wp) return")),
    ("no look at the floor before a rising (r - r_in):n",
     (DIRECTION, "single_root = side*there%residual < 0.0_wp", "single_root = there%scale > 0.0_wp")),
    ("plastic shear without sqrt(2/3)", (RATES, "w%d_eps_q = SQRT_2_3*w%l", "w%d_eps_q = w%l")),
    # memory
    ("forget to store the memory", (REVERSAL, "      memory%r_in = r_in\n", "      memory%r_in = memory%r_in\n")),
    ("forget to zero the plastic shear at a reversal",
     (REVERSAL, "memory%r_in = r_in\n      memory%eps_q_p = 0.0_wp",
      "memory%r_in = r_in\n      memory%eps_q_p = memory%eps_q_p")),
    ("threshold weight on the wrong memory", (REVERSAL, "*(memory%r_before - r)", "*(memory%r_in - r)")),
    ("no fall-back of the threshold rule", (REVERSAL, "if (ddot(r - r_in, n) < 0.0_wp) r_in = r", "continue")),
    ("repositioning with the process that ends",
     (REVERSAL, "x_before = memory%x_before\n", "x_before = memory%x_running\n")),
    ("return_point follows the stress ratio", (RETURN_POINT, "memory%direction = place%chord/place%length", "memory%direction = place%r/norm(place%r)")),
    ("return_point notes every direction", (RETURN_POINT, "SMALLEST_COSINE = 0.7_wp", "SMALLEST_COSINE = -2.0_wp")),
    ("return_point notes its turning point where a substep ends",
     (EVENTS, "call land_on(par, inc, EVENT_TURN, size, probe, counters, landed)", "landed = 0")),
    ("return_point notes progress against its chord", (RETURN_POINT, "along = ddot(t, place%chord)", "along = abs(ddot(t, place%chord))")),
    ("return_point forgets how far it came",
     (RETURN_POINT, "max(memory%target, ddot(r, memory%direction))", "max(memory%target, 0.0_wp*r(1))")),
    ("return_point hands its direction to the next process",
     (RETURN_POINT, "      memory%direction = 0.0_wp\n", "      memory%direction = memory%direction\n")),
    ("return_point keeps a drift",
     (REVERSAL, "if (ddot(t, memory%direction) <= 0.0_wp) call", "if (ddot(t, memory%direction) < huge(1.0_wp)) call")),
    ("return_point drops its oldest loops", (RETURN_POINT, "memory%depth = MAX_INTERRUPTED - 2", "memory%depth = 0")),
    ("return_point looks at the newest process only", (RETURN_POINT, "      k = k - 1\n", "      k = 0\n")),
    ("a target beyond the bounding surface",
     (RETURN_POINT, "min(process%target, target_limit(par, process)*m_b)", "process%target")),
    ("return_point takes the harder memory", (RETURN_POINT, ">= ddot(r - memory%r_in, t))", "< ddot(r - memory%r_in, t))")),
    ("return_point restores no target", (RETURN_POINT, "memory%target = process%target", "memory%target = memory%target")),
    ("no reversal inside a substep", (EVENTS, "may_reverse = last%loading .and.", "may_reverse = .false. .and.")),
    ("reversals are looked for wherever x is below zero",
     (EVENTS, "(last%x < -par%x_rev .or.", "(last%x < 0.0_wp .or.")),
    ("an event's time is frozen", (EVENT_TIME, "dh = -slopes(j)/slopes(BY_SIZE)", "dh = 0.0_wp*slopes(j)")),
    ("substeps behind an event keep their place",
     (EVENT_TIME, "sens%shift(j) = sens%shift(j) + dh", "sens%shift(j) = sens%shift(j) + 0.0_wp*dh")),
    ("a reversal in a jump is timed like others", (EVENT_TIME, "FOUND = 1.0e-6_wp", "FOUND = 1.0e9_wp")),
    ("a held point does not follow the strain",
     (CUTOFF, "change = dr0 + deviator(stiffness*d_strain)", "change = dr0 + 0.0_wp*deviator(stiffness*d_strain)")),
    ("hysteresis the other way round", (TRANSITIONS, "%x >= -par%x_rev .and. event", "%x >= par%x_rev .and. event")),
    ("reversals never found", (TRANSITIONS, "%x >= -par%x_rev .and. event /= EVENT_REVERSAL", "%x >= -huge(1.0_wp)")),
    # integration
    ("suction stays at its start",
     (INCREMENT, "p_c = inc%p_c0 + time*inc%d_pc", "p_c = inc%p_c0 + 0.0_wp*time*inc%d_pc")),
    ("void ratio linear in the increment",
     (INCREMENT, "e = (1.0_wp + e)*exp(-inc%d_v*time) - 1.0_wp", "e = e - (1.0_wp + e)*inc%d_v*time")),
    ("error norm without the stress",
     (TRIAL, "error = max(norm(delta(1:6))/", "error = max(0.0_wp*norm(delta(1:6))/")),
    ("a weight of Dormand-Prince mistyped", (SUBSTEP, "19372.0_wp/6561", "19732.0_wp/6561")),
    ("an error weight of Bogacki-Shampine mistyped", (SUBSTEP, "[-5.0_wp/72, ", "[-5.0_wp/27, ")),
    ("growth right after a rejection", (SUBSTEP, "factor = min(factor, 1.0_wp)", "factor = min(factor, 2.0_wp)")),
    # tension cut-off
    ("p' is not held at the opening",
     (EVENTS, "< 3.0_wp*par%p_min) call land_on(par, inc, EVENT_OPENS",
      "< -huge(1.0_wp)) call land_on(par, inc, EVENT_OPENS")),
    ("closing remembers the gap", (TRANSITIONS, "state%memory = new_memory(r)", "state%memory%depth = state%memory%depth")),
    ("open stress ratio beyond the bounding surface", (BOUNDING, "if (beyond > 0.0_wp) r_limited", "if (beyond > 1.0e9_wp) r_limited")),
    ("an open point never closes",
     (TRANSITIONS, "closing_rate(inc, trial, trial%w(1)) <= 0.0_wp", "closing_rate(inc, trial, trial%w(1)) <= huge(1.0_wp)")),
    ("tension is not reported", (POINT, "if (has_tension(state1%sigma)) counters%tensile = 1", "continue")),
    # elastic domain
    ("the elastic domain forgets the strain inside",
     (PHASES, "whole%from_centre + share*whole%d_strain", "whole%from_centre + 0.0_wp*share")),
    ("strain beside the loading direction is lost",
     (INCREMENT, "aside = inc%d_strain - loading", "aside = 0.0_wp*loading")),
    ("no bounding surface inside the elastic domain", (EVENTS, "LARGEST_EXCESS = 0.2_wp", "LARGEST_EXCESS = 1.0e9_wp")),
    ("the tangent does not know where the elastic domain ends",
     (DRIVING, "change = changes_of_exit", "change = 0.0_wp*changes_of_exit")),
    # kinks of suction, and the step control
    ("suction passes zero inside a substep", (PHASES, "share = -inc%p_c0/inc%d_pc", "share = 1.0_wp")),
    ("modified Euler never hands over", (SUBSTEPPING, "MANY_SUBSTEPS = 50.0_wp", "MANY_SUBSTEPS = 1.0e9_wp")),
    # tables
    ("two parameters swapped", (PARAMS, "params%n_b = props(P_N_B)", "params%n_b = props(P_N_D)")),
    ("a default mistyped", (REGISTRY, "3370.0_wp", "3730.0_wp")),
]

MORTAR, RESPONSE, PENALTY = "contact/contact_mortar.f90", "contact/contact_response.f90", "contact/contact_penalty.f90"
SEARCH, PLATE, JOINED = "contact/contact_search.f90", "contact/contact_plate.f90", "contact/contact_interfaces.f90"
DRAINAGE = "model/contact_drainage.f90"

# Of the host's contact, below host.
CONTACT = [
    ("no segments: whole halves of slave edges, points beside the master left out",
     (MORTAR, "lower = foot(2)\n      upper = foot(1)", "lower = -1.0_wp\n      upper = 1.0_wp"),
     (MORTAR, "if (where_it_is(3) == INSIDE .and. between", "if (where_it_is(3) > huge(1) .and. between"),
     (MORTAR, "merge(2, 0, where_it_is(2)", "merge(0, 0, where_it_is(2)"),
     (MORTAR, "merge(1, 0, where_it_is(1)", "merge(0, 0, where_it_is(1)"),
     (MORTAR, "if (missed > 0.0_wp) return\n            m = hats", "if (missed > 0.0_wp) cycle\n            m = hats"),
     (RESPONSE, "if (missed > 0.0_wp) return\n", "if (missed > 0.0_wp) then\n missed = 0.0_wp\n cycle\n end if\n")),
    ("segments do not end at the master's middle node",
     (MORTAR, "if (where_it_is(3) == INSIDE .and. between", "if (where_it_is(3) > huge(1) .and. between")),
    ("quadratic multipliers", (MORTAR, "m = [max(-s, 0.0_wp), max(s, 0.0_wp), 1.0_wp - abs(s)]",
                               "m = [-0.5_wp*s*(1.0_wp - s), 0.5_wp*s*(1.0_wp + s), 1.0_wp - s*s]")),
    ("no radius in the integrals", (MORTAR, "p%ring = TWO_PI*p%x(1)", "p%ring = TWO_PI")),
    ("the tangent forgets that segments move",
     (MORTAR, "d_s = d_s/(dot_product(t, t)", "d_s = 0.0_wp*d_s/(dot_product(t, t)")),
    ("the tangent forgets that normals turn",
     (MORTAR, "+ p%y(1)*p%d_t(2, :) - p%y(2)*p%d_t(1, :)", "+ 0.0_wp*p%y(1)*p%d_t(2, :)")),
    ("the tangent forgets the radius", (MORTAR, "p%d_ring = TWO_PI*p%d_xs(1, :)", "p%d_ring = 0.0_wp")),
    ("the tangent forgets the nodal pressures",
     (PENALTY, "if (result%pressure(i) > 0.0_wp) call add_node", "if (result%pressure(i) > huge(1.0_wp)) call add_node")),
    ("nothing pushes the master", (RESPONSE, "push(2*i + 5:2*i + 6) = -p%nm(i)*nu", "push(2*i + 5:2*i + 6) = 0.0_wp*nu")),
    ("an open gap pulls", (PENALTY, "penalty*max(-result%gap, 0.0_wp)", "penalty*(-result%gap)")),
    ("the search does not sort", (SEARCH, "grid%side = max(mean, ", "grid%side = max(1.0e6_wp*mean, ")),
    ("the search forgets the reach", (SEARCH, "search%slave_box(1:2, e) - near", "search%slave_box(1:2, e) - 0.0_wp*near")),
    ("a plate feels nothing", (PLATE, "force = force + result%force(i)", "force = force + 0.0_wp*result%force(i)")),
    ("slopes against the values within the step", (JOINED, "values(place) + share*value(k)", "values(place) + value(k)")),
    ("a contact acts in every stage", (JOINED, "if (.not. t%acts) cycle\n            call probe_interface(t%geometry, t%fixed, t%slave, t%master, t%plate, x, with_tangent",
                                          "call probe_interface(t%geometry, t%fixed, t%slave, t%master, t%plate, x, with_tangent")),
    ("drainage without coverage", (DRAINAGE, "probe%weight >= HALF*probe%whole", "probe%weight > 0.0_wp")),
    ("drainage without pressure", (DRAINAGE, "probe%pressure > 0.0_wp .and. ", "")),
    ("a released node stays so", (DRAINAGE, "drainage%released = .false.\n      do c", "do c")),
    ("a boundary that touches the slave gives way too",
     (DRAINAGE, "shared .or. all(in_group(edges(:, e)))", "shared .or. any(in_group(edges(:, e)))")),
    ("drainage in every stage", (DRAINAGE, " .or. .not. contacts%interfaces(c)%acts) cycle", ") cycle")),
]
