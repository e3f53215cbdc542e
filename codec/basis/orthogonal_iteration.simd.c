/* Orthogonal iterations, U(t) = Onorm(R^z U(t-1)) (paper, Algorithm 1; specification, M 8.4, M 8.9). */
#include "codec/basis/vectors.h"
#include "codec/basis/onorm.h"

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

INLINE Panels panels_of(int64_t n, int64_t c, float *memory) {
    return (Panels){memory, padded_rows(n), whole_vectors(c)};
}

/* Numbers of scratch that a matrix of n rows and c columns takes: itself, two matrices of a panel's columns, a column,
 * and two numbers for each; and where Onorm follows `apart` solutions, room for it in doubles. */
int64_t ISA(iteration_space)(int64_t n, int64_t c, int64_t apart) {
    Panels panels = panels_of(n, c, 0);
    int64_t more = apart > 0 ? 2 * ISA(doubles_space)(n, c) + LINE : 0;
    return panels_size(&panels) + 2 * LANES * LANES + n + 2 * panels.columns + LINE - 1 + more;
}

/* Iterations of `power` solutions each with a factor of `factorize_fronts`, of as many of the columns of `start` as
 * `subspace` has. Onorm follows each solution, and once more the last; or, in doubles, each `apart` of them and the
 * last of an iteration. At most `care` columns are made orthonormal one by one. */
int64_t ISA(iterate)(Fronts fronts, Singles values, ConstSingles inverse, ConstSingles2 start, int64_t power,
                       int64_t iterations, int64_t apart, int64_t care, Singles scratch, Singles2 subspace) {
    int64_t n = start.rows, c = subspace.columns, found = DONE;
    float *memory = aligned(scratch.data);
    Panels panels = panels_of(n, c, memory);
    const uint32_t *order = fronts.rows.data;
    pack(start, c, order, panels);
    memory = aligned(memory + panels_size(&panels));
    for (int64_t t = 0; t < iterations; t++)
        for (int64_t k = 1; k <= power && found == DONE; k++) {
            ISA(substitute)(fronts, aligned(values.data), inverse.data, panels);
            if (apart == 0)
                found = onorm(&panels, n, c, &care, order, memory);
            else if (k % apart == 0 || k == power)
                found = ISA(onorm_in_doubles)(panels.data, panels.rows, panels.columns, n, c, &care, order, memory);
        }
    if (apart == 0 && found == DONE) found = onorm(&panels, n, c, &care, order, memory);
    unpack(panels, order, subspace);
    return found;
}
