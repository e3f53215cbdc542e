/* Orthogonal iterations, U(t) = Onorm(R^z U(t-1)) (paper, Algorithm 1; specification, M 8.4). */
#include "codec/basis/vectors.h"

INLINE Panels panels_of(int64_t n, int64_t c, double *memory) {
    return (Panels){memory, padded_rows(n), whole_vectors(c)};
}

/* Doubles of scratch that a matrix of n rows and c columns takes. */
int64_t LEVEL(iteration_space)(int64_t n, int64_t c) {
    Panels panels = panels_of(n, c, 0);
    return panels_size(&panels) + qr_size(&panels) + WIDTH - 1;
}

/* Orthogonal iterations with a factor of `factorize_fronts`, for as many of the columns of `start` as `subspace` has; `once`:
 * see `cholesky_qr`. Before the last, only the spans of columns matter. Returns the least independence of all passes. */
double LEVEL(iterate)(Fronts fronts, Doubles values, ConstDoubles inverse, ConstDoubles2 start, int64_t power, int64_t iterations,
               double once, Doubles scratch, Doubles2 subspace) {
    int64_t c = subspace.columns;
    double *memory = aligned(scratch.data), least_seen = 1.0;
    Panels panels = panels_of(start.rows, c, memory);
    LEVEL(pack)(start, c, fronts.rows.data, panels);
    for (; iterations > 0 && least_seen > 0.0; iterations--) {
        LEVEL(substitute)(fronts, aligned(values.data), inverse.data, panels, power);
        double independence =
            LEVEL(cholesky_qr)(&panels, c, iterations == 1 ? once : 0.0, memory + panels_size(&panels));
        if (independence < least_seen) least_seen = independence;
    }
    LEVEL(unpack)(panels, fronts.rows.data, subspace);
    return least_seen;
}

/* Onorm of `columns` alone; returns how independent they are. */
double LEVEL(cholesky_onorm)(ConstDoubles2 columns, double once, Doubles scratch, Doubles2 subspace) {
    double *memory = aligned(scratch.data);
    Panels panels = panels_of(columns.rows, columns.columns, memory);
    LEVEL(pack)(columns, columns.columns, 0, panels);
    double independence = LEVEL(cholesky_qr)(&panels, columns.columns, once, memory + panels_size(&panels));
    LEVEL(unpack)(panels, 0, subspace);
    return independence;
}

/* Between a matrix row by row and its panels, the rows in any order. */

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

/* Onorm of the paper's Algorithm 1 (specification, M 8.1): Q of a QR factorisation, panel by panel.
 *
 * A panel is made orthonormal by Cholesky QR, X C^-1 with X^T X = C^T C, and what it spans is then taken out of all
 * later panels: modified Gram-Schmidt by blocks. Squaring the condition of a whole matrix would cost half the digits;
 * this squares that of a panel only, and where even that is too much the panel is done again, which is cheap.
 *
 * Every entry is the sum of its terms in the order of the rows, or of the columns, that it runs over, each product
 * fused with the sum.
 */

/* `rows` rows and some vectors side by side of X^T Y. */
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

/* Eight rows of X^T Y from column `skip` of Y on; `left` is X from one of its columns on. */
INLINE void gram_rows(const double *left, int64_t left_apart, Panel y, int64_t skip, int64_t size, double *result) {
    const double *right = y.data + skip;
    int64_t apart = y.apart;
    result += skip;
#if SIDE == 1
    for (int64_t v = 0; v < apart - skip; v += WIDTH) {
        for (int64_t k = 0; k < WIDTH; k += ROWS)
            gram_tile(1, ROWS, left + k, left_apart, right + v, apart, size, result + k * apart + v, apart);
    }
#else
    switch ((apart - skip) / WIDTH) {
        case 1: gram_tile(1, 8, left, left_apart, right, apart, size, result, apart); break;
        case 2: gram_tile(2, 8, left, left_apart, right, apart, size, result, apart); break;
        case 3: gram_tile(3, 8, left, left_apart, right, apart, size, result, apart); break;
        default:
            gram_tile(4, 4, left, left_apart, right, apart, size, result, apart);
            gram_tile(4, 4, left + 4, left_apart, right, apart, size, result + 4 * apart, apart);
    }
#endif
}

/* X^T X on and above the diagonal. */
static void gram(Panel x, int64_t rows, double *product) {
    for (int64_t i = 0; i < x.apart; i += WIDTH) gram_rows(x.data + i, x.apart, x, i, rows, product + i * x.apart);
}

/* Part of row j of a triangle, at `panel`, less what the rows before it take: the sum of column[k] times row k. */
INLINE void reduce_row(const int vectors, double *panel, int64_t apart, int64_t j, const double *column) {
    Vector row[VECTORS];
    EACH(v, vectors) row[v] = load(panel + j * apart + v * WIDTH);
    for (int64_t k = 0; k < j; k++)
        EACH(v, vectors)
            row[v] = add_scaled(row[v], -column[k * apart], load(panel + k * apart + v * WIDTH));
    EACH(v, vectors) store(panel + j * apart + v * WIDTH, row[v]);
}

/* Overwrite the first c rows of G = X^T X by the upper triangular C with G = C^T C; nothing below the diagonal is used.
 *
 * Returns the least squared sine of the angle between a column of X and the space of those before it; 0 if C could not
 * be computed. It is what limits the accuracy of X C^-1: the lengths of the columns do not. */
static double factorize_gram(double *product, int64_t apart, int64_t c) {
    double independence = 1.0;
    for (int64_t j = 0; j < c; j++) {
        double *row = product + j * apart, before = row[j];
        int64_t skip = j / WIDTH;
        WITH_VECTORS(apart / WIDTH - skip, product + skip * WIDTH, reduce_row, apart, j, product + j);
        double squared = row[j];
        if (!(squared > 0.0 && squared < __builtin_inf())) return 0.0;
        if (squared / before < independence) independence = squared / before;
        double scale = 1.0 / __builtin_sqrt(squared);
        for (int64_t p = skip * WIDTH; p < apart; p += WIDTH) store(row + p, scaled(load(row + p), scale));
    }
    return independence;
}

/* Part of row j of the inverse of a triangle of c rows whose pivot is 1 / scale; `row` is that of the triangle. */
INLINE void invert_row(const int vectors, double *inverse, int64_t apart, int64_t j, int64_t c, const double *row,
                       double scale) {
    Vector sums[VECTORS];
    EACH(v, vectors) sums[v] = zeros();
    for (int64_t k = j + 1; k < c; k++) {
        double share = -row[k] * scale;
        EACH(v, vectors) sums[v] = add_scaled(sums[v], share, load(inverse + k * apart + v * WIDTH));
    }
    EACH(v, vectors) store(inverse + j * apart + v * WIDTH, sums[v]);
}

/* Inverse of an upper triangular matrix of c rows; what `triangle` holds below its diagonal is not used. */
static void invert_triangle(const double *triangle, int64_t apart, int64_t c, double *inverse) {
    for (int64_t i = 0; i < apart * apart; i += WIDTH) store(inverse + i, zeros());
    for (int64_t j = c - 1; j >= 0; j--) {
        const double *row = triangle + j * apart;
        double scale = 1.0 / row[j];
        int64_t skip = j / WIDTH;
        WITH_VECTORS(apart / WIDTH - skip, inverse + skip * WIDTH, invert_row, apart, j, c, row, scale);
        inverse[j * apart + j] = scale;
    }
}

/* Add to some rows of a result, from vector `from` on, the terms of `size` columns of X. */
INLINE void add_terms(const int vectors, const int from, Vector sums[ROWS][VECTORS], const double *left, int64_t left_apart,
                      const double *t, int64_t t_apart, int64_t size) {
    for (int64_t k = 0; k < size; k++, t += t_apart)
        EACH(i, ROWS) EACH(v, vectors - from)
            sums[i][from + v] = add_scaled(sums[i][from + v], left[i * left_apart + k], load(t + (from + v) * WIDTH));
}

/* Some rows of X T, for vectors of T from `column` on; below the diagonal T is not looked at. */
INLINE void multiply_tile(const int vectors, int64_t column, const double *left, const double *t, int64_t apart,
                          double *result) {
    Vector sums[ROWS][VECTORS];
    EACH(i, ROWS) EACH(v, vectors) sums[i][v] = zeros();
    add_terms(vectors, 0, sums, left, apart, t + column, apart, column);
    EACH(v, vectors) {
        int64_t k = column + v * WIDTH;
        add_terms(vectors, v, sums, left + k, apart, t + k * apart + column, apart, WIDTH);
    }
    EACH(i, ROWS) EACH(v, vectors) store(result + i * apart + column + v * WIDTH, sums[i][v]);
}

/* Overwrite X by X T, T upper triangular. */
static void multiply(Panel x, int64_t rows, const double *t) {
    double some[ROWS * LANES];
    for (int64_t r = 0; r < rows; r += ROWS) {
        double *from = x.data + r * x.apart;
        for (int64_t i = 0; i < ROWS * x.apart; i += WIDTH) store(some + i, load(from + i));
        WITH_VECTORS(x.apart / WIDTH, 0, multiply_tile, some, t, x.apart, from);
    }
}

/* Some rows of Y less what X times `shares` says, for vectors of Y from `column` on; X is a whole panel. */
INLINE void take_tile(const int vectors, int64_t column, const double *left, const double *shares, int64_t apart,
                      double *rows) {
    Vector sums[ROWS][VECTORS];
    EACH(i, ROWS) EACH(v, vectors) sums[i][v] = load(rows + i * apart + column + v * WIDTH);
    add_terms(vectors, 0, sums, left, LANES, shares + column, apart, LANES);
    EACH(i, ROWS) EACH(v, vectors) store(rows + i * apart + column + v * WIDTH, sums[i][v]);
}

/* Take out of Y what X, orthonormal and a whole panel, spans: Y - X X^T Y. */
static void take_out(Panel x, Panel y, int64_t rows, double *shares) {
    for (int64_t i = 0; i < LANES; i += WIDTH) gram_rows(x.data + i, LANES, y, 0, rows, shares + i * y.apart);
    for (int64_t i = 0; i < LANES * y.apart; i += WIDTH) store(shares + i, scaled(load(shares + i), -1.0));
    for (int64_t r = 0; r < rows; r += ROWS)
        WITH_VECTORS(y.apart / WIDTH, 0, take_tile, x.data + r * LANES, shares, y.apart, y.data + r * y.apart);
}

/* Squared lengths of the columns of some vectors side by side. */
INLINE void measure_tile(const int vectors, int64_t column, Panel x, int64_t rows, double *lengths) {
    Vector sums[VECTORS];
    EACH(v, vectors) sums[v] = zeros();
    for (int64_t r = 0; r < rows; r++)
        EACH(v, vectors) sums[v] = sum_of(sums[v], squared(load(x.data + r * x.apart + column + v * WIDTH)));
    EACH(v, vectors) store(lengths + column + v * WIDTH, sums[v]);
}

/* Overwrites X, of c columns, by Q; a panel of columns less independent than `once` is gone over again. Returns how
 * independent the columns of X are, see `factorize_gram`; 0, and X is lost, if that is nothing. */
double LEVEL(cholesky_qr)(Panels *panels, int64_t c, double once, double *scratch) {
    double *triangle = scratch, *other = triangle + LANES * LANES, *lengths = other + LANES * LANES, least_seen = 1.0;
    int64_t count = panel_count(panels), rows = panels->rows;
    for (int64_t b = 0; b < count; b++) {
        Panel panel = panel_at(panels, b);
        WITH_VECTORS(panel.apart / WIDTH, 0, measure_tile, panel, rows, lengths + panel.first);
    }
    for (int64_t b = 0; b < count; b++) {
        Panel panel = panel_at(panels, b);
        int64_t own = least(panel.apart, c - panel.first);
        gram(panel, rows, triangle);
        double kept = 1.0;
        for (int64_t j = 0; j < own; j++) {
            double share = triangle[j * panel.apart + j] / lengths[panel.first + j];
            if (!(share >= kept)) kept = share;
        }
        double independence = factorize_gram(triangle, panel.apart, own);
        if (!(independence > 0.0 && kept > 0.0)) return 0.0;
        invert_triangle(triangle, panel.apart, own, other);
        multiply(panel, rows, other);
        if (independence < once) {
            gram(panel, rows, triangle);
            if (factorize_gram(triangle, panel.apart, own) == 0.0) return 0.0;
            invert_triangle(triangle, panel.apart, own, other);
            multiply(panel, rows, other);
        }
        if (kept * independence < least_seen) least_seen = kept * independence;
        for (int64_t later = b + 1; later < count; later++) take_out(panel, panel_at(panels, later), rows, triangle);
    }
    return least_seen;
}
