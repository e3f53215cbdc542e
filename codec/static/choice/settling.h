/* See settling.c. */
#ifndef BSM_SETTLING_H
#define BSM_SETTLING_H

#include "codec/static/choice/creases.h"

int64_t settle_levels(ConstDoubles2 offsets, ConstDoubles2 normals, ConstDoubles2 losses, ConstDoubles2 steps,
                      ConstDoubles reach, ConstInts starts, ConstInts members, ConstDoubles2 rates, double pull, int64_t fixed,
                      Creases creases, ConstDoubles2 places, ConstDoubles2 frames, Doubles2 moved, Ints2 levels,
                      Doubles2 counts);

#endif
