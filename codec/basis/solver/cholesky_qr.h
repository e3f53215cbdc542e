#ifndef BSM_CHOLESKY_QR_H
#define BSM_CHOLESKY_QR_H

#include "codec/basis/solver/panels.h"

/* What one pass needs besides the panels: a second matrix of their size, and two upper triangular ones, kept alike. */
typedef struct {
    Panels product, triangle, inverse;
} QrSpace;

INLINE int64_t qr_size(const Panels *panels) { return panels_size(panels) + 2 * panels->columns * panels->columns; }

INLINE QrSpace qr_space(const Panels *panels, double *memory) {
    int64_t c = panels->columns;
    double *triangles = memory + panels_size(panels);
    return (QrSpace){{memory, panels->rows, c}, {triangles, c, c}, {triangles + c * c, c, c}};
}

double LEVEL(cholesky_qr)(Panels *panels, int64_t c, QrSpace *space);

#endif
