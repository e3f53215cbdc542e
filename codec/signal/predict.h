#ifndef BSM_PREDICT_H
#define BSM_PREDICT_H

#include "codec/basis/solver/solver.h"

void look_around(ConstInts offsets, ConstInts neighbours, ConstInts vertices, Bytes inside, ConstDoubles2 sums,
                 ConstDoubles weights, double stiffness, Doubles springs, Doubles2 pulls);
void continue_known(Fronts fronts, Doubles values, ConstDoubles inverse, ConstDoubles springs, double total,
                    ConstDoubles2 pulls, Doubles scratch, Doubles2 continued);

#endif
