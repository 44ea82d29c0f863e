/* SPDX-License-Identifier: MIT */
/* mud_triax as a library: a case given as text, its table in memory. See drivers/README.md for cases and columns.
 *
 * Texts go into the caller's buffer of `len` bytes, cut to fit and always terminated. Nothing is printed, and no file is
 * written; files that the case names (materials, libraries of UMATs) are read. Calls are independent of each other;
 * any thread may call mud_triax_run, and threads wait for each other there: for tests side by side take processes.
 */
#ifndef MUD_TRIAX_H
#define MUD_TRIAX_H

#ifdef __cplusplus
extern "C" {
#endif

#define MUD_TRIAX_ABI_VERSION 1

enum mud_triax_field { MUD_TRIAX_NAME = 1, MUD_TRIAX_UNIT = 2, MUD_TRIAX_MEANING = 3 };

/* Runs the case. `name` is what messages call it; the folder in it is where relative paths of the case begin (NULL: the
 * present one). Returns an exit code of mud_triax: 0 done; 2 the case is refused, *table is NULL; 3 the test stopped,
 * rows so far are in *table. `message` says why, empty on success. A table is given back with mud_triax_free. */
int mud_triax_run(const char *text, const char *name, void **table, char *message, int len);

int mud_triax_rows(const void *table);
int mud_triax_columns(const void *table);
/* Name, unit or meaning of a column, from 0; -1: no such column or field. */
int mud_triax_column(const void *table, int index, int field, char *text, int len);
/* Fills values[rows*columns], column after column; -1: a NULL pointer. */
int mud_triax_values(const void *table, double *values);
/* Facts about the run, "name: text" lines; returns their length, so that a second call can have room for all. */
int mud_triax_remarks(const void *table, char *text, int len);
void mud_triax_free(void *table);

#ifdef __cplusplus
}
#endif
#endif
