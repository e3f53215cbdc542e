#ifndef BSM_RASTER_H
#define BSM_RASTER_H

#include "bitstream/kernel.h"

void nearest_faces(ConstDoubles2 corners, Ints2 owner, Doubles2 depth);

#endif
