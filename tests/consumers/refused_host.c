/* SPDX-License-Identifier: MIT */
/* Imitates what real hosts do to umat_, each over 100 increments of undrained compression to 1 % axial strain with a
 * known answer, and prints what it ends with; what the library says goes to standard error.
 *    refused_host kratos [STATEV]       fields, DROT and PNEWDT are NULL, element and point 0, a first call with dt 0;
 *                                       trials start from the finalised state; STATEV: how many it reserves
 *    refused_host kratos_hard           the same, but the 50th increment is too large: "converged" on it or stopped?
 *    refused_host kratos_prescribed     the same with K_0 < 0 and every strain prescribed: nothing iterates
 *    refused_host calculix [STATEV]     PNEWDT enters with -1, PREDEF and DPRED were never set
 *    refused_host incremental_driver    PNEWDT enters with 0, DROT was never set
 *    refused_host abaqus NTENS          PNEWDT enters with 1
 *    refused_host contradiction         PREDEF is the suction at the end of the increment
 *    refused_host null                  DSTRAN and NPROPS are NULL, one after the other
 *    refused_host units                 p_atm in Pa, everything else in kPa
 *    refused_host tension CUTOFF        expands by 2 % from p' = 20 kPa with this cutoff, at two points
 *    refused_host threads               eight threads fail a thousand times each, in two ways
 *    refused_host fork                  fails, forks; the child fails in the same way, then in another one */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "mud.h"

extern void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
                  double *ddsddt, double *drplde, double *drpldt, double *stran, double *dstran, double *time,
                  double *dtime, double *temp, double *dtemp, double *predef, double *dpred, char *cmname, int *ndi,
                  int *nshr, int *ntens, int *nstatv, double *props, int *nprops, double *coords, double *drot,
                  double *pnewdt, double *celent, double *dfgrd0, double *dfgrd1, int *noel, int *npt, int *layer,
                  int *kspt, int *kstep, int *kinc);

enum { MAX = 256, STEPS = 100, THREADS = 8 };

typedef struct {
   double stress[6], statev[MAX], tangent[36], props[MAX], dstrain[6];
   double *predef, *dpred, *drot, *pnewdt;   /* NULL where the host has none */
   double scd;
   int ntens, nstatv, nprops, element, point, step, increment;
} host_t;

static void set_up(host_t *h)
{
   memset(h, 0, sizeof *h);
   h->ntens = 6;
   h->nstatv = mud_count(MUD_STATEV);
   h->nprops = mud_count(MUD_PROPS);
   h->element = 12, h->point = 3, h->step = 2;
   for (int i = 0; i < 3; i++)
      h->stress[i] = -100.0;
   if (h->nprops > MAX || h->nstatv > MAX || mud_default_props(h->props, h->nprops) != MUD_OK)
      exit(2);
   h->props[mud_index(MUD_PROPS, "e_0")] = 0.735;
}

/* One increment of the strain that the host holds. */
static void update(host_t *h)
{
   int ndi = 3, nshr = 3;
   h->increment++;
   umat_(h->stress, h->statev, h->tangent, NULL, NULL, &h->scd, NULL, NULL, NULL, NULL, NULL, h->dstrain, NULL, NULL,
         NULL, NULL, h->predef, h->dpred, NULL, &ndi, &nshr, &h->ntens, &h->nstatv, h->props, &h->nprops, NULL, h->drot,
         h->pnewdt, NULL, NULL, NULL, &h->element, &h->point, NULL, NULL, &h->step, &h->increment);
}

static void call(host_t *h, double axial)
{
   h->dstrain[0] = -axial, h->dstrain[1] = h->dstrain[2] = 0.5 * axial;
   update(h);
}

static int tell(const host_t *h)
{
   const double *s = h->stress;
   printf("p' %.3f kPa, q %.3f kPa\n", -(s[0] + s[1] + s[2]) / 3.0, s[1] - s[0]);
   return 0;
}

/* Iterates until the stress no longer changes, from the finalised state each time. A NaN never passes that test. */
static int kratos(int nstatv, int hard)
{
   host_t finalised, trial;
   set_up(&finalised);
   finalised.element = finalised.point = 0;
   if (nstatv)
      finalised.nstatv = nstatv;
   trial = finalised;
   call(&trial, 0.0);                   /* dt = 0 */
   for (int step = 1; step <= STEPS; step++) {
      double before = 0.0, axial = hard && step == 50 ? 3.0 : 1.0e-4;
      int iteration, converged = 0;
      for (iteration = 0; iteration < 15 && !converged; iteration++) {
         trial = finalised;
         call(&trial, axial);
         converged = fabs(trial.stress[0] - before) <= 1.0e-9 * fabs(before);
         before = trial.stress[0];
      }
      if (!converged) {
         printf("step %d did not converge in %d iterations\n", step, iteration);
         return 1;
      }
      finalised = trial;
   }
   return tell(&finalised);
}

static int prescribed(void)
{
   host_t h;
   set_up(&h);
   h.props[mud_index(MUD_PROPS, "K_0")] = -1.0;
   for (int step = 0; step < STEPS; step++)
      call(&h, 1.0e-4);
   return tell(&h);
}

static int abaqus_like(double enters, double fields, double rotation, int ntens, int nstatv)
{
   host_t h;
   double pnewdt, predef, dpred, drot[9];
   set_up(&h);
   h.pnewdt = &pnewdt, h.predef = &predef, h.dpred = &dpred, h.drot = drot;
   h.ntens = ntens;
   if (nstatv)
      h.nstatv = nstatv;
   for (int step = 1; step <= STEPS; step++) {
      pnewdt = enters;
      predef = fields * step, dpred = -0.3 * fields;      /* another value every time */
      for (int i = 0; i < 9; i++)
         drot[i] = i % 4 == 0 && rotation == 0.0 ? 1.0 : rotation;
      call(&h, 1.0e-4);
      if (pnewdt > 0.0 && pnewdt < 1.0) {
         printf("step %d cut by %g\n", step, pnewdt);
         return 1;
      }
   }
   return tell(&h);
}

/* PREDEF = suction at the end, DPRED = its change: the usual mistake. */
static int contradiction(void)
{
   host_t h;
   double pnewdt = 1.0, predef = 20.0, dpred;
   set_up(&h);
   h.pnewdt = &pnewdt, h.predef = &predef, h.dpred = &dpred;
   for (int step = 1; step <= 10; step++) {
      dpred = step;
      predef += dpred;
      call(&h, 1.0e-5);
   }
   printf("suction %.6f\n", h.statev[mud_index(MUD_STATEV, "suction")]);
   return 0;
}

static int fail(double strain, int nstatv, double p_atm)
{
   host_t h;
   double pnewdt = 1.0;
   set_up(&h);
   h.pnewdt = &pnewdt;
   if (p_atm > 0.0)
      h.props[mud_index(MUD_PROPS, "p_atm")] = p_atm;
   if (nstatv)
      h.nstatv = nstatv;
   call(&h, strain);
   return (int)h.scd;
}

/* Without these there is nothing to compute with; the library names them. */
static int null(void)
{
   host_t h;
   double pnewdt = 1.0;
   set_up(&h);
   for (int i = 0; i < 2; i++)
      umat_(h.stress, h.statev, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, i == 0 ? NULL : h.dstrain, NULL,
            NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, &h.ntens, &h.nstatv, h.props, i == 1 ? NULL : &h.nprops,
            NULL, NULL, &pnewdt, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL);
   return pnewdt < 1.0 ? 0 : 1;
}

static int tension(int cutoff)
{
   host_t h;
   double pnewdt = 1.0;
   for (int point = 1; point <= 2; point++) {
      set_up(&h);
      h.pnewdt = &pnewdt, h.point = point;
      h.props[mud_index(MUD_PROPS, "cutoff")] = cutoff;
      for (int i = 0; i < 3; i++)
         h.stress[i] = -20.0;
      for (int i = 0; i < 3; i++)
         h.dstrain[i] = 0.02 / STEPS / 3.0;
      for (int step = 0; step < STEPS; step++)
         update(&h);
   }
   return tell(&h);
}

static void *fail_often(void *argument)
{
   for (int i = 0; i < 1000; i++)
      if (fail(3.0, 0, 0.0) != MUD_INCREMENT_TOO_LARGE || fail(1.0e-4, 10, 0.0) != MUD_BAD_NSTATV)
         return NULL;
   return argument;
}

static int threads(void)
{
   pthread_t thread[THREADS];
   int good = 0;
   for (int i = 0; i < THREADS; i++)
      if (pthread_create(&thread[i], NULL, fail_often, thread))
         return 2;
   for (int i = 0; i < THREADS; i++) {
      void *answer;
      pthread_join(thread[i], &answer);
      good += answer != NULL;
   }
   printf("%d threads\n", good);
   return 0;
}

static int forks(void)
{
   int status = 0;
   fail(3.0, 0, 0.0);
   pid_t child = fork();
   if (child == 0) {
      fail(3.0, 0, 0.0);
      fail(1.0e-4, 10, 0.0);
      _exit(0);
   }
   return child < 0 || waitpid(child, &status, 0) != child || status != 0;
}

int main(int argc, char **argv)
{
   const char *task = argc > 1 ? argv[1] : "";
   int number = argc > 2 ? atoi(argv[2]) : 0;

   if (strcmp(task, "kratos") == 0)
      return kratos(number, 0);
   if (strcmp(task, "kratos_hard") == 0)
      return kratos(0, 1);
   if (strcmp(task, "kratos_prescribed") == 0)
      return prescribed();
   if (strcmp(task, "calculix") == 0)
      return abaqus_like(-1.0, 37.2, 0.0, 6, number);
   if (strcmp(task, "incremental_driver") == 0)
      return abaqus_like(0.0, 0.0, 4.9e-310, 6, 0);
   if (strcmp(task, "abaqus") == 0)
      return abaqus_like(1.0, 0.0, 0.0, number, 0);
   if (strcmp(task, "contradiction") == 0)
      return contradiction();
   if (strcmp(task, "null") == 0)
      return null();
   if (strcmp(task, "units") == 0)
      return fail(1.0e-6, 0, 101325.0) + fail(1.0e-6, 0, 101325.0);
   if (strcmp(task, "tension") == 0)
      return tension(number);
   if (strcmp(task, "threads") == 0)
      return threads();
   if (strcmp(task, "fork") == 0)
      return forks();
   return 2;
}
