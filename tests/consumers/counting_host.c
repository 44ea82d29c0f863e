/* SPDX-License-Identifier: MIT */
/* Counts allocations of memory during updates: every malloc, calloc, realloc of the process passes through here, those
 * of the Fortran runtime as well. Usage: counting_host UPDATES. One line per variant; the last one is a control.
 * Compiled with -DSANITIZED it leaves the allocator to the sanitizers and counts nothing: they look for leaks. */
#include <stdio.h>
#include <stdlib.h>
#include "mud.h"

enum { MAX = 160, POINTS = 400 };   /* room for PROPS and STATEV; points of a batch */

static volatile long allocations;

#ifndef SANITIZED
void *__libc_malloc(size_t), *__libc_calloc(size_t, size_t), *__libc_realloc(void *, size_t);

void *malloc(size_t n) { __atomic_add_fetch(&allocations, 1, __ATOMIC_RELAXED); return __libc_malloc(n); }
void *calloc(size_t n, size_t m) { __atomic_add_fetch(&allocations, 1, __ATOMIC_RELAXED); return __libc_calloc(n, m); }
void *realloc(void *p, size_t n) { __atomic_add_fetch(&allocations, 1, __ATOMIC_RELAXED); return __libc_realloc(p, n); }
#endif

static double props[MAX], stress[6*POINTS], statev[MAX*POINTS], dstrain[6*POINTS], suction[POINTS];
static double c[36*POINTS], c_pc[6*POINTS], sw_e[6*POINTS], sw_pc[POINTS], *material, change;
static int status[POINTS];
static int nprops, nstatev;

static void start(int scheme, int rule, double p_c)
{
   mud_default_props(props, nprops);
   props[mud_index(MUD_PROPS, "scheme")] = scheme;
   props[mud_index(MUD_PROPS, "memory_rule")] = rule;
   change = p_c > 0.0 ? 1.0e-3 : 0.0;
   if (mud_prepare(props, nprops, material, mud_prepared_size(), NULL, 0)) exit(2);
   for (int i = 0; i < POINTS; i++) {
      for (int j = 0; j < 6; j++) stress[6*i + j] = j < 3 ? -100.0 : 0.0;
      suction[i] = p_c;
      if (mud_init(material, stress + 6*i, p_c, 0.75, 0.0, statev + nstatev*i, nstatev, NULL, 0)) exit(2);
   }
}

/* Strain of an update: its direction turns and turns back, so that processes end and begin. */
static void strain_of(int k, double *d)
{
   static const double a[6] = {-1.0, 0.5, 0.5, 0.4, -0.3, 0.2}, b[6] = {0.2, -0.6, 0.3, 1.0, 0.5, -0.7};
   const double size = k % 10 ? 1.0e-5 : 1.0e-3, s = k % 40 < 20 ? size : -size, t = (k % 40)/40.0;
   for (int j = 0; j < 6; j++) d[j] = s*((1.0 - t)*a[j] + t*b[j]);
}

int main(int argc, char **argv)
{
   const int updates = argc > 1 ? atoi(argv[1]) : 1000;
   mud_report report;
   mud_blocks blocks;
   long before, done, failed;

   nprops = mud_count(MUD_PROPS);
   nstatev = mud_count(MUD_STATEV);
   material = malloc(sizeof(double)*(size_t)mud_prepared_size());
   if (nprops > MAX || nstatev > MAX || !material) return 2;
   setvbuf(stdout, NULL, _IOLBF, 1 << 16);
   printf("warming up\n");
   for (int scheme = 1; scheme <= 3; scheme++)
      for (int tangent = 0; tangent <= 3; tangent++)
         for (int wet = 0; wet <= 1; wet++) {
            start(scheme, 1 + (scheme + tangent) % 3, wet ? 0.0 : 40.0);
            before = allocations;
            done = failed = 0;
            for (int k = 0; k < updates; k++) {
               strain_of(k, dstrain);
               if (k == 7) dstrain[2] = 2.0;   /* refused: a failure must not allocate either */
               int code = mud_update(material, stress, statev, nstatev, dstrain, suction[0] + change, tangent, stress,
                                     statev, &blocks, &report);
               if (code) failed++; else { done++; suction[0] += change; }
            }
            printf("update scheme %d tangent %d suction %d: %ld done, %ld refused, allocations %ld\n", scheme, tangent,
                   !wet, done, failed, allocations - before);
         }
   start(3, 1, 40.0);
   for (int call = 0; call < 2; call++) {   /* the first may say what is doubtful, once a process */
      before = allocations;
      done = 0;
      for (int k = 0; k < updates; k++) {
         strain_of(k, dstrain);
         if (mud_increment_at(NULL, material, stress, statev, nstatev, suction[0], dstrain, suction[0] + change,
                              MUD_TANGENT_CONSISTENT + MUD_IN_PIECES, stress, statev, &blocks, &report)) continue;
         done++;
         suction[0] += change;
      }
   }
   printf("in pieces: %ld done, allocations %ld\n", done, allocations - before);
   for (int threads = 1; threads <= 2; threads++)
      for (int n = POINTS/4; n <= POINTS; n += 3*POINTS/4) {
         start(1, 1, 40.0);
         for (int i = 0; i < POINTS; i++) strain_of(i, dstrain + 6*i);
         for (int call = 0; call < 3; call++) {   /* the first makes the team of threads */
            before = allocations;
            for (int i = 0; i < POINTS; i++) suction[i] += change;
            failed = mud_update_points(material, 1, &(mud_points){
               .n = n, .nstatev = nstatev, .tangent = 3, .threads = threads, .stress0 = stress, .statev0 = statev,
               .dstrain = dstrain, .suction = suction, .stress1 = stress, .statev1 = statev, .dsig_deps = c,
               .dsig_dpc = c_pc, .dsw_deps = sw_e, .dsw_dpc = sw_pc, .status = status}, NULL);
         }
         printf("batch threads %d points %d: %ld failed, allocations %ld\n", threads, n, failed, allocations - before);
      }
   free(material);
   before = allocations;
   free(malloc(10 + argc));
   free(realloc(calloc(3, 5 + argc), 100));
   printf("control: allocations %ld\n", allocations - before);
   return 0;
}
