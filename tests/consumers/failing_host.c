/* SPDX-License-Identifier: MIT */
/* A host whose increment fails, to see what is saved of it. Prints the status and, where asked for, the text.
 *    failing_host api FILE        saves the increment with mud_save_increment, FILE `NULL` stands for no name
 *    failing_host umat TIMES      lets umat_ fail so many times; the environment says whether that is saved
 *    failing_host threads FILE    eight threads save to one FILE: prints how many did
 *    failing_host several         lets umat_ fail in other ways, each twice
 *    failing_host crowd           eight threads let umat_ fail five times each */
#include <math.h>
#include <pthread.h>
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

enum { MAX = 128, ROOM = 512, THREADS = 8 };
static const double STRESS[6] = {-90.0, -95.0, -120.0, 3.0, -2.0, 1.0};
static const double DSTRAIN[6] = {1.0e-3, 2.0e-3, -4.0e-3, 1.0e-3 / 3.0, -1.0e-4, 7.0e-4};
static const double SUCTION = 40.0, DSUCTION = -0.375;

/* The material, prepared, and a point of it that has begun. */
static int set_up(double props[MAX], double material[ROOM], double statev[MAX])
{
   double stress[6];
   memcpy(stress, STRESS, sizeof stress);
   if (mud_default_props(props, mud_count(MUD_PROPS)) != MUD_OK)
      return 0;
   props[mud_index(MUD_PROPS, "max_substeps")] = 12.0;
   props[mud_index(MUD_PROPS, "tangent")] = MUD_TANGENT_CONTINUUM;   /* as `save` asks for */
   return mud_prepare(props, mud_count(MUD_PROPS), material, ROOM, NULL, 0) == MUD_OK &&
          mud_init(material, stress, SUCTION, 0.0, 0.0, statev, mud_count(MUD_STATEV), NULL, 0) == MUD_OK;
}

static int save(const char *path, char *text, int len)
{
   double props[MAX], material[ROOM], statev[MAX];
   if (!set_up(props, material, statev))
      return 1;
   return mud_save_increment(path, "failing_host", material, STRESS, statev, mud_count(MUD_STATEV), DSTRAIN,
                             SUCTION + DSUCTION, MUD_TANGENT_CONTINUUM, text, len);
}

/* What is wrong with a call; NOTHING_ELSE: too few substeps are allowed, as with the others. */
enum fault { NOTHING_ELSE, PROPS_H_0, PROPS_N_B, STRAIN_13, MEMORY_22, STRESS_11, START, FAULTS };

static int fail_as_umat(int element, enum fault fault)
{
   double props[MAX], material[ROOM], statev[MAX], stress[6], dstrain[6], suction = SUCTION, dsuction = DSUCTION;
   double scd = 0.0, pnewdt = 1.0;
   int ntens = 6, nprops = mud_count(MUD_PROPS), nstatv = mud_count(MUD_STATEV), npt = 4, kstep = 1, kinc = 9;

   if (!set_up(props, material, statev))
      return 1;
   memcpy(stress, STRESS, sizeof stress);
   memcpy(dstrain, DSTRAIN, sizeof dstrain);
   if (fault == PROPS_H_0)
      props[mud_index(MUD_PROPS, "h_0")] = -1.0;
   if (fault == PROPS_N_B)
      props[mud_index(MUD_PROPS, "n_b")] = 100.0;
   if (fault == STRAIN_13)
      dstrain[4] = 3.0;
   if (fault == MEMORY_22) {
      statev[mud_index(MUD_STATEV, "layout")] = 1.0;
      statev[mud_index(MUD_STATEV, "void_ratio")] = 0.8;
      statev[mud_index(MUD_STATEV, "memory_22")] = NAN;
   }
   if (fault == STRESS_11)
      stress[0] = INFINITY;
   if (fault == START) {   /* a point without a past that is too loose to begin */
      memset(statev, 0, sizeof statev);
      statev[mud_index(MUD_STATEV, "void_ratio")] = 6.0;
   }
   umat_(stress, statev, NULL, NULL, NULL, &scd, NULL, NULL, NULL, NULL, NULL, dstrain, NULL, NULL, NULL, NULL,
         &suction, &dsuction, NULL, NULL, NULL, &ntens, &nstatv, props, &nprops, NULL, NULL, &pnewdt, NULL, NULL, NULL,
         &element, &npt, NULL, NULL, &kstep, &kinc);
   if (memcmp(&stress[fault == STRESS_11], &STRESS[fault == STRESS_11], 5 * sizeof *stress) != 0 || pnewdt >= 1.0)
      return 99;
   return (int)scd;
}

static void *save_to_one(void *path)
{
   return save(path, NULL, 0) == MUD_OK ? path : NULL;
}

static void *fail_five_times(void *argument)
{
   for (int i = 0; i < 5; i++)
      if (fail_as_umat(i, NOTHING_ELSE) != MUD_TOO_MANY_SUBSTEPS)
         return NULL;
   return argument;
}

/* How many of the threads returned their argument. */
static int crowd(void *(*work)(void *), void *argument)
{
   pthread_t threads[THREADS];
   int good = 0;
   for (int i = 0; i < THREADS; i++)
      if (pthread_create(&threads[i], NULL, work, argument) != 0)
         exit(1);
   for (int i = 0; i < THREADS; i++) {
      void *answer;
      pthread_join(threads[i], &answer);
      good += answer != NULL;
   }
   return good;
}

int main(int argc, char **argv)
{
   const char *task = argc > 1 ? argv[1] : "", *word = argc > 2 ? argv[2] : "";
   char text[2000] = "";
   int code = 0;

   if (strcmp(task, "api") == 0)
      code = save(strcmp(word, "NULL") == 0 ? NULL : word, text, sizeof text);
   else if (strcmp(task, "umat") == 0)
      for (int i = 1; i <= atoi(word); i++)
         code = fail_as_umat(i, NOTHING_ELSE);
   else if (strcmp(task, "several") == 0)
      for (int i = 0; i < 2 * FAULTS - 2; i++)
         code = fail_as_umat(i, (enum fault)(i / 2 + 1));
   else if (strcmp(task, "threads") == 0)
      code = crowd(save_to_one, argv[2]);
   else if (strcmp(task, "crowd") == 0)
      code = crowd(fail_five_times, argv[0]);
   else
      return 2;
   printf("%d %s\n", code, text);
   return 0;
}
