#ifndef BSM_PREDICT_H
#define BSM_PREDICT_H

#include "bitstream/kernel.h"

void look_around(ConstInts offsets, ConstInts neighbours, ConstInts vertices, Bytes inside, ConstDoubles2 sums,
                 ConstDoubles weights, double stiffness, Doubles springs, Doubles2 pulls);

#endif
