#ifndef BSM_FRAMES_H
#define BSM_FRAMES_H

#include "bitstream/kernel.h"

int64_t local_frames(ConstDoubles2 positions, ConstInts2 faces, Doubles2 frames);
int64_t add_levels(Doubles2 positions, ConstDoubles2 frames, ConstInts2 levels, double step, double ratio);

#endif
