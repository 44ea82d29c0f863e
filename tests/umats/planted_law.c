/* SPDX-License-Identifier: MIT
 * A UMAT with a mistake on request: von Mises with linear kinematic hardening, returned radially, with its consistent
 * tangent. PROPS: which mistake (0: none), shear modulus, bulk modulus, radius of the surface, hardening modulus.
 * STATEV: back stress (six), flow direction at the last reversal (six), whether there is one. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
   NONE, SIZE_OF_INCREMENTS, TANGENT, SHEAR_COLUMNS, TENSOR_SHEAR, NO_DROT, KEPT_PROPS, KEPT_STATE, SHARED_WORK,
   BEYOND_STATEV, CHANGES_WHAT_IT_REFUSES, SILENT_NAN, STOPS, ENERGY, FORGETS_ITS_LOADING, WRITES_DSTRAN,
   SINGULAR_START, LOSES_A_STRAIN, ONE_STIFFNESS, NAN_TANGENT, SIGN_OF_SHEAR, OTHER_SIGN, NAN_PNEWDT
};

static double kept_props[5];
static int have_props;
static double kept_back[6];
static double shared[6];

static void turn(double *v, const double *drot)
{
   const int place[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
   double m[3][3] = {{0}};
   for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
         for (int k = 0; k < 3; k++)
            for (int l = 0; l < 3; l++) m[i][j] += drot[i + 3*k]*v[place[k][l]]*drot[j + 3*l];
   for (int i = 0; i < 3; i++)
      for (int j = i; j < 3; j++) v[place[i][j]] = m[i][j];
}

static double inner(const double *a, const double *b)
{
   double sum = 0;
   for (int i = 0; i < 6; i++) sum += (i < 3 ? 1 : 2)*a[i]*b[i];
   return sum;
}

void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
           double *ddsddt, double *drplde, double *drpldt, double *stran, double *dstran, double *time, double *dtime,
           double *temp, double *dtemp, double *predef, double *dpred, char *cmname, int *ndi, int *nshr, int *ntens,
           int *nstatv, double *props, int *nprops, double *coords, double *drot, double *pnewdt)
{
   const int n = *ntens, fault = (int)props[0];
   double p[5], size = 0, own[6] = {0}, *relative = fault == SHARED_WORK ? shared : own;
   memcpy(p, props, sizeof p);
   if (fault == KEPT_PROPS) {
      if (!have_props) memcpy(kept_props, props, sizeof p);
      have_props = 1;
      memcpy(p, kept_props, sizeof p);
   }
   if (fault == OTHER_SIGN) p[1] = -p[1], p[2] = -p[2];
   if (fault == NAN_PNEWDT) *pnewdt = NAN;
   double shear = p[1], bulk = p[2], radius = p[3], hardening = p[4];
   double *back = fault == KEPT_STATE ? kept_back : statev;
   if (fault != NO_DROT && n == 6) turn(back, drot);
   if (n == 6) turn(statev + 6, drot);

   int finite = 1;
   for (int i = 0; i < n; i++) {
      size = fmax(size, fabs(dstran[i]));
      finite = finite && isfinite(dstran[i]);
   }
   if (fault == STOPS && size > 0.05) exit(3);
   if (!finite || size > 0.05) {
      if (fault == LOSES_A_STRAIN && finite) return;
      if (fault == CHANGES_WHAT_IT_REFUSES) statev[0] += 1;
      if (fault == SILENT_NAN) stress[0] = NAN;
      else *pnewdt = 0.25;
      return;
   }
   if (fault == SIZE_OF_INCREMENTS) hardening *= 1 + 1e4*size;
   double mean = (stress[0] + stress[1] + stress[2])/3;
   if (fault == ENERGY) shear *= fmax(0.1, 1 - 10*(mean/100 + 1));

   double volume = dstran[0] + dstran[1] + dstran[2], trial[6] = {0}, flow[6] = {0};
   for (int i = 0; i < n; i++) {
      double d = i < 3 ? dstran[i] - volume/3 : 0.5*dstran[i];
      if (fault == TENSOR_SHEAR && i >= 3) d = dstran[i];
      trial[i] = stress[i] - (i < 3 ? mean : 0) + 2*shear*d;
   }
   mean += bulk*volume;
   for (int i = 0; i < 6; i++) relative[i] = trial[i] - back[i];
   if (fault == SHARED_WORK)
      for (volatile int wait = 0; wait < 20000; wait++) {}
   double length = sqrt(inner(relative, relative)), excess = length - radius, slip = 0;
   if (excess > 0) {
      for (int i = 0; i < 6; i++) flow[i] = relative[i]/length;
      if (fault == FORGETS_ITS_LOADING) {
         /* A reversal, however small, begins a new process, which is stiff. */
         if (inner(flow, statev + 6) <= 0) memcpy(statev + 6, back, 6*sizeof(double));
         double way[6];
         for (int i = 0; i < 6; i++) way[i] = back[i] - statev[6 + i];
         hardening *= 1 + 20*radius/(0.1*radius + sqrt(inner(way, way)));
      }
      slip = excess/(2*shear + hardening);
      for (int i = 0; i < 6; i++) {
         trial[i] -= 2*shear*slip*flow[i];
         back[i] += hardening*slip*flow[i];
      }
   } else if (fault == FORGETS_ITS_LOADING && size > 0) {
      memcpy(statev + 6, back, 6*sizeof(double));
   }
   for (int i = 0; i < n; i++) stress[i] = trial[i] + (i < 3 ? mean : 0);

   double beta = excess > 0 ? 2*shear*slip/length : 0, gamma = excess > 0 ? 2*shear/(2*shear + hardening) - beta : 0;
   for (int j = 0; j < n; j++)
      for (int i = 0; i < n; i++) {
         double unit = i == j ? (i < 3 ? 1 : 0.5) : 0, d = i < 3 && j < 3 ? bulk - 2*shear*(1 - beta)/3 : 0;
         ddsdde[i + n*j] = d + 2*shear*((1 - beta)*unit - gamma*flow[i]*flow[j]);
      }
   if (fault == ONE_STIFFNESS)
      for (int j = 0; j < n; j++)
         for (int i = 0; i < n; i++) {
            double unit = i == j ? (i < 3 ? 1 : 0.5) : 0;
            ddsdde[i + n*j] = (2 - mean/1000)*((i < 3 && j < 3 ? bulk - 2*shear/3 : 0) + 2*shear*unit);
         }
   if (fault == SIGN_OF_SHEAR)
      for (int j = 0; j < n; j++)
         for (int i = 0; i < n; i++)
            ddsdde[i + n*j] = (i < 3 && j < 3 ? bulk - 2*shear/3 : 0) + (i == j ? (i < 3 ? 2 : -1)*shear : 0);
   if (fault == NAN_TANGENT && size > 0) ddsdde[0] = NAN;
   if (fault == TANGENT) ddsdde[1] *= 1.3;
   if (fault == SHEAR_COLUMNS)
      for (int j = 3; j < n; j++)
         for (int i = 0; i < n; i++) ddsdde[i + n*j] *= 2;
   if (fault == SINGULAR_START && size <= 0) memset(ddsdde, 0, n*n*sizeof(double));
   if (fault == BEYOND_STATEV) statev[*nstatv] = 1;
   if (fault == WRITES_DSTRAN) dstran[0] = 0;
}
