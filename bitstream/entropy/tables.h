/* Tables of the mixer (specification, C 2.1, C 2.2, C 2.6); tables.c is written by `python -m tools.entropy_tables`. */
#ifndef BSM_TABLES_H
#define BSM_TABLES_H

#include <stdint.h>

enum { SQUASH_REACH = 2880, STRETCH_BITS = 12, SLOT_COUNT_BITS = 10 };

#define INSIDE __attribute__((visibility("hidden")))

/* Probability of log-odds, in units of 1 / 256 nat, from -SQUASH_REACH on. */
extern INSIDE const uint16_t SQUASH[2 * SQUASH_REACH];
/* Log-odds of a probability, by its upper bits. */
extern INSIDE const int16_t STRETCH[1 << STRETCH_BITS];
/* How much a slot learns, by how often it was used, in 1 / 65536. */
extern INSIDE const uint16_t RECIPROCAL[1 << SLOT_COUNT_BITS];

#endif
