/* The kernels of denoising. */
#pragma once

#include "codec/geometry/geometry.h"

/* What describes a face: filtered normals, what lies on circles around it, and how like its neighbors are. */
enum { RANGES = 4, SCALES = 2, SECTORS = 8, RINGS = 2, FILTERED = SCALES * (2 * RANGES + 1),
    LIKE = SCALES * 2 * RANGES };
enum { DESCRIBED = 3 * (1 + FILTERED) + 4 * SECTORS * RINGS + LIKE + SCALES + 1 };

int64_t reach(ConstDoubles2 points, Lists adjacent, double radius, int64_t most, int64_t begin, Ints seen,
    Longs reached_starts, Ints reached);
void follow_normals(Doubles2 positions, ConstInts2 faces, Lists around, ConstDoubles2 normals, int64_t iterations,
    ConstBytes free, Doubles heights);
void filter_normals(FaceGeometry faces, ConstDoubles2 guide, Lists near, double sigma_s, double sigma_r,
    Doubles2 packed, Doubles2 filtered);
void patch_guidance(ConstDoubles2 normals, ConstDoubles areas, Lists patches, ConstDoubles steps, Lists inner,
    Doubles scores, Doubles2 means, Doubles2 guide);
/* Normals filtered in three ways, each with a row a face. */
typedef struct {
    ConstDoubles2 guide, smooth, axes;
} Filtered;

void describe_faces(FaceGeometry faces, Filtered filtered, Lists near, double distance, int64_t begin,
    Doubles2 described, Doubles2 frames);
