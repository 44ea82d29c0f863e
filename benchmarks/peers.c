/* SPDX-License-Identifier: MIT */
/* Updates of other laws, timed beside those of MUD: what peers.py calls. A walk goes on from a point by n equal
 * increments; its time is that of the thread, in nanoseconds an update. Tension positive, engineering shear. */
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "mud.h"

static double now(void)
{
   struct timespec t;
   clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
   return 1e9*(double)t.tv_sec + (double)t.tv_nsec;
}

/* --- MUD ------------------------------------------------------------------------------------------------ */
double walk_mud(const double *material, double *stress, double *statev, int nstatev, const double *dstrain, int n,
                int tangent, int *failed)
{
   mud_blocks blocks;
   mud_report report;
   int i;
   double start = now();

   for (i = 0; i < n; i++)
      if (mud_update(material, stress, statev, nstatev, dstrain, 0.0, tangent, stress, statev, &blocks, &report))
         ++*failed;
   return (now() - start)/n;
}

/* --- a law behind umat_, the suction 0 ------------------------------------------------------------------ */
typedef void umat_t(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
                    double *ddsddt, double *drplde, double *drpldt, const double *stran, const double *dstran,
                    const double *time, const double *dtime, const double *temp, const double *dtemp,
                    const double *predef, const double *dpred, const char *cmname, const int *ndi, const int *nshr,
                    const int *ntens, const int *nstatv, const double *props, const int *nprops, const double *coords,
                    const double *drot, double *pnewdt, const double *celent, const double *dfgrd0,
                    const double *dfgrd1, const int *noel, const int *npt, const int *layer, const int *kspt,
                    const int *kstep, const int *kinc, long length);

double walk_umat(umat_t *umat, const double *props, int nprops, double *stress, double *statev, int nstatev,
                 double *strain, const double *dstrain, int n, int *failed)
{
   static const double unit[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
   static const int ndi = 3, nshr = 3, ntens = 6, one = 1;
   static char name[80] = "PEER";
   double ddsdde[36], sse = 0, spd = 0, scd = 0, rpl = 0, ddsddt[6] = {0}, drplde[6] = {0}, drpldt = 0, time[2] = {0},
      dtime = 1, zero[8] = {0}, pnewdt, celent = 1, given[6];
   int i, j;
   double start = now();

   for (i = 0; i < n; i++) {
      pnewdt = 1;
      memcpy(given, dstrain, sizeof given);   /* some laws write into it */
      umat(stress, statev, ddsdde, &sse, &spd, &scd, &rpl, ddsddt, drplde, &drpldt, strain, given, time, &dtime, zero,
           zero, zero, zero, name, &ndi, &nshr, &ntens, &nstatev, props, &nprops, zero, unit, &pnewdt, &celent, unit,
           unit, &one, &one, &one, &one, &one, &one, 80L);
      if (pnewdt < 1) ++*failed;
      for (j = 0; j < 6; j++) strain[j] += dstrain[j];
      time[0] += dtime;
      time[1] += dtime;
   }
   return (now() - start)/n;
}

/* --- ManzariDafalias of OpenSees, by the symbols of its library ------------------------------------------ */
typedef struct peer {   /* addresses, in this order */
   void (*new_material)(void *self, int tag, double, double, double, double, double, double, double, double, double,
                        double, double, double, double, double, double, double, double, double, int scheme,
                        int tangent, int jacobian, double tolerance_f, double tolerance_r);
   int (*set_strain)(void *self, const void *strain);
   int (*commit)(void *self);
   const void *(*stress)(void *self);
   const void *(*tangent)(void *self);
   void (*to_plastic)(void *self);
   void (*new_vector)(void *self, double *data, int n);
   void (*assign)(void *self, const void *other);
   unsigned char *plastic;   /* 0: every material is elastic */
} peer;

enum { ROOM = 1 << 16 };   /* bytes, more than any of these objects has */

/* A material at rest; its elastic stage goes to the stress. strain is that of the point from then on. */
void *begin_opensees(const peer *p, const double *c, int scheme, double tolerance, double pressure, double *strain)
{
   void *self = calloc(1, ROOM);
   double stress[6] = {0};
   char e[256], s[256];
   int i;

   p->new_material(self, 1, c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], c[8], c[9], c[10], c[11], c[12], c[13],
                   c[14], c[15], c[16], c[17], scheme, 1, 1, tolerance, tolerance);
   memset(strain, 0, 6*sizeof *strain);
   p->new_vector(e, strain, 6);
   p->new_vector(s, stress, 6);
   *p->plastic = 0;
   for (i = 0; i < 10000000 && -(stress[0] + stress[1] + stress[2])/3 < pressure; i++) {
      strain[0] = strain[1] = strain[2] = strain[0] - 1e-8;
      p->set_strain(self, e);
      p->commit(self);
      p->assign(s, p->stress(self));
   }
   *p->plastic = 1;
   p->to_plastic(self);
   return self;
}

double walk_opensees(const peer *p, void *self, double *strain, const double *dstrain, int n, double *stress,
                     int *failed)
{
   char e[256], s[256];
   const void *tangent = NULL;
   int i, j;
   double start;

   p->new_vector(e, strain, 6);
   p->new_vector(s, stress, 6);
   start = now();
   for (i = 0; i < n; i++) {
      for (j = 0; j < 6; j++) strain[j] += dstrain[j];
      if (p->set_strain(self, e)) ++*failed;
      tangent = p->tangent(self);
      p->assign(s, p->stress(self));
      p->commit(self);
   }
   return tangent ? (now() - start)/n : 0;
}
