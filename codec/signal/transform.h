#ifndef BSM_TRANSFORM_H
#define BSM_TRANSFORM_H

#include "bitstream/kernel.h"

void LEVEL(project)(ConstDoubles2 subspace, ConstDoubles2 values, Doubles2 coefficients);
void LEVEL(reconstruct)(ConstDoubles2 subspace, ConstDoubles2 coefficients, Doubles2 values);

#endif
