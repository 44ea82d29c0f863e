/* SPDX-License-Identifier: MIT */
/* Runs a fuzz target on the files that are named, without libFuzzer: the seeds in every check run. A finding aborts. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
__attribute__((weak)) int LLVMFuzzerInitialize(int *argc, char ***argv);

int main(int argc, char **argv)
{
   if (LLVMFuzzerInitialize)
      LLVMFuzzerInitialize(&argc, &argv);
   for (int i = 1; i < argc; i++) {
      FILE *file = fopen(argv[i], "rb");
      uint8_t *data = malloc(1 << 16);
      if (!file || !data) {
         fprintf(stderr, "%s cannot be read\n", argv[i]);
         return 2;
      }
      size_t size = fread(data, 1, 1 << 16, file);
      fclose(file);
      fprintf(stderr, "%s\n", argv[i]);
      LLVMFuzzerTestOneInput(data, size);
      free(data);
   }
   return 0;
}
