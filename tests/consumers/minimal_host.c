/* SPDX-License-Identifier: MIT */
/* A minimal host: one point of dense sand, sheared without change of volume to 1 % axial strain. */
#include <stdio.h>
#include "mud.h"

enum { MAX = 128 };   /* room for PROPS and STATEV */

int main(void)
{
   double props[MAX], statev[MAX] = {0};              /* a zeroed state is initialised by the first update */
   double stress[6] = {-100.0, -100.0, -100.0};       /* effective stress [kPa], tension positive */
   double tangent[36], strain = 0.0, step = 1.0e-4;
   const double end = 0.01;
   const int nprops = mud_count(MUD_PROPS), nstatev = mud_count(MUD_STATEV);
   char text[200];

   if (mud_abi_version() != MUD_ABI_VERSION || nprops > MAX || nstatev > MAX)
      return 1;
   mud_default_props(props, nprops);
   props[mud_index(MUD_PROPS, "e_0")] = 0.735;        /* initial void ratio */
   if (mud_validate_props(props, nprops, text, sizeof text) != MUD_OK) {
      fprintf(stderr, "%s\n", text);
      return 1;
   }

   while (end - strain > 1.0e-12) {
      double d = step < end - strain ? step : end - strain;
      double dstrain[6] = {-d, 0.5 * d, 0.5 * d};     /* 11, 22, 33, 12, 13, 23; shear would be engineering shear */
      mud_report report;
      int status = mud_update(props, nprops, stress, statev, nstatev, dstrain, 0.0, 0.0, MUD_TANGENT_CONSISTENT,
                              stress, statev, tangent, NULL, NULL, NULL, &report);
      if (status > MUD_OK && d > 1.0e-9) {            /* hard increment: nothing was written, try a smaller one */
         step = d * report.pnewdt;
         continue;
      }
      if (status != MUD_OK) {
         mud_message(&report, text, sizeof text);
         fprintf(stderr, "%s\n", text);
         return 1;
      }
      strain += d;
   }
   printf("p' %.3f kPa, q %.3f kPa\n", -(stress[0] + stress[1] + stress[2]) / 3.0, stress[1] - stress[0]);
   return 0;
}
