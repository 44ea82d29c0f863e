/* SPDX-License-Identifier: MIT */
/* A host written in C: what only a C compiler can say about mud.h, and two threads. */
#define _POSIX_C_SOURCE 200809L
#include <pthread.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include "mud.h"

_Static_assert(MUD_OK == 0, "success is zero");
_Static_assert(offsetof(mud_report, value) == 18 * sizeof(int), "17 counts and a gap before the numbers");
_Static_assert(sizeof(mud_substep) == 8 * sizeof(int) + 12 * sizeof(double), "8 counts and 12 numbers, no gap");
_Static_assert(offsetof(mud_substep, landed) == 3 * sizeof(int) && offsetof(mud_substep, n_guard) == 6 * sizeof(int),
               "counts in the order of mud_interface.f90");
_Static_assert(offsetof(mud_substep, error) == 8 * sizeof(int) + 2 * sizeof(double)
               && offsetof(mud_substep, stress) == 8 * sizeof(int) + 6 * sizeof(double), "likewise the numbers");

_Static_assert(offsetof(mud_summary, pnewdt) == 6 * sizeof(int)
               && sizeof(mud_summary) == 6 * sizeof(int) + 3 * sizeof(double) + sizeof(mud_report),
               "five counts, a gap, three numbers, the report of the worst point");
_Static_assert(offsetof(mud_points, list) == 4 * sizeof(int)
               && sizeof(mud_points) == 4 * sizeof(int) + 17 * sizeof(void *), "four counts, 17 arrays, no gap");
_Static_assert(sizeof(mud_blocks) == 50 * sizeof(double), "36, 6 and 6 slopes, two numbers");

enum { MAX_PROPS = 128, MAX_STATEV = 256, MAX_MATERIAL = 512, STEPS = 300 };

/* Layout of the report, in bytes. */
int abi_report_size(void) { return (int)sizeof(mud_report); }
int abi_header_version(void) { return MUD_ABI_VERSION; }

/* Every member has its own number, to be read on the Fortran side. */
void abi_fill_report(mud_report *r)
{
   *r = (mud_report){
      .status = 1, .subject = 2, .index = 3, .n_rate = 4, .n_substep = 5, .n_reject = 6, .n_reset = 7, .n_floor = 8,
      .n_cap_d = 9, .n_cap_h = 10, .n_hysteresis = 11, .n_iso_kept = 12, .n_no_root = 13, .n_min_step = 14,
      .n_open = 15, .n_tensile = 16, .n_turns_cleared = 17, .value = 18.0, .lower = 19.0, .upper = 20.0,
      .reached = 21.0, .pnewdt = 22.0};
}

/* Constants of mud.h in the order in which it lists them. */
void abi_status_codes(int codes[18])
{
   const int all[18] = {
      MUD_OK, MUD_BAD_NPROPS, MUD_BAD_NSTATV, MUD_BAD_NTENS, MUD_BAD_PROPS, MUD_BAD_STATE, MUD_BAD_INPUT,
      MUD_NULL_ARGUMENT, MUD_BAD_VOID_RATIO, MUD_BAD_OPTION, MUD_MINIMUM_STEP, MUD_TOO_MANY_SUBSTEPS, MUD_NO_DIRECTION,
      MUD_VOID_RATIO_LIMIT, MUD_NOT_FINITE, MUD_INCREMENT_TOO_LARGE, MUD_NOT_WRITTEN, MUD_NOT_PREPARED};
   memcpy(codes, all, sizeof all);
}

void abi_options(int options[27])
{
   const int all[27] = {MUD_PROPS, MUD_STATEV, MUD_NAME, MUD_SYMBOL, MUD_UNIT, MUD_ORIGIN, MUD_MEANING, MUD_INITIAL,
                        MUD_ROTATION, MUD_EVOLUTION, MUD_TANGENT_NONE, MUD_TANGENT_ELASTIC, MUD_TANGENT_CONTINUUM,
                        MUD_TANGENT_CONSISTENT, MUD_TANGENT_PRESENT, MUD_TOTAL_STRESS, MUD_IN_PIECES, MUD_ON_NOTHING,
                        MUD_ON_PROPS, MUD_ON_STATEV, MUD_ON_STRESS, MUD_ON_STRAIN, MUD_ON_SUCTION, MUD_ON_VOID_RATIO,
                        MUD_ON_ARGUMENT, MUD_ON_ROTATION, MUD_LANES};
   memcpy(options, all, sizeof all);
}

/* One point on its own walk. */
typedef struct {
   unsigned seed;
   int in_place, status;
   double stress[6], statev[MAX_STATEV], tangent[36];
} walk_t;

/* The default material; MUD_OK, or why not. */
static int prepare(double *material)
{
   double props[MAX_PROPS];
   const int nprops = mud_count(MUD_PROPS);
   if (mud_prepared_size() > MAX_MATERIAL || mud_default_props(props, nprops) != MUD_OK)
      return MUD_NOT_PREPARED;
   return mud_prepare(props, nprops, material, MAX_MATERIAL, NULL, 0);
}

static double next(unsigned *seed)
{
   *seed = 1664525u * *seed + 1013904223u;
   return (double)*seed / 4294967296.0 - 0.5;
}

/* In place, outputs are the inputs; otherwise they are others, filled with nonsense before. */
static void *walk(void *argument)
{
   walk_t *w = argument;
   double material[MAX_MATERIAL], stress[6], statev[MAX_STATEV];
   int nstatev = 0;
   mud_blocks blocks;
   unsigned seed = w->seed;

   memset(w->statev, 0, sizeof w->statev);
   for (int i = 0; i < 6; i++)
      w->stress[i] = i < 3 ? -80.0 : 0.0;
   w->status = prepare(material);
   if (w->status == MUD_OK) {
      nstatev = mud_prepared_statev(material);
      w->status = mud_init(material, w->stress, 25.0, 0.0, 0.0, w->statev, nstatev, NULL, 0);
   }
   for (int step = 0; step < STEPS && w->status == MUD_OK; step++) {
      double dstrain[6], *to_stress = w->in_place ? w->stress : stress, *to_statev = w->in_place ? w->statev : statev;
      for (int i = 0; i < 6; i++)
         dstrain[i] = 1.0e-3 * next(&seed);
      for (int i = 0; i < 3; i++)
         dstrain[i] *= 0.5;
      if (!w->in_place) {
         memset(stress, 0x55, sizeof stress);
         memset(statev, 0x55, sizeof statev);
      }
      w->status = mud_update(material, w->stress, w->statev, nstatev, dstrain, 25.0, MUD_TANGENT_CONTINUUM, to_stress,
                             to_statev, &blocks, NULL);
      memcpy(w->tangent, blocks.dsig_deps, sizeof w->tangent);
      if (!w->in_place) {
         memcpy(w->stress, stress, sizeof stress);
         memcpy(w->statev, statev, (size_t)nstatev * sizeof *statev);
      }
   }
   return NULL;
}

static int same(const walk_t *a, const walk_t *b)
{
   return a->status == MUD_OK && b->status == MUD_OK && !memcmp(a->stress, b->stress, sizeof a->stress) &&
          !memcmp(a->statev, b->statev, sizeof a->statev) && !memcmp(a->tangent, b->tangent, sizeof a->tangent);
}

/* 1 if a walk in place ends with the bits of one that keeps inputs and outputs apart. */
int abi_walk_in_place_is_the_same(void)
{
   static walk_t apart, in_place;
   apart = (walk_t){.seed = 5u};
   in_place = (walk_t){.seed = 5u, .in_place = 1};
   walk(&apart);
   walk(&in_place);
   return same(&apart, &in_place);
}

/* 1 if a failed update in place leaves every byte. */
int abi_failure_in_place_leaves_all(void)
{
   static walk_t before, after;
   double material[MAX_MATERIAL], dstrain[6] = {3.0};
   mud_blocks blocks, untouched;
   before = (walk_t){.seed = 6u, .in_place = 1};
   walk(&before);
   memcpy(&after, &before, sizeof after);
   memset(&blocks, 0x55, sizeof blocks);
   untouched = blocks;
   int status = prepare(material);
   if (status == MUD_OK)
      status = mud_update(material, after.stress, after.statev, mud_count(MUD_STATEV), dstrain, 25.0,
                          MUD_TANGENT_CONTINUUM, after.stress, after.statev, &blocks, NULL);
   return status == MUD_INCREMENT_TOO_LARGE && !memcmp(&before, &after, sizeof after)
          && !memcmp(&blocks, &untouched, sizeof blocks);
}

/* 1 if walks in `n` threads at the same time end with the bits of the same walks one after the other. */
int abi_threads_walk_as_one(int n)
{
   walk_t *serial = calloc((size_t)n, sizeof *serial), *parallel = calloc((size_t)n, sizeof *parallel);
   pthread_t *thread = calloc((size_t)n, sizeof *thread);
   int good = serial && parallel && thread, started = 0;

   for (int i = 0; i < n && good; i++) {
      serial[i] = (walk_t){.seed = 100u + (unsigned)i, .in_place = 1};
      parallel[i] = serial[i];
      walk(&serial[i]);
   }
   for (int i = 0; i < n && good; i++) {
      good = !pthread_create(&thread[i], NULL, walk, &parallel[i]);
      started += good;
   }
   for (int i = 0; i < started; i++)
      pthread_join(thread[i], NULL);
   for (int i = 0; i < n && good; i++)
      good = same(&serial[i], &parallel[i]);
   for (int i = 1; i < n && good; i++)   /* different walks, or the test would be none */
      good = memcmp(serial[i].stress, serial[0].stress, sizeof serial[i].stress) != 0;
   free(serial);
   free(parallel);
   free(thread);
   return good;
}

/* 1 if every mandatory pointer of mud_update, NULL alone, is refused with nothing written, and NULL for the others
 * is not. */
int abi_null_pointers_of_update(void)
{
   static walk_t w, copy;
   double material[MAX_MATERIAL], dstrain[6] = {-1.0e-5};
   const int nstatev = mud_count(MUD_STATEV);
   w = (walk_t){.seed = 7u, .in_place = 1};
   walk(&w);
   if (prepare(material) != MUD_OK)
      return 0;
   for (int i = 0; i < 7; i++) {
      mud_report report;
      memcpy(&copy, &w, sizeof copy);
      int status = mud_update(i == 0 ? NULL : material, i == 1 ? NULL : w.stress, i == 2 ? NULL : w.statev, nstatev,
                              i == 3 ? NULL : dstrain, 25.0, MUD_TANGENT_CONTINUUM, i == 4 ? NULL : copy.stress,
                              i == 5 ? NULL : copy.statev, NULL, i == 6 ? NULL : &report);
      if (i < 6 && (status != MUD_NULL_ARGUMENT || report.status != status || memcmp(&copy, &w, sizeof copy)))
         return 0;
      if (i == 6 && status != MUD_OK)
         return 0;
   }
   return 1;
}

/* 1 if a library of GNU compilers takes points side by side on this processor. */
int abi_has_lanes(void)
{
#if defined __x86_64__ && defined __GNUC__ && !defined __clang__
   return __builtin_cpu_supports("x86-64-v3") != 0;
#else
   return 0;
#endif
}

/* 1 if NULL is answered with a code by every other function that takes a pointer. */
int abi_null_pointers_of_the_rest(void)
{
   double props[MAX_PROPS], material[MAX_MATERIAL], stress[6] = {-1.0, -1.0, -1.0}, statev[MAX_STATEV] = {0.0};
   const int nprops = mud_count(MUD_PROPS), nstatev = mud_count(MUD_STATEV);
   return prepare(material) == MUD_OK &&
          mud_default_props(NULL, nprops) == MUD_NULL_ARGUMENT && mud_default_props(props, nprops) == MUD_OK &&
          mud_validate_props(NULL, nprops, NULL, 0) == MUD_NULL_ARGUMENT &&
          mud_validate_props(props, nprops, NULL, 0) == MUD_OK && mud_message(NULL, NULL, 0) == MUD_NULL_ARGUMENT &&
          mud_prepare(NULL, nprops, material, MAX_MATERIAL, NULL, 0) == MUD_NULL_ARGUMENT &&
          mud_prepare(props, nprops, NULL, MAX_MATERIAL, NULL, 0) == MUD_NULL_ARGUMENT &&
          mud_init(NULL, stress, 0.0, 0.0, 0.0, statev, nstatev, NULL, 0) == MUD_NULL_ARGUMENT &&
          mud_init(material, NULL, 0.0, 0.0, 0.0, statev, nstatev, NULL, 0) == MUD_NULL_ARGUMENT &&
          mud_init(material, stress, 0.0, 0.0, 0.0, NULL, nstatev, NULL, 0) == MUD_NULL_ARGUMENT &&
          mud_init(material, stress, 0.0, 0.0, 0.0, statev, nstatev, NULL, 0) == MUD_OK &&
          mud_update_points(NULL, 1, &(mud_points){0}, NULL) == MUD_NULL_ARGUMENT &&
          mud_init_points(material, 1, NULL, NULL) == MUD_NULL_ARGUMENT &&
          mud_saturation_points(material, 1, &(mud_points){.n = 1, .nstatev = nstatev}, NULL) == MUD_NULL_ARGUMENT &&
          mud_index(MUD_PROPS, NULL) == -1 && mud_bounds(MUD_PROPS, 0, NULL, NULL, NULL) == MUD_OK &&
          mud_version(NULL, 10) == MUD_OK && mud_text(MUD_PROPS, 0, MUD_NAME, NULL, 10) == MUD_OK &&
          mud_status_text(0, NULL, 10) == MUD_OK;
}
