/* SPDX-License-Identifier: MIT */
/* Coverage of Fortran for libFuzzer: gfortran calls __sanitizer_cov_trace_pc in every block
 * (-fsanitize-coverage=trace-pc), and libFuzzer reads counters of ours. This file itself is compiled without that
 * option. */
#include <stdint.h>

enum { COUNTERS = 1 << 16 };
__attribute__((section("__libfuzzer_extra_counters"))) static uint8_t counters[COUNTERS];

void __sanitizer_cov_trace_pc(void)
{
   uintptr_t place = (uintptr_t)__builtin_return_address(0);
   uint8_t *counter = &counters[(place * 0x9E3779B97F4A7C15u >> 40) % COUNTERS];

   if (*counter < 255)
      ++*counter;
}

/* Comparisons of real numbers, which libFuzzer does not listen to. */
void __sanitizer_cov_trace_cmpf(float a, float b) { (void)a; (void)b; }
void __sanitizer_cov_trace_cmpd(double a, double b) { (void)a; (void)b; }
