/* The graph of a mesh, its blocks, and their dictionaries (specification, M 2 to M 8). */
#pragma once

#include "bitstream/container/container.h"
#include "bitstream/costs.h"
#include "codec/basis/basis.h"

/* The graph of a mesh, its blocks and their patches (specification, M 2 to M 6). */
typedef struct {
    int64_t size;
    ConstInts offsets, neighbors;
} Graph;

/* All blocks of a mesh, in the order of their chain. */
typedef struct {
    int64_t count;
    Ints cores;      /* vertices of the part that each grew from: the first of its members */
    Longs starts, edges;
    Ints members;
} Blocks;

/* One block, or the part of one: its vertices row after row, and L among them. */
typedef struct {
    int64_t size;
    ConstInts vertices, offsets, neighbors;
    ConstDoubles weights; /* of the entries of `neighbors`; empty: all are 1 */
    Doubles diagonal;
    Fronts fronts;
} Patch;

bool make_graph(Ints2 faces, int64_t size, Arena *arena, Arena *scratch, Graph *graph);
/* The part of each vertex that follows from the graph alone (M 4). */
bool derive_labels(Context *context, const Graph *graph, int64_t parts, Arena *scratch, Ints labels);
/* `labels`: the part of each vertex, or no array for what follows from the graph. */
bool make_blocks(Context *context, const Header *header, const Graph *graph, Ints labels, Arena *arena, Arena *scratch,
    Blocks *blocks);
/* Cells of a mesh: the cell of each vertex, their graph and their faces (M 18). */
typedef struct {
    ConstInts own;
    Graph graph;
    Ints2 faces;
} CellMesh;

/* As many cells as the base says (0: any number), or the context fails. */
bool make_cells(Context *context, const Coarse *base, const Graph *graph, ConstInts2 faces, Arena *arena,
    Arena *scratch, CellMesh *cells);
/* Order the rows of a block of these vertices (M 6), and find what its factorization needs. */
bool order_patch(const Graph *graph, ConstInts members, Arena *arena, Patch *patch);
bool find_patch_fronts(Context *context, Arena *arena, Patch *patch);
/* Members of a block, or the `count` first of them. */
INLINE ConstInts members_of(const Blocks *blocks, int64_t index, int64_t count) {
    return (ConstInts){blocks->members.data + blocks->starts.data[index], count};
}
INLINE int64_t size_of_block(const Blocks *blocks, int64_t index) {
    return blocks->starts.data[index + 1] - blocks->starts.data[index];
}

/* What dictionaries cost, as bitstream/costs.h has it of all else (specification, M 14.2, M 14.3). */

/* Columns count as they are computed, in vectors of sixteen. */
INLINE double whole_columns(int64_t columns) { return (double)((columns + 15) / 16 * 16); }
INLINE double solve_work(const Fronts *fronts, int64_t columns) {
    return 50 + fronts->sums.data[0] * (0.3 * (double)((columns + 63) / 64) + 0.02 * whole_columns(columns));
}
INLINE double factor_work(const Fronts *fronts) {
    return fronts->sums.data[1] / 6 + 50.0 * (double)fronts->rows.size + 4000;
}
INLINE double onorm_work(double rows, int64_t columns) {
    double c = whole_columns(columns);
    return rows * (3 + 0.4 * c + c * c / 80) + 3000;
}
static const double IN_DOUBLES = 2; /* Onorm, over that in single precision */
INLINE double dictionary_work(const Fronts *fronts, int64_t columns, double solutions, double onorms, double care) {
    double rows = (double)fronts->rows.size;
    double rounds = solutions * solve_work(fronts, columns) + onorms * onorm_work(rows, columns);
    return 5 * rows * whole_columns(columns) + rounds + 6 * rows * (double)columns * care;
}
INLINE double completion_work(double rows, double first, double columns) {
    double more = above_zero(columns - first);
    return (first * first * first / 3 + more * first * (first + rows)) / 15 + 2 * rows * columns + 1500;
}
INLINE double ground_work(const Fronts *fronts, int64_t columns) {
    return factor_work(fronts) + solve_work(fronts, 3) + 1.5 * (double)fronts->rows.size * (double)columns;
}
INLINE double patch_memory(const Fronts *fronts, int64_t columns) {
    double rows = (double)fronts->rows.size, c = whole_columns(columns),
           size = fronts->places.data[fronts->places.size - 1];
    return 8 * (6 * rows * c + 2 * c * c + size) + 500 * rows;
}

/* Dictionaries of patches: U, by orthogonal iterations (specification, M 8). */

/* C and D^-1 of L + diagonal. */
typedef struct {
    Singles values, inverse;
} Factor;

/* Compute U of a patch that follows none (M 8.3 to M 8.5), as many columns as `dictionary` has; `held` is the factor of
 * L + springs + shift, or NULL. */
bool key_dictionary(Context *context, const Header *header, const Patch *patch, ConstDoubles springs,
    const Factor *held, Arena *scratch, Singles2 dictionary);
/* U of a patch whose predecessor has as many rows, and the dictionary `previous`. */
bool following_dictionary(Context *context, const Header *header, const Patch *patch, const Factor *factor,
    Singles2 previous, Arena *scratch, Singles2 dictionary);
/* How a dictionary is iterated: z, t, at most how many columns that gives, and solutions before each Onorm in doubles
 * (M 8.4, M 8.7, M 8.9). */
typedef struct {
    int64_t power, iterations, most, apart;
} Schedule;
/* U(t) = Onorm(R^z U(t - 1)) of the first columns of a start (M 8.4), as many as `subspace` has. */
bool iterate_columns(Context *context, const Patch *patch, const Factor *factor, Singles2 start, Schedule plan,
    Arena *scratch, Singles2 subspace);
/* The work of making a dictionary, but for columns that must be made orthonormal one by one, and for completion. */
double work_of_dictionary(const Header *header, const Patch *patch, bool follows, int64_t width);
bool factorize_patch(const Patch *patch, ConstDoubles springs, double shift, Arena *arena, Factor *factor);
INLINE int64_t solving_space(int64_t rows, int64_t columns) { return (rows + 4) * (columns + 16) + 15; }
MUST_CHECK bool take_factor(Arena *arena, const Patch *patch, Factor *factor);
