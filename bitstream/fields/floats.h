/* Which float of the cell of a grid each coordinate is. See floats.py and floats.c. */
#ifndef BSM_FLOATS_H
#define BSM_FLOATS_H

#include "bitstream/entropy/mixing.h"

/* What has been learnt, as Python keeps it. */
typedef struct {
    Words slots;  /* 3 x 9: by the last three answers where a value comes again, and one where it is new */
    Longs latest; /* 3: bits of the last three answers on each axis where a value came again */
    Longs2 known; /* 3 x values: the last float in each cell of an axis, or `NO_FLOAT` */
} Floats;

int64_t code_floats(Coder coder, Floats floats, ConstInts2 values, ConstLongs2 low, ConstLongs2 nearest, ConstLongs2 high,
                    Longs2 chosen);

#endif
