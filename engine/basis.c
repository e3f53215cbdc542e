/* Dictionaries of blocks (specification, M 8): orthogonal iterations, and where these would lose columns, with care. */
#include "codec/geometry/geometry.h"
#include "engine/chain.h"

/* Independence of a panel's columns from which one pass of Cholesky QR is enough, and of all from which it is at all. */
static const double ONCE = 1e-5, TWICE = 1e-13;
static const double LEAST_PIVOT = 0x1p-20, EXACT_SHIFT = 0x1p-5;
/* The share of hash columns in a start that might lack something, of cosines and of a predecessor's columns (M 8.3). */
static const double START_NOISE = 0.25, FOLLOWING_NOISE = 0x1p-8;
enum { EXACT_POWER = 2, EXACT_ITERATIONS = 128, FACTOR_PADDING = 7 };

static Factor factor_room(Arena *arena, const Patch *patch) {
    int64_t size = patch->fronts.places.data[patch->fronts.places.size - 1];
    return (Factor){take_doubles(arena, size + FACTOR_PADDING), take_doubles(arena, patch->size)};
}

bool factorize_patch(Context *context, const Patch *patch, ConstDoubles springs, double shift, Arena *arena, Factor *factor) {
    int64_t n = patch->size;
    Doubles diagonal = take_doubles(arena, n), scratch = take_doubles(arena, 2 * (n + 16) + FACTOR_PADDING);
    Words column = take_words(arena, n + 1);
    *factor = factor_room(arena, patch);
    if (failed(context)) return false;
    for (int64_t r = 0; r < n; r++) diagonal.data[r] = patch->diagonal.data[r] + (springs.data[r] + shift);
    factorize_fronts(patch->offsets, patch->neighbours, patch->weights, const_doubles(diagonal), patch->fronts, column, scratch,
        factor->values, factor->inverse);
    return true;
}

static bool is_in_pieces(const Patch *patch, Arena *scratch) {
    Ints room = take_ints(scratch, 2 * patch->size + 1);
    return fine(scratch->context) && !reaches_all(patch->offsets, patch->neighbours, room);
}

/* The first `width` columns of others, and cosines where there are fewer. */
static Doubles2 resized(Doubles2 previous, int64_t rows, int64_t width, Arena *arena) {
    Doubles2 columns = take_doubles2(arena, rows, width);
    Doubles table = take_doubles(arena, rows + 8);
    if (fine(arena->context)) resize_columns(const_doubles2(previous), table, columns);
    return columns;
}

static void add_noise(Doubles2 columns, double share, Arena *scratch) {
    Doubles2 hashed = take_doubles2(scratch, columns.rows, columns.columns);
    if (failed(scratch->context)) return;
    hash_columns(hashed);
    for (int64_t i = 0; i < columns.rows * columns.columns; i++) columns.data[i] += share * hashed.data[i];
}

static Doubles iteration_room(Arena *scratch, Doubles2 columns) {
    return take_doubles(scratch, iteration_space(columns.rows, columns.columns));
}

static bool are_finite(ConstDoubles2 numbers) {
    double spoiled = 0.0;
    for (int64_t i = 0; i < numbers.rows * numbers.columns; i++) spoiled += numbers.data[i] * 0.0;
    return spoiled == 0.0;
}

/* Overwrite U by Onorm(R U). */
static bool solve_with_care(Context *context, const Patch *patch, const Factor *factor, Arena *scratch, Doubles2 subspace) {
    int64_t rows = subspace.rows, columns = subspace.columns;
    Mark mark = mark_of(scratch);
    Doubles2 solved = take_doubles2(scratch, rows, columns);
    Doubles room = take_doubles(scratch, solving_space(rows, columns)), other = iteration_room(scratch, subspace);
    Doubles scales = take_doubles(scratch, 3 * columns);
    bool done = fine(context);
    if (done) {
        solve_columns(patch->fronts, factor->values, const_doubles(factor->inverse), const_doubles2(subspace), 1, room, solved);
        if (cholesky_onorm(const_doubles2(solved), ONCE, other, subspace) < TWICE) {
            done = spend(context, reflection_work((double)rows, (double)columns), 0)
                && (are_finite(const_doubles2(solved)) || FAIL(context, NUMERIC, "the subspace iteration produced a value that is not finite"));
            if (done) householder(solved, scales, subspace);
        }
    }
    release_to(scratch, mark);
    return done;
}

/* U(t) = Onorm(R^z U(t - 1)) of the first `columns` of a start (M 8.4). */
static bool iterate_columns(Context *context, const Patch *patch, const Factor *factor, Doubles2 start, Schedule plan, Arena *scratch, Doubles2 subspace) {
    int64_t columns = subspace.columns;
    if (!spend(context, dictionary_work(&patch->fronts, columns, (double)plan.power, (double)plan.iterations), 0)) return false;
    Doubles room = iteration_room(scratch, subspace);
    if (failed(context)) return false;
    double independence = iterate(patch->fronts, factor->values, const_doubles(factor->inverse), const_doubles2(start), plan.power,
        plan.iterations, ONCE, room, subspace);
    if (independence >= TWICE) return true;
    int64_t steps = plan.power * plan.iterations;
    if (!spend(context, careful_work(&patch->fronts, columns, (double)steps), 0)) return false;
    for (int64_t r = 0; r < subspace.rows; r++)
        memcpy(subspace.data + r * columns, start.data + r * start.columns, (size_t)columns * sizeof(double));
    for (; steps > 0; steps--)
        if (!solve_with_care(context, patch, factor, scratch, subspace)) return false;
    return true;
}

/* `width` columns of U: those that iterations give, and where these are fewer, any at right angles to them (M 8.7). */
static bool iterate_and_complete(Context *context, const Patch *patch, const Factor *factor, Doubles2 start, Schedule plan,
    int64_t width, Arena *arena, Arena *scratch, Doubles2 *dictionary) {
    int64_t first = least(width, plan.most), rows = patch->size;
    *dictionary = take_doubles2(arena, rows, width);
    Doubles2 iterated = first == width ? *dictionary : take_doubles2(scratch, rows, first);
    if (failed(context) || !iterate_columns(context, patch, factor, start, plan, scratch, iterated)) return false;
    if (first == width) return true;
    if (!spend(context, completion_work((double)rows, (double)plan.most, (double)width), 0)) return false;
    Doubles room = take_doubles(scratch, completion_space(first));
    if (failed(context)) return false;
    return complete_columns(const_doubles2(iterated), LEAST_PIVOT, room, *dictionary)
        || FAIL(context, NUMERIC, "the columns of a dictionary cannot be completed");
}

bool key_dictionary(Context *context, const Header *header, const Patch *patch, ConstDoubles springs, const Factor *held,
    int64_t width, Arena *arena, Arena *scratch, Doubles2 *dictionary) {
    const Paper *paper = &header->paper;
    Schedule plan = {paper->power, paper->key_iterations, iterated_columns(header, patch->size)};
    Factor own;
    Doubles2 none = {NULL, 0, 0};
    if (paper->exact) {
        plan.power = EXACT_POWER;
        plan.iterations = EXACT_ITERATIONS;
    }
    if (paper->exact || held == NULL) {
        if (!factorize_patch(context, patch, springs, paper->exact ? EXACT_SHIFT : paper->shift, scratch, &own)) return false;
        held = &own;
    }
    Doubles2 start = resized(none, patch->size, least(width, plan.most), scratch);
    if (paper->exact || is_in_pieces(patch, scratch)) add_noise(start, START_NOISE, scratch);
    return fine(context) && iterate_and_complete(context, patch, held, start, plan, width, arena, scratch, dictionary);
}

bool following_dictionary(Context *context, const Header *header, const Patch *patch, const Factor *factor, Doubles2 previous,
    int64_t width, Arena *arena, Arena *scratch, Doubles2 *dictionary) {
    Schedule plan = {header->paper.power, header->paper.iterations, iterated_columns(header, patch->size)};
    int64_t first = least(width, plan.most);
    bool noisy = is_in_pieces(patch, scratch);
    Doubles2 start = noisy || previous.columns < first ? resized(previous, patch->size, first, scratch) : previous;
    if (noisy) add_noise(start, FOLLOWING_NOISE, scratch);
    return fine(context) && iterate_and_complete(context, patch, factor, start, plan, width, arena, scratch, dictionary);
}
