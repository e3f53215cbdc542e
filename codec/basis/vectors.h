/* Vector registers: eight doubles, a cache line, as one value.
 *
 * Every lane is computed by itself and in the order that is written, so the result is the same to the last bit whatever
 * the processor's registers hold. Where the processor cannot fuse a product and a sum, the C library's fma does it;
 * WebAssembly has neither, and rounds twice: there the last bits differ, far within the tolerance of the specification.
 */
#ifndef BSM_VECTORS_H
#define BSM_VECTORS_H

#include "codec/basis/basis.h"

#if defined(__wasm__)
#define FUSED(a, b, c) ((a) * (b) + (c))
#else
#define FUSED(a, b, c) __builtin_fma(a, b, c)
#endif

#define WIDTH 8   /* doubles of a vector: a cache line */
#define VECTORS 4 /* vectors of a panel */
#define LANES (WIDTH * VECTORS)

/* Doubles that a register holds, and how many vectors side by side have room in registers for several rows of them. */
#if defined(__AVX512F__)
#define REGISTER 8
#define SIDE VECTORS
#elif defined(__AVX__)
#define REGISTER 4
#define SIDE 1
#else
#define REGISTER 2
#define SIDE 1
#endif
#define PARTS (WIDTH / REGISTER)
/* Rows of one vector that are summed side by side: eight registers, so that as many are left for what is added. */
#define ROWS (REGISTER == 2 ? 2 : 4)

typedef double Part __attribute__((vector_size(8 * REGISTER)));
typedef double UnalignedPart __attribute__((vector_size(8 * REGISTER), aligned(8), may_alias));
typedef struct {
    Part part[PARTS];
} Vector;

/* A loop over the registers of a tile, written out by the compiler; without it they would be memory. */
#define EACH(i, size) _Pragma("GCC unroll 8") for (int i = 0; i < (size); i++)

/* Parts are made as wholes, never lane by lane inside a structure, which would keep them in memory. */
INLINE Part spread(double value) {
    Part part = {0.0};
    EACH(i, REGISTER) part[i] = value;
    return part;
}

INLINE Part add_scaled_part(Part sum, double scalar, Part other) {
    EACH(i, REGISTER) sum[i] = FUSED(scalar, other[i], sum[i]);
    return sum;
}

INLINE Vector load(const double *from) {
    Vector vector;
    EACH(i, PARTS) vector.part[i] = *(const UnalignedPart *)(from + i * REGISTER);
    return vector;
}

INLINE void store(double *to, Vector vector) { EACH(i, PARTS) *(UnalignedPart *)(to + i * REGISTER) = vector.part[i]; }

INLINE Vector zeros(void) {
    Vector vector;
    EACH(i, PARTS) vector.part[i] = spread(0.0);
    return vector;
}

INLINE Vector sum_of(Vector a, Vector b) {
    EACH(i, PARTS) a.part[i] += b.part[i];
    return a;
}

INLINE Vector scaled(Vector vector, double scalar) {
    EACH(i, PARTS) vector.part[i] *= scalar;
    return vector;
}

/* sum + scalar * other, rounded once. */
INLINE Vector add_scaled(Vector sum, double scalar, Vector other) {
    EACH(i, PARTS) sum.part[i] = add_scaled_part(sum.part[i], scalar, other.part[i]);
    return sum;
}

INLINE Vector squared(Vector vector) {
    EACH(i, PARTS) vector.part[i] *= vector.part[i];
    return vector;
}

/* The first cache line that begins in an array: arrays come with room for WIDTH - 1 more doubles than are used. */
INLINE double *aligned(double *array) {
    return (double *)(((uintptr_t)array + (8 * WIDTH - 1)) / (8 * WIDTH) * (8 * WIDTH));
}

INLINE int64_t whole_vectors(int64_t doubles) { return (doubles + WIDTH - 1) / WIDTH * WIDTH; }

/* Call `function(vectors, column, ...)` for vectors side by side from `column` on, as many at a time as registers hold,
 * compiled for each number of them. */
#if SIDE == 1
#define WITH_VECTORS(vectors, column, function, ...)                                                                   \
    do {                                                                                                               \
        for (int64_t v_ = 0; v_ < (vectors); v_++) function(1, (column) + v_ * WIDTH, __VA_ARGS__);                    \
    } while (0)
#else
#define WITH_VECTORS(vectors, column, function, ...)                                                                   \
    do {                                                                                                               \
        switch (vectors) {                                                                                             \
            case 1: function(1, column, __VA_ARGS__); break;                                                           \
            case 2: function(2, column, __VA_ARGS__); break;                                                           \
            case 3: function(3, column, __VA_ARGS__); break;                                                           \
            default: function(VECTORS, column, __VA_ARGS__);                                                           \
        }                                                                                                              \
    } while (0)
#endif

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

/* Rows of panels for n rows: a multiple of four, and one at least beyond the last. */
INLINE int64_t padded_rows(int64_t n) { return (n / 4 + 1) * 4; }

INLINE int64_t panels_size(const Panels *panels) { return panels->rows * panels->columns; }

void LEVEL(pack)(ConstDoubles2 columns, int64_t count, const uint32_t *order, Panels panels);
void LEVEL(unpack)(Panels panels, const uint32_t *order, Doubles2 columns);

/* Front t: its own steps, its border, its matrix, and how far the rows of that are apart. */
typedef struct {
    int64_t first, own, edge, width, place, apart;
} Front;

INLINE Front front_at(const Fronts *fronts, int64_t t) {
    Front front;
    front.first = fronts->firsts.data[t];
    front.own = fronts->firsts.data[t + 1] - front.first;
    front.edge = fronts->starts.data[t];
    front.width = front.own + fronts->starts.data[t + 1] - front.edge;
    front.place = fronts->places.data[t];
    front.apart = whole_vectors(front.width);
    return front;
}

/* Doubles of scratch that it takes: two matrices of a panel's columns, and the length of every column. */
INLINE int64_t qr_size(const Panels *panels) { return 2 * LANES * LANES + panels->columns; }

double LEVEL(cholesky_qr)(Panels *panels, int64_t c, double once, double *scratch);

void LEVEL(substitute)(Fronts fronts, const double *matrices, const double *inverse, Panels panels, int64_t power);

#endif
