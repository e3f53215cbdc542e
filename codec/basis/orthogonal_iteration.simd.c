/* Orthogonal iterations, U(t) = Onorm(R^z U(t-1)) (paper, Algorithm 1; specification, M 8.4). */
#include "codec/basis/orthogonal_iteration.h"

#include "codec/basis/solver/cholesky_qr.h"
#include "codec/basis/solver/substitution.h"

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
