/* SPDX-License-Identifier: MIT */
/* libFuzzer on every entry of mud.h and of the interfaces of other programs. The bytes choose entries, parameters,
 * states and increments, from sound to absurd. Beyond what the sanitizers see, this must hold: a failed update writes
 * nothing, a good one leaves finite numbers, what fails has a sentence, and one point is the same through every door,
 * bit by bit. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "mud.h"

enum { NPROPS = 128, NSTATV = 256, TEXT = 600, STEPS = 3 };
#define MUST(what) \
   do { \
      if (!(what)) { \
         fprintf(stderr, "broken: %s (%s:%d)\n", #what, __FILE__, __LINE__); abort(); \
      } \
   } while (0)

typedef struct { const uint8_t *at, *end; } input_t;

typedef struct {
   double *gradients, *forces, *density, *properties, *state, *stored, *dissipated, *external;
} state_view_t;
typedef struct {
   char *error_message;
   double dt, *k, *rdt, *speed_of_sound;
   state_view_t s0, s1;
} view_t;

int MUD_Tridimensional(view_t *), MUD_PlaneStrain(view_t *), MUD_Axisymmetrical(view_t *),
   MUD_GeneralisedPlaneStrain(view_t *), MUD_StressSaturation_Tridimensional(view_t *),
   MUD_StressSaturation_PlaneStrain(view_t *), MUD_StressSaturation_Axisymmetrical(view_t *);
void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
           double *ddsddt, double *drplde, double *drpldt, double *stran, double *dstran, double *time, double *dtime,
           double *temp, double *dtemp, double *predef, double *dpred, char *cmname, int *ndi, int *nshr, int *ntens,
           int *nstatv, double *props, int *nprops, double *coords, double *drot, double *pnewdt, double *celent,
           double *dfgrd0, double *dfgrd1, int *noel, int *npt, int *layer, int *kspt, int *kstep, int *kinc,
           size_t length);
void vumat_(int *nblock, int *ndir, int *nshr, int *nstatev, int *nfieldv, int *nprops, int *lanneal,
            double *step_time, double *total_time, double *dt, char *cmname, double *coord, double *length,
            double *props, double *density, double *strain_inc, double *spin, double *temp_old, double *stretch_old,
            double *defgrad_old, double *field_old, double *stress_old, double *state_old, double *energy_old,
            double *inelastic_old, double *temp_new, double *stretch_new, double *defgrad_new, double *field_new,
            double *stress_new, double *state_new, double *energy_new, double *inelastic_new);
void user_mod_(int *idtask, int *imod, int *isundr, int *istep, int *iter, int *iel, int *integration, double *x,
               double *y, double *z, double *time0, double *dtime, double *props, double *sig0, double *swp0,
               double *stvar0, double *deps, double *d, double *bulkw, double *sig, double *swp, double *stvar,
               int *ipl, int *nstat, int *nonsym, int *istrsdep, int *itimedep, int *itang, int *iprjdir,
               int *iprjlen, int *iabort);
void getmodelname_(int *, char *), getparamname_(int *, int *, char *), getparamunit_(int *, int *, char *),
   getstatevarname_(int *, int *, char *), getstatevarunit_(int *, int *, char *), getparamcount_(int *, int *),
   getstatevarcount_(int *, int *);

static int nprops, nstatv;

static unsigned byte_of(input_t *in) { return in->at < in->end ? *in->at++ : 0; }

static double raw_of(input_t *in)
{
   double value = 0;
   if (in->end - in->at >= 8) {
      memcpy(&value, in->at, 8);
      in->at += 8;
   }
   return value;
}

/* A number about `scale`, now and then anything. */
static double number_of(input_t *in, double scale)
{
   static const double odd[] = {0.0, -0.0, 1.0, -1.0, NAN, INFINITY, -INFINITY, 1e308, -1e308, 4e-324, 1e-320, 1e-9,
      1e9, 0.5, 1e-300, 2e-16};
   unsigned kind = byte_of(in);
   if (kind < 16)
      return odd[kind];
   if (kind < 20)
      return raw_of(in);
   double mantissa = (int8_t)byte_of(in) / 64.0;
   return kind < 200 ? scale * mantissa : scale * mantissa * pow(10.0, (int)(kind % 14) - 8);
}

static void numbers_of(input_t *in, double *values, int n, double scale)
{
   for (int i = 0; i < n; i++)
      values[i] = number_of(in, scale);
}

static int finite_all(const double *values, int n)
{
   for (int i = 0; i < n; i++)
      if (!isfinite(values[i]))
         return 0;
   return 1;
}

static int same(const void *a, const void *b, int n) { return memcmp(a, b, sizeof(double) * (size_t)n) == 0; }

static void check_text(const char *text, int len) { MUST(memchr(text, 0, (size_t)len) != NULL); }

/* One update through all doors of the library itself. */
static void through_every_door(input_t *in, const double *material, double *stress, double *statev, int ns,
   double *suction)
{
   double strain[6], more = number_of(in, 10.0), scale = pow(10.0, -(int)(byte_of(in) % 10));
   int tangent = (int)(byte_of(in) % 6) - 1;
   numbers_of(in, strain, 6, scale);
   /* with hysteresis off the last numbers of STATEV are the host's */
   const int of_material = mud_prepared_statev(material), used = of_material > 0 ? of_material : nstatv;
   double stress1[6], state1[NSTATV], before[NSTATV];
   mud_blocks blocks, no_blocks;
   memset(stress1, 0x55, sizeof stress1);
   memset(state1, 0x55, sizeof state1);
   memset(&blocks, 0x55, sizeof blocks);
   memset(&no_blocks, 0x55, sizeof no_blocks);
   memset(before, 0x55, sizeof before);
   mud_report report;
   if (byte_of(in) % 4 == 0)
      tangent += MUD_TOTAL_STRESS;
   int status = mud_update(material, stress, statev, ns, strain, *suction + more, tangent, stress1, state1, &blocks,
      &report);
   char text[TEXT];
   MUST(report.status == status);
   if (status != MUD_OK) {
      MUST(same(stress1, before, 6) && same(state1, before, nstatv) && memcmp(&blocks, &no_blocks, sizeof blocks) == 0);
      MUST(report.pnewdt < 1.0 && report.pnewdt > 0.0);
      MUST(mud_message(&report, text, TEXT) >= 0 && text[0]);
      check_text(text, TEXT);
      mud_message(&report, text, 7);
      check_text(text, 7);
   } else {
      int kind = tangent & ~MUD_TOTAL_STRESS;
      MUST(kind == MUD_TANGENT_PRESENT || (finite_all(stress1, 6) && finite_all(state1, used)));
      MUST(kind < 1 || (finite_all(blocks.dsig_deps, 36) && finite_all(blocks.dsig_dpc, 6)));
      MUST(finite_all(blocks.dsw_deps, 6) && isfinite(blocks.dsw_dpc) && isfinite(blocks.s_w));
      MUST(report.pnewdt == 1.0);
   }

   mud_substep rows[4];
   int attempts = -1;
   int first = (int)byte_of(in) - 2, traced = mud_trace_increment(material, stress, statev, ns, strain, *suction + more,
                                                                  tangent, first, rows, 4, &attempts, &report);
   if (first >= 1 && traced != status && (tangent & ~MUD_TOTAL_STRESS) != MUD_TANGENT_PRESENT) {
      fprintf(stderr, "traced %d, updated %d, first %d, tangent %d, nstatv %d\n", traced, status, first, tangent, ns);
      abort();
   }

   if (ns == nstatv) {
      double s2[12], v2[2 * NSTATV], e2[12], p2[2] = {*suction + more, *suction + more}, stress2[12],
         state2[2 * NSTATV], tangents[72], s_w[2], ratio[2] = {number_of(in, 1.0), 0.8}, preset[2] = {0, 0};
      int list[2] = {1, 0}, codes[2], kinds[2] = {0, byte_of(in) % 8 == 0};
      mud_summary summary;
      for (int i = 0; i < 2; i++) {
         memcpy(s2 + 6 * i, stress, 6 * sizeof(double));
         memcpy(v2 + nstatv * i, statev, (size_t)nstatv * sizeof(double));
         memcpy(e2 + 6 * i, strain, 6 * sizeof(double));
      }
      memcpy(stress2, s2, sizeof s2);
      memcpy(state2, v2, sizeof v2);
      const unsigned drawn = byte_of(in);
      const int lanes = tangent >= 0 && drawn / 2 % 2 ? MUD_LANES : 0;   /* rounds otherwise */
      mud_points points = {.n = 2, .nstatev = nstatv, .tangent = tangent + lanes, .threads = 1, .list = list,
         .material = drawn % 2 ? kinds : NULL, .stress0 = s2, .statev0 = v2, .dstrain = e2, .suction = p2,
         .stress1 = stress2, .statev1 = state2, .dsig_deps = tangents, .s_w = s_w, .status = codes};
      int failed = mud_update_points(material, 1, &points, &summary);
      MUST(failed < 0 || (codes[0] == codes[1] && (lanes || codes[0] == status) && summary.failed == failed));
      if (failed == 0 && (tangent & ~MUD_TOTAL_STRESS) != MUD_TANGENT_PRESENT) {
         MUST(same(stress2, stress2 + 6, 6) && same(state2, state2 + nstatv, used));
         MUST(finite_all(stress2, 6) && finite_all(state2, used));
         MUST(lanes || (same(stress2, stress1, 6) && same(state2, state1, used)));
         MUST((tangent & ~MUD_TOTAL_STRESS) < 1 || (same(tangents, tangents + 36, 36) && finite_all(tangents, 36)));
      }
      points.tangent = MUD_TANGENT_PRESENT;
      if (byte_of(in) % 2)
         points.dstrain = NULL;
      mud_update_points(material, 1, &points, NULL);
      mud_saturation_points(material, 1, &points, &summary);
      double slope, other;
      mud_saturation(material, number_of(in, 100.0), number_of(in, 1.0), &slope, &other, NULL);
      preset[0] = number_of(in, 1.0);
      points.tangent = byte_of(in) % 2 ? MUD_TOTAL_STRESS : 0;
      points.void_ratio = ratio;
      points.saturation = preset;
      mud_init_points(material, 1, &points, &summary);
   }
   if (tangent >= MUD_TOTAL_STRESS || tangent == MUD_TANGENT_PRESENT)
      return;
   if (status == MUD_OK) {   /* goes on from there */
      memcpy(stress, stress1, sizeof stress1);
      memcpy(statev, state1, (size_t)used * sizeof(double));
      *suction += more;
   }
}

static void as_umat(input_t *in, double *props, int np, double *stress, double *statev, int ns, double suction)
{
   double ddsdde[36], sse = 0, spd = 0, scd = 0, rpl = 0, ddsddt[6], drplde[6], drpldt = 0, stran[6] = {0}, dstran[6],
      time[2] = {0}, dtime = 1,
          temp = 0, dtemp = 0, dpred = number_of(in, 10.0), coords[3] = {0}, drot[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1},
             pnewdt = 1, celent = 1, f[9];
   int shapes[][3] = {{3, 3, 6}, {3, 1, 4}, {3, 0, 3}, {2, 1, 3}, {0, 0, 0}, {3, 3, -1}, {3, 3, 7}},
      *shape = shapes[byte_of(in) % 7], one = 1;
   char name[80];
   memset(name, ' ', sizeof name);
   numbers_of(in, dstran, 6, pow(10.0, -(int)(byte_of(in) % 8)));
   if (byte_of(in) % 4 == 0)
      numbers_of(in, drot, 9, 1.0);
   memcpy(f, drot, sizeof f);
   umat_(stress, statev, ddsdde, &sse, &spd, &scd, &rpl, ddsddt, drplde, &drpldt, stran, dstran, time, &dtime, &temp,
      &dtemp, &suction, &dpred, name,
         &shape[0], &shape[1], &shape[2], &ns, props, &np, coords, drot, byte_of(in) % 8 ? &pnewdt : NULL, &celent, f,
            f, &one, &one, &one, &one, &one,
         &one, sizeof name);
}

static void as_vumat(input_t *in, double *props, int np, double *stress, double *statev, int ns, double suction)
{
   enum { N = 2 };
   int n = N, ndir = 3, nshr = byte_of(in) % 2 ? 3 : 1, fields = (int)(byte_of(in) % 2), zero = 0;
   double step = number_of(in, 1.0), total = step, dt = 1, strain[6 * N], s0[6 * N], s1[6 * N], v0[NSTATV * N],
      v1[NSTATV * N], density[N] = {2, 2},
          field[2 * N], energy0[N] = {0}, energy1[N] = {0}, none[9 * N] = {0};
   char name[80];
   if (ns < 0 || ns > NSTATV)
      ns = nstatv;
   memset(name, ' ', sizeof name);
   numbers_of(in, strain, 6 * N, pow(10.0, -(int)(byte_of(in) % 8)));
   for (int i = 0; i < N; i++) {
      for (int k = 0; k < 6; k++)
         s0[i + N * k] = stress[k];
      for (int k = 0; k < ns; k++)
         v0[i + N * k] = statev[k];
      field[i] = suction;
      field[N + i] = suction;
   }
   memcpy(s1, s0, sizeof s1);
   memcpy(v1, v0, sizeof v1);
   vumat_(&n, &ndir, &nshr, &ns, &fields, &np, &zero, &step, &total, &dt, name, none, none, props, density, strain,
      none, none, none, none, field, s0, v0,
          energy0, energy0, none, none, none, field, s1, v1, energy1, energy1);
}

static void as_plaxis(input_t *in, double *props, double *stress, double *statev, double suction)
{
   int task = (int)(byte_of(in) % 8), model = (int)(byte_of(in) % 3), undrained = (int)(byte_of(in) % 3), one = 1,
      ipl = 0, nstat = 0, flags[4] = {0},
       zero[8] = {0}, abort_code = 0, index = (int)byte_of(in) - 3;
   double x = 0, deps[12] = {0}, d[36], bulk = number_of(in, 1e6), sig[20], pore = 0, sig0[20] = {0}, pore0 = suction,
      stvar[NSTATV];
   char name[256];
   memcpy(sig0, stress, 6 * sizeof(double));
   memcpy(stvar, statev, sizeof stvar);
   numbers_of(in, deps, 6, pow(10.0, -(int)(byte_of(in) % 8)));
   user_mod_(&task, &model, &undrained, &one, &one, &one, &one, &x, &x, &x, &x, &x, props, sig0, &pore0, statev, deps,
      d, &bulk, sig, &pore, stvar, &ipl,
             &nstat, &flags[0], &flags[1], &flags[2], &flags[3], zero, zero, &abort_code);
   MUST(abort_code == 0 || abort_code == 1);
   getmodelname_(&model, name);
   getparamname_(&model, &index, name);
   getparamunit_(&model, &index, name);
   getstatevarname_(&model, &index, name);
   getstatevarunit_(&model, &index, name);
   getparamcount_(&model, &nstat);
   getstatevarcount_(&model, &nstat);
}

static void as_mfront(input_t *in, double *props, double *stress, double *statev, double suction)
{
   static int (*const door[])(view_t *) = {MUD_Tridimensional, MUD_PlaneStrain, MUD_Axisymmetrical,
      MUD_GeneralisedPlaneStrain,
                                           MUD_StressSaturation_Tridimensional, MUD_StressSaturation_PlaneStrain,
                                           MUD_StressSaturation_Axisymmetrical};
   double k[64] = {0}, rdt = 1, sound = 0, g0[8] = {0}, g1[8], f0[8] = {0}, f1[8], v1[NSTATV], density[1] = {2},
      energy[1] = {0}, outside[4] = {293};
   char message[512] = "";
   int which = (int)(byte_of(in) % 7);
   k[0] = number_of(in, 4.0) + (byte_of(in) % 3 == 0 ? 100.0 : 0.0);
   numbers_of(in, g1, 8, pow(10.0, -(int)(byte_of(in) % 8)));
   if (which >= 4)
      g1[which == 4 ? 6 : 4] = suction + number_of(in, 10.0);
   memcpy(f0, stress, 6 * sizeof(double));
   memcpy(f1, f0, sizeof f1);
   memcpy(v1, statev, sizeof v1);
   view_t view = {message, 1.0, k, byte_of(in) % 4 ? &rdt : NULL, &sound, {g0, f0, density, props, statev, energy,
      energy, outside},
                  {g1, f1, density, props, v1, energy, energy, outside}};
   int outcome = door[which](&view);
   MUST(outcome >= -1 && outcome <= 1);
   check_text(message, sizeof message);
   if (outcome == -1) {
      MUST(message[0]);
      MUST(same(f1, f0, 6) && same(v1, statev, nstatv));
   }
}

/* Tables, names, bounds, units. */
static void about_itself(input_t *in, double *props, int np, const double *material)
{
   char text[TEXT], word[40] = {0};
   double a, b, c;
   int list = (int)byte_of(in) % 4, index = (int)byte_of(in) - 3, field = (int)byte_of(in) % 12 - 1,
      len = (int)byte_of(in);
   for (int i = 0; i < 39; i++)
      word[i] = (char)byte_of(in);
   mud_index(list, word);
   if (mud_text(list, index, field, text, len) >= 0 && len > 0)
      check_text(text, len);
   mud_option(index, field, &a, text, len);
   mud_bounds(list, index, &a, &b, &c);
   mud_bounds_for(props, np, index, &a, &b, &c);
   mud_validate_props(props, np, text, TEXT);
   mud_status_text(index, text, len);
   mud_count(list);
   mud_version(text, len);
   double state[NSTATV] = {0}, dummy[6] = {0};
   mud_save_increment("/nonexistent/file", word, material, dummy, state, (int)byte_of(in), dummy, 0, 1, text, TEXT);
   mud_convert_props(props, np, number_of(in, 1000.0));
}

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
   (void)argc;
   (void)argv;
   setenv("MUD_MESSAGES", "off", 1);
   setenv("OMP_NUM_THREADS", "1", 1);
   nprops = mud_count(MUD_PROPS);
   nstatv = mud_count(MUD_STATEV);
   if (nprops > NPROPS || nstatv > NSTATV)
      abort();
   return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
   input_t in = {data, data + size};
   double props[NPROPS] = {0}, stress[6], statev[NSTATV] = {0}, suction = 0.0;
   char text[TEXT];

   mud_default_props(props, nprops);
   props[mud_index(MUD_PROPS, "max_substeps")] = 300;   /* so that an absurd increment does not take seconds */
   for (unsigned changes = byte_of(&in) % 6; changes > 0; changes--) {
      unsigned which = byte_of(&in) % (unsigned)nprops;
      double factor = number_of(&in, 1.0);
      props[which] = byte_of(&in) % 2 ? props[which] * (1 + factor) : factor;
   }
   int np = byte_of(&in) % 32 ? nprops : (int)byte_of(&in) % NPROPS - 2,
      ns = byte_of(&in) % 32 ? nstatv : (int)byte_of(&in) % NSTATV - 2;
   double p = -fabs(number_of(&in, 200.0));
   for (int i = 0; i < 6; i++)
      stress[i] = (i < 3 ? p : 0.0) + number_of(&in, 20.0);
   if (byte_of(&in) % 2)
      suction = number_of(&in, 100.0);
   double begin[6];
   memcpy(begin, stress, sizeof begin);
   double *material = calloc((size_t)mud_prepared_size(), sizeof *material), ratio = number_of(&in, 1.0);
   int status = mud_prepare(props, np, material, mud_prepared_size(), text, TEXT);
   MUST(status == MUD_OK || text[0]);
   check_text(text, TEXT);
   status = mud_init(material, stress, suction, ratio, 0.0, statev, ns, text, TEXT);
   check_text(text, TEXT);
   if (status != MUD_OK)
      MUST(text[0] && same(begin, stress, 6));
   if (status == MUD_BAD_INPUT && finite_all(stress, 6)) {   /* far beyond its strength: begin without shear */
      stress[0] = stress[1] = stress[2] = p;
      stress[3] = stress[4] = stress[5] = 0.0;
      mud_init(material, stress, suction, ratio, 0.0, statev, ns, text, TEXT);
   }
   for (int step = 0; step < STEPS; step++) {
      unsigned door = byte_of(&in);
      if (byte_of(&in) % 8 == 0)
         statev[byte_of(&in) % (unsigned)nstatv] = number_of(&in, 1.0);
      if (door < 140)
         through_every_door(&in, material, stress, statev, ns, &suction);
      else if (door < 175)
         as_umat(&in, props, np, stress, statev, ns, suction);
      else if (door < 200)
         as_vumat(&in, props, np, stress, statev, ns, suction);
      else if (door < 220)
         as_plaxis(&in, props, stress, statev, suction);
      else if (door < 245)
         as_mfront(&in, props, stress, statev, suction);
      else
         about_itself(&in, props, np, material);
      mud_prepare(props, np, material, mud_prepared_size(), text, TEXT);
   }
   free(material);
   return 0;
}
