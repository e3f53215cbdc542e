#ifndef BSM_INCIDENCE_H
#define BSM_INCIDENCE_H

#include "bitstream/kernel.h"

void vertex_faces(ConstInts2 faces, Longs starts, Ints members);

#endif
