/* SPDX-License-Identifier: MIT */
/* A minimal host: one point of dense sand, sheared without change of volume to 1 % axial strain. */
#include <stdio.h>
#include <stdlib.h>
#include "mud.h"

static char text[200];

static int give_up(void)
{
   fprintf(stderr, "%s\n", text);
   return 1;
}

int main(void)
{
   const int nprops = mud_count(MUD_PROPS), nstatev = mud_count(MUD_STATEV), size = mud_prepared_size();
   double *props = calloc((size_t)nprops, sizeof *props), *statev = calloc((size_t)nstatev, sizeof *statev);
   double *material = calloc((size_t)size, sizeof *material);
   double stress[6] = {-100.0, -100.0, -100.0};       /* effective stress [kPa], tension positive */
   double strain = 0.0, step = 1.0e-4;
   const double end = 0.01;

   if (mud_abi_version() != MUD_ABI_VERSION)
      return 1;
   mud_default_props(props, nprops);
   props[mud_index(MUD_PROPS, "e_0")] = 0.735;        /* initial void ratio */
   if (mud_prepare(props, nprops, material, size, text, sizeof text) != MUD_OK)
      return give_up();
   if (mud_init(material, stress, 0.0, 0.0, 0.0, statev, nstatev, text, sizeof text) != MUD_OK)
      return give_up();

   while (end - strain > 1.0e-12) {
      double d = step < end - strain ? step : end - strain;
      double dstrain[6] = {-d, 0.5 * d, 0.5 * d};     /* 11, 22, 33, 12, 13, 23; shear would be engineering shear */
      mud_blocks blocks;                              /* dsig_deps is the tangent */
      mud_report report;
      int status = mud_update(material, stress, statev, nstatev, dstrain, 0.0, MUD_TANGENT_CONSISTENT,
                              stress, statev, &blocks, &report);
      if (status > MUD_OK && d > 1.0e-9) {            /* hard increment: nothing was written, try a smaller one */
         step = d * report.pnewdt;
         continue;
      }
      if (status != MUD_OK) {
         mud_message(&report, text, sizeof text);
         return give_up();
      }
      strain += d;
   }
   printf("p' %.3f kPa, q %.3f kPa\n", -(stress[0] + stress[1] + stress[2]) / 3.0, stress[1] - stress[0]);
   return 0;
}
