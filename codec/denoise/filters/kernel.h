#ifndef BSM_DENOISE_KERNEL_H
#define BSM_DENOISE_KERNEL_H

#include "bitstream/kernel.h"

void filter_normals(ConstDoubles2 centroids, ConstDoubles areas, ConstDoubles2 normals, ConstDoubles2 guide,
                    ConstLongs starts, ConstInts near, double sigma_s, double sigma_r, Doubles2 filtered);

#endif
