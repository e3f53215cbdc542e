#ifndef BSM_DENOISE_FAST_EFFECTIVE_H
#define BSM_DENOISE_FAST_EFFECTIVE_H

#include "bitstream/kernel.h"

void average_alike(ConstDoubles2 normals, ConstLongs starts, ConstInts members, double threshold, Doubles2 averaged);

#endif
