#ifndef BSM_PREDICT_H
#define BSM_PREDICT_H

#include "codec/basis/basis.h"

void look_around(ConstInts offsets, ConstInts neighbours, ConstInts vertices, Bytes inside, ConstDoubles2 sums,
                 ConstDoubles weights, double stiffness, Doubles springs, Doubles2 pulls);
void continue_known(Fronts fronts, Doubles values, ConstDoubles inverse, ConstDoubles springs, double total,
                    ConstDoubles2 pulls, Doubles scratch, Doubles2 continued);
int64_t suspend(ConstInts offsets, ConstInts neighbours, ConstDoubles weights, ConstDoubles diagonal, Fronts fronts,
                ConstDoubles springs, ConstDoubles2 pulls, double shift, Doubles scratch, Doubles values, Doubles inverse,
                Doubles2 continued);

#endif
