/* SPDX-License-Identifier: MIT */
/* libFuzzer on the readers: scenes (namelists, keys, names), cases, Gmsh meshes, lists of numbers. The first byte of
 * the input says which; the rest is the file, in memory. */
#define _GNU_SOURCE
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

int fuzz_scene(const char *, int), fuzz_case(const char *, int), fuzz_mesh(const char *, int),
   fuzz_pairs(const char *, int);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
   static int (*const readers[])(const char *, int) = {fuzz_scene, fuzz_case, fuzz_mesh, fuzz_pairs};
   static int file = -1;
   static char path[64];

   if (size < 1)
      return 0;
   if (file < 0) {
      file = memfd_create("fuzz", 0);
      snprintf(path, sizeof path, "/proc/%d/fd/%d", (int)getpid(), file);
   }
   if (file < 0 || ftruncate(file, 0) || pwrite(file, data + 1, size - 1, 0) != (ssize_t)(size - 1))
      abort();
   readers[data[0] % 4](path, (int)strlen(path));
   return 0;
}
