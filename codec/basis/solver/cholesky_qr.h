#ifndef BSM_CHOLESKY_QR_H
#define BSM_CHOLESKY_QR_H

#include "codec/basis/solver/panels.h"

/* Doubles of scratch that it takes: two matrices of a panel's columns, and the length of every column. */
INLINE int64_t qr_size(const Panels *panels) { return 2 * LANES * LANES + panels->columns; }

double LEVEL(cholesky_qr)(Panels *panels, int64_t c, double once, double *scratch);

#endif
