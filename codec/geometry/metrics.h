#ifndef BSM_METRICS_H
#define BSM_METRICS_H

#include "bitstream/kernel.h"

void face_normals(ConstDoubles2 positions, ConstInts2 faces, Doubles2 normals);
void crosses_around(ConstDoubles2 positions, ConstInts2 faces, Doubles2 crosses, Doubles lengths);
void geometric_laplacian(ConstDoubles2 positions, ConstLongs starts, ConstInts members, Doubles2 result);

#endif
