/* Rows of a binary table whose lists differ in length. See walk.py. */
#ifndef BSM_WALK_H
#define BSM_WALK_H

#include "bitstream/kernel.h"

int64_t walk_rows(
    ConstBytes raw, int64_t offset, ConstLongs2 widths, int64_t place, bool big_endian, Longs starts, Longs sizes);

#endif
