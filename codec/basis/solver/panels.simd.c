/* Between a matrix row by row and its panels, the rows in any order. */
#include "codec/basis/solver/panels.h"

/* Panels of the first `count` columns, whose row k is row `order[k]` of `columns`; without an order, row k. */
void LEVEL(pack)(ConstDoubles2 columns, int64_t count, const uint32_t *order, Panels panels) {
    for (int64_t b = 0; b < panel_count(&panels); b++) {
        Panel panel = panel_at(&panels, b);
        int64_t width = least(panel.apart, count - panel.first);
        double *to = panel.data;
        for (int64_t k = 0; k < panels.rows; k++, to += panel.apart) {
            int64_t known = k < columns.rows ? width : 0;
            const double *from = columns.data + (known ? (order ? order[k] : k) * columns.columns + panel.first : 0);
            int64_t whole = known / WIDTH * WIDTH;
            for (int64_t j = 0; j < whole; j += WIDTH) store(to + j, load(from + j));
            for (int64_t j = whole; j < known; j++) to[j] = from[j];
            for (int64_t j = known; j < panel.apart; j++) to[j] = 0.0;
        }
    }
}

/* Inverse of `pack`. */
void LEVEL(unpack)(Panels panels, const uint32_t *order, Doubles2 columns) {
    for (int64_t b = 0; b < panel_count(&panels); b++) {
        Panel panel = panel_at(&panels, b);
        int64_t width = least(panel.apart, columns.columns - panel.first);
        int64_t whole = width / WIDTH * WIDTH;
        const double *from = panel.data;
        for (int64_t k = 0; k < columns.rows; k++, from += panel.apart) {
            double *to = columns.data + (order ? order[k] : k) * columns.columns + panel.first;
            for (int64_t j = 0; j < whole; j += WIDTH) store(to + j, load(from + j));
            for (int64_t j = whole; j < width; j++) to[j] = from[j];
        }
    }
}
