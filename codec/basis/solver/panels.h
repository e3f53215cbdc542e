#ifndef BSM_PANELS_H
#define BSM_PANELS_H

#include "codec/basis/solver/vectors.h"

/* A matrix of n rows and c columns in panels of LANES columns: panel b holds columns b LANES to (b + 1) LANES of all
 * rows, one row after the other, so that work on a panel stays near the processor. The last panel is as wide as it must
 * be, in whole vectors. Columns beyond c, and rows from n to `rows`, are zero. */
typedef struct {
    double *data;
    int64_t rows, columns; /* columns of all panels, a multiple of WIDTH */
} Panels;

typedef struct {
    double *data;
    int64_t first, apart; /* first column, and doubles from one row to the next: its columns */
} Panel;

INLINE int64_t panel_count(const Panels *panels) { return (panels->columns + LANES - 1) / LANES; }

INLINE Panel panel_at(const Panels *panels, int64_t b) {
    return (Panel){panels->data + b * panels->rows * LANES, b * LANES, least(LANES, panels->columns - b * LANES)};
}

/* Where row k of column j is. */
INLINE double *panel_entry(const Panels *panels, int64_t k, int64_t j) {
    Panel panel = panel_at(panels, j / LANES);
    return panel.data + k * panel.apart + j % LANES;
}

/* Rows of panels for n rows: a multiple of four, and one at least beyond the last. */
INLINE int64_t padded_rows(int64_t n) { return (n / 4 + 1) * 4; }

INLINE int64_t panels_size(const Panels *panels) { return panels->rows * panels->columns; }

void LEVEL(pack)(ConstDoubles2 columns, int64_t count, const uint32_t *order, Panels panels);
void LEVEL(unpack)(Panels panels, const uint32_t *order, Doubles2 columns);

#endif
