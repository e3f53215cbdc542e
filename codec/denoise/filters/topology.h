#ifndef BSM_DENOISE_TOPOLOGY_H
#define BSM_DENOISE_TOPOLOGY_H

#include "bitstream/kernel.h"

int64_t face_patches(ConstInts2 faces, ConstLongs around_starts, ConstInts around, int64_t crowd, Ints seen, Longs starts,
                     Ints members);
int64_t inner_pairs(ConstLongs starts, ConstInts members, ConstInts2 pairs, Longs first, Ints own, Ints inside,
                    Longs inner_starts, Ints inner);

#endif
