/* Onorm (specification, M 8.1, M 8.9), panel by panel; the file that includes it says of which numbers vectors are.
 *
 * A panel is made orthonormal by Cholesky QR, X C^-1 with X^T X = C^T C, and what it spans is then taken out of all
 * later panels: modified Gram-Schmidt by blocks. Squaring the condition of a whole matrix would cost all digits;
 * this squares that of a panel only, and where even that is too much columns are made orthonormal one by one. No column
 * depends on a later one.
 */

/* Of a column's squared length: if less is left of it, this is too much. */
#ifdef VECTORS_OF_DOUBLES
#define REORTHOGONALIZE_BELOW 0x1p-36
#define SQUARE_ROOT __builtin_sqrt
#else
#define REORTHOGONALIZE_BELOW 0x1p-14f
#define SQUARE_ROOT __builtin_sqrtf
#endif
#define INFINITE ((Real)__builtin_inff())
#define ORTHOGONAL_ENOUGH ((Real)0.25) /* of one that had length 1: it is orthogonal to those before it */
#define MAX_PASSES 4                   /* that a column is taken before it is replaced */

/* `rows` rows and some vectors side by side of X^T Y. */
INLINE void gram_tile(const int vectors, const int rows, const Real *left, int64_t left_apart, const Real *right,
                      int64_t right_apart, int64_t size, Real *result, int64_t apart) {
    Vector sums[8][VECTORS];
    EACH(i, rows)
        EACH(v, vectors) sums[i][v] = zeros();
    for (int64_t r = 0; r < size; r++, left += left_apart, right += right_apart)
        EACH(i, rows) EACH(v, vectors) sums[i][v] = add_scaled(sums[i][v], left[i], load(right + v * WIDTH));
    EACH(i, rows)
        EACH(v, vectors) store(result + i * apart + v * WIDTH, sums[i][v]);
}

/* WIDTH rows of X^T Y from column `skip` of Y on; `left` is X from one of its columns on. */
INLINE void gram_rows(const Real *left, int64_t left_apart, Panel y, int64_t skip, int64_t size, Real *result) {
    const Real *right = y.data + skip;
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
OFTEN static void gram(Panel x, int64_t rows, Real *product) {
    for (int64_t i = 0; i < x.apart; i += WIDTH) gram_rows(x.data + i, x.apart, x, i, rows, product + i * x.apart);
}

/* Part of row j of a triangle, at `panel`, less what the rows before it take: the sum of column[k] times row k. */
INLINE void reduce_row(const int vectors, Real *panel, int64_t apart, int64_t j, const Real *column) {
    Vector row[VECTORS];
    EACH(v, vectors) row[v] = load(panel + j * apart + v * WIDTH);
    for (int64_t k = 0; k < j; k++)
        EACH(v, vectors) row[v] = add_scaled(row[v], -column[k * apart], load(panel + k * apart + v * WIDTH));
    EACH(v, vectors) store(panel + j * apart + v * WIDTH, row[v]);
}

/* Overwrite the first c rows of G = X^T X by the upper triangular C with G = C^T C, but for its diagonal, where it has
 * the inverse; nothing below the diagonal is used. Returns how many columns there are before one of which little is
 * left of the squared length that it had. */
OFTEN static int64_t factorize_gram(Real *product, int64_t apart, int64_t c, const Real *lengths) {
    for (int64_t j = 0; j < c; j++) {
        Real *row = product + j * apart;
        int64_t skip = j / WIDTH;
        WITH_VECTORS(apart / WIDTH - skip, product + skip * WIDTH, reduce_row, apart, j, product + j);
        Real squared = row[j];
        if (!(squared > REORTHOGONALIZE_BELOW * lengths[j] && squared < INFINITE)) return j;
        Real scale = (Real)1 / SQUARE_ROOT(squared);
        for (int64_t p = skip * WIDTH; p < apart; p += WIDTH) store(row + p, scaled(load(row + p), scale));
        row[j] = scale;
    }
    return c;
}

/* Part of row j of the inverse of a triangle of c rows whose pivot is 1 / scale; `row` is that of the triangle. */
INLINE void invert_row(const int vectors, Real *inverse, int64_t apart, int64_t j, int64_t c, const Real *row,
                       Real scale) {
    Vector sums[VECTORS];
    EACH(v, vectors) sums[v] = zeros();
    for (int64_t k = j + 1; k < c; k++) {
        Real share = -row[k] * scale;
        EACH(v, vectors) sums[v] = add_scaled(sums[v], share, load(inverse + k * apart + v * WIDTH));
    }
    EACH(v, vectors) store(inverse + j * apart + v * WIDTH, sums[v]);
}

/* Inverse of the first `good` rows of what `factorize_gram` leaves, and behind them the identity. */
OFTEN static void invert_triangle(const Real *triangle, int64_t apart, int64_t good, Real *inverse) {
    for (int64_t i = 0; i < apart * apart; i += WIDTH) store(inverse + i, zeros());
    for (int64_t j = good; j < apart; j++) inverse[j * apart + j] = (Real)1;
    for (int64_t j = good - 1; j >= 0; j--) {
        const Real *row = triangle + j * apart;
        int64_t skip = j / WIDTH;
        WITH_VECTORS(apart / WIDTH - skip, inverse + skip * WIDTH, invert_row, apart, j, good, row, row[j]);
        inverse[j * apart + j] = row[j];
    }
}

/* Add to some rows of a result, from vector `from` on, the terms of `size` columns of X. */
INLINE void add_terms(const int vectors, const int from, Vector sums[ROWS][VECTORS], const Real *left,
    int64_t left_apart, const Real *t, int64_t t_apart, int64_t size) {
    for (int64_t k = 0; k < size; k++, t += t_apart)
        EACH(i, ROWS) EACH(v, vectors - from)
            sums[i][from + v] = add_scaled(sums[i][from + v], left[i * left_apart + k], load(t + (from + v) * WIDTH));
}

/* Some rows of X T, for vectors of T from `column` on; below the diagonal T is not looked at. */
INLINE void multiply_tile(const int vectors, int64_t column, const Real *left, const Real *t, int64_t apart,
                          Real *result) {
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
OFTEN static void multiply(Panel x, int64_t rows, const Real *t) {
    Real some[ROWS * LANES];
    for (int64_t r = 0; r < rows; r += ROWS) {
        Real *from = x.data + r * x.apart;
        for (int64_t i = 0; i < ROWS * x.apart; i += WIDTH) store(some + i, load(from + i));
        WITH_VECTORS(x.apart / WIDTH, 0, multiply_tile, some, t, x.apart, from);
    }
}

/* Some rows of Y less what X times `shares` says, for vectors of Y from `column` on; X is a whole panel. */
INLINE void take_tile(const int vectors, int64_t column, const Real *left, const Real *shares, int64_t apart,
                      Real *rows) {
    Vector sums[ROWS][VECTORS];
    EACH(i, ROWS) EACH(v, vectors) sums[i][v] = load(rows + i * apart + column + v * WIDTH);
    add_terms(vectors, 0, sums, left, LANES, shares + column, apart, LANES);
    EACH(i, ROWS) EACH(v, vectors) store(rows + i * apart + column + v * WIDTH, sums[i][v]);
}

/* Take out of Y what X, orthonormal and a whole panel, spans: Y - X X^T Y. */
OFTEN static void take_out(Panel x, Panel y, int64_t rows, Real *shares) {
    for (int64_t i = 0; i < LANES; i += WIDTH) gram_rows(x.data + i, LANES, y, 0, rows, shares + i * y.apart);
    for (int64_t i = 0; i < LANES * y.apart; i += WIDTH) store(shares + i, scaled(load(shares + i), -1));
    for (int64_t r = 0; r < rows; r += ROWS)
        WITH_VECTORS(y.apart / WIDTH, 0, take_tile, x.data + r * LANES, shares, y.apart, y.data + r * y.apart);
}

INLINE Real square(const Real *v, int64_t n) {
    Real sum = 0;
    for (int64_t r = 0; r < n; r++) sum += v[r] * v[r];
    return sum;
}

INLINE void scale_by(Real *v, int64_t n, Real scale) {
    for (int64_t r = 0; r < n; r++) v[r] *= scale;
}

/* Take out of v what the columns before column j span; `shares` has room for them in whole panels. */
static void take_out_all(Panels *panels, int64_t n, int64_t j, Real *v, Real *shares) {
    for (int64_t b = 0; b * LANES < j; b++) {
        Panel panel = panel_at(panels, b);
        Real *sums = shares + panel.first;
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
static void measure(Panels *panels, Real *lengths) {
    for (int64_t b = 1; b < panel_count(panels); b++) {
        Panel panel = panel_at(panels, b);
        Real *sums = lengths + panel.first;
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
    Real sum = 0;
    for (int64_t r = 0; r < rows; r++) sum += panel.data[r * panel.apart + j] * panel.data[r * panel.apart + j];
    if (sum < INFINITE) return;
    for (int64_t r = 0; r < rows; r++) panel.data[r * panel.apart + j] = 0;
}

/* Make column j of length one and orthogonal to those before it; `scratch` has room for n numbers, and for all
 * columns. Whether that could be done. */
static bool clean_column(Panels *panels, int64_t n, int64_t j, const uint32_t *order, Real *scratch) {
    Panel panel = panel_at(panels, j / LANES);
    Real *v = scratch, *shares = scratch + n, *column = panel.data + (j - panel.first);
    for (int64_t r = 0; r < n; r++) v[r] = column[r * panel.apart];
    for (int pass = 0; pass < 2 * MAX_PASSES; pass++) {
        Real length = square(v, n);
        bool some = length > 0 && length < INFINITE;
        if (pass == MAX_PASSES || (pass < MAX_PASSES && !some)) {
            for (int64_t r = 0; r < n; r++) v[r] = (Real)(float)hash_at(order[r], j);
            length = square(v, n);
            pass = MAX_PASSES;
        } else if (!some)
            return false;
        scale_by(v, n, (Real)1 / SQUARE_ROOT(length));
        take_out_all(panels, n, j, v, shares);
        length = square(v, n);
        if (!(length > ORTHOGONAL_ENOUGH)) continue;
        scale_by(v, n, (Real)1 / SQUARE_ROOT(length));
        for (int64_t r = 0; r < n; r++) column[r * panel.apart] = v[r];
        return true;
    }
    return false;
}

/* What `iterate` returns: U is there; more columns have to be made orthonormal one by one; they cannot be. */

/* Overwrites X, of n rows in some order and c columns, by Onorm(X); takes those that are made orthonormal one by one
 * from `care`. */
static int64_t onorm(Panels *panels, int64_t n, int64_t c, int64_t *care, const uint32_t *order, Real *scratch) {
    Real *triangle = scratch, *other = triangle + LANES * LANES, *lengths = other + LANES * LANES;
    Real *rest = lengths + panels->columns;
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
