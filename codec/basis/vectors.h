/* Vector registers: some floats as one value, or doubles where VECTORS_OF_DOUBLES is defined.
 *
 * Every lane is computed by itself and in the order that is written, each operation rounded as IEEE 754 has it
 * (bitstream/kernel.h), so the result is the same to the last bit whatever the processor's registers hold.
 */
#ifndef BSM_VECTORS_H
#define BSM_VECTORS_H

#include "codec/basis/basis.h"

#ifdef VECTORS_OF_DOUBLES
typedef double Real;
#define REAL_BYTES 8
#else
typedef float Real;
#define REAL_BYTES 4
#endif

#define LINE (64 / REAL_BYTES) /* numbers of a cache line */
#define LANES (4 * LINE)       /* columns of a panel */

/* Numbers that a register and a vector hold, how many vectors side by side have room in registers for several rows of
 * them, and rows of one vector that are summed side by side: eight registers, so that as many are left for what is
 * added. Where registers are short, so are vectors: fewer lanes are beyond the last column. */
#if defined(__AVX512F__) || KERNEL_ISA == 4
#define REGISTER LINE
#define WIDTH LINE
#define SIDE VECTORS
#define ROWS 4
#elif defined(__AVX__) || KERNEL_ISA == 3
#define REGISTER (32 / REAL_BYTES)
#define WIDTH LINE
#define SIDE 1
#define ROWS 4
#elif defined(__ARM_NEON) && !defined(__aarch64__) /* registers that flush subnormal numbers */
#define REGISTER 1
#define WIDTH 8
#define SIDE 1
#define ROWS 1
#else
#define REGISTER (16 / REAL_BYTES)
#define WIDTH 8
#define SIDE 1
#define ROWS (8 * REGISTER / WIDTH)
#endif
#define VECTORS (LANES / WIDTH) /* of a panel */
#define PARTS (WIDTH / REGISTER)

typedef __attribute__((vector_size(REAL_BYTES * REGISTER))) Real Part;
typedef __attribute__((vector_size(REAL_BYTES * REGISTER), __aligned__(REAL_BYTES), may_alias)) Real UnalignedPart;
typedef struct {
    Part part[PARTS];
} Vector;

/* A loop over the registers of a tile, written out by the compiler; without it they would be memory. */
#if defined(__clang__)
#define EACH(i, size) _Pragma("clang loop unroll(full)") for (int i = 0; i < (size); i++)
#else
#define EACH(i, size) _Pragma("GCC unroll 16") for (int i = 0; i < (size); i++)
#endif

/* Parts are made as wholes, never lane by lane inside a structure, which would keep them in memory. */
INLINE Part spread(Real value) {
    Part part = {0};
    EACH(i, REGISTER) part[i] = value;
    return part;
}

INLINE Vector load(const Real *from) {
    Vector vector;
    EACH(i, PARTS) vector.part[i] = *(const UnalignedPart *)(from + i * REGISTER);
    return vector;
}

INLINE void store(Real *to, Vector vector) { EACH(i, PARTS) *(UnalignedPart *)(to + i * REGISTER) = vector.part[i]; }

INLINE Vector zeros(void) {
    Vector vector;
    EACH(i, PARTS) vector.part[i] = spread(0);
    return vector;
}

INLINE Vector sum_of(Vector a, Vector b) {
    EACH(i, PARTS) a.part[i] += b.part[i];
    return a;
}

INLINE Vector scaled(Vector vector, Real scalar) {
    EACH(i, PARTS) vector.part[i] *= scalar;
    return vector;
}

/* sum + scalar * other, both rounded. */
INLINE Vector add_scaled(Vector sum, Real scalar, Vector other) {
    EACH(i, PARTS) sum.part[i] += scalar * other.part[i];
    return sum;
}

/* The first cache line that begins in an array: arrays come with room for LINE - 1 more numbers than are used. */
INLINE Real *aligned(Real *array) { return (Real *)(((uintptr_t)array + 63) / 64 * 64); }

INLINE int64_t whole_vectors(int64_t numbers) { return (numbers + WIDTH - 1) / WIDTH * WIDTH; }
INLINE int64_t whole_lines(int64_t numbers) { return (numbers + LINE - 1) / LINE * LINE; }

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
    Real *data;
    int64_t rows, columns; /* columns of all panels, a multiple of WIDTH */
} Panels;

typedef struct {
    Real *data;
    int64_t first, apart; /* first column, and numbers from one row to the next: its columns */
} Panel;

INLINE int64_t panel_count(const Panels *panels) { return (panels->columns + LANES - 1) / LANES; }

INLINE Panel panel_at(const Panels *panels, int64_t b) {
    return (Panel){panels->data + b * panels->rows * LANES, b * LANES, least(LANES, panels->columns - b * LANES)};
}

/* Rows of panels for n rows: a multiple of four, and one at least beyond the last. */
INLINE int64_t padded_rows(int64_t n) { return (n / 4 + 1) * 4; }

INLINE int64_t panels_size(const Panels *panels) { return panels->rows * panels->columns; }

/* Front t: its own steps, its border, its matrix, and the distance of the rows of this matrix. */
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
    front.apart = whole_lines(front.width);
    return front;
}

#ifndef VECTORS_OF_DOUBLES
void ISA(substitute)(Fronts fronts, const float *matrices, const float *inverse, Panels panels);
#endif

#endif
