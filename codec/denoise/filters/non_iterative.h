#ifndef BSM_DENOISE_NON_ITERATIVE_H
#define BSM_DENOISE_NON_ITERATIVE_H

#include "bitstream/kernel.h"

void mollify(ConstDoubles2 positions, ConstDoubles2 centroids, ConstDoubles areas, ConstLongs starts, ConstInts near,
             double width, Doubles2 moved);
void predict_from_planes(ConstDoubles2 positions, ConstDoubles2 centroids, ConstDoubles areas, ConstDoubles2 normals,
                         ConstLongs starts, ConstInts near, double spatial, double influence, Doubles2 moved);

#endif
