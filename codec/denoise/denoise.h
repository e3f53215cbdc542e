/* The kernels of denoising. */
#pragma once

#include "codec/geometry/geometry.h"

int64_t reach(ConstDoubles2 points, Lists adjacent, double radius, int64_t most, int64_t begin, Ints seen,
    Longs reached_starts, Ints reached);
void follow_normals(Doubles2 positions, ConstInts2 faces, Lists around, ConstDoubles2 normals, int64_t iterations,
    ConstBytes free, Doubles heights);
void weighed_normals(FaceGeometry faces, ConstDoubles2 guide, Lists near, double sigma_s, double sigma_r,
    Doubles2 packed, Doubles2 sums);
void patch_guidance(ConstDoubles2 normals, ConstDoubles areas, Lists patches, ConstDoubles steps, Lists inner,
    Doubles scores, Doubles2 means, Doubles2 guide);
