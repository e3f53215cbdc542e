/* Dictionaries of patches: U, by orthogonal iterations (specification, M 8). */
#pragma once

#include "codec/basis/dictionary_costs.h"
#include "codec/basis/structure.h"

/* C and D^-1 of L + diagonal. */
typedef struct {
    Singles values, inverse;
} Factor;

/* U of a patch that follows none (M 8.3 to M 8.5), of `width` columns, in `arena`; `held` is the factor of L + springs
 * + shift, or NULL. */
bool key_dictionary(Context *context, const Header *header, const Patch *patch, ConstDoubles springs,
    const Factor *held, int64_t width, Arena *arena, Arena *scratch, Singles2 *dictionary);
/* U of a patch whose predecessor has as many rows, and the dictionary `previous`. */
bool following_dictionary(Context *context, const Header *header, const Patch *patch, const Factor *factor,
    Singles2 previous, int64_t width, Arena *arena, Arena *scratch, Singles2 *dictionary);
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
