#ifndef BSM_DENOISE_ESTIMATE_H
#define BSM_DENOISE_ESTIMATE_H

#include "bitstream/kernel.h"

void minus_mean(ConstDoubles2 values, ConstLongs starts, ConstInts members, Doubles2 rest);

#endif
