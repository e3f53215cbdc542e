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

/* Orthogonal iterations with a factor of `factorize_fronts`. The last pass of Cholesky QR is followed by another if its
 * columns are less independent than `once`; before, only their spans matter. Returns the least independence of all first
 * passes that is less than that, or 1. */
double LEVEL(iterate)(Fronts fronts, Doubles values, ConstDoubles inverse, ConstDoubles2 start, int64_t power, int64_t iterations,
               double once, Doubles scratch, Doubles2 subspace) {
    int64_t c = start.columns;
    double *memory = aligned(scratch.data), least_seen = 1.0;
    Panels panels = panels_of(start.rows, c, memory);
    QrSpace space = qr_space(&panels, memory + panels_size(&panels));
    LEVEL(pack)(start, fronts.rows.data, panels);
    for (; iterations > 0; iterations--) {
        LEVEL(substitute)(fronts, aligned(values.data), inverse.data, panels, power);
        double independence = LEVEL(cholesky_qr)(&panels, c, &space);
        if (independence < once) {
            if (independence < least_seen) least_seen = independence;
            if (iterations == 1) LEVEL(cholesky_qr)(&panels, c, &space);
        }
    }
    LEVEL(unpack)(panels, fronts.rows.data, subspace);
    return least_seen;
}

/* Onorm of `columns` alone, by one or two passes; returns how independent they are. */
double LEVEL(cholesky_onorm)(ConstDoubles2 columns, double once, Doubles scratch, Doubles2 subspace) {
    double *memory = aligned(scratch.data);
    Panels panels = panels_of(columns.rows, columns.columns, memory);
    QrSpace space = qr_space(&panels, memory + panels_size(&panels));
    LEVEL(pack)(columns, 0, panels);
    double independence = LEVEL(cholesky_qr)(&panels, columns.columns, &space);
    if (independence < once && independence > 0.0) LEVEL(cholesky_qr)(&panels, columns.columns, &space);
    LEVEL(unpack)(panels, 0, subspace);
    return independence;
}
