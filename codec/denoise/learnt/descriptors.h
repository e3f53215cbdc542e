#ifndef BSM_DENOISE_DESCRIPTORS_H
#define BSM_DENOISE_DESCRIPTORS_H

#include "bitstream/kernel.h"

void describe_faces(ConstDoubles2 centroids, ConstDoubles areas, ConstDoubles2 normals, ConstDoubles2 guide,
                    ConstDoubles2 smooth, ConstDoubles2 axes, ConstLongs starts, ConstInts near, double distance,
                    int64_t begin, Doubles2 described, Doubles2 frames);

#endif
