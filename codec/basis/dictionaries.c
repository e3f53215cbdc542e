/* Dictionaries of blocks (specification, M 8): orthogonal iterations. */
#include "codec/geometry/geometry.h"
#include "codec/basis/patches.h"

static const double EXACT_SHIFT = 0x1p-5;
/* The share of hash columns in a start that might lack something, of cosines and of a predecessor's columns (M 8.3). */
static const double START_NOISE = 0.25, FOLLOWING_NOISE = 0x1p-8;
enum { EXACT_POWER = 2, EXACT_ITERATIONS = 128, FIRST_CARE = 16 };

bool take_factor(Arena *arena, const Patch *patch, Factor *factor) {
    int64_t size = patch->fronts.places.data[patch->fronts.places.size - 1];
    return take_singles(arena, size + 15, &factor->values) && take_singles(arena, patch->size, &factor->inverse);
}

bool factorize_patch(const Patch *patch, ConstDoubles springs, double shift, Arena *arena, Factor *factor) {
    int64_t n = patch->size;
    Doubles diagonal;
    Singles scratch;
    Words column;
    if (!take_doubles(arena, n, &diagonal) || !take_singles(arena, 3 * (n + 16) + 15, &scratch)
        || !take_words(arena, n + 1, &column) || !take_factor(arena, patch, factor))
        return false;
    for (int64_t r = 0; r < n; r++) diagonal.data[r] = patch->diagonal.data[r] + (springs.data[r] + shift);
    factorize_fronts(patch->offsets, patch->neighbors, patch->weights, const_doubles(diagonal), patch->fronts, column,
        scratch, factor->values, factor->inverse);
    return true;
}

/* Whether a patch is in pieces. */
static bool look_for_pieces(const Patch *patch, Arena *scratch, bool *in_pieces) {
    Ints room;
    if (!take_ints(scratch, 2 * patch->size + 1, &room)) return false;
    *in_pieces = !reaches_all(patch->offsets, patch->neighbors, room);
    return true;
}

/* The first `width` columns of others, and cosines where there are fewer. */
static bool resize(Singles2 previous, int64_t rows, int64_t width, Arena *arena, Singles2 *columns) {
    Doubles table;
    if (!take_singles2(arena, rows, width, columns) || !take_doubles(arena, rows + 8, &table)) return false;
    resize_columns(const_singles2(previous), table, *columns);
    return true;
}

static void add_noise(Singles2 columns, double share) {
    for (int64_t r = 0; r < columns.rows; r++)
        for (int64_t j = 0; j < columns.columns; j++)
            columns.data[r * columns.columns + j] += (float)(share * hash_at(r, j));
}

static double iteration_work(const Patch *patch, Schedule plan, int64_t columns, double care) {
    double solutions = (double)(plan.power * plan.iterations), onorms = plan.apart > 0
        ? IN_DOUBLES * (double)plan.iterations * (double)((plan.power + plan.apart - 1) / plan.apart) : solutions + 1;
    return dictionary_work(&patch->fronts, columns, solutions, onorms, care);
}

bool iterate_columns(Context *context, const Patch *patch, const Factor *factor, Singles2 start, Schedule plan,
    Arena *scratch, Singles2 subspace) {
    int64_t found = NEEDS_CARE;
    Singles room;
    if (!take_singles(scratch, iteration_space(subspace.rows, subspace.columns, plan.apart), &room)) return false;
    for (int64_t care = 0; found == NEEDS_CARE; care = care > 0 ? 4 * care : FIRST_CARE) {
        if (!charge(context, iteration_work(patch, plan, subspace.columns, (double)care), 0)) return false;
        found = iterate(patch->fronts, factor->values, const_singles(factor->inverse), const_singles2(start),
            plan.power, plan.iterations, plan.apart, care, room, subspace);
    }
    return found != LOST || FAIL(context, NUMERIC, "the columns of a dictionary cannot be made orthonormal");
}

static Schedule schedule_of(const Header *header, int64_t rows, bool follows) {
    const Paper *paper = &header->paper;
    int64_t most = header->gop_frames > 0 && rows <= header->coefficients ? (rows + 1) / 2 : rows; /* M 8.7 */
    if (!follows && paper->exact) return (Schedule){EXACT_POWER, EXACT_ITERATIONS, most, 0};
    return (Schedule){paper->power, follows ? paper->iterations : paper->key_iterations, most, header->onorm};
}

double work_of_dictionary(const Header *header, const Patch *patch, bool follows, int64_t width) {
    return iteration_work(patch, schedule_of(header, patch->size, follows), width, 0);
}

/* Columns of U: those of the iterations, then any that are orthogonal to them (M 8.7). */
static bool iterate_and_complete(Context *context, const Patch *patch, const Factor *factor, Singles2 start,
    Schedule plan, Arena *scratch, Singles2 dictionary) {
    int64_t width = dictionary.columns, first = least(width, plan.most), rows = patch->size;
    Singles2 iterated = dictionary;
    if (first < width && !take_singles2(scratch, rows, first, &iterated)) return false;
    if (!iterate_columns(context, patch, factor, start, plan, scratch, iterated)) return false;
    if (first == width) return true;
    if (!charge(context, completion_work((double)rows, (double)plan.most, (double)width), 0)) return false;
    Singles room;
    if (!take_singles(scratch, completion_space(first), &room)) return false;
    return complete_columns(const_singles2(iterated), room, dictionary)
        || FAIL(context, NUMERIC, "the columns of a dictionary cannot be completed");
}

bool key_dictionary(Context *context, const Header *header, const Patch *patch, ConstDoubles springs,
    const Factor *held, Arena *scratch, Singles2 dictionary) {
    const Paper *paper = &header->paper;
    Schedule plan = schedule_of(header, patch->size, false);
    Factor own;
    Singles2 start;
    bool noisy = true;
    if (paper->exact || held == NULL) {
        if (!factorize_patch(patch, springs, paper->exact ? EXACT_SHIFT : paper->shift, scratch, &own)) return false;
        held = &own;
    }
    if (!resize((Singles2){NULL, 0, 0}, patch->size, least(dictionary.columns, plan.most), scratch, &start))
        return false;
    if (!paper->exact && !look_for_pieces(patch, scratch, &noisy)) return false;
    if (noisy) add_noise(start, START_NOISE);
    return iterate_and_complete(context, patch, held, start, plan, scratch, dictionary);
}

bool following_dictionary(Context *context, const Header *header, const Patch *patch, const Factor *factor,
    Singles2 previous, Arena *scratch, Singles2 dictionary) {
    Schedule plan = schedule_of(header, patch->size, true);
    int64_t first = least(dictionary.columns, plan.most);
    Singles2 start = previous;
    bool noisy;
    if (!look_for_pieces(patch, scratch, &noisy)) return false;
    if ((noisy || previous.columns < first) && !resize(previous, patch->size, first, scratch, &start)) return false;
    if (noisy) add_noise(start, FOLLOWING_NOISE);
    return iterate_and_complete(context, patch, factor, start, plan, scratch, dictionary);
}
