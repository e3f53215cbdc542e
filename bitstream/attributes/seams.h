/* Edges across which an attribute changes, and the corners that share a value. See seams.py. */
#ifndef BSM_ATTRIBUTE_SEAMS_H
#define BSM_ATTRIBUTE_SEAMS_H

#include "bitstream/entropy/mixing.h"
#include "bitstream/fields/corners.h"

int64_t code_edges(Coder coder, Bank bank, Corners corners, Bytes seams, ConstBytes others, Ints2 ends);
int64_t join_corners(Corners corners, ConstBytes seams, Ints joined, Ints first);

#endif
