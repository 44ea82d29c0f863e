/* SPDX-License-Identifier: MIT */
/* Calls umat_ as Abaqus does, with the hidden length of CMNAME last, and prints every bit of the answers. */
#include <stddef.h>
#include <stdio.h>
#include "mud.h"

enum { NPROPS_MAX = 128, NSTATV_MAX = 256, SHEARED = 100, MIXED = 60 };

void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
           double *ddsddt, double *drplde, double *drpldt, double *stran, double *dstran, double *time, double *dtime,
           double *temp, double *dtemp, double *predef, double *dpred, char *cmname, int *ndi, int *nshr, int *ntens,
           int *nstatv, double *props, int *nprops, double *coords, double *drot, double *pnewdt, double *celent,
           double *dfgrd0, double *dfgrd1, int *noel, int *npt, int *layer, int *kspt, int *kstep, int *kinc,
           size_t cmname_length);

typedef struct {
   int nprops, nstatv;
   double props[NPROPS_MAX], statev[NSTATV_MAX], stress[6], tangent[36], suction;
} point_t;

/* One increment; 0 if it failed. */
static int increment(point_t *p, double *dstran, double dpred, double *drot, int kinc)
{
   double sse = 0.0, spd = 0.0, scd = 0.0, rpl = 0.0, ddsddt[6] = {0}, drplde[6] = {0}, drpldt = 0.0, stran[6] = {0},
          time[2] = {0}, dtime = 1.0, temp = 0.0, dtemp = 0.0, coords[3] = {0}, pnewdt = 1.0, celent = 1.0,
          dfgrd[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
   int ndi = 3, nshr = 3, ntens = 6, noel = 1, npt = 1, layer = 1, kspt = 1, kstep = 1;
   char cmname[80];

   for (size_t i = 0; i < sizeof cmname; i++)      /* blank padded, not terminated */
      cmname[i] = i < 3 ? "MUD"[i] : ' ';
   umat_(p->stress, p->statev, p->tangent, &sse, &spd, &scd, &rpl, ddsddt, drplde, &drpldt, stran, dstran, time, &dtime,
         &temp, &dtemp, &p->suction, &dpred, cmname, &ndi, &nshr, &ntens, &p->nstatv, p->props, &p->nprops, coords,
         drot, &pnewdt, &celent, dfgrd, dfgrd, &noel, &npt, &layer, &kspt, &kstep, &kinc, sizeof cmname);
   p->suction += dpred;
   if (pnewdt < 1.0 || scd < 0.0)
      fprintf(stderr, "increment %d: code %g, PNEWDT %g\n", kinc, scd, pnewdt);
   return pnewdt >= 1.0;
}

static void print_bits(const char *name, const double *values, int n)
{
   printf("%s", name);
   for (int i = 0; i < n; i++)
      printf(" %a", values[i]);
   printf("\n");
}

int main(void)
{
   static point_t p = {.stress = {-100.0, -100.0, -100.0}};
   double none[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, turn[9] = {0.8, 0.6, 0, -0.6, 0.8, 0, 0, 0, 1};

   p.nprops = mud_count(MUD_PROPS);
   p.nstatv = mud_count(MUD_STATEV);
   if (p.nprops > NPROPS_MAX || p.nstatv > NSTATV_MAX || mud_default_props(p.props, p.nprops) != MUD_OK)
      return 2;
   p.props[mud_index(MUD_PROPS, "e_0")] = 0.735;

   /* Undrained compression to 1 % axial strain: the first line has a known answer. */
   for (int i = 0; i < SHEARED; i++)
      if (!increment(&p, (double[]){-1.0e-4, 0.5e-4, 0.5e-4, 0, 0, 0}, 0.0, none, i + 1))
         return 1;
   printf("p' %.3f kPa, q %.3f kPa\n", -(p.stress[0] + p.stress[1] + p.stress[2]) / 3.0, p.stress[1] - p.stress[0]);

   /* All components, reversals, drying and a rotation of the axes (0.6, 0.8). */
   for (int i = 0; i < MIXED; i++) {
      double s = i / 7 % 2 ? -1.0e-4 : 1.0e-4;
      if (!increment(&p, (double[]){-s, 0.3 * s, 0.5 * s, 0.7 * s, -1.1 * s, 0.4 * s}, i < 20 ? 1.0 : 0.0,
                     i == 30 ? turn : none, i + 1))
         return 1;
      print_bits("stress", p.stress, 6);
   }
   print_bits("statev", p.statev, p.nstatv);
   print_bits("ddsdde", p.tangent, 36);
   return 0;
}
