/* Orthogonal iterations, U(t) = Onorm(R^z U(t-1)) (paper, Algorithm 1; specification, M 8.4), Onorm after every
 * solution. */
#include "codec/basis/vectors.h"

/* Between a matrix row by row and its panels, the rows in any order. */

/* Panels of the first `count` columns, whose row k is row `order[k]` of `columns`. */
static void pack(ConstSingles2 columns, int64_t count, const uint32_t *order, Panels panels) {
    for (int64_t b = 0; b < panel_count(&panels); b++) {
        Panel panel = panel_at(&panels, b);
        int64_t width = least(panel.apart, count - panel.first);
        float *to = panel.data;
        for (int64_t k = 0; k < panels.rows; k++, to += panel.apart) {
            int64_t known = k < columns.rows ? width : 0;
            const float *from = columns.data + (known ? order[k] * columns.columns + panel.first : 0);
            int64_t whole = known / WIDTH * WIDTH;
            for (int64_t j = 0; j < whole; j += WIDTH) store(to + j, load(from + j));
            for (int64_t j = whole; j < known; j++) to[j] = from[j];
            for (int64_t j = known; j < panel.apart; j++) to[j] = 0.0;
        }
    }
}

/* Inverse of `pack`. */
static void unpack(Panels panels, const uint32_t *order, Singles2 columns) {
    for (int64_t b = 0; b < panel_count(&panels); b++) {
        Panel panel = panel_at(&panels, b);
        int64_t width = least(panel.apart, columns.columns - panel.first);
        int64_t whole = width / WIDTH * WIDTH;
        const float *from = panel.data;
        for (int64_t k = 0; k < columns.rows; k++, from += panel.apart) {
            float *to = columns.data + order[k] * columns.columns + panel.first;
            for (int64_t j = 0; j < whole; j += WIDTH) store(to + j, load(from + j));
            for (int64_t j = whole; j < width; j++) to[j] = from[j];
        }
    }
}

/* Onorm (specification, M 8.1), panel by panel.
 *
 * A panel is made orthonormal by Cholesky QR, X C^-1 with X^T X = C^T C, and what it spans is then taken out of all
 * later panels: modified Gram-Schmidt by blocks. Squaring the condition of a whole matrix would cost all digits;
 * this squares that of a panel only, and where even that is too much columns are made orthonormal one by one. No column
 * depends on a later one.
 */

#define REORTHOGONALIZE_BELOW 0x1p-14f /* of a column's squared length: if less is left of it, this is too much */
#define ORTHOGONAL_ENOUGH 0.25f      /* of one that had length 1: it is orthogonal to those before it */
#define MAX_PASSES 4         /* that a column is taken before it is replaced */

/* `rows` rows and some vectors side by side of X^T Y. */
INLINE void gram_tile(const int vectors, const int rows, const float *left, int64_t left_apart, const float *right,
                      int64_t right_apart, int64_t size, float *result, int64_t apart) {
    Vector sums[8][VECTORS];
    EACH(i, rows)
        EACH(v, vectors) sums[i][v] = zeros();
    for (int64_t r = 0; r < size; r++, left += left_apart, right += right_apart)
        EACH(i, rows) EACH(v, vectors) sums[i][v] = add_scaled(sums[i][v], left[i], load(right + v * WIDTH));
    EACH(i, rows)
        EACH(v, vectors) store(result + i * apart + v * WIDTH, sums[i][v]);
}

/* WIDTH rows of X^T Y from column `skip` of Y on; `left` is X from one of its columns on. */
INLINE void gram_rows(const float *left, int64_t left_apart, Panel y, int64_t skip, int64_t size, float *result) {
    const float *right = y.data + skip;
    int64_t apart = y.apart;
    result += skip;
#if SIDE == 1
    for (int64_t v = 0; v < apart - skip; v += WIDTH)
        for (int64_t k = 0; k < WIDTH; k += ROWS)
            gram_tile(1, ROWS, left + k, left_apart, right + v, apart, size, result + k * apart + v, apart);
#else
    int64_t vectors = (apart - skip) / WIDTH;
    for (int64_t k = 0; k < WIDTH; k += 8, left += 8, result += 8 * apart)
        switch (vectors) {
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
OFTEN static void gram(Panel x, int64_t rows, float *product) {
    for (int64_t i = 0; i < x.apart; i += WIDTH) gram_rows(x.data + i, x.apart, x, i, rows, product + i * x.apart);
}

/* Part of row j of a triangle, at `panel`, less what the rows before it take: the sum of column[k] times row k. */
INLINE void reduce_row(const int vectors, float *panel, int64_t apart, int64_t j, const float *column) {
    Vector row[VECTORS];
    EACH(v, vectors) row[v] = load(panel + j * apart + v * WIDTH);
    for (int64_t k = 0; k < j; k++)
        EACH(v, vectors) row[v] = add_scaled(row[v], -column[k * apart], load(panel + k * apart + v * WIDTH));
    EACH(v, vectors) store(panel + j * apart + v * WIDTH, row[v]);
}

/* Overwrite the first c rows of G = X^T X by the upper triangular C with G = C^T C, but for its diagonal, where it has
 * the inverse; nothing below the diagonal is used. Returns how many columns there are before one of which little is
 * left of the squared length that it had. */
OFTEN static int64_t factorize_gram(float *product, int64_t apart, int64_t c, const float *lengths) {
    for (int64_t j = 0; j < c; j++) {
        float *row = product + j * apart;
        int64_t skip = j / WIDTH;
        WITH_VECTORS(apart / WIDTH - skip, product + skip * WIDTH, reduce_row, apart, j, product + j);
        float squared = row[j];
        if (!(squared > REORTHOGONALIZE_BELOW * lengths[j] && squared < __builtin_inff())) return j;
        float scale = 1.0f / __builtin_sqrtf(squared);
        for (int64_t p = skip * WIDTH; p < apart; p += WIDTH) store(row + p, scaled(load(row + p), scale));
        row[j] = scale;
    }
    return c;
}

/* Part of row j of the inverse of a triangle of c rows whose pivot is 1 / scale; `row` is that of the triangle. */
INLINE void invert_row(const int vectors, float *inverse, int64_t apart, int64_t j, int64_t c, const float *row,
                       float scale) {
    Vector sums[VECTORS];
    EACH(v, vectors) sums[v] = zeros();
    for (int64_t k = j + 1; k < c; k++) {
        float share = -row[k] * scale;
        EACH(v, vectors) sums[v] = add_scaled(sums[v], share, load(inverse + k * apart + v * WIDTH));
    }
    EACH(v, vectors) store(inverse + j * apart + v * WIDTH, sums[v]);
}

/* Inverse of the first `good` rows of what `factorize_gram` leaves, and behind them the identity. */
OFTEN static void invert_triangle(const float *triangle, int64_t apart, int64_t good, float *inverse) {
    for (int64_t i = 0; i < apart * apart; i += WIDTH) store(inverse + i, zeros());
    for (int64_t j = good; j < apart; j++) inverse[j * apart + j] = 1.0f;
    for (int64_t j = good - 1; j >= 0; j--) {
        const float *row = triangle + j * apart;
        int64_t skip = j / WIDTH;
        WITH_VECTORS(apart / WIDTH - skip, inverse + skip * WIDTH, invert_row, apart, j, good, row, row[j]);
        inverse[j * apart + j] = row[j];
    }
}

/* Add to some rows of a result, from vector `from` on, the terms of `size` columns of X. */
INLINE void add_terms(const int vectors, const int from, Vector sums[ROWS][VECTORS], const float *left,
    int64_t left_apart, const float *t, int64_t t_apart, int64_t size) {
    for (int64_t k = 0; k < size; k++, t += t_apart)
        EACH(i, ROWS) EACH(v, vectors - from)
            sums[i][from + v] = add_scaled(sums[i][from + v], left[i * left_apart + k], load(t + (from + v) * WIDTH));
}

/* Some rows of X T, for vectors of T from `column` on; below the diagonal T is not looked at. */
INLINE void multiply_tile(const int vectors, int64_t column, const float *left, const float *t, int64_t apart,
                          float *result) {
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
OFTEN static void multiply(Panel x, int64_t rows, const float *t) {
    float some[ROWS * LANES];
    for (int64_t r = 0; r < rows; r += ROWS) {
        float *from = x.data + r * x.apart;
        for (int64_t i = 0; i < ROWS * x.apart; i += WIDTH) store(some + i, load(from + i));
        WITH_VECTORS(x.apart / WIDTH, 0, multiply_tile, some, t, x.apart, from);
    }
}

/* Some rows of Y less what X times `shares` says, for vectors of Y from `column` on; X is a whole panel. */
INLINE void take_tile(const int vectors, int64_t column, const float *left, const float *shares, int64_t apart,
                      float *rows) {
    Vector sums[ROWS][VECTORS];
    EACH(i, ROWS) EACH(v, vectors) sums[i][v] = load(rows + i * apart + column + v * WIDTH);
    add_terms(vectors, 0, sums, left, LANES, shares + column, apart, LANES);
    EACH(i, ROWS) EACH(v, vectors) store(rows + i * apart + column + v * WIDTH, sums[i][v]);
}

/* Take out of Y what X, orthonormal and a whole panel, spans: Y - X X^T Y. */
OFTEN static void take_out(Panel x, Panel y, int64_t rows, float *shares) {
    for (int64_t i = 0; i < LANES; i += WIDTH) gram_rows(x.data + i, LANES, y, 0, rows, shares + i * y.apart);
    for (int64_t i = 0; i < LANES * y.apart; i += WIDTH) store(shares + i, scaled(load(shares + i), -1.0));
    for (int64_t r = 0; r < rows; r += ROWS)
        WITH_VECTORS(y.apart / WIDTH, 0, take_tile, x.data + r * LANES, shares, y.apart, y.data + r * y.apart);
}

INLINE float square(const float *v, int64_t n) {
    float sum = 0.0f;
    for (int64_t r = 0; r < n; r++) sum += v[r] * v[r];
    return sum;
}

INLINE void scale_by(float *v, int64_t n, float scale) {
    for (int64_t r = 0; r < n; r++) v[r] *= scale;
}

/* Take out of v what the columns before column j span; `shares` has room for them in whole panels. */
static void take_out_all(Panels *panels, int64_t n, int64_t j, float *v, float *shares) {
    for (int64_t b = 0; b * LANES < j; b++) {
        Panel panel = panel_at(panels, b);
        float *sums = shares + panel.first;
        for (int64_t p = 0; p < panel.apart; p += WIDTH) store(sums + p, zeros());
        for (int64_t r = 0; r < n; r++)
            for (int64_t p = 0; p < panel.apart; p += WIDTH)
                store(sums + p, add_scaled(load(sums + p), v[r], load(panel.data + r * panel.apart + p)));
    }
    for (int64_t b = 0; b * LANES < j; b++) {
        Panel panel = panel_at(panels, b);
        int64_t count = least(panel.apart, j - panel.first);
        for (int64_t r = 0; r < n; r++)
            for (int64_t i = 0; i < count; i++) v[r] -= panel.data[r * panel.apart + i] * shares[panel.first + i];
    }
}

/* Squared lengths of the columns of all panels but the first: those are on the diagonal of its X^T X. */
static void measure(Panels *panels, float *lengths) {
    for (int64_t b = 1; b < panel_count(panels); b++) {
        Panel panel = panel_at(panels, b);
        float *sums = lengths + panel.first;
        for (int64_t p = 0; p < panel.apart; p += WIDTH) store(sums + p, zeros());
        for (int64_t r = 0; r < panels->rows; r++)
            for (int64_t p = 0; p < panel.apart; p += WIDTH) {
                Vector row = load(panel.data + r * panel.apart + p);
                EACH(i, PARTS) row.part[i] *= row.part[i];
                store(sums + p, sum_of(load(sums + p), row));
            }
    }
}

/* Overwrite a column by zeros unless its squares have a sum: it is replaced, but nothing must reach the others. */
static void clear_infinite(Panel panel, int64_t rows, int64_t j) {
    float sum = 0.0f;
    for (int64_t r = 0; r < rows; r++) sum += panel.data[r * panel.apart + j] * panel.data[r * panel.apart + j];
    if (sum < __builtin_inff()) return;
    for (int64_t r = 0; r < rows; r++) panel.data[r * panel.apart + j] = 0.0f;
}

/* Make column j of length one and orthogonal to those before it; `scratch` has room for n numbers, and for all
 * columns. Whether that could be done. */
static bool clean_column(Panels *panels, int64_t n, int64_t j, const uint32_t *order, float *scratch) {
    Panel panel = panel_at(panels, j / LANES);
    float *v = scratch, *shares = scratch + n, *column = panel.data + (j - panel.first);
    for (int64_t r = 0; r < n; r++) v[r] = column[r * panel.apart];
    for (int pass = 0; pass < 2 * MAX_PASSES; pass++) {
        float length = square(v, n);
        bool some = length > 0.0f && length < __builtin_inff();
        if (pass == MAX_PASSES || (pass < MAX_PASSES && !some)) {
            for (int64_t r = 0; r < n; r++) v[r] = (float)hash_at(order[r], j);
            length = square(v, n);
            pass = MAX_PASSES;
        } else if (!some)
            return false;
        scale_by(v, n, 1.0f / __builtin_sqrtf(length));
        take_out_all(panels, n, j, v, shares);
        length = square(v, n);
        if (!(length > ORTHOGONAL_ENOUGH)) continue;
        scale_by(v, n, 1.0f / __builtin_sqrtf(length));
        for (int64_t r = 0; r < n; r++) column[r * panel.apart] = v[r];
        return true;
    }
    return false;
}

/* What `iterate` returns: U is there; more columns have to be made orthonormal one by one; they cannot be. */

/* Overwrites X, of n rows in some order and c columns, by Onorm(X); takes those that are made orthonormal one by one
 * from `care`. */
static int64_t onorm(Panels *panels, int64_t n, int64_t c, int64_t *care, const uint32_t *order, float *scratch) {
    float *triangle = scratch, *other = triangle + LANES * LANES, *lengths = other + LANES * LANES;
    float *rest = lengths + panels->columns;
    int64_t count = panel_count(panels), rows = panels->rows;
    measure(panels, lengths);
    for (int64_t b = 0; b < count; b++) {
        Panel panel = panel_at(panels, b);
        int64_t own = least(panel.apart, c - panel.first);
        gram(panel, rows, triangle);
        for (int64_t j = 0; b == 0 && j < own; j++) lengths[j] = triangle[j * panel.apart + j];
        int64_t good = factorize_gram(triangle, panel.apart, own, lengths + panel.first);
        if ((*care -= own - good) < 0) return NEEDS_CARE;
        for (int64_t j = good; j < own; j++) clear_infinite(panel, rows, j);
        invert_triangle(triangle, panel.apart, good, other);
        multiply(panel, rows, other);
        for (int64_t j = good; j < own; j++)
            if (!clean_column(panels, n, panel.first + j, order, rest)) return LOST;
        for (int64_t later = b + 1; later < count; later++) take_out(panel, panel_at(panels, later), rows, triangle);
    }
    return DONE;
}

INLINE Panels panels_of(int64_t n, int64_t c, float *memory) {
    return (Panels){memory, padded_rows(n), whole_vectors(c)};
}

/* Numbers of scratch that a matrix of n rows and c columns takes: itself, two matrices of a panel's columns, a column,
 * and two numbers for each. */
int64_t ISA(iteration_space)(int64_t n, int64_t c) {
    Panels panels = panels_of(n, c, 0);
    return panels_size(&panels) + 2 * LANES * LANES + n + 2 * panels.columns + LINE - 1;
}

/* A number of solutions with a factor of `factorize_fronts`, Onorm after each and once more, of as many of the columns
 * of `start` as `subspace` has; at most `care` columns are made orthonormal one by one. */
int64_t ISA(iterate)(Fronts fronts, Singles values, ConstSingles inverse, ConstSingles2 start, int64_t solutions,
                       int64_t care, Singles scratch, Singles2 subspace) {
    int64_t n = start.rows, c = subspace.columns, found = DONE;
    if (subspace.rows != n || c > start.columns || c < 1 || scratch.size < ISA(iteration_space)(n, c) ||
        !fits_factor(&fronts, n, values, inverse))
        return MISUSED;
    float *memory = aligned(scratch.data);
    Panels panels = panels_of(n, c, memory);
    const uint32_t *order = fronts.rows.data;
    pack(start, c, order, panels);
    for (int64_t k = 0; k <= solutions && found == DONE; k++) {
        if (k < solutions) ISA(substitute)(fronts, aligned(values.data), inverse.data, panels);
        found = onorm(&panels, n, c, &care, order, memory + panels_size(&panels));
    }
    unpack(panels, order, subspace);
    return found;
}
