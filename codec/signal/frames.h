#ifndef BSM_FRAMES_H
#define BSM_FRAMES_H

#include "bitstream/kernel.h"

int64_t local_frames(ConstDoubles2 positions, ConstInts2 faces, Doubles2 frames);
int64_t tangent_steps(ConstDoubles2 positions, ConstInts2 faces, double step, double ratio, Doubles2 scratch,
                      Doubles steps);
int64_t add_heights(Doubles2 positions, ConstDoubles2 frames, ConstInts2 levels, double step);
int64_t add_slides(Doubles2 positions, ConstDoubles2 frames, ConstInts2 levels, ConstDoubles steps);

#endif
