/* See normals.c. */
#ifndef BSM_LOOK_NORMALS_H
#define BSM_LOOK_NORMALS_H
#include "bitstream/kernel.h"

int64_t shown_normals(ConstDoubles2 positions, ConstInts2 faces, ConstInts2 joined, ConstLongs starts, ConstInts around,
                      double cosine, double half, int64_t most, Doubles2 crosses, Singles2 normals);

#endif
