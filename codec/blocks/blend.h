#ifndef BSM_BLEND_H
#define BSM_BLEND_H

#include "bitstream/kernel.h"

void add_copies(Doubles2 sums, Doubles total, ConstInts vertices, ConstDoubles2 positions, ConstDoubles weights);

#endif
