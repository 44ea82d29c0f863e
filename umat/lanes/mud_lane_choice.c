/* SPDX-License-Identifier: MIT
 * Increments side by side where the processor has what they are compiled for; compiled itself for any processor.
 * A build system that compiles no copies of the core (cmake/MudLanes.cmake) has abi/mud_no_lanes.f90 instead. */
int mud_lane_points(const void *material, const void *increments, int n, int tangent, void *outputs, void *reports);
int mud_lane_points_v3(const void *material, const void *increments, int n, int tangent, void *outputs, void *reports);
int mud_lane_points_v4(const void *material, const void *increments, int n, int tangent, void *outputs, void *reports);

#ifdef MUD_LANES_COMPILED
#include <xmmintrin.h>

/* Optimised loops over lanes compute both sides of a choice, and the one that is dropped may divide by zero. A host that
 * traps such operations must not end by it: they are masked meanwhile, and the flags are the host's afterwards. */
#ifdef __OPTIMIZE__
#define MASKED _MM_MASK_MASK
#else
#define MASKED 0
#endif

int mud_lane_points(const void *material, const void *increments, int n, int tangent, void *outputs, void *reports)
{
   const unsigned control_of_host = _mm_getcsr();
   int done = 0;

   _mm_setcsr(control_of_host | MASKED);
   if (__builtin_cpu_supports("x86-64-v4"))
      done = mud_lane_points_v4(material, increments, n, tangent, outputs, reports);
   else if (__builtin_cpu_supports("x86-64-v3"))
      done = mud_lane_points_v3(material, increments, n, tangent, outputs, reports);
   _mm_setcsr(control_of_host);
   return done;
}

/* Brings memory that will soon be read or written near: the lanes wait for it longer than one point does. */
void mud_fetch(const void *first, int bytes);

void mud_fetch(const void *first, int bytes)
{
   for (int i = 0; i < bytes; i += 64)
      __builtin_prefetch((const char *)first + i);
}
#endif
