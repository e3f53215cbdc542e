/* Tables of integer fields (specification, V 4.1, V 4.2); tables.c is written by `python -m tools.field_tables`. */
#ifndef BSM_FIELD_TABLES_H
#define BSM_FIELD_TABLES_H

#include "bitstream/entropy/tables.h"

enum { SURVIVAL_REACH = 512, ODDS_SIZE = 544 };

/* -ln of the probability that an error exceeds i / 32 of its scale, from i = -SURVIVAL_REACH on, in 2^-16 nat. */
extern INSIDE const int32_t SURVIVAL[2 * SURVIVAL_REACH + 1];
/* ln(e^d - 1) and ln(1 - e^-d) of a d in 2^-16 nat, by its leading bits; in 1 / 256 nat. */
extern INSIDE const int16_t ODDS[ODDS_SIZE];
extern INSIDE const int16_t LESS[ODDS_SIZE];

#endif
