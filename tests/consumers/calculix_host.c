/* SPDX-License-Identifier: MIT */
/* Does to umat_ what CalculiX 2.20 does, at one point: PNEWDT enters with -1, fields were never set, and a matrix is
 * factorised whether the increment was refused or not.
 *    calculix_host cut SUBSTEPS       drained compression to 2 % in increments of 1 % that are cut as PNEWDT asks
 *    calculix_host fine               the same in increments of 0.01 %
 *    calculix_host restart            likewise; STATEV comes back as zeros in the middle
 *    calculix_host added              an element that is activated at time 1; the points of the first begin at time 0
 *    calculix_host nlgeom DOOR DEGREES  finite strains while the sample turns, in 40 increments. DOOR logarithmic
 *                                     (@ABAQUSNL): DROT is the true rotation, stress and strain stand in axes that do
 *                                     not turn; green (@ABAQUS): Green's strain; linear (@ABAQUS without NLGEOM)
 * Prints the axial stress at the end, or why there is none; what the library says goes to standard error. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "mud.h"

extern void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
                  double *ddsddt, double *drplde, double *drpldt, double *stran, double *dstran, double *time,
                  double *dtime, double *temp, double *dtemp, double *predef, double *dpred, char *cmname, int *ndi,
                  int *nshr, int *ntens, int *nstatv, double *props, int *nprops, double *coords, double *drot,
                  double *pnewdt, double *celent, double *dfgrd0, double *dfgrd1, int *noel, int *npt, int *layer,
                  int *kspt, int *kstep, int *kinc);

enum { MAX = 256, ITERATIONS = 50 };

typedef struct {
   double stress[6], statev[MAX], tangent[36], props[MAX], strain[6], dstrain[6], drot[9], f0[9], f1[9], time[2], dtime;
   double pnewdt;
   int nstatev, nprops, increment;
} host_t;

static void unit(double *matrix)
{
   for (int i = 0; i < 9; i++)
      matrix[i] = i % 4 == 0;
}

static void set_up(host_t *h)
{
   memset(h, 0, sizeof *h);
   h->nstatev = mud_count(MUD_STATEV);
   h->nprops = mud_count(MUD_PROPS);
   if (h->nprops > MAX || h->nstatev > MAX || mud_default_props(h->props, h->nprops) != MUD_OK)
      exit(2);
   for (int i = 0; i < 3; i++)
      h->stress[i] = -100.0;
   unit(h->drot), unit(h->f0), unit(h->f1);
   h->dtime = 1.0;
}

/* The stiffness is memory that was never set, here zeros: what is not written is singular. */
static void call(host_t *h)
{
   double predef = 4.9e-310, dpred = 2.0e-310, temp = 0.0, coords[3] = {0}, celent = 1.0;
   int ndi = 3, nshr = 3, ntens = 6, element = 1, point = 1, layer = 0, kspt = 0, step[4] = {1, 1, 0, 0};
   char name[81] = "@ABAQUS_MUD";
   double unused[36];
   memset(h->tangent, 0, sizeof h->tangent);
   h->pnewdt = -1.0;
   umat_(h->stress, h->statev, h->tangent, unused, unused, unused, unused, unused, unused, unused, h->strain,
         h->dstrain, h->time, &h->dtime, &temp, &temp, &predef, &dpred, name, &ndi, &nshr, &ntens, &h->nstatev,
         h->props, &h->nprops, coords, h->drot, &h->pnewdt, &celent, h->f0, h->f1, &element, &point, &layer, &kspt,
         step, &h->increment);
}

static void stop(const char *why)
{
   puts(why);
   exit(1);
}

/* One increment of axial strain at a radial stress of -100: 1 if it converged, 0 if a cut was asked for (*factor). */
static int compress(host_t *h, double axial, double *factor)
{
   const host_t start = *h;
   double radial = 0.5 * axial;
   for (int iteration = 0; iteration < ITERATIONS; iteration++) {
      *h = start;
      h->increment++;
      h->dstrain[2] = -axial, h->dstrain[0] = h->dstrain[1] = radial;
      call(h);
      double pivot = h->tangent[0] + h->tangent[6];       /* the factorisation: radial stress against radial strain */
      if (!(fabs(pivot) > 0.0))
         stop("matrix found to be singular");
      if (h->pnewdt > 0.0) {
         *factor = h->pnewdt;
         *h = start;
         return 0;
      }
      if (fabs(h->stress[0] + 100.0) < 1.0e-9)
         return 1;
      radial -= (h->stress[0] + 100.0) / pivot;
   }
   stop("no convergence");
   return 0;
}

/* To 2 % of axial strain; STATEV is lost where half of it is reached. */
static int drained(double largest, int substeps, int loses)
{
   host_t h;
   double reached = 0.0, factor = 1.0, step = largest;
   int cuts = 0, lost = 0;
   set_up(&h);
   if (substeps)
      h.props[mud_index(MUD_PROPS, "max_substeps")] = substeps;
   while (reached < 0.02 - 1.0e-12) {
      double axial = fmin(step, 0.02 - reached);
      if (loses && !lost && reached > 0.01 - 1.0e-12)
         memset(h.statev, 0, sizeof h.statev), lost = 1;
      h.dtime = axial;
      h.time[0] = h.time[1] = reached;
      if (!compress(&h, axial, &factor)) {
         step = axial * factor;
         cuts++;
         if (step < 1.0e-7)
            stop("increment size smaller than minimum");
         continue;
      }
      reached += axial;
      step = fmin(1.5 * step, largest);
   }
   printf("axial %.6f, cuts %d\n", h.stress[2], cuts);
   return 0;
}

static int added(void)
{
   host_t first, second;
   set_up(&first), set_up(&second);
   for (int step = 0; step < 4; step++) {
      first.time[0] = first.time[1] = 0.5 * step, first.dtime = 0.5;
      first.dstrain[2] = -1.0e-4;
      call(&first);
      if (step < 2)
         continue;
      second.time[0] = 0.5 * (step - 2), second.time[1] = first.time[1], second.dtime = 0.5;
      second.dstrain[2] = -1.0e-4;
      call(&second);
   }
   printf("axial %.6f\n", second.stress[2]);
   return 0;
}

/* F = R U, by columns: U stretches along the axes, R turns about the second. */
static void gradient(double *f, double *r, double axial, double radial, double angle)
{
   const double c = cos(angle), s = sin(angle), u[3] = {exp(radial), exp(radial), exp(axial)};
   const double rotation[9] = {c, 0.0, -s, 0.0, 1.0, 0.0, s, 0.0, c};
   memcpy(r, rotation, sizeof rotation);
   for (int i = 0; i < 9; i++)
      f[i] = rotation[i] * u[i / 3];
}

static int nlgeom(const char *door, double degrees)
{
   const int steps = 40, logarithmic = strcmp(door, "logarithmic") == 0, green = strcmp(door, "green") == 0;
   const double angle = degrees * acos(-1.0) / 180.0;
   host_t h;
   double r0[9], r1[9];
   set_up(&h);
   for (int step = 0; step < steps; step++) {
      double t0 = (double)step / steps, t1 = (step + 1.0) / steps, before[2], after[2];
      const double axial = -0.02, radial = 0.008;
      gradient(h.f0, r0, t0 * axial, t0 * radial, t0 * angle);
      gradient(h.f1, r1, t1 * axial, t1 * radial, t1 * angle);
      h.time[0] = h.time[1] = t0, h.dtime = t1 - t0;
      for (int k = 0; k < 2; k++) {
         double e = k == 0 ? axial : radial;
         before[k] = t0 * e, after[k] = t1 * e;
         if (green)
            before[k] = 0.5 * (exp(2.0 * before[k]) - 1.0), after[k] = 0.5 * (exp(2.0 * after[k]) - 1.0);
      }
      for (int i = 0; i < 3; i++) {
         h.strain[i] = before[i == 2 ? 0 : 1];
         h.dstrain[i] = after[i == 2 ? 0 : 1] - h.strain[i];
      }
      if (logarithmic)
         for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
               h.drot[3 * j + i] = 0.0;
               for (int k = 0; k < 3; k++)
                  h.drot[3 * j + i] += r1[3 * k + i] * r0[3 * k + j];
            }
      call(&h);
      if (h.pnewdt > 0.0)
         stop("refused");
   }
   printf("axial %.9f\n", h.stress[2]);
   return 0;
}

int main(int argc, char **argv)
{
   const char *task = argc > 1 ? argv[1] : "";
   if (strcmp(task, "cut") == 0 && argc > 2)
      return drained(0.01, atoi(argv[2]), 0);
   if (strcmp(task, "fine") == 0 || strcmp(task, "restart") == 0)
      return drained(1.0e-4, 0, strcmp(task, "restart") == 0);
   if (strcmp(task, "added") == 0)
      return added();
   if (strcmp(task, "nlgeom") == 0 && argc > 3)
      return nlgeom(argv[2], atof(argv[3]));
   return 2;
}
