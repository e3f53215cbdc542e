/* The kernels of denoising. */
#pragma once

#include "bitstream/kernel.h"

/* What describes a face: filtered normals, what lies on circles around it, and how like its neighbors are. */
enum { RANGES = 4, SCALES = 2, SECTORS = 8, RINGS = 2, FILTERED = SCALES * (2 * RANGES + 1),
    LIKE = SCALES * 2 * RANGES };
enum { DESCRIBED = 3 * (1 + FILTERED) + 4 * SECTORS * RINGS + LIKE + SCALES + 1 };

int64_t face_patches(ConstInts2 faces, ConstLongs around_starts, ConstInts around, int64_t crowd, Ints seen,
    Longs starts, Ints members);
int64_t reach(ConstDoubles2 points, ConstLongs starts, ConstInts members, double radius, int64_t most, int64_t begin,
              Ints seen, Longs reached_starts, Ints reached);
void pair_distances(ConstDoubles2 values, ConstInts2 pairs, Doubles distances);
void follow_normals(Doubles2 positions, ConstInts2 faces, ConstLongs starts, ConstInts around, ConstDoubles2 normals,
                    int64_t iterations, ConstBytes free, Doubles2 planes, Doubles2 sums);
void filter_normals(ConstDoubles2 centroids, ConstDoubles areas, ConstDoubles2 normals, ConstDoubles2 guide,
    ConstLongs starts, ConstInts near, double sigma_s, double sigma_r, Doubles2 packed, Doubles2 filtered);
void patch_guidance(ConstDoubles2 normals, ConstDoubles areas, ConstLongs starts, ConstInts members, ConstDoubles steps,
                    ConstLongs inner_starts, ConstInts inner, Doubles scores, Doubles2 means, Doubles2 guide);
void describe_faces(ConstDoubles2 centroids, ConstDoubles areas, ConstDoubles2 normals, ConstDoubles2 guide,
                    ConstDoubles2 smooth, ConstDoubles2 axes, ConstLongs starts, ConstInts near, double distance,
                    int64_t begin, Doubles2 described, Doubles2 frames);
