#ifndef BSM_SUBSTITUTION_H
#define BSM_SUBSTITUTION_H

#include "codec/basis/solver/front.h"
#include "codec/basis/solver/panels.h"

void LEVEL(substitute)(Fronts fronts, const double *matrices, const double *inverse, Panels panels, int64_t power);

#endif
