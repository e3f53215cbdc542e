/* Cholesky QR of a tall matrix: Onorm of the paper's Algorithm 1 (specification, M 8.1) as Q = X C^-1, X^T X = C^T C.
 *
 * Every entry is the sum of its terms in the order of the rows, or of the columns, that it runs over, each product
 * fused with the sum.
 */
#include "codec/basis/solver/cholesky_qr.h"

/* `rows` rows and some vectors side by side of X^T X. */
INLINE void gram_tile(const int vectors, const int rows, const double *left, int64_t left_apart, const double *right,
                      int64_t right_apart, int64_t size, double *result, int64_t apart) {
    Vector sums[8][VECTORS];
    EACH(i, rows)
        EACH(v, vectors) sums[i][v] = zeros();
    for (int64_t r = 0; r < size; r++, left += left_apart, right += right_apart)
        EACH(i, rows)
            EACH(v, vectors) sums[i][v] = add_scaled(sums[i][v], left[i], load(right + v * WIDTH));
    EACH(i, rows)
        EACH(v, vectors) store(result + i * apart + v * WIDTH, sums[i][v]);
}

/* X^T X on and above the diagonal. */
static void gram(const Panels *x, const Panels *product) {
    for (int64_t b = 0; b < panel_count(x); b++) {
        Panel right = panel_at(x, b), result = panel_at(product, b);
        for (int64_t i = 0; i < right.first + right.apart; i += WIDTH) {
            Panel left = panel_at(x, i / LANES);
            int64_t skip = i < right.first ? 0 : i - right.first, apart = right.apart;
            const double *from = left.data + i % LANES, *source = right.data + skip;
            double *to = result.data + i * apart + skip;
#if SIDE == 1
            for (int64_t v = 0; v < apart - skip; v += WIDTH) {
                gram_tile(1, 4, from, left.apart, source + v, apart, x->rows, to + v, apart);
                gram_tile(1, 4, from + 4, left.apart, source + v, apart, x->rows, to + 4 * apart + v, apart);
            }
#else
            switch ((apart - skip) / WIDTH) {
                case 1: gram_tile(1, 8, from, left.apart, source, apart, x->rows, to, apart); break;
                case 2: gram_tile(2, 8, from, left.apart, source, apart, x->rows, to, apart); break;
                case 3: gram_tile(3, 8, from, left.apart, source, apart, x->rows, to, apart); break;
                default:
                    gram_tile(4, 4, from, left.apart, source, apart, x->rows, to, apart);
                    gram_tile(4, 4, from + 4, left.apart, source, apart, x->rows, to + 4 * apart, apart);
            }
#endif
        }
    }
}

/* Part of row j of a triangle, at `panel`, less what the rows before it take: the sum of column[k] times row k. */
INLINE void reduce_row(const int vectors, double *panel, int64_t apart, int64_t j, const double *column,
                       int64_t column_apart) {
    Vector row[VECTORS];
    EACH(v, vectors) row[v] = load(panel + j * apart + v * WIDTH);
    for (int64_t k = 0; k < j; k++)
        EACH(v, vectors)
            row[v] = add_scaled(row[v], -column[k * column_apart], load(panel + k * apart + v * WIDTH));
    EACH(v, vectors) store(panel + j * apart + v * WIDTH, row[v]);
}

/* Overwrite the first c rows of G = X^T X by the upper triangular C with G = C^T C; nothing below the diagonal is used.
 *
 * Returns the least squared sine of the angle between a column of X and the space of those before it; 0 if C could not
 * be computed. It is what limits the accuracy of X C^-1: the lengths of the columns do not. */
static double factorize_gram(const Panels *product, int64_t c) {
    double independence = 1.0;
    for (int64_t j = 0; j < c; j++) {
        Panel own = panel_at(product, j / LANES);
        const double *column = own.data + j % LANES;
        const double *pivot = column + j * own.apart;
        double before = *pivot;
        for (int64_t b = j / LANES; b < panel_count(product); b++) {
            Panel panel = panel_at(product, b);
            int64_t skip = largest(0, j - panel.first) / WIDTH;
            WITH_VECTORS(panel.apart / WIDTH - skip, panel.data + skip * WIDTH, reduce_row, panel.apart, j, column, own.apart);
        }
        double squared = *pivot;
        if (!(squared > 0.0 && squared < __builtin_inf())) return 0.0;
        if (squared / before < independence) independence = squared / before;
        double scale = 1.0 / __builtin_sqrt(squared);
        for (int64_t b = j / LANES; b < panel_count(product); b++) {
            Panel panel = panel_at(product, b);
            double *row = panel.data + j * panel.apart;
            for (int64_t p = largest(0, j - panel.first) / WIDTH * WIDTH; p < panel.apart; p += WIDTH)
                store(row + p, scaled(load(row + p), scale));
        }
    }
    return independence;
}

/* Part of row j of the inverse of a triangle whose columns before `last` count, and whose pivot is 1 / scale. */
INLINE void invert_row(const int vectors, double *panel, int64_t apart, int64_t j, int64_t last, const Panels *triangle,
                       double scale) {
    Vector row[VECTORS];
    EACH(v, vectors) row[v] = zeros();
    for (int64_t k = j + 1; k < last; k++) {
        double share = -*panel_entry(triangle, j, k) * scale;
        EACH(v, vectors) row[v] = add_scaled(row[v], share, load(panel + k * apart + v * WIDTH));
    }
    EACH(v, vectors) store(panel + j * apart + v * WIDTH, row[v]);
}

/* Inverse of an upper triangular matrix of c rows; what `triangle` holds below its diagonal is not used. */
static void invert_triangle(const Panels *triangle, int64_t c, const Panels *inverse) {
    for (int64_t i = 0; i < panels_size(inverse); i += WIDTH) store(inverse->data + i, zeros());
    for (int64_t j = c - 1; j >= 0; j--) {
        double scale = 1.0 / *panel_entry(triangle, j, j);
        for (int64_t b = j / LANES; b < panel_count(inverse); b++) {
            Panel panel = panel_at(inverse, b);
            int64_t skip = largest(0, j - panel.first) / WIDTH, last = least(c, panel.first + panel.apart);
            WITH_VECTORS(panel.apart / WIDTH - skip, panel.data + skip * WIDTH, invert_row, panel.apart, j, last, triangle,
                         scale);
        }
        *panel_entry(inverse, j, j) = scale;
    }
}

/* Add to four rows of X T the terms of `size` columns of X, for the vectors of a panel of T from the one `from` on. */
INLINE void add_terms(const int vectors, const int from, Vector sums[4][VECTORS], const double *left, int64_t left_apart,
                      const double *t, int64_t t_apart, int64_t size) {
    for (int64_t k = 0; k < size; k++, t += t_apart)
        EACH(i, 4) EACH(v, vectors - from)
            sums[i][from + v] = add_scaled(sums[i][from + v], left[i * left_apart + k], load(t + (from + v) * WIDTH));
}

/* Four rows of X T, for vectors of a panel of T from `column` on; below the diagonal T is not looked at. */
INLINE void multiply_tile(const int vectors, int64_t column, const Panels *x, Panel t, int64_t r, double *result) {
    Vector sums[4][VECTORS];
    EACH(i, 4) EACH(v, vectors) sums[i][v] = zeros();
    const double *right = t.data + column;
    for (int64_t first = 0; first < t.first; first += LANES)
        add_terms(vectors, 0, sums, x->data + first * x->rows + r * LANES, LANES, right + first * t.apart, t.apart, LANES);
    const double *left = x->data + t.first * x->rows + r * t.apart;
    right += t.first * t.apart;
    add_terms(vectors, 0, sums, left, t.apart, right, t.apart, column);
    EACH(v, vectors) {
        int64_t k = column + v * WIDTH;
        add_terms(vectors, v, sums, left + k, t.apart, right + k * t.apart, t.apart, WIDTH);
    }
    EACH(i, 4) EACH(v, vectors) store(result + i * t.apart + column + v * WIDTH, sums[i][v]);
}

/* X T of a matrix X and an upper triangular T. */
static void multiply(const Panels *x, const Panels *triangle, const Panels *product) {
    for (int64_t b = 0; b < panel_count(x); b++) {
        Panel t = panel_at(triangle, b), result = panel_at(product, b);
        for (int64_t r = 0; r < x->rows; r += 4)
            WITH_VECTORS(t.apart / WIDTH, 0, multiply_tile, x, t, r, result.data + r * t.apart);
    }
}

/* One pass: overwrites X, of c columns, by Q and returns how independent its columns are (0 to 1); 0 leaves X alone. */
double LEVEL(cholesky_qr)(Panels *panels, int64_t c, QrSpace *space) {
    gram(panels, &space->triangle);
    double independence = factorize_gram(&space->triangle, c);
    if (independence == 0.0) return 0.0;
    invert_triangle(&space->triangle, c, &space->inverse);
    multiply(panels, &space->inverse, &space->product);
    double *other = panels->data;
    panels->data = space->product.data;
    space->product.data = other;
    return independence;
}
