#ifndef BSM_DENOISE_GUIDANCE_H
#define BSM_DENOISE_GUIDANCE_H

#include "bitstream/kernel.h"

void patch_scores(ConstDoubles2 normals, ConstDoubles areas, ConstLongs starts, ConstInts members, ConstDoubles steps,
                  ConstLongs inner_starts, ConstInts inner, Doubles scores, Doubles2 means);
void most_consistent(ConstDoubles scores, ConstDoubles2 means, ConstLongs starts, ConstInts members, Doubles2 guide);

#endif
