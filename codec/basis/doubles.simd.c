/* Onorm in doubles of columns that several solutions have made nearly dependent (specification, M 8.9). */
#define VECTORS_OF_DOUBLES
#include "codec/basis/vectors.h"
#include "codec/basis/onorm.h"

enum { SINGLES = 64 }; /* columns of a panel of floats */

INLINE Panels panels_of(int64_t n, int64_t c, double *memory) {
    return (Panels){memory, padded_rows(n), whole_vectors(c)};
}

/* Numbers of scratch for n rows and c columns, as those of `iteration_space`. */
int64_t ISA(doubles_space)(int64_t n, int64_t c) {
    Panels panels = panels_of(n, c, 0);
    return panels_size(&panels) + 2 * LANES * LANES + n + 2 * panels.columns + LINE - 1;
}

/* The panel of floats that holds a panel of doubles, and its columns. */
INLINE float *singles_at(float *columns, int64_t rows, int64_t width, Panel panel, int64_t *apart) {
    int64_t first = panel.first / SINGLES * SINGLES;
    *apart = least(SINGLES, width - first);
    return columns + first * rows + (panel.first - first);
}

/* Overwrite panels of floats, of `rows` rows and `width` columns, n and c of them in use, by their Onorm. */
int64_t ISA(onorm_in_doubles)(float *columns, int64_t rows, int64_t width, int64_t n, int64_t c, int64_t *care,
                               const uint32_t *order, float *scratch) {
    double *memory = aligned((double *)(void *)scratch);
    Panels panels = panels_of(n, c, memory);
    int64_t apart;
    for (int64_t b = 0; b < panel_count(&panels); b++) {
        Panel panel = panel_at(&panels, b);
        const float *from = singles_at(columns, rows, width, panel, &apart);
        for (int64_t r = 0; r < rows; r++)
            for (int64_t j = 0; j < panel.apart; j++) panel.data[r * panel.apart + j] = from[r * apart + j];
    }
    int64_t found = onorm(&panels, n, c, care, order, memory + panels_size(&panels));
    for (int64_t b = 0; b < panel_count(&panels); b++) {
        Panel panel = panel_at(&panels, b);
        float *to = singles_at(columns, rows, width, panel, &apart);
        for (int64_t r = 0; r < rows; r++)
            for (int64_t j = 0; j < panel.apart; j++) to[r * apart + j] = (float)panel.data[r * panel.apart + j];
    }
    return found;
}
