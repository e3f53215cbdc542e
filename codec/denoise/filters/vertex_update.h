#ifndef BSM_DENOISE_VERTEX_UPDATE_H
#define BSM_DENOISE_VERTEX_UPDATE_H

#include "bitstream/kernel.h"

void face_geometry(ConstDoubles2 positions, ConstInts2 faces, Doubles2 centroids, Doubles areas, Doubles2 normals);
void pair_distances(ConstDoubles2 values, ConstInts2 pairs, Doubles distances);
void vertex_normals(ConstDoubles2 normals, ConstLongs starts, ConstInts around, Doubles2 averaged);
void follow_normals(Doubles2 positions, ConstInts2 faces, ConstLongs starts, ConstInts around, ConstDoubles2 normals,
                    int64_t iterations, ConstBytes free, Doubles offsets);

#endif
