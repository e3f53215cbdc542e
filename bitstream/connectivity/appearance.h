/* Numbering by first appearance. */
#ifndef BSM_APPEARANCE_H
#define BSM_APPEARANCE_H

#include "bitstream/kernel.h"

int64_t number_by_appearance(ConstInts sequence, Ints order, Ints number);

#endif
