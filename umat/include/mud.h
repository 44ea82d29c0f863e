/* SPDX-License-Identifier: MIT */
/* MUD: bounding-surface model for unsaturated soil dynamics. C interface.
 *
 * Conventions of every array here are those of a UMAT: tension positive, components 11, 22, 33, 12, 13, 23,
 * strain with ENGINEERING shear (gamma = 2 eps), stress and suction in the unit of p_atm (kPa by default).
 * "Stress" is Bishop's effective stress sigma' with chi = S_w. Suction p_c = p_a - p_w is positive when unsaturated.
 * Indices of PROPS and STATEV are those of C, from 0.
 *
 * The way of a host: mud_prepare a material once; mud_init every point; mud_update in every iteration. The same for the
 * points of a mesh: mud_init_points, mud_update_points.
 *
 * Every array is the caller's. Nothing is allocated or kept between calls; calls are thread-safe. No file is read or
 * written, but for mud_save_increment and what MUD_SAVE_FAILED asks of umat_ (see "failed increments" below). What is
 * printed goes to standard error, once a process (MUD_MESSAGES=off silences): each distinct refusal of umat_ and
 * mud_refuse, and doubtful starts and void ratios of every entry. umat_ where PNEWDT is NULL, and mud_refuse (vumat_),
 * alone return a NaN, in the stress of a point that they refuse (MUD_NO_PNEWDT=keep leaves the stress).
 * Functions return MUD_OK (0), a negative code (the caller's mistake) or a positive one (a hard increment: cut it).
 * Text goes into the caller's buffer of `len` bytes, cut to fit and always terminated; a NULL buffer is allowed.
 */
#ifndef MUD_H
#define MUD_H

#ifdef __cplusplus
extern "C" {
#endif

#define MUD_ABI_VERSION 3

enum mud_status {
   MUD_OK = 0,
   MUD_BAD_NPROPS = -1, MUD_BAD_NSTATV = -2, MUD_BAD_NTENS = -3, MUD_BAD_PROPS = -4, MUD_BAD_STATE = -5,
   MUD_BAD_INPUT = -6, MUD_NULL_ARGUMENT = -7, MUD_BAD_VOID_RATIO = -8, MUD_BAD_OPTION = -9,
   MUD_NOT_WRITTEN = -10, MUD_NOT_PREPARED = -11,
   MUD_MINIMUM_STEP = 1, MUD_TOO_MANY_SUBSTEPS = 2, MUD_NO_DIRECTION = 3, MUD_VOID_RATIO_LIMIT = 4,
   MUD_NOT_FINITE = 5, MUD_INCREMENT_TOO_LARGE = 6
};

/* What a status is about; the index counts its entries from 1, 0 is the whole. */
enum mud_subject {
   MUD_ON_NOTHING = 0, MUD_ON_PROPS = 1, MUD_ON_STATEV = 2, MUD_ON_STRESS = 3, MUD_ON_STRAIN = 4, MUD_ON_SUCTION = 5,
   MUD_ON_VOID_RATIO = 6, MUD_ON_ARGUMENT = 7, MUD_ON_ROTATION = 8
};

enum mud_list  { MUD_PROPS = 1, MUD_STATEV = 2 };
enum mud_field {
   MUD_NAME = 1, MUD_SYMBOL = 2, MUD_UNIT = 3, MUD_ORIGIN = 4, MUD_MEANING = 5,
   MUD_INITIAL = 6, MUD_ROTATION = 7, MUD_EVOLUTION = 8   /* of STATEV only */
};
/* Kind of tangent. PRESENT: nothing is updated; the slopes are those with which the state goes on, for the first
 * iteration of a step. MUD_TOTAL_STRESS may be added to each: stress0, stress1, dsig_deps and dsig_dpc are those of
 * total stress less air pressure, sigma + p_a I = sigma' + S_w p_c I (tension positive). MUD_LANES may be added for
 * mud_update_points: up to eight points of a material side by side, in less time, where the processor (x86-64-v3 or
 * later) and the material allow it; the others one by one. Numbers then differ from those without it by rounding. */
enum mud_tangent {
   MUD_TANGENT_NONE = 0, MUD_TANGENT_ELASTIC = 1, MUD_TANGENT_CONTINUUM = 2, MUD_TANGENT_CONSISTENT = 3,
   MUD_TANGENT_PRESENT = 4, MUD_TOTAL_STRESS = 16, MUD_LANES = 64
};

/* What one update did and, on failure, where it stopped: filled by every mud_update. */
typedef struct mud_report {
   int status;              /* the code that was returned                                              */
   int subject;             /* what a failure is about, of mud_subject; mud_message makes a sentence   */
   int index;               /* entry of that array, from 1; 0: none                                    */
   int n_rate;              /* rate evaluations                                                        */
   int n_substep;           /* accepted substeps                                                       */
   int n_reject;            /* rejected substeps                                                       */
   int n_reset;             /* resets of the memory                                                    */
   int n_floor;             /* rates with the floor x_0 active                                         */
   int n_cap_d;             /* rates with the contraction cap active                                   */
   int n_cap_h;             /* rates with the softening cap active                                     */
   int n_hysteresis;        /* substeps whose reset the hysteresis x_rev held back                     */
   int n_iso_kept;          /* rates where the isotropic mechanism contradicted itself                 */
   int n_no_root;           /* rates without an admissible direction, taken as elastic                 */
   int n_min_step;          /* substeps accepted at the minimum size (without any guard)              */
   int n_open;              /* substeps held by the tension cut-off                                    */
   int n_tensile;           /* 1 if the increment ended with a tensile principal effective stress      */
   int n_turns_cleared;     /* 1 if S_w was off its branch: its turning points were forgotten          */
   double value;            /* offending value                                                         */
   double lower, upper;     /* its allowed range                                                       */
   double reached;          /* share of the increment that was integrated, 1 on success                */
   double pnewdt;           /* suggested factor on the increment, below 1 on any failure, else 1       */
} mud_report;

/* --- the library and its tables --------------------------------------------------------------------- */
int mud_abi_version(void);
int mud_version(char *text, int len);                       /* such as "0.2.0" */
int mud_count(int list);                                    /* all of PROPS or STATEV; MUD_BAD_OPTION */
int mud_index(int list, const char *name);                  /* index from 0; -1: no such name (case is ignored) */
int mud_text(int list, int index, int field, char *text, int len);
/* Entries of PROPS that stand for a choice: the number-th value, from 0, and its word. MUD_BAD_OPTION: no such value,
 * or the entry takes numbers. */
int mud_option(int index, int number, double *value, char *word, int len);
/* Bounds and default of an entry of PROPS. Those whose MUD_UNIT is kPa or kPa^lambda hold for p_atm = 101.325 and
 * scale with p_atm (and p_atm^lambda); only p_atm's own bounds do not. mud_bounds_for gives them for the p_atm and
 * lambda of props. */
int mud_bounds(int list, int index, double *lower, double *upper, double *preset);
int mud_bounds_for(const double *props, int nprops, int index, double *lower, double *upper, double *preset);
int mud_default_props(double *props, int nprops);           /* in kPa */
/* The same material in another unit of stress, `factor` of which make one of the present unit (from kPa: 1000 Pa,
 * 0.001 MPa, 0.1450377 psi). Changes p_atm, alpha_csl, P_a, P_aw, p_min, p_ell and, by factor^lambda, N_c
 * and N_l. */
int mud_convert_props(double *props, int nprops, double factor);
/* Text: a sentence for the first fault; with MUD_OK "no error" or, where stresses of PROPS seem to have another unit
 * than p_atm, a sentence that begins with "warning: ". */
int mud_validate_props(const double *props, int nprops, char *text, int len);
/* What mud_prepare would return, and which entry has which value out of which range. */
int mud_check_props(const double *props, int nprops, mud_report *report);

/* The same names as constants, for tables of your own that the linker fills; as many as mud_count says. They are those
 * of the library that is linked, so do not copy their number into code. A point without hysteresis has fewer numbers
 * of STATEV, mud_prepared_statev tells how many; those behind them are never touched. */
extern const int mud_props_count, mud_statev_count;
extern const char *const mud_props_names[], *const mud_props_units[];
extern const char *const mud_statev_names[], *const mud_statev_units[];

/* --- a material ----------------------------------------------------------------------------------------- */
/* PROPS checked and kept in mud_prepared_size() doubles of the caller, who passes their number as `size`; opaque, may
 * be copied in memory, not to be kept in a file. Whatever uses it only reads it, so threads may share it. After an
 * error the storage is no material; storage that is no material of this library: MUD_NOT_PREPARED. */
int mud_prepared_size(void);
int mud_prepared_statev(const double *material);            /* numbers of STATEV that its points have */
int mud_prepared_lanes(const double *material);             /* 1: MUD_LANES acts, of material and processor; else 0 */
int mud_prepare(const double *props, int nprops, double *material, int size, char *text, int len);

/* Degree of saturation at a suction and a void ratio (above 0), and its slopes against either at constant other; each
 * output may be NULL. The curve that updates use; with hysteresis the main drying curve. */
int mud_saturation(const double *material, double suction, double void_ratio, double *s_w, double *ds_dpc,
                   double *ds_de);

/* --- one integration point --------------------------------------------------------------------------- */
/* Begins a point: fills statev[nstatev] for an effective stress[6], a suction, a void ratio (0: e_0 of the props) and,
 * with hysteresis, a degree of saturation (0: on the main drying curve). A mean stress below p_min is lifted in place;
 * a stress ratio far beyond the bounding surface is refused. Tension, a mean stress beyond 50 MPa, a void ratio far
 * above the compression line or from 2.97 on is taken, printed once a process, and text begins with "warning: ". */
int mud_init(const double *material, double *stress, double suction, double void_ratio, double saturation,
             double *statev, int nstatev, char *text, int len);

/* Slopes at the end of an update: dsig_* for a tangent other than NONE, the rest always. */
typedef struct mud_blocks {
   double dsig_deps[36];    /* column j (at 6*j): d sigma' / d (engineering strain j)                  */
   double dsig_dpc[6];      /* d sigma' / d suction                                                    */
   double dsw_deps[6];      /* d S_w / d strain                                                        */
   double dsw_dpc;          /* d S_w / d suction                                                       */
   double s_w;              /* degree of saturation                                                    */
} mud_blocks;

/* Integrates dstrain[6] and a change of suction from (stress0, statev0) to (stress1, statev1). `suction` is that at the
 * end; where the change begins statev0 tells. Outputs may be the same arrays as inputs; blocks and report may be NULL.
 * On any failure stress1, statev1 and blocks are untouched. A statev0 that no mud_init filled is refused.
 *
 * With MUD_TANGENT_PRESENT stress1 and statev1 are not written (NULL is allowed), and dstrain, of any length, is the
 * direction that is expected, such as the last increment, with its suction. A zero or NULL dstrain means the direction
 * in which the point strained last, as far as its elastic domain remembers it; of the suction only the sense counts
 * then. Inside the elastic domain the slopes are elastic. */
int mud_update(const double *material, const double *stress0, const double *statev0, int nstatev,
               const double *dstrain, double suction, int tangent,
               double *stress1, double *statev1, mud_blocks *blocks, mud_report *report);

/* --- many points --------------------------------------------------------------------------------------- */
/* The arrays of a mesh, those of one point after those of another. Zero the structure, then set what a call needs. */
typedef struct mud_points {
   int n;                   /* how many points a call reads and writes; 0: no array is needed           */
   int nstatev;             /* numbers of a point in statev0 and statev1                               */
   int tangent;             /* as in mud_update                                                        */
   int threads;             /* 0: as many as OpenMP would take; at most 1024; 1 in a fork of a process that used more */
   const int *list;         /* numbers of the n points, from 0, each once; NULL: the first n           */
   const int *material;     /* [...]: number of the material of every point, from 0; NULL: 0           */
   const double *stress0, *statev0;      /* [6*...], [nstatev*...]: where the points are               */
   const double *dstrain;   /* [6*...]                                                                 */
   const double *suction;   /* [...]: at the end; NULL: that of statev0, of a point that begins 0      */
   const double *void_ratio, *saturation;   /* [...]: of points that begin; NULL: 0, see mud_init      */
   double *stress1, *statev1;   /* may be stress0 and statev0                                          */
   double *dsig_deps, *dsig_dpc, *dsw_deps, *dsw_dpc, *s_w;   /* as in mud_blocks; NULL: not wanted     */
   int *status;             /* [...]: code of every point; may be NULL                                 */
   mud_report *reports;     /* [...]; may be NULL                                                      */
} mud_points;

/* What became of the points. Join those of several calls or ranks by sums, and by the smallest pnewdt. */
typedef struct mud_summary {
   int failed;              /* how many points failed                                                  */
   int worst;               /* number of the failed point that got least far, from 0; -1: none failed  */
   int n_open, n_tensile;   /* points held by the tension cut-off; with a tensile principal stress     */
   int n_lifted;            /* points that began with a mean stress below p_min                        */
   double pnewdt;           /* smallest suggested factor on the increment, 1 if no point failed        */
   double n_rate, n_substep;   /* of all points together                                               */
   mud_report report;       /* of the worst point                                                      */
} mud_summary;

/* `materials` are nmaterials prepared ones, each of mud_prepared_size() doubles, one after another. A point that fails
 * keeps its outputs and leaves the others alone; every other one has the answer of mud_init or mud_update, bit by bit,
 * whatever the number of threads. Each returns how many points failed, or a negative code if nothing was done; summary
 * may be NULL.
 *
 * mud_init_points reads stress0, suction, void_ratio, saturation (tangent: 0 or MUD_TOTAL_STRESS) and fills stress1,
 * statev1, s_w. mud_update_points is mud_update. mud_saturation_points gives S_w and its slopes at a suction to which
 * the points go at their present void ratio, from what statev0 tells: s_w, dsw_dpc, dsw_deps. */
int mud_init_points(const double *materials, int nmaterials, const mud_points *points, mud_summary *summary);
int mud_update_points(const double *materials, int nmaterials, const mud_points *points, mud_summary *summary);
int mud_saturation_points(const double *materials, int nmaterials, const mud_points *points, mud_summary *summary);

/* --- entries that other programs prescribe ------------------------------------------------------------- */
/* For an interface of your own to a host that neither begins points nor reads a code. Those of Abaqus/Explicit, PLAXIS
 * and MFront are written on this file alone: umat/doors. */
typedef struct mud_place {
   char entry[24];          /* name of the entry in what is printed; terminated                        */
   const int *step, *increment, *element, *point;   /* where the host is, as far as it says: or NULL   */
} mud_place;

enum mud_way { MUD_IN_PIECES = 32 };   /* Added to a kind of tangent. */

/* mud_update for such a host. A point whose statev0 has no past (layout 0) begins in this increment, with suction0 and
 * the void ratio and saturation that statev0 presets, as in a UMAT; a NULL dstrain integrates nothing: the point only
 * begins, and blocks stay. With MUD_IN_PIECES a hard increment is taken in up to 256 equal pieces. What is doubtful
 * about PROPS, start and end is printed once a process, with the place. What is refused is saved where MUD_SAVE_FAILED
 * asks for it, and not printed: mud_refuse does that. Effective stress alone; place may be NULL. */
int mud_increment_at(const mud_place *place, const double *material, const double *stress0, const double *statev0,
                     int nstatev, double suction0, const double *dstrain, double suction, int tangent,
                     double *stress1, double *statev1, mud_blocks *blocks, mud_report *report);
/* Prints once a process that an increment was refused: the sentence of the report, the place and the consequence, such
 * as ". IABORT is 1". A host that would see nothing else gives its stress[n]: it becomes NaN unless MUD_NO_PNEWDT is
 * keep, and the process tells at its end how often. NULL: no stress is touched. */
int mud_refuse(const mud_place *place, const mud_report *report, const char *consequence, double *stress, int n);

/* --- failed increments ---------------------------------------------------------------------------------- */
/* One substep that an update tried. */
enum mud_outcome { MUD_SUBSTEP_REJECTED = 0, MUD_SUBSTEP_ACCEPTED = 1, MUD_SUBSTEP_FAILED = 2 /* the update ended */ };
enum mud_mode {
   MUD_MODE_ORDINARY = 0, MUD_MODE_ELASTIC = 1 /* inside the elastic domain */, MUD_MODE_HELD = 2 /* by the cut-off */
};
enum mud_jump {   /* of the memory, where the substep begins */
   MUD_JUMP_NONE = 0, MUD_JUMP_REVERSAL = 1 /* a new process begins */, MUD_JUMP_RETURN = 2 /* an old one goes on */,
   MUD_JUMP_NEW = 3 /* the point leaves the tension cut-off */
};
typedef struct mud_substep {
   int outcome, mode, jump; /* enumerations above                                                      */
   int landed;              /* 1: shortened to end at an event (p_min, a reversal, a return)        */
   int n_rate, n_reset;     /* counted since the increment began, as in mud_report                     */
   int n_guard, n_no_root;  /* likewise; n_guard: all guards together                                  */
   double time, size;       /* where it began and how long it was, shares of the increment             */
   double error;            /* relative; compare with `tolerance` of PROPS                             */
   double void_ratio, saturation, suction, stress[6];   /* where it led                                */
} mud_substep;

/* Runs mud_update and reports its substeps: rows[i] is substep number first + i (from 1), as far as there are
 * nrows; *attempts receives how many were tried. Only rows, attempts and report are written; each may be NULL.
 * Returns the status of the update. */
int mud_trace_increment(const double *material, const double *stress0, const double *statev0, int nstatev,
                        const double *dstrain, double suction, int tangent,
                        int first, mud_substep *rows, int nrows, int *attempts, mud_report *report);

/* Writes an increment, with the arguments of mud_update and how it ends, to a new case file that mud_triax runs alone;
 * bit by bit the same. `origin` is a remark for the reader (may be NULL). A file of that name is never overwritten, an
 * unfinished one is removed: MUD_NOT_WRITTEN, and text says why.
 *
 * umat_ does the same by itself where the environment variable MUD_SAVE_FAILED names a folder: the first increment of
 * each distinct failure, under a name that says which, such as mud_failed_too_many_substeps.nml. A file that is there
 * already stays; that the folder cannot be written is said once. */
int mud_save_increment(const char *path, const char *origin, const double *material, const double *stress0,
                       const double *statev0, int nstatev, const double *dstrain, double suction, int tangent,
                       char *text, int len);

/* --- texts ---------------------------------------------------------------------------------------------- */
/* A sentence for a status code; with a report, one that says where, the value, the allowed range and the remedy. */
int mud_status_text(int code, char *text, int len);
int mud_message(const mud_report *report, char *text, int len);

#ifdef __cplusplus
}
#endif
#endif
