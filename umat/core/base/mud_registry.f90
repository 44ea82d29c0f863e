! SPDX-License-Identifier: MIT
!> Every entry of PROPS and STATEV, once: index, name, symbol, unit, bounds, default, origin, meaning.
!> Validation, queries of the C interface, tables of the documentation and input files all come from here.
module mud_registry
   use mud_kinds, only: wp
   implicit none (type, external)
   private
   public :: property_t, variable_t, PROPERTIES, VARIABLES, NPROPS, NSTATV, NVARIABLES, STATE_LAYOUT
   public :: UNIT_STRESS, UNIT_STRESS_TO_LAMBDA, NPROPS_BASE, NSTATV_BASE, &
             NPROPS_WITHOUT_PRELOADING, NSTATV_WITHOUT_PRELOADING, NPROPS_WITHOUT_FLUIDITY, NSTATV_WITHOUT_FLUIDITY
   public :: KIND_REAL, KIND_SWITCH, KIND_OPTION, KIND_COUNT
   public :: option_t, OPTIONS, property_meaning, property_index, statev_index, statev_name, statev_variable, &
             numbered, COMPONENTS
   public :: ISOTROPIC_NONE, ISOTROPIC_FORGETS, ISOTROPIC_REMEMBERS
   public :: RULE_CLASSIC, RULE_THRESHOLD, RULE_REPOSITIONING, RULE_RETURN_POINT, SCHEME_AUTOMATIC, &
             SCHEME_OF_PAPER

   public :: P_K_0, P_G_0, P_N_C, P_LAMBDA, P_ALPHA_CSL, P_N_L, P_THETA, P_M_C, P_C, P_N_B, P_N_D, P_A_0, &
             P_H_0, P_C_H, P_C_Z, P_Z_MAX, P_B_1, P_B_2, P_S_MAX, P_S_MIN, P_P_A, P_OMEGA, P_N_X, P_M_X, P_E_0, &
             P_P_ATM, P_P_MIN, P_BONDING, P_FABRIC, P_ISOTROPIC, P_LODE, P_MEMORY_RULE, P_EPS_HAT, P_J_EXP, &
             P_X_0, P_X_REV, P_CAP_D, P_CAP_H, P_CUTOFF, P_SCHEME, P_TOLERANCE, P_H_MIN, P_MAX_SUBSTEPS, &
             P_TANGENT, P_RHO_E, P_SHEAR_ORDER, P_HYSTERESIS, P_P_AW, P_N_W, P_M_W, P_B_D, P_B_W, P_C_CHI, &
             P_ZETA_CHI, P_S_CHI, P_C_ELL, P_ELL_MAX, P_P_ELL, P_R_ELL
   public :: S_LAYOUT, S_VOID_RATIO, S_SATURATION, S_SUCTION, S_STATE_PARAMETER, S_EPS_Q_P, S_EPS_Q_P_TOTAL, &
             S_X_BEFORE, S_X_RUNNING, S_TARGET, S_INTERRUPTED, S_OPEN, S_LAST_STEP, S_FABRIC, S_MEMORY, &
             S_MEMORY_BEFORE, S_DIRECTION, S_DSIGMA_DPC, S_DSW_DPC, S_DSW_DEV, S_N_RATE, &
             S_N_SUBSTEP, S_N_REJECT, S_N_RESET, S_N_GUARD, S_N_NO_ROOT, S_N_MIN_STEP, S_N_OPEN, S_N_TENSILE, &
             S_ELASTIC_DOMAIN, S_GAP, S_MARGIN, S_STACK, ENTRY_SIZE, MAX_INTERRUPTED, S_TURNS, S_N_CLEARED, S_TURN, &
             MAX_TURNS, S_CHI, S_CHI_OWN, S_CHI_STACK, S_FLUIDITY

   integer, parameter :: STATE_LAYOUT = 4   !< Layout number that an initialised STATEV carries.
   integer, parameter :: KIND_REAL = 0, KIND_SWITCH = 1, KIND_OPTION = 2, KIND_COUNT = 3
   integer, parameter :: ISOTROPIC_NONE = 0, ISOTROPIC_FORGETS = 1, ISOTROPIC_REMEMBERS = 2
   integer, parameter :: RULE_CLASSIC = 0, RULE_THRESHOLD = 1, RULE_REPOSITIONING = 2, RULE_RETURN_POINT = 3
   !> The order follows the error; other values are pairs of mud_substep, modified Euler first.
   integer, parameter :: SCHEME_AUTOMATIC = 0, SCHEME_OF_PAPER = 1
   !> Units of the entries of PROPS that change with the unit of p_atm. Their bounds and defaults below are those for
   !> the default p_atm; mud_units converts them.
   character(10), parameter :: UNIT_STRESS = 'kPa', UNIT_STRESS_TO_LAMBDA = 'kPa^lambda'
   character(2), parameter :: COMPONENTS(6) = ['11', '22', '33', '12', '13', '23']   !< Order of tensor components.

   !> One material parameter.
   type :: property_t
      integer :: index         !< Place in PROPS, from 1.
      character(16) :: name    !< Name in input files and in the C interface.
      character(12) :: symbol  !< Symbol in the theory.
      character(10) :: unit    !< Unit, 1 if it has none.
      integer :: kind          !< KIND_REAL, KIND_SWITCH (0 or 1), KIND_OPTION or KIND_COUNT (integers).
      real(wp) :: lower        !< Smallest allowed value (kPa, kPa^lambda: at the default p_atm).
      real(wp) :: upper        !< Largest allowed value, likewise.
      real(wp) :: default      !< Value of the paper, or ours; likewise.
      character(12) :: origin  !< paper, mended, rebuilt, ours or numerical.
      character(112) :: meaning   !< Meaning; that of a KIND_OPTION is without its words, which are OPTIONS.
   end type property_t

   !> A value of a KIND_OPTION parameter, and the word for it.
   type :: option_t
      integer :: property, value
      character(24) :: word
   end type option_t

   integer, parameter :: P_K_0 = 1
   integer, parameter :: P_G_0 = 2
   integer, parameter :: P_N_C = 3
   integer, parameter :: P_LAMBDA = 4
   integer, parameter :: P_ALPHA_CSL = 5
   integer, parameter :: P_N_L = 6
   integer, parameter :: P_THETA = 7
   integer, parameter :: P_M_C = 8
   integer, parameter :: P_C = 9
   integer, parameter :: P_N_B = 10
   integer, parameter :: P_N_D = 11
   integer, parameter :: P_A_0 = 12
   integer, parameter :: P_H_0 = 13
   integer, parameter :: P_C_H = 14
   integer, parameter :: P_C_Z = 15
   integer, parameter :: P_Z_MAX = 16
   integer, parameter :: P_B_1 = 17
   integer, parameter :: P_B_2 = 18
   integer, parameter :: P_S_MAX = 19
   integer, parameter :: P_S_MIN = 20
   integer, parameter :: P_P_A = 21
   integer, parameter :: P_OMEGA = 22
   integer, parameter :: P_N_X = 23
   integer, parameter :: P_M_X = 24
   integer, parameter :: P_E_0 = 25
   integer, parameter :: P_P_ATM = 26
   integer, parameter :: P_P_MIN = 27
   integer, parameter :: P_BONDING = 28
   integer, parameter :: P_FABRIC = 29
   integer, parameter :: P_ISOTROPIC = 30
   integer, parameter :: P_LODE = 31
   integer, parameter :: P_MEMORY_RULE = 32
   integer, parameter :: P_EPS_HAT = 33
   integer, parameter :: P_J_EXP = 34
   integer, parameter :: P_X_0 = 35
   integer, parameter :: P_X_REV = 36
   integer, parameter :: P_CAP_D = 37
   integer, parameter :: P_CAP_H = 38
   integer, parameter :: P_CUTOFF = 39
   integer, parameter :: P_SCHEME = 40
   integer, parameter :: P_TOLERANCE = 41
   integer, parameter :: P_H_MIN = 42
   integer, parameter :: P_MAX_SUBSTEPS = 43
   integer, parameter :: P_TANGENT = 44
   integer, parameter :: P_RHO_E = 45
   integer, parameter :: P_SHEAR_ORDER = 46
   integer, parameter :: P_HYSTERESIS = 47, P_P_AW = 48, P_N_W = 49, P_M_W = 50, P_B_D = 51, P_B_W = 52
   integer, parameter :: P_C_CHI = 53, P_ZETA_CHI = 54, P_S_CHI = 55
   integer, parameter :: P_C_ELL = 56, P_ELL_MAX = 57, P_P_ELL = 58, P_R_ELL = 59, NPROPS = 59
   !> PROPS may end before hysteresis: it is off, and what follows has its default. Hosts with PROPS of that length, or
   !> with no room for more (PLAXIS: 50), go on as they are.
   integer, parameter :: NPROPS_BASE = P_HYSTERESIS - 1
   !> Number of PROPS before cyclic preloading.
   integer, parameter :: NPROPS_WITHOUT_PRELOADING = P_C_CHI - 1
   !> Number of PROPS before the fluidity.
   integer, parameter :: NPROPS_WITHOUT_FLUIDITY = P_C_ELL - 1

   ! Places in STATEV, each behind the one before; a tensor takes six.
   integer, parameter :: S_LAYOUT = 1, S_VOID_RATIO = S_LAYOUT + 1, S_SATURATION = S_VOID_RATIO + 1, &
      S_SUCTION = S_SATURATION + 1, S_STATE_PARAMETER = S_SUCTION + 1, S_EPS_Q_P = S_STATE_PARAMETER + 1, &
      S_EPS_Q_P_TOTAL = S_EPS_Q_P + 1, S_X_BEFORE = S_EPS_Q_P_TOTAL + 1, S_X_RUNNING = S_X_BEFORE + 1, &
      S_TARGET = S_X_RUNNING + 1, S_INTERRUPTED = S_TARGET + 1, S_OPEN = S_INTERRUPTED + 1, S_LAST_STEP = S_OPEN + 1
   integer, parameter :: S_FABRIC = S_LAST_STEP + 1, S_MEMORY = S_FABRIC + 6, S_MEMORY_BEFORE = S_MEMORY + 6, &
      S_DIRECTION = S_MEMORY_BEFORE + 6, S_DSIGMA_DPC = S_DIRECTION + 6, S_DSW_DPC = S_DSIGMA_DPC + 6, &
      S_DSW_DEV = S_DSW_DPC + 1
   integer, parameter :: S_N_RATE = S_DSW_DEV + 1, S_N_SUBSTEP = S_N_RATE + 1, S_N_REJECT = S_N_SUBSTEP + 1, &
      S_N_RESET = S_N_REJECT + 1, S_N_GUARD = S_N_RESET + 1, S_N_NO_ROOT = S_N_GUARD + 1, &
      S_N_MIN_STEP = S_N_NO_ROOT + 1, S_N_OPEN = S_N_MIN_STEP + 1, S_N_TENSILE = S_N_OPEN + 1
   integer, parameter :: S_ELASTIC_DOMAIN = S_N_TENSILE + 1
   !> Interrupted processes of the rule return_point, the oldest first: memory, direction and target of each.
   integer, parameter :: MAX_INTERRUPTED = 4, ENTRY_SIZE = 13
   integer, parameter :: S_GAP = S_ELASTIC_DOMAIN + 6
   integer, parameter :: S_MARGIN = S_GAP + 1, S_STACK = S_MARGIN + 1
   !> STATEV may end here without hysteresis.
   integer, parameter :: NSTATV_BASE = S_STACK - 1 + ENTRY_SIZE*MAX_INTERRUPTED
   !> Turning points of suction, the oldest first: ln(x/P_a) and S_w of each. Four leave a finite effect of vanishing
   !> noise, six are the least, eight bear noise on five nested loops.
   integer, parameter :: MAX_TURNS = 8
   integer, parameter :: S_TURNS = NSTATV_BASE + 1, S_N_CLEARED = S_TURNS + 1, S_TURN = S_N_CLEARED + 1
   !> STATEV may end here without cyclic preloading.
   integer, parameter :: NSTATV_WITHOUT_PRELOADING = S_TURN - 1 + 2*MAX_TURNS
   integer, parameter :: S_CHI = NSTATV_WITHOUT_PRELOADING + 1, S_CHI_OWN = S_CHI + 1, S_CHI_STACK = S_CHI_OWN + 1
   !> STATEV may end here without fluidity.
   integer, parameter :: NSTATV_WITHOUT_FLUIDITY = S_CHI_STACK - 1 + MAX_INTERRUPTED
   integer, parameter :: S_FLUIDITY = NSTATV_WITHOUT_FLUIDITY + 1
   integer, parameter :: NSTATV = S_FLUIDITY

   !> One state variable: a scalar or a tensor of six components; or several of a kind, whose number texts have for #.
   type :: variable_t
      integer :: first         !< First place in STATEV, from 1.
      integer :: size          !< 1 or 6.
      character(16) :: name
      character(12) :: symbol
      character(8) :: unit
      logical :: rotates       !< DROT acts on it.
      character(12) :: origin
      character(112) :: meaning
      character(20) :: initial !< Word for its value at the start.
      character(64) :: evolution !< Sentence on how and when it changes.
      integer :: copies = 1     !< So many of a kind ...
      integer :: stride = NSTATV !< ... so far apart in STATEV.
   end type variable_t

   type(property_t), parameter :: PROPERTIES(NPROPS) = [ &
      property_t(P_K_0, 'K_0', 'K_0', '1', KIND_REAL, 0.001_wp, 1.0e5_wp, 150.0_wp, 'paper', &
         'bulk modulus number, eq. (2)'), &
      property_t(P_G_0, 'G_0', 'G_0', '1', KIND_REAL, 0.001_wp, 1.0e5_wp, 125.0_wp, 'paper', &
         'shear modulus number, eq. (3)'), &
      property_t(P_N_C, 'N_c', 'N_c', UNIT_STRESS_TO_LAMBDA, KIND_REAL, 0.001_wp, 10000.0_wp, 18.7_wp, 'paper', &
         'position of the critical state line in ln e - ln p'', eq. (8)'), &
      property_t(P_LAMBDA, 'lambda', 'lambda', '1', KIND_REAL, 0.001_wp, 5.0_wp, 0.37_wp, 'paper', &
         'slope of the critical state line and of the compression line, eqs (7), (8)'), &
      property_t(P_ALPHA_CSL, 'alpha_csl', 'alpha_csl', UNIT_STRESS, KIND_REAL, 0.0_wp, 1.0e6_wp, 3370.0_wp, 'paper', &
         'shift of p'' in the critical state line, eq. (8)'), &
      property_t(P_N_L, 'N_l', 'N_l', UNIT_STRESS_TO_LAMBDA, KIND_REAL, 0.001_wp, 10000.0_wp, 25.0_wp, 'paper', &
         'position of the compression line in ln e - ln p'', eq. (7)'), &
      property_t(P_THETA, 'theta', 'theta', '1', KIND_REAL, 0.01_wp, 5.0_wp, 0.2_wp, 'mended', &
         'exponent of the distance to the compression line, eq. (4); missing in the paper''s Table 2'), &
      property_t(P_M_C, 'M_c', 'M_c', '1', KIND_REAL, 0.1_wp, 2.5_wp, 1.25_wp, 'paper', &
         'critical stress ratio q/p'' in triaxial compression'), &
      property_t(P_C, 'c', 'c', '1', KIND_REAL, 0.611_wp, 1.0_wp, 0.712_wp, 'paper', &
         'M_e/M_c, strength in extension over compression; the surface is convex from 0.611'), &
      property_t(P_N_B, 'n_b', 'n_b', '1', KIND_REAL, 0.0_wp, 20.0_wp, 1.25_wp, 'paper', &
         'dependence of the bounding stress ratio on the state parameter, eq. (12)'), &
      property_t(P_N_D, 'n_d', 'n_d', '1', KIND_REAL, 0.0_wp, 20.0_wp, 2.1_wp, 'paper', &
         'dependence of the dilatancy stress ratio on the state parameter, eq. (10)'), &
      property_t(P_A_0, 'A_0', 'A_0', '1', KIND_REAL, 0.0_wp, 20.0_wp, 0.4_wp, 'paper', &
         'dilatancy constant, eq. (9)'), &
      property_t(P_H_0, 'h_0', 'h_0', '1', KIND_REAL, 0.001_wp, 10000.0_wp, 12.0_wp, 'paper', &
         'kinematic hardening constant, eq. (13)'), &
      property_t(P_C_H, 'c_h', 'c_h', '1', KIND_REAL, 0.0_wp, 5.0_wp, 0.968_wp, 'paper', &
         'void ratio in the kinematic hardening, eq. (13)'), &
      property_t(P_C_Z, 'c_z', 'c_z', '1', KIND_REAL, 0.0_wp, 1.0e5_wp, 600.0_wp, 'paper', &
         'rate of fabric evolution'), &
      property_t(P_Z_MAX, 'z_max', 'z_max', '1', KIND_REAL, 1e-06_wp, 1000.0_wp, 4.0_wp, 'paper', &
         'largest fabric'), &
      property_t(P_B_1, 'b_1', 'b_1', '1', KIND_REAL, 0.0_wp, 10.0_wp, 0.5_wp, 'paper', &
         'bonding function, eq. (5)'), &
      property_t(P_B_2, 'b_2', 'b_2', '1', KIND_REAL, 0.0_wp, 5.0_wp, 0.5_wp, 'paper', &
         'bonding function, eq. (5)'), &
      property_t(P_S_MAX, 'S_max', 'S_max', '1', KIND_REAL, 0.001_wp, 1.0_wp, 1.0_wp, 'paper', &
         'largest degree of saturation, eq. (24); S_i of Table 3'), &
      property_t(P_S_MIN, 'S_min', 'S_min', '1', KIND_REAL, 0.0_wp, 0.999_wp, 0.0_wp, 'paper', &
         'residual degree of saturation, eq. (24), below S_max; S_rw of Table 3'), &
      property_t(P_P_A, 'P_a', 'P_a', UNIT_STRESS, KIND_REAL, 1e-06_wp, 1000000.0_wp, 5.0_wp, 'paper', &
         'air-entry value, eq. (24)'), &
      property_t(P_OMEGA, 'Omega', 'Omega', '1', KIND_REAL, 0.0_wp, 20.0_wp, 2.0_wp, 'paper', &
         'void ratio in the modified suction p_c e^Omega, eq. (23)'), &
      property_t(P_N_X, 'n_x', 'n_x', '1', KIND_REAL, 1.0_wp, 20.0_wp, 2.0_wp, 'paper', &
         'inner exponent of the retention curve, eq. (24)'), &
      property_t(P_M_X, 'm_x', 'm_x', '1', KIND_REAL, 0.001_wp, 20.0_wp, 1.0_wp, 'paper', &
         'outer exponent of the retention curve, eq. (24)'), &
      property_t(P_E_0, 'e_0', 'e_0', '1', KIND_REAL, 0.01_wp, 5.0_wp, 0.8_wp, 'ours', &
         'initial void ratio, used where the host has not preset STATEV'), &
      property_t(P_P_ATM, 'p_atm', 'p_atm', UNIT_STRESS, KIND_REAL, 1e-06_wp, 1000000000.0_wp, 101.325_wp, 'paper', &
         'atmospheric pressure; its unit is the unit of all stresses, and the bounds in kPa scale with it'), &
      property_t(P_P_MIN, 'p_min', 'p_min', UNIT_STRESS, KIND_REAL, 0.0_wp, 1000000.0_wp, 0.0_wp, 'numerical', &
         'smallest mean effective stress, tension cut-off; 0: 1e-3 p_atm; otherwise at least 1e-11 p_atm'), &
      property_t(P_BONDING, 'bonding', 'bonding', '1', KIND_SWITCH, 0.0_wp, 1.0_wp, 1.0_wp, 'paper', &
         '1: suction bonding zeta acts on the lines of eqs (7), (8); 0: f = 1'), &
      property_t(P_FABRIC, 'fabric', 'fabric', '1', KIND_SWITCH, 0.0_wp, 1.0_wp, 1.0_wp, 'rebuilt', &
         '1: fabric z evolves and acts on dilatancy; 0: A_d = A_0'), &
      property_t(P_ISOTROPIC, 'isotropic', 'isotropic', '1', KIND_OPTION, 0.0_wp, 2.0_wp, 2.0_wp, 'mended', &
         'isotropic mechanism, eq. (4)'), &
      property_t(P_LODE, 'lode', 'lode', '1', KIND_SWITCH, 0.0_wp, 1.0_wp, 1.0_wp, 'rebuilt', &
         '1: strength depends on the Lode angle; 0: circle of M_c'), &
      property_t(P_MEMORY_RULE, 'memory_rule', 'rule', '1', KIND_OPTION, 0.0_wp, 3.0_wp, 3.0_wp, 'ours', &
         ''), &
      property_t(P_EPS_HAT, 'eps_hat', 'eps_hat', '1', KIND_REAL, 1e-12_wp, 1.0_wp, 0.0001_wp, 'paper', &
         'plastic shear below which a process counts as an oscillation, eq. (16); value of Dafalias & Taiebat 2016'), &
      property_t(P_J_EXP, 'j_exp', 'j', '1', KIND_REAL, 0.01_wp, 100.0_wp, 1.0_wp, 'paper', &
         'exponent of eq. (16)'), &
      property_t(P_X_0, 'x_0', 'x_0', '1', KIND_REAL, 0.0_wp, 1.0_wp, 0.003_wp, 'numerical', &
         'floor of (r - r_in):n in the hardening; 0: off'), &
      property_t(P_X_REV, 'x_rev', 'x_rev', '1', KIND_REAL, 0.0_wp, 1.0_wp, 0.001_wp, 'numerical', &
         'hysteresis of the reversal test; 0: off'), &
      property_t(P_CAP_D, 'cap_d', 'k_D', '1', KIND_REAL, 0.0_wp, 0.999_wp, 0.95_wp, 'numerical', &
         'contraction cap as a share of 2G/(K r:n); 0: off'), &
      property_t(P_CAP_H, 'cap_h', 'kappa_c', '1', KIND_REAL, 0.0_wp, 0.999_wp, 0.5_wp, 'numerical', &
         'softening cap; 0: off'), &
      property_t(P_CUTOFF, 'cutoff', 'cutoff', '1', KIND_SWITCH, 0.0_wp, 1.0_wp, 1.0_wp, 'numerical', &
         '1: tension cut-off at p_min; 0: off'), &
      property_t(P_SCHEME, 'scheme', 'scheme', '1', KIND_OPTION, 0.0_wp, 3.0_wp, 0.0_wp, 'ours', &
         ''), &
      property_t(P_TOLERANCE, 'tolerance', 'tol', '1', KIND_REAL, 1e-12_wp, 0.1_wp, 1e-05_wp, 'paper', &
         'relative tolerance of the stress integration'), &
      property_t(P_H_MIN, 'h_min', 'h_min', '1', KIND_REAL, 1e-12_wp, 0.1_wp, 1e-07_wp, 'numerical', &
         'smallest substep as a share of the increment'), &
      property_t(P_MAX_SUBSTEPS, 'max_substeps', 'n_max', '1', KIND_COUNT, 1.0_wp, 1.0e8_wp, 1.0e5_wp, 'numerical', &
         'largest number of attempted substeps in an update'), &
      property_t(P_TANGENT, 'tangent', 'tangent', '1', KIND_OPTION, 0.0_wp, 3.0_wp, 3.0_wp, 'ours', &
         'tangent that umat_ returns'), &
      property_t(P_RHO_E, 'rho_e', 'rho_e', '1', KIND_REAL, 0.0_wp, 0.01_wp, 2.0e-5_wp, 'ours', &
         'radius of the elastic domain, a norm of the strain tensor; 0: none, as in the paper'), &
      property_t(P_SHEAR_ORDER, 'shear_order', '-', '1', KIND_SWITCH, 0.0_wp, 1.0_wp, 0.0_wp, 'ours', &
         'shear components of umat_: 0 as 12, 13, 23 (Abaqus, CalculiX), 1 as 12, 23, 13 (Kratos)'), &
      property_t(P_HYSTERESIS, 'hysteresis', '-', '1', KIND_SWITCH, 0.0_wp, 1.0_wp, 0.0_wp, 'ours', &
         '1: S_w is a state between main drying (P_a, n_x, m_x) and main wetting (P_aw, n_w, m_w); 0: one curve'), &
      property_t(P_P_AW, 'P_aw', 'P_aw', UNIT_STRESS, KIND_REAL, 0.0_wp, 1000000.0_wp, 0.0_wp, 'ours', &
         'main wetting curve''s P_a, at most P_a; 0: half of P_a (Kool & Parker 1987); with hysteresis'), &
      property_t(P_N_W, 'n_w', 'n_w', '1', KIND_REAL, 0.0_wp, 20.0_wp, 0.0_wp, 'ours', &
         'main wetting curve''s inner exponent, 1 to n_x; 0: n_x; with hysteresis'), &
      property_t(P_M_W, 'm_w', 'm_w', '1', KIND_REAL, 0.0_wp, 20.0_wp, 0.0_wp, 'ours', &
         'main wetting curve''s outer exponent, at least m_x; 0: m_x; with hysteresis'), &
      property_t(P_B_D, 'b_d', 'b_d', '1', KIND_REAL, 0.0_wp, 100.0_wp, 3.7_wp, 'ours', &
         'how flat drying scanning curves begin (Zhou et al. 2012); with hysteresis'), &
      property_t(P_B_W, 'b_w', 'b_w', '1', KIND_REAL, 1.001_wp, 100.0_wp, 2.9_wp, 'ours', &
         'how flat wetting scanning curves begin; below 1 they would leave the main curves; with hysteresis'), &
      property_t(P_C_CHI, 'c_chi', 'c_chi', '1', KIND_REAL, 0.0_wp, 100.0_wp, 0.0_wp, 'ours', &
         'cyclic preloading: how much earlier contraction a process of virgin size forgets; 0: off'), &
      property_t(P_ZETA_CHI, 'zeta_chi', 'zeta_chi', '1', KIND_REAL, 0.0_wp, 1.0e6_wp, 3000.0_wp, 'ours', &
         'how fast dilation takes the contraction back that preloads; with c_chi'), &
      property_t(P_S_CHI, 's_chi', 's_chi', '1', KIND_REAL, 0.0_wp, 1.0_wp, 0.25_wp, 'ours', &
         'how much preloading stiffens, beside how much it keeps from contracting; with c_chi'), &
      property_t(P_C_ELL, 'c_ell', 'c_ell', '1', KIND_REAL, 0.0_wp, 1.0e6_wp, 0.0_wp, 'ours', &
         'fluidity: how fast shear at a vanishing mean stress makes it grow; 0: off'), &
      property_t(P_ELL_MAX, 'ell_max', 'ell_max', '1', KIND_REAL, 1.0e-3_wp, 1.0e4_wp, 20.0_wp, 'ours', &
         'largest fluidity: A_0 and b_0 fall to 1/(1 + ell_max) at p'' = 0; with c_ell'), &
      property_t(P_P_ELL, 'p_ell', 'p_ell', UNIT_STRESS, KIND_REAL, 0.0_wp, 1.0e4_wp, 0.0_wp, 'ours', &
         'p'' below which fluidity grows and acts; 0: 30 kPa where p_atm is 101.325; with c_ell'), &
      property_t(P_R_ELL, 'r_ell', 'r_ell', '1', KIND_REAL, 0.0_wp, 1.0e6_wp, 300.0_wp, 'ours', &
         'how fast a decrease of volume takes the fluidity back; with c_ell')]

   type(variable_t), parameter :: VARIABLES(*) = [ &
      variable_t(S_LAYOUT, 1, 'layout', '-', '1', .false., 'ours', &
         '0: not initialised; otherwise the layout number', 'set to '//achar(iachar('0') + STATE_LAYOUT), 'never'), &
      variable_t(S_VOID_RATIO, 1, 'void_ratio', 'e', '1', .false., 'paper', &
         'void ratio; preset it (layout = 0) to override e_0', 'preset or e_0', &
         '1 + e falls with exp(-eps_v), exactly'), &
      variable_t(S_SATURATION, 1, 'saturation', 'S_w', '1', .false., 'paper', &
         'degree of saturation; with hysteresis a state: preset it (layout = 0) to start between the main curves', &
         'preset or eq. (24)', 'eq. (24), with hysteresis along its branch, at the end'), &
      variable_t(S_SUCTION, 1, 'suction', 'p_c', 'kPa', .false., 'paper', &
         'suction at the end of the last increment', 'PREDEF(1) or preset', 'by DPRED(1)'), &
      variable_t(S_STATE_PARAMETER, 1, 'state_parameter', 'psi', '1', .false., 'paper', &
         'e - e_c, eq. (8)', 'from e, p'', p_c', 'computed at the end of the increment'), &
      variable_t(S_EPS_Q_P, 1, 'eps_q_p', 'eps_q^p', '1', .false., 'paper', &
         'plastic shear of the present loading process, eq. (16)', '0', &
         'grows with plastic shear; 0 at a reset or return of the memory'), &
      variable_t(S_EPS_Q_P_TOTAL, 1, 'eps_q_p_total', '-', '1', .false., 'ours', &
         'plastic shear of all processes', '0', 'grows with plastic shear'), &
      variable_t(S_X_BEFORE, 1, 'x_before', 'J', '1', .false., 'paper', &
         '(r - r_in):n at the end of the process before (rule repositioning)', '0', 'set at a reversal'), &
      variable_t(S_X_RUNNING, 1, 'x_running', 'x', '1', .false., 'paper', &
         '(r - r_in):n of the last accepted rate with x >= 0', '0', 'set by every accepted substep'), &
      variable_t(S_TARGET, 1, 'target', 'T:n_t', '1', .false., 'ours', &
         'how far r has come along direction in the present process (rule return_point)', '0', &
         'with direction; restored where an interrupted process goes on'), &
      variable_t(S_INTERRUPTED, 1, 'interrupted', '-', '1', .false., 'ours', &
         'number of interrupted processes that are remembered (rule return_point)', '0', &
         'grows at a reversal, falls at a return'), &
      variable_t(S_OPEN, 1, 'open', '-', '1', .false., 'numerical', &
         '1 while the tension cut-off holds p'' at p_min', '0', &
         'set where p'' would fall below p_min, 0 when p'' rises again'), &
      variable_t(S_LAST_STEP, 1, 'last_step', 'h', '1', .false., 'numerical', &
         'last substep proposed, in units of strain', '0', 'set by every accepted substep'), &
      variable_t(S_FABRIC, 6, 'fabric', 'z', '1', .true., 'rebuilt', &
         'fabric deviator', '0', 'grows against n in dilation, bounded by z_max'), &
      variable_t(S_MEMORY, 6, 'memory', 'r_in', '1', .true., 'paper', &
         'stress ratio where the present loading process began', 'r', 'jumps at a reversal, by the memory rule'), &
      variable_t(S_MEMORY_BEFORE, 6, 'memory_before', 'r_prev', '1', .true., 'paper', &
         'memory of the loading process before the present one (rule threshold)', 'r', 'set where memory jumps'), &
      variable_t(S_DIRECTION, 6, 'direction', 'n_t', '1', .true., 'ours', &
         'direction in which the present process moves r, the chord from memory (rule return_point)', '0', &
         'set by accepted plastic substeps; restored at a return'), &
      variable_t(S_DSIGMA_DPC, 6, 'dsigma_dpc', '-', '1', .true., 'paper', &
         'output: d sigma''/d p_c in the sign convention of STRESS', '0', 'written with every tangent'), &
      variable_t(S_DSW_DPC, 1, 'dsw_dpc', '-', '1/kPa', .false., 'paper', &
         'output: d S_w/d p_c at constant e', 'eq. (24)', 'written by every update'), &
      variable_t(S_DSW_DEV, 1, 'dsw_dev', '-', '1', .false., 'paper', &
         'output: d S_w/d eps_v at constant p_c, eps_v in the sign convention of STRAN', 'eq. (24)', &
         'written by every update'), &
      variable_t(S_N_RATE, 1, 'n_rate', '-', '1', .false., 'ours', &
         'total: rate evaluations', '0', 'adds up'), &
      variable_t(S_N_SUBSTEP, 1, 'n_substep', '-', '1', .false., 'ours', &
         'total: accepted substeps', '0', 'adds up'), &
      variable_t(S_N_REJECT, 1, 'n_reject', '-', '1', .false., 'ours', &
         'total: rejected substeps', '0', 'adds up'), &
      variable_t(S_N_RESET, 1, 'n_reset', '-', '1', .false., 'ours', &
         'total: resets of the memory', '0', 'adds up'), &
      variable_t(S_N_GUARD, 1, 'n_guard', '-', '1', .false., 'ours', &
         'total: times the floor, a cap or x_rev acted or the isotropic mechanism contradicted itself', &
         '0', 'adds up'), &
      variable_t(S_N_NO_ROOT, 1, 'n_no_root', '-', '1', .false., 'ours', &
         'total: rates without an admissible direction, taken as elastic', '0', 'adds up'), &
      variable_t(S_N_MIN_STEP, 1, 'n_min_step', '-', '1', .false., 'ours', &
         'total: substeps accepted at the minimum size (without any guard)', '0', 'adds up'), &
      variable_t(S_N_OPEN, 1, 'n_open', '-', '1', .false., 'ours', &
         'total: substeps held by the tension cut-off', '0', 'adds up'), &
      variable_t(S_N_TENSILE, 1, 'n_tensile', '-', '1', .false., 'ours', &
         'total: increments that ended with a tensile principal effective stress', '0', 'adds up'), &
      variable_t(S_ELASTIC_DOMAIN, 6, 'elastic_domain', 'd', '1', .true., 'ours', &
         'strain from the centre of the elastic domain (rho_e > 0), compression positive', '0', &
         'follows the strain, |d| <= rho_e'), &
      variable_t(S_GAP, 1, 'gap', 'e_g', '1', .false., 'numerical', &
         'part of the void ratio: the gap between grains that have parted at p_min', '0', &
         'grows and shrinks with e while a held point is at its loosest'), &
      variable_t(S_MARGIN, 1, 'isotropic_margin', 'u', '1', .false., 'ours', &
         'how far compression is from where it was before, as ln p''; 0: there; with isotropic = 2', '0', &
         'falls where compression ceases, rises with it to 0'), &
      variable_t(S_STACK, 6, 'memory_#', 'r_in,#', '1', .true., 'ours', &
         'memory of the interrupted process #; the first is the oldest (rule return_point)', '0', &
         'set where the process is interrupted', MAX_INTERRUPTED, ENTRY_SIZE), &
      variable_t(S_STACK + 6, 6, 'direction_#', 'n_#', '1', .true., 'ours', &
         'direction of the interrupted process #', '0', 'set where the process is interrupted', MAX_INTERRUPTED, &
         ENTRY_SIZE), &
      variable_t(S_STACK + 12, 1, 'target_#', 'T:n_#', '1', .false., 'ours', &
         'r:direction_# at which the process # goes on', '0', 'set where the process is interrupted', MAX_INTERRUPTED, &
         ENTRY_SIZE), &
      variable_t(S_TURNS, 1, 'turns', '-', '1', .false., 'ours', &
         '1 + number of turning points of suction, positive in drying, negative in wetting; with hysteresis', '1', &
         'grows where suction turns, falls where it passes a turning point'), &
      variable_t(S_N_CLEARED, 1, 'n_turns_cleared', '-', '1', .false., 'ours', &
         'total: increments whose S_w was off its branch, so that the turning points were forgotten; with hysteresis', &
         '0', 'adds up'), &
      variable_t(S_TURN, 1, 'turn_x_#', 'ln(x_#/P_a)', '1', .false., 'ours', &
         'modified suction of turning point #; the first is the oldest; with hysteresis', '0', &
         'set where suction turns', MAX_TURNS, 2), &
      variable_t(S_TURN + 1, 1, 'turn_s_w_#', 'S_#', '1', .false., 'ours', &
         'degree of saturation of turning point #; with hysteresis', '0', 'set where suction turns', MAX_TURNS, 2), &
      variable_t(S_CHI, 1, 'contraction', 'chi', '1', .false., 'ours', &
         'plastic contraction of all processes that preloads; with c_chi', '0', &
         'grows in contraction, falls in dilation'), &
      variable_t(S_CHI_OWN, 1, 'contraction_own', 'chi_o', '1', .false., 'ours', &
         'the share of the present process in it; with c_chi', '0', &
         'likewise; 0 at a reset, restored at a return'), &
      variable_t(S_CHI_STACK, 1, 'contraction_#', 'chi_#', '1', .false., 'ours', &
         'the share of the interrupted process # in it; with c_chi', '0', 'set where the process is interrupted', &
         MAX_INTERRUPTED, 1), &
      variable_t(S_FLUIDITY, 1, 'fluidity', 'ell', '1', .false., 'ours', &
         'fluidity that liquefaction has left; with c_ell', '0', &
         'grows by shear below p_ell, falls with the volume')]
   integer, parameter :: NVARIABLES = size(VARIABLES)

   type(option_t), parameter :: OPTIONS(*) = [ &
      option_t(P_ISOTROPIC, ISOTROPIC_NONE, 'none'), &
      option_t(P_ISOTROPIC, ISOTROPIC_FORGETS, 'without_memory'), &
      option_t(P_ISOTROPIC, ISOTROPIC_REMEMBERS, 'with_memory'), &
      option_t(P_MEMORY_RULE, RULE_CLASSIC, 'classic'), &
      option_t(P_MEMORY_RULE, RULE_THRESHOLD, 'threshold'), &
      option_t(P_MEMORY_RULE, RULE_REPOSITIONING, 'repositioning'), &
      option_t(P_MEMORY_RULE, RULE_RETURN_POINT, 'return_point'), &
      option_t(P_SCHEME, SCHEME_AUTOMATIC, 'automatic'), &
      option_t(P_SCHEME, SCHEME_OF_PAPER, 'modified Euler 2(1)'), &
      option_t(P_SCHEME, 2, 'Bogacki-Shampine 3(2)'), &
      option_t(P_SCHEME, 3, 'Dormand-Prince 5(4)'), &
      option_t(P_TANGENT, 0, 'none'), &
      option_t(P_TANGENT, 1, 'elastic'), &
      option_t(P_TANGENT, 2, 'continuum'), &
      option_t(P_TANGENT, 3, 'consistent')]
contains
   !> Meaning of a parameter, with its values and words if it is an option: 'tangent that umat_ returns: 0 none, ...'.
   pure function property_meaning(index) result(text)
      integer, intent(in) :: index   !< From 1 to NPROPS, not checked.
      character(200) :: text
      character(2) :: gap
      character :: digit
      integer :: i

      text = PROPERTIES(index)%meaning
      gap = ': '
      do i = 1, size(OPTIONS)
         if (OPTIONS(i)%property /= index) cycle
         digit = achar(iachar('0') + OPTIONS(i)%value)   ! options are few
         if (text == '') then
            text = digit//' '//OPTIONS(i)%word
         else
            text = trim(text)//gap//digit//' '//OPTIONS(i)%word
         end if
         gap = ', '
      end do
   end function property_meaning

   !> Place of a parameter in PROPS, 0 if there is none of that name. Case does not matter, as in a namelist.
   pure integer function property_index(name) result(index)
      character(*), intent(in) :: name
      character(len(name)) :: wanted

      wanted = lower_case(name)
      do index = 1, NPROPS
         if (lower_case(PROPERTIES(index)%name) == wanted) return
      end do
      index = 0
   end function property_index

   !> Place of a state variable in STATEV, 0 if there is none of that name; tensors as name_11 and so on.
   pure integer function statev_index(name) result(index)
      character(*), intent(in) :: name
      character(len(name)) :: wanted

      wanted = lower_case(name)
      do index = 1, NSTATV
         if (statev_name(index) == wanted) return
      end do
      index = 0
   end function statev_index

   !> Name of one place in STATEV.
   pure function statev_name(index) result(name)
      integer, intent(in) :: index   !< From 1 to NSTATV, not checked.
      character(20) :: name
      integer :: i

      i = statev_variable(index)
      name = numbered(VARIABLES(i)%name, index)
      if (VARIABLES(i)%size == 6) name = trim(name)//'_'// &
         COMPONENTS(mod(index - VARIABLES(i)%first, VARIABLES(i)%stride) + 1)
   end function statev_name

   !> A text about one place in STATEV: # is its number among those of a kind.
   pure function numbered(text, index) result(told)
      character(*), intent(in) :: text
      integer, intent(in) :: index   !< From 1 to NSTATV, not checked.
      character(len(text)) :: told
      integer :: i, k

      told = text
      i = statev_variable(index)
      if (VARIABLES(i)%copies == 1) return
      do k = 1, len(text)   ! copies are less than ten
         if (text(k:k) == '#') told(k:k) = achar(iachar('1') + (index - VARIABLES(i)%first)/VARIABLES(i)%stride)
      end do
   end function numbered

   !> Entry of VARIABLES that a place in STATEV belongs to.
   pure integer function statev_variable(index) result(variable)
      integer, intent(in) :: index   !< From 1 to NSTATV, not checked.

      do variable = 1, NVARIABLES - 1
         associate (at => index - VARIABLES(variable)%first, stride => VARIABLES(variable)%stride)
            if (at >= 0 .and. mod(at, stride) < VARIABLES(variable)%size .and. at/stride < VARIABLES(variable)%copies) &
               return
         end associate
      end do
   end function statev_variable

   pure function lower_case(text) result(lower)
      character(*), intent(in) :: text
      character(len(text)) :: lower
      integer :: i

      lower = text
      do i = 1, len(text)
         if (lge(text(i:i), 'A') .and. lle(text(i:i), 'Z')) lower(i:i) = achar(iachar(text(i:i)) + 32)
      end do
   end function lower_case
end module mud_registry
