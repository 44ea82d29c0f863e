// SPDX-License-Identifier: MIT
// One point of saturated sand in six components, with and without a rule for drained cycles (README.md), written apart from
// the library: docs/theory/material.md sections 3 and 4 with preloading and isotropic memory, memory-rules.md sections 3
// and 4. Compression positive, tensor shear, components 11 22 33 12 13 23, kPa. Where a process ceases to go forwards is
// taken at ends of substeps, not located. No tension cut-off, no suction.
#include <math.h>
#include <string.h>

#define SQRT_2_3 0.816496580927726
#define DEEPEST 4           // entries of the stack
#define ROW 20              // numbers of a row

// RULE: 0 none (section 4.9), 1 as its prototype computes, 2 as it was written down (contraction without its weight).
typedef struct {
   double K_0, G_0, N_c, lambda, alpha_csl, N_l, theta, M_c, c, n_b, n_d, A_0, h_0, c_h, c_z, z_max, p_atm, c_chi, zeta_chi;
   double rho_e, isotropic, rule, tolerance;
} params_t;

typedef struct { double r_in[6], n[6], target, own; } process_t;

// What is integrated; rests: the isotropic mechanism is below its memory.
typedef struct { double sigma[6], e, z[6], chi, own, margin, a[6], d[6]; int rests; } vector_t;

typedef struct {
   vector_t y;
   double strain[6], work, lowest_p, step, jacobian[36];
   process_t now, stack[DEEPEST];
   int directed, depth, has_jacobian;
   long resets, substeps;
} state_t;

typedef struct { double sigma[6], z[6], chi, own, margin, a[6], n[6], t[6], l; } rate_t;

static const double X_0 = 3e-3, X_REV = 1e-3, KAPPA_A = 50, A_MAX = 0.3, EXCESS = 4;

static double dot(const double *a, const double *b)
{
   return a[0]*b[0] + a[1]*b[1] + a[2]*b[2] + 2*(a[3]*b[3] + a[4]*b[4] + a[5]*b[5]);
}
static double norm(const double *a) { return sqrt(dot(a, a)); }
static double trace(const double *a) { return a[0] + a[1] + a[2]; }
static void deviator(const double *a, double *s)
{
   for (int i = 0; i < 6; i++) s[i] = a[i] - (i < 3 ? trace(a)/3 : 0);
}
static void minus(const double *a, const double *b, double *c) { for (int i = 0; i < 6; i++) c[i] = a[i] - b[i]; }
static double p_min(const params_t *m) { return 1e-3*m->p_atm; }
static double mean(const params_t *m, const double *sigma) { return fmax(trace(sigma)/3, p_min(m)); }
static void ratio(const params_t *m, const double *sigma, double *r)
{
   deviator(sigma, r);
   for (int i = 0; i < 6; i++) r[i] /= mean(m, sigma);
}
static double bulk(const params_t *m, double e, double p)
{
   return m->K_0*m->p_atm*(1 + e)/e*cbrt(p/m->p_atm)*cbrt(p/m->p_atm);
}
static double shear(const params_t *m, double e, double p)
{
   return m->G_0*m->p_atm*(2.97 - e)*(2.97 - e)/(1 + e)*sqrt(p/m->p_atm);
}
static double lode(const params_t *m, const double *n)
{
   double det = n[0]*(n[1]*n[2] - n[5]*n[5]) - n[3]*(n[3]*n[2] - n[5]*n[4]) + n[4]*(n[3]*n[5] - n[1]*n[4]);
   double cos_3 = fmax(-1, fmin(1, sqrt(6.)*3*det)), c_4 = m->c*m->c*m->c*m->c;
   return sqrt(sqrt(2*c_4/(1 + c_4 - (1 - c_4)*cos_3)));
}
static double psi(const params_t *m, double e, double p) { return e - m->N_c*pow(p + m->alpha_csl, -m->lambda); }
static double bounding(const params_t *m, double e, double p) { return m->M_c*exp(fmax(0, -m->n_b*psi(m, e, p))); }

// What of a point does not depend on the direction.
typedef struct { double p, r[6], K, G, M_b, M_d, b_0; const vector_t *y; } point_t;

static point_t point_of(const params_t *m, const vector_t *y)
{
   point_t q = { .p = mean(m, y->sigma), .y = y };
   ratio(m, y->sigma, q.r);
   q.K = bulk(m, y->e, q.p);
   q.G = shear(m, y->e, q.p);
   q.M_b = bounding(m, y->e, q.p);
   q.M_d = m->M_c*exp(m->n_d*psi(m, y->e, q.p));
   q.b_0 = m->h_0*m->G_0*fmax(0.01, 1 - m->c_h*y->e)/sqrt(q.p/m->p_atm);
   return q;
}

// Numbers of the kinematic mechanism in a direction, and the coefficients of the direction equation (section 4.6).
typedef struct { double contraction, h_b, r_b, rn, f, mu, gamma, beta; } mechanism_t;

static mechanism_t mechanism(const params_t *m, const state_t *s, const point_t *q, const double *n, double k_e)
{
   mechanism_t w = { 0 };
   double away[6];
   minus(q->r, s->now.r_in, away);
   w.rn = dot(q->r, n);
   double g = lode(m, n), x = fmax(dot(away, n), X_0), zn = dot(q->y->z, n);
   w.r_b = SQRT_2_3*g*q->M_b;
   w.h_b = x/q->b_0;
   double v = 0.75*m->A_0*q->M_d/q->M_b*x*x/q->b_0, others = q->y->chi - q->y->own;
   double d = m->A_0*(1 + fmax(0, zn))*(SQRT_2_3*g*q->M_d - w.rn), cap = w.rn > 0 ? 0.95*2*q->G/(k_e*w.rn) : INFINITY;
   if (m->rule > 0) {
      for (int k = 0; k < s->depth; k++) {   // an open process counts as far as it has been retraced
         double range = s->stack[k].target - dot(s->stack[k].r_in, s->stack[k].n), share = range > 0 ? fmin(1, x/range) : 1;
         others -= s->stack[k].own*(1 - share*share);
      }
      others = fmax(0, others) + fmax(0, q->y->own - EXCESS*v);
   }
   double g_chi = others > 0 ? 1/(1 + others/(2*m->c_chi*v)) : 1;
   w.f = g_chi*g_chi;
   double of_n = 1, least = (2./3)*q->p*(w.rn - w.r_b)/0.5;
   if (m->rule > 0) {
      d = fmin(d, cap);
      of_n = w.f;
      if (w.r_b > w.rn) w.mu = exp(-dot(q->y->a, n))/(SQRT_2_3*0.5*(1 + m->c)*q->M_b);
      d *= w.f;
      if (m->rule < 2) d *= w.f + (1 - w.f)*w.mu*fmax(0, w.r_b - w.rn);
   } else {
      d = fmin(d > 0 ? w.f*d : d, cap);
   }
   double e = 2*q->G*of_n - k_e*d*w.rn;
   if (w.rn > w.r_b && e > 0) w.h_b = fmax(w.h_b, least/e);
   double p = (2./3)*q->p + 2*q->G*w.h_b*(1 - of_n)*w.mu;
   w.contraction = d;
   w.gamma = p*w.r_b + 2*q->G*w.h_b*of_n;
   w.beta = p + w.h_b*k_e*d;
   return w;
}

// Direction n and loading index l for the elastic rate t; false: there is none.
static int direction(const params_t *m, const state_t *s, const point_t *q, const double *t, double k_e, double scale,
                     double *n, double *l, mechanism_t *w)
{
   double size = norm(t), along[6], across[6];
   if (size <= 1e-14*scale) return 0;
   for (int i = 0; i < 6; i++) along[i] = t[i]/size;
   double r_t = dot(q->r, along), angle = 0;
   for (int i = 0; i < 6; i++) across[i] = q->r[i] - r_t*along[i];
   double r_q = norm(across);
   memcpy(n, along, sizeof along);
   *w = mechanism(m, s, q, n, k_e);
   if (r_q > 1e-13*fmax(norm(q->r), 1e-3)) {   // the first change of sign, closer by regula falsi (Illinois)
      double sign = w->beta > 0 ? 1 : -1, a = 0, f_a = -fabs(w->beta)*r_q, b = 0, f_b = f_a, f = f_a;
      int side = 0;
      for (int k = 1, inside = 0, it = 0; it < 80; it++) {
         angle = inside ? (f_a*b - f_b*a)/(f_a - f_b) : k*M_PI/24 - (k == 12)*1e-12;
         for (int i = 0; i < 6; i++) n[i] = cos(angle)*along[i] + sign*sin(angle)*across[i]/r_q;
         *w = mechanism(m, s, q, n, k_e);
         f = w->gamma*sin(angle) - sign*w->beta*r_q;
         if (!inside) {
            if (f < 0) { a = angle; f_a = f; if (k++ == 12) return 0; continue; }
            b = angle; f_b = f; inside = 1; continue;
         }
         if (fabs(f) <= 1e-14*(fabs(w->gamma) + fabs(w->beta)*r_q)) break;
         if (f < 0) { a = angle; f_a = f; if (side < 0) f_b *= 0.5; side = -1; }
         else { b = angle; f_b = f; if (side > 0) f_a *= 0.5; side = 1; }
      }
   }
   double y = (w->gamma*cos(angle) - w->beta*r_t)/size;
   *l = w->h_b/y;
   return y > 0;
}

static double isotropic_hardening(const params_t *m, const point_t *q, double kappa)
{
   double eta_2 = 1.5*dot(q->r, q->r), size = norm(q->r), w = 1, u[6], e = q->y->e;
   if (size > 1e-12) {
      for (int i = 0; i < 6; i++) u[i] = q->r[i]/size;
      w = 1 - eta_2/pow(lode(m, u)*q->M_b, 2);
   }
   double delta = 1 - q->p*pow(m->N_l/e, -1/m->lambda)*(1 + 2*eta_2/(m->M_c*m->M_c));
   double f = 1 - copysign(pow(fabs(delta), m->theta), delta);
   return fmax(0, w)*e/(1 + e)*fmax(0, (m->lambda - kappa)*f);
}

// Rates for a strain; elastic inside the elastic domain, and where the strain leads into it.
static void rate(const params_t *m, const state_t *s, const vector_t *y, const double *strain, int inside, rate_t *o)
{
   point_t q = point_of(m, y);
   double v = trace(strain), e[6], load[6], rest[6] = { 0 }, kappa = cbrt(q.p/m->p_atm)/m->K_0, y_p = (1 - kappa/m->lambda)/q.p;
   double g_c = q.G, outwards = 0;
   memset(o, 0, sizeof *o);
   deviator(strain, e);
   memcpy(load, strain, sizeof load);
   for (int i = 0; i < 6; i++) o->t[i] = 2*q.G*e[i] - q.r[i]*q.K*v;
   if (m->rho_e > 0) {
      double e_c = (1 + y->e)*exp(trace(y->d)) - 1, root = cbrt(q.p/m->p_atm) - m->K_0/3*log(e_c/y->e);
      g_c = shear(m, e_c, fmax(p_min(m), m->p_atm*root*root*root));
      outwards = dot(y->d, strain)/norm(y->d);
      inside = inside || outwards <= 0;
      for (int i = 0; i < 6 && !inside; i++) load[i] = outwards*y->d[i]/norm(y->d), rest[i] = strain[i] - load[i];
   }
   if (inside) {
      for (int i = 0; i < 6; i++) o->sigma[i] = 2*g_c*e[i] + (i < 3 ? q.K*v : 0);
      o->margin = y_p*q.K*v;
      return;
   }
   double l_v = trace(load), l_e[6], k_e = q.K, l = 0, contracts = 0, dp = 0, n[6], back[6], of_n[6] = { 0 }, r_e[6];
   double scale = 2*q.G*norm(load) + fmax(norm(q.r), 1e-3)*q.K*fabs(l_v);
   mechanism_t w = { 0 };
   int loads = 0, isotropic = 0;
   deviator(load, l_e);
   deviator(rest, r_e);
   for (int pass = 0; pass < 2; pass++) {
      double t[6];
      for (int i = 0; i < 6; i++) t[i] = 2*q.G*l_e[i] - q.r[i]*k_e*l_v;
      l = 0;
      loads = direction(m, s, &q, t, k_e, scale, n, &l, &w);
      if (!loads) l = 0;
      contracts = l*w.contraction;
      dp = k_e*(l_v - contracts);
      if (pass || m->isotropic < 2 || dp <= 0 || y->rests || v + fmax(0, -contracts) < -1e-10*norm(strain)) break;
      double a = isotropic_hardening(m, &q, kappa);
      if (a <= 0) break;
      k_e = q.K/(1 + q.K*a/q.p);
      isotropic = 1;
   }
   if (loads) {
      double f = m->rule > 0 ? w.f : 1, size, closing, far = norm(y->a);
      for (int i = 0; i < 6; i++) back[i] = w.r_b*n[i] - q.r[i], of_n[i] = f*n[i] + (1 - f)*w.mu*back[i];
      size = norm(back);
      closing = l*(1 - f)*w.mu*size;
      for (int i = 0; i < 6; i++) {
         o->a[i] = KAPPA_A*closing*(back[i]/size - (far > 0 ? pow(far/A_MAX, 4)*y->a[i]/far : 0));
         o->z[i] = contracts < 0 ? m->c_z*contracts*(m->z_max*n[i] + y->z[i]) : 0;
      }
      memcpy(o->n, n, sizeof n);
      o->chi = contracts > 0 ? contracts : m->zeta_chi*y->chi*contracts;
      o->own = contracts > 0 ? contracts : m->zeta_chi*y->own*contracts;
      o->l = l;
   }
   for (int i = 0; i < 6; i++)
      o->sigma[i] = 2*q.G*(l_e[i] - l*of_n[i]) + 2*g_c*r_e[i] + (i < 3 ? dp + q.K*trace(rest) : 0);
   if (!isotropic) o->margin = y_p*(dp + q.K*trace(rest)) + exp(fmin(y->margin, 0)/0.1)*y_p*q.K*fmax(0, contracts);
}

static int solve_linear(const double *matrix, const double *right, double *x)
{
   double a[36];
   memcpy(a, matrix, sizeof a);
   memmove(x, right, 6*sizeof *x);
   for (int i = 0; i < 6; i++) {
      int best = i;
      for (int k = i + 1; k < 6; k++) if (fabs(a[6*k + i]) > fabs(a[6*best + i])) best = k;
      if (a[6*best + i] == 0) return 0;
      for (int j = 0; j < 6; j++) { double t = a[6*i + j]; a[6*i + j] = a[6*best + j]; a[6*best + j] = t; }
      double t = x[i]; x[i] = x[best]; x[best] = t;
      for (int k = i + 1; k < 6; k++) {
         double f = a[6*k + i]/a[6*i + i];
         for (int j = i; j < 6; j++) a[6*k + j] -= f*a[6*i + j];
         x[k] -= f*x[i];
      }
   }
   for (int i = 5; i >= 0; i--) {
      for (int j = i + 1; j < 6; j++) x[i] -= a[6*i + j]*x[j];
      x[i] /= a[6*i + i];
   }
   return 1;
}

// A leg: row i leads by stress (led[i] = 0) or by strain (1); goal[i] is the change of what leads [kPa or -].
typedef struct { int led[6]; double goal[6]; } leg_t;

static double residual(const leg_t *leg, double share, const rate_t *o, const double *strain, double unit, double *r)
{
   double sum = 0;
   for (int i = 0; i < 6; i++) {
      r[i] = leg->led[i] ? unit*(strain[i] - share*leg->goal[i]) : o->sigma[i] - share*leg->goal[i];
      sum += fabs(r[i]);
   }
   return sum;
}

// Strain with which the led quantities change by a share of the leg: Broyden's method, Newton's where that fails.
static int solve(const params_t *m, state_t *s, const vector_t *y, const leg_t *leg, double share, int inside, double *strain, rate_t *o)
{
   double unit = shear(m, y->e, mean(m, y->sigma)), whole = 0, r[6], next[6], x[6];
   int strains = 0;
   for (int i = 0; i < 6; i++) whole += fabs(share*leg->goal[i])*(leg->led[i] ? unit : 1), strains += leg->led[i];
   if (strains == 6) {
      for (int i = 0; i < 6; i++) strain[i] = share*leg->goal[i];
      rate(m, s, y, strain, inside, o);
      return 1;
   }
   for (int attempt = 0; attempt < 3; attempt++) {   // the last one begins anew from an elastic strain
      if (attempt) s->has_jacobian = 0;
      if (attempt == 2) {
         double d[6];
         for (int i = 0; i < 6; i++) d[i] = share*leg->goal[i]*(leg->led[i] ? 2*unit : 1);
         double v = trace(d)/3, k = bulk(m, y->e, mean(m, y->sigma));
         for (int i = 0; i < 6; i++) strain[i] = (d[i] - (i < 3 ? v : 0))/(2*unit) + (i < 3 ? v/(3*k) : 0);
      }
      rate(m, s, y, strain, inside, o);
      double off = residual(leg, share, o, strain, unit, r);
      for (int it = 0; it < (attempt ? 25 : 10) && off > 1e-12*whole; it++) {
         if (!s->has_jacobian || attempt) {
            double h = 1e-5*norm(strain), other[6];
            rate_t o_2;
            for (int j = 0; j < 6; j++) {
               memcpy(other, strain, sizeof other);
               other[j] += h;
               rate(m, s, y, other, inside, &o_2);
               residual(leg, share, &o_2, other, unit, next);
               for (int i = 0; i < 6; i++) s->jacobian[6*i + j] = (next[i] - r[i])/h;
            }
            s->has_jacobian = 1;
         }
         if (!solve_linear(s->jacobian, r, x)) break;
         double length = fmin(it > 12 ? 0.5 : 1, 5*norm(strain)/fmax(norm(x), 1e-300)), square = 0;
         for (int i = 0; i < 6; i++) x[i] *= -length, strain[i] += x[i], square += x[i]*x[i];
         rate(m, s, y, strain, inside, o);
         off = residual(leg, share, o, strain, unit, next);
         if (!(off < 1e300)) break;
         for (int i = 0; i < 6; i++) {
            double jx = next[i] - (1 - length)*r[i];
            for (int j = 0; j < 6; j++) s->jacobian[6*i + j] += jx*x[j]/square;
         }
         memcpy(r, next, sizeof r);
      }
      if (off <= 1e-10*whole) return 1;
   }
   s->has_jacobian = 0;
   return 0;
}

// Return-point memory, memory-rules.md section 3.
static int candidate(const state_t *s, const double *t)
{
   for (int k = s->depth - 1; k >= 0 && k >= s->depth - 2; k--) if (dot(t, s->stack[k].n) > 0) return k;
   return -1;
}
static double distance(const params_t *m, const state_t *s, int k, const double *sigma, double e)
{
   double r[6], limit = SQRT_2_3*lode(m, s->stack[k].n)*bounding(m, e, mean(m, sigma))/1.001;
   ratio(m, sigma, r);
   return fmin(s->stack[k].target, limit) - dot(r, s->stack[k].n);
}
static int take_returns(const params_t *m, state_t *s, const double *t, double tolerance)
{
   int any = 0;
   for (int k; (k = candidate(s, t)) >= 0 && distance(m, s, k, s->y.sigma, s->y.e) <= tolerance; any = 1) {
      process_t back = s->stack[k];
      double r[6], a[6], b[6];
      ratio(m, s->y.sigma, r);
      minus(r, s->now.r_in, a);
      minus(r, back.r_in, b);
      if (dot(b, t) <= dot(a, t)) memcpy(back.r_in, s->now.r_in, sizeof back.r_in);
      s->y.own = fmin(back.own, s->y.chi);
      s->now = back;
      s->directed = 1;
      s->depth = k;
   }
   return any;
}
static void turn_back(const params_t *m, state_t *s, const double *t)
{
   if (s->directed && dot(t, s->now.n) <= 0) {
      if (s->depth == DEEPEST) s->depth -= 2;
      s->now.own = s->y.own;
      s->stack[s->depth++] = s->now;
   }
   ratio(m, s->y.sigma, s->now.r_in);
   s->directed = 0;
   s->y.own = 0;
   s->resets++;
}
static double beyond(const params_t *m, const state_t *s, const double *sigma, const double *n)
{
   double r[6], x[6];
   ratio(m, sigma, r);
   minus(r, s->now.r_in, x);
   return dot(x, n);
}

static void advanced(const params_t *m, const vector_t *y, const rate_t *o, const rate_t *o_2, const double *strain, int keeps, vector_t *z)
{
   *z = *y;
   for (int i = 0; i < 6; i++) {
      z->sigma[i] += 0.5*(o->sigma[i] + o_2->sigma[i]);
      z->z[i] += 0.5*(o->z[i] + o_2->z[i]);
      z->a[i] += 0.5*(o->a[i] + o_2->a[i]);
      z->d[i] += strain[i];
   }
   z->e = (1 + y->e)*exp(-trace(strain)) - 1;
   z->chi = fmax(0, y->chi + 0.5*(o->chi + o_2->chi));
   z->own = fmin(z->chi, fmax(0, y->own + 0.5*(o->own + o_2->own)));
   z->margin = fmin(0, y->margin + 0.5*(o->margin + o_2->margin));
   double size = norm(z->d);
   if (m->rho_e > 0 && (keeps || size > m->rho_e)) for (int i = 0; i < 6; i++) z->d[i] *= m->rho_e/size;
}

void begin(const params_t *m, state_t *s, const double *sigma, double e)
{
   memset(s, 0, sizeof *s);
   memcpy(s->y.sigma, sigma, sizeof s->y.sigma);
   s->y.e = e;
   ratio(m, sigma, s->now.r_in);
   s->step = 0.05;
}
int size_of_state(void) { return sizeof(state_t); }

// Follows a leg, at most to where the stress sigma_11 - ends*sigma_33 is `until` (if not NaN). 0: done, 1: that was met, < 0: failed.
static int follow(const params_t *m, state_t *s, const leg_t *leg, double ends, double until, double longest)
{
   double tau = 0, h = fmin(fmax(0.5*s->step, 1e-4), longest), guess[6] = { 0 };
   s->has_jacobian = 0;
   s->lowest_p = mean(m, s->y.sigma);
   for (int i = 0; i < 6; i++) guess[i] = leg->led[i] ? leg->goal[i] : leg->goal[i]/(3*shear(m, s->y.e, s->lowest_p));
   for (long count = 0; tau < 1 - 1e-12; count++) {
      if (count > 200000 || h < 1e-18) return -1;
      h = fmin(fmin(h, longest), 1 - tau);
      state_t before = *s;
      double strain[6], strain_2[6], average[6], share = 1, size = norm(s->y.d), error = 0, bent = 0;
      rate_t o, o_2;
      int inside = m->rho_e > 0 && size < m->rho_e*(1 - 1e-9);
      s->y.rests = s->y.margin < -1e-14;
      for (int i = 0; i < 6; i++) strain[i] = guess[i]*h;
      int solved = solve(m, s, &s->y, leg, h, inside, strain, &o);
      inside = inside || (m->rho_e > 0 && dot(s->y.d, strain) <= 0);
      if (solved && !inside) {
         int changed = take_returns(m, s, o.t, 1e-10);
         if (o.l > 0 && beyond(m, s, s->y.sigma, o.n) < -X_REV*(1 - 1e-7)) {
            turn_back(m, s, o.t);
            take_returns(m, s, o.t, 1e-10);
            changed = 1;
         }
         if (changed) {
            s->has_jacobian = 0;
            solved = solve(m, s, &s->y, leg, h, 0, strain, &o);
         }
      }
      if (!solved) { *s = before; s->has_jacobian = 0; h *= 0.25; continue; }
      if (inside) {   // up to the sphere
         double a = dot(strain, strain), b = dot(s->y.d, strain), c = fmin(0, size*size - m->rho_e*m->rho_e);
         share = fmax(1e-9, (-b + sqrt(b*b - a*c))/a);
         if (share >= 1 - 1e-12) share = 1;
         h *= share;
         for (int i = 0; i < 6; i++) strain[i] *= share, o.sigma[i] *= share;
         o.margin *= share;
      }
      int meets = share < 1;
      vector_t middle, end;
      advanced(m, &s->y, &o, &o, strain, !inside, &middle);
      memcpy(strain_2, strain, sizeof strain_2);
      if (!solve(m, s, &middle, leg, h, inside, strain_2, &o_2)) { *s = before; s->has_jacobian = 0; h *= 0.25; continue; }
      for (int i = 0; i < 6; i++) {
         average[i] = 0.5*(strain[i] + strain_2[i]);
         error += 0.5*fabs(o_2.sigma[i] - o.sigma[i])/fmax(norm(s->y.sigma), p_min(m));
         bent += 0.5*(fabs(strain_2[i] - strain[i])/1e-2 + fabs(o_2.z[i] - o.z[i])/(m->z_max + 1) + 0.1*fabs(o_2.a[i] - o.a[i]));
      }
      error = fmax(error, bent);
      s->substeps = ++before.substeps;
      if (error > m->tolerance && h > 1e-9) { *s = before; h *= fmax(0.1, 0.8*sqrt(m->tolerance/error)); continue; }
      advanced(m, &s->y, &o, &o_2, average, !inside || meets, &end);
      double cut = 1;   // events: return, reversal, yield of the isotropic mechanism, the end that is asked for
      if (!inside) {
         int k = candidate(s, o_2.t);
         double d_0 = k < 0 ? 0 : distance(m, s, k, s->y.sigma, s->y.e), d_1 = k < 0 ? 0 : distance(m, s, k, end.sigma, end.e);
         if (d_0 > 1e-10 && d_1 < -1e-10) cut = fmin(cut, d_0/(d_0 - d_1));
         double x_0 = beyond(m, s, s->y.sigma, o.n), x_1 = beyond(m, s, end.sigma, o_2.n);
         if (o_2.l > 0 && x_0 > -X_REV*(1 - 1e-7) && x_1 < -X_REV*(1 + 1e-6)) cut = fmin(cut, (x_0 + X_REV)/(x_0 - x_1));
      }
      double u = s->y.margin + 0.5*(o.margin + o_2.margin);
      if (m->isotropic > 1 && s->y.rests && u > 1e-9) cut = fmin(cut, s->y.margin/(s->y.margin - u));
      double w_0 = s->y.sigma[0] - ends*s->y.sigma[2] - until, w_1 = end.sigma[0] - ends*end.sigma[2] - until;
      if (w_0*w_1 < 0 && fabs(w_1) > 1e-5*fabs(until)) cut = fmin(cut, w_0/(w_0 - w_1));
      if (cut < 1 && h > 1e-11) { *s = before; h *= fmin(fmax(cut, 1e-3), 0.9999999); continue; }
      for (int i = 0; i < 6; i++) {
         s->strain[i] += average[i];
         s->work += (i < 3 ? 1 : 2)*0.5*(s->y.sigma[i] + end.sigma[i])*average[i];
      }
      s->y = end;
      if (s->y.margin > -1e-9) s->y.margin = 0;
      if (trace(s->y.sigma)/3 < p_min(m)) {
         double r[6], unit[6], far;
         ratio(m, s->y.sigma, r);
         far = norm(r);
         for (int i = 0; i < 6; i++) unit[i] = far > 0 ? r[i]/far : 0;
         far = far > 0 ? fmin(far, SQRT_2_3*lode(m, unit)*bounding(m, s->y.e, p_min(m))) : 0;
         for (int i = 0; i < 6; i++) s->y.sigma[i] = p_min(m)*((i < 3) + far*unit[i]);
      }
      if (!inside) {
         double r[6], c[6], x;
         ratio(m, s->y.sigma, r);
         minus(r, s->now.r_in, c);
         x = dot(c, o_2.n);
         for (int i = 0; i < 6; i++) c[i] += X_0*o_2.n[i];
         if (o_2.l > 0 && x >= 0 && dot(c, o_2.n) >= 0.7*norm(c) && dot(o_2.t, c) > 0) {
            s->directed = 1;
            for (int i = 0; i < 6; i++) s->now.n[i] = c[i]/norm(c);
            s->now.target = dot(r, s->now.n);
         } else if (s->directed) {
            s->now.target = fmax(s->now.target, dot(r, s->now.n));
         }
         take_returns(m, s, o_2.t, 1e-9);   // exactly at the target, ahead of the reversal that follows
      }
      s->lowest_p = fmin(s->lowest_p, trace(s->y.sigma)/3);
      tau += h;
      for (int i = 0; i < 6; i++) guess[i] = strain_2[i]/h;
      s->step = h;
      h *= fmin(2, fmax(0.3, 0.9*sqrt(m->tolerance/fmax(error, 1e-14))));
      if (meets) { h = fmax(h, 0.3*s->step/share); s->has_jacobian = 0; }
      if (!(norm(s->strain) < 1.5)) return -2;
      if (!isnan(until) && (fabs(w_1) <= 1e-5*fabs(until) || w_0*w_1 < 0)) return 1;
   }
   return 0;
}

// Repeats legs; after the cycles of `marks` a row for each leg. Returns the number of marked cycles, or < 0 where a leg failed.
int cycles(const params_t *m, state_t *s, int legs, const leg_t *leg, double ends, const double *until, double longest, int count, int marks,
           const int *mark, double *rows)
{
   int k = 0;
   for (int c = 1; c <= count; c++) {
      int told = k < marks && mark[k] == c;
      for (int i = 0; i < legs; i++) {
         if (follow(m, s, &leg[i], ends, until[i], longest) < 0) return -c;
         if (!told) continue;
         double *row = rows + ROW*(legs*k + i);
         memcpy(row, s->y.sigma, sizeof s->y.sigma);
         memcpy(row + 6, s->strain, sizeof s->strain);
         double more[8] = { s->y.e, s->y.chi, s->y.margin, norm(s->y.a), s->work, s->lowest_p, (double)s->resets, (double)s->substeps };
         memcpy(row + 12, more, sizeof more);
      }
      k += told;
   }
   return k;
}
