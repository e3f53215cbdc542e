/* Which rows of a block are eliminated when: nested dissection along its bisection, and what each front leads to.
 *
 * The rows before a cut that see across it separate the two halves; they are eliminated after both. The rows of a
 * separator, or of a half that is not cut further, make a front: its own steps, and the later steps to which they lead,
 * its border. It is a dense matrix, a row for each own step; this costs some fill and buys vector instructions.
 *
 * A. George, "Nested dissection of a regular finite element mesh", 1973; C. Ashcraft, R. Grimes, "The influence of
 * relaxed supernode partitions on the multifrontal method", 1989.
 */
#include "codec/basis/vectors.h"
#include "codec/geometry/geometry.h"

#define NONE UINT32_MAX
enum { LEAF = 8 }; /* halves of at most this many rows are not cut further */

/* Elimination order of a graph whose rows are in bisection order: `rows` and, at the end of `firsts`, the first step of
 * each front. Returns the number of fronts; `cuts`, one entry a row, is scratch, `firsts` has room for one more. */
static int64_t dissect(ConstInts offsets, ConstInts neighbors, Ints cuts, Words rows, Words firsts) {
    int64_t n = offsets.size - 1;
    /* The widest cut between a row and its farthest later neighbor has the row in its separator. */
    for (int64_t r = 0; r < n; r++) {
        int64_t top = r, first = 0, last = n;
        for (int64_t i = offsets.data[r]; i < offsets.data[r + 1]; i++) top = largest(top, neighbors.data[i]);
        cuts.data[r] = 0;
        while (top > r && last - first > LEAF) {
            int64_t middle = (first + last) / 2;
            if (r < middle && middle <= top) {
                cuts.data[r] = (int32_t)middle;
                break;
            }
            if (r < middle)
                last = middle;
            else
                first = middle;
        }
    }
    /* Post-order, written from the back: a separator, before it the right half, before that the left one. The stack
     * holds one part of each level, of which there are as many as n has binary digits, and one more. */
    int64_t stack[66][2] = {{0, n}};
    int64_t depth = 1, count = n, filled_from = n;
    firsts.data[count] = (uint32_t)n;
    while (depth > 0) {
        int64_t first = stack[--depth][0], last = stack[depth][1], cut = 0;
        if (last - first > LEAF) {
            cut = (first + last) / 2;
            stack[depth][0] = first;
            stack[depth++][1] = cut;
            stack[depth][0] = cut;
            stack[depth++][1] = last;
        }
        int64_t before = filled_from;
        for (int64_t r = (cut > 0 ? cut : last) - 1; r >= first; r--)
            if (cuts.data[r] == cut) rows.data[--filled_from] = (uint32_t)r;
        if (filled_from < before) firsts.data[--count] = (uint32_t)filled_from;
    }
    return n - count;
}

typedef uint64_t StepBits __attribute__((aligned(4), may_alias));

/* Sets of steps, of `words` words each. A set waits for the front whose step is its first after the front that left it.
 * That front is a separator of a part around: sets wait for one front of each level at most, and those are fewer than
 * 31. */
typedef struct {
    StepBits *bits;
    int64_t words;
    uint64_t free;     /* bit k: set k */
    uint32_t *waiting; /* of each front, the set that waits for it */
} Sets;

/* Sets in 3 n numbers of scratch: there is room for 32 where n is 64 or more, and for n where it is less. */
static Sets open_sets(uint32_t *scratch, int64_t n) {
    int64_t words = (n + 63) / 64, most = words > 0 ? n / words : 0;
    for (int64_t t = 0; t < n; t++) scratch[2 * n + t] = NONE;
    return (Sets){(StepBits *)scratch, words, most < 64 ? (UINT64_C(1) << most) - 1 : UINT64_MAX, scratch + 2 * n};
}

/* An empty set; NONE if there is none left. */
INLINE uint32_t take_set(Sets *sets) {
    if (sets->free == 0) return NONE;
    uint32_t set = (uint32_t)__builtin_ctzll(sets->free);
    sets->free &= sets->free - 1;
    for (int64_t w = 0; w < sets->words; w++) sets->bits[set * sets->words + w] = 0;
    return set;
}

/* Leave the later steps of a set, the first of which is in front `owner`, to that front. */
static void leave_set(Sets *sets, uint32_t set, int64_t from, uint32_t owner) {
    const StepBits *bits = sets->bits + set * sets->words;
    uint32_t other = sets->waiting[owner];
    if (other == NONE) {
        sets->waiting[owner] = set;
        return;
    }
    for (int64_t w = from; w < sets->words; w++) sets->bits[other * sets->words + w] |= bits[w];
    sets->free |= UINT64_C(1) << set;
}

/* Find the borders of the fronts that `dissect` found, and the rest of `Fronts`.
 *
 * Returns the size of `borders`; -1 if there is no room for them; -2 if a factorization takes more operations than
 * `most_work`, or rows are not in the order of a bisection. `scratch` has room for 3 n, `starts` and `places` for t +
 * 1.
 */
static int64_t find_borders(ConstInts offsets, ConstInts neighbors, int64_t count, double most_work, Words scratch,
    Fronts *fronts) {
    int64_t n = offsets.size - 1;
    const uint32_t *rows = fronts->rows.data, *firsts = fronts->firsts.data;
    uint32_t *steps = fronts->steps.data, *owners = fronts->owners.data, *starts = fronts->starts.data,
        *places = fronts->places.data, *borders = fronts->borders.data;
    Sets sets = open_sets(scratch.data, n);
    for (int64_t t = 0; t < count; t++) {
        for (int64_t k = firsts[t]; k < firsts[t + 1]; k++) {
            steps[rows[k]] = (uint32_t)k;
            owners[k] = (uint32_t)t;
        }
    }
    int64_t size = 0, place = 0;
    double work = 0.0;
    starts[0] = places[0] = 0;
    for (int64_t t = 0; t < count; t++) {
        int64_t first = firsts[t], end = firsts[t + 1], begin = size, from = end >> 6;
        uint32_t set = sets.waiting[t] != NONE ? sets.waiting[t] : take_set(&sets);
        if (fronts->borders.size < size + n + 2) return -1;
        if (set == NONE) return -2;
        StepBits *bits = sets.bits + set * sets.words;
        for (int64_t k = first; k < end; k++) {
            for (int64_t i = offsets.data[rows[k]]; i < offsets.data[rows[k] + 1]; i++) {
                uint32_t step = steps[neighbors.data[i]];
                bits[step >> 6] |= UINT64_C(1) << (step & 63);
            }
        }
        uint64_t later = UINT64_MAX << (end & 63);
        for (int64_t w = from; w < sets.words; w++, later = UINT64_MAX)
            for (uint64_t left = bits[w] & later; left != 0; left &= left - 1)
                borders[size++] = (uint32_t)(64 * w + __builtin_ctzll(left));
        if (size > begin) leave_set(&sets, set, from, owners[borders[begin]]);
        else sets.free |= UINT64_C(1) << set;
        if ((size - begin) % 2 > 0) borders[size++] = (uint32_t)n;
        double own = (double)(end - first), width = own + (double)(size - begin);
        work += own * width * width;
        place += (end - first) * whole_lines(end - first + size - begin);
        if (work > most_work || place > UINT32_MAX) return -2;
        starts[t + 1] = (uint32_t)size;
        places[t + 1] = (uint32_t)place;
    }
    return size;
}

/* Find the fronts of a graph of n rows in bisection order: `dissect`, `find_borders`, and for each front its own steps
 * times its width, once and twice, summed. Returns how many fronts there are, or the result of `find_borders` where
 * that is negative. `fronts` comes with room: n + 1 for `firsts`, `starts` and `places`; `scratch` has 3 n. */
int64_t find_fronts(ConstInts offsets, ConstInts neighbors, double most_work, Words scratch, Fronts *fronts) {
    int64_t n = offsets.size - 1;
    uint32_t *firsts = fronts->firsts.data, *starts = fronts->starts.data;
    int64_t count = dissect(offsets, neighbors, (Ints){(int32_t *)scratch.data, n}, fronts->rows, fronts->firsts);
    for (int64_t t = 0; t <= count; t++) firsts[t] = firsts[n - count + t];
    int64_t size = find_borders(offsets, neighbors, count, most_work, scratch, fronts);
    if (size < 0) return size;
    double *sums = fronts->sums.data;
    sums[0] = sums[1] = 0.0;
    for (int64_t t = 0; t < count; t++) {
        double own = firsts[t + 1] - firsts[t], width = own + (starts[t + 1] - starts[t]);
        sums[0] += own * width;
        sums[1] += own * width * width;
    }
    return count;
}
