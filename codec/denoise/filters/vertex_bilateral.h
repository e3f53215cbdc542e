#ifndef BSM_DENOISE_VERTEX_BILATERAL_H
#define BSM_DENOISE_VERTEX_BILATERAL_H

#include "bitstream/kernel.h"

void shortest_edges(ConstDoubles2 positions, ConstLongs starts, ConstInts members, Doubles lengths);
void filter_heights(ConstDoubles2 positions, ConstDoubles2 normals, ConstDoubles widths, ConstLongs starts, ConstInts near,
                    Doubles2 moved);

#endif
