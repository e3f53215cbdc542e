#ifndef BSM_CLOSENESS_H
#define BSM_CLOSENESS_H

#include "bitstream/kernel.h"

double weighted_angle(ConstDoubles2 normals, ConstDoubles weights, ConstDoubles2 decoded, ConstInts2 faces,
                      double lost);
double farthest_apart(ConstDoubles2 original, ConstDoubles2 decoded);

#endif
