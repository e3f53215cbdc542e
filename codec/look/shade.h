/* See shade.c. */
#ifndef BSM_LOOK_SHADE_H
#define BSM_LOOK_SHADE_H
#include "bitstream/kernel.h"

int64_t draw_shaded(ConstDoubles2 positions, ConstInts2 faces, ConstSingles2 normals, ConstDoubles camera,
                    Doubles2 placed, Singles2 depth, Singles2 lengths, Singles2 farthest, Singles2 picture, Ints2 owner);
int64_t interpolate_shown(ConstInts2 owner, ConstDoubles2 ways, ConstDoubles2 values, Doubles2 found);

#endif
