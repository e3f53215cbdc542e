/* Integers on vertices: corners, models of values, and the kernels of this room. */
#pragma once

#include "bitstream/entropy/entropy.h"

/* What both sides know of a mesh before its values: the corners at each vertex, and those beyond its edges. */
enum { MOST_NEIGHBORS = 16, MOST_FLAPS = 8 };

/* Corner k is corner k % 3 of face k / 3. Made by link_corners and order_vertices, which check. */
typedef struct {
    ConstInts2 faces; /* m x 3 */
    Ints starts;      /* n + 1: where the corners of each vertex begin in `corners` */
    Ints corners;     /* 3 m, ascending at each vertex */
    Ints opposite;    /* 3 m: the corner that faces the same edge from the other side, or -1 */
    Ints rank;        /* n: when each vertex is coded */
    bool crowded;     /* whether more than two corners face an edge */
} Corners;

/* Two coded ends of an edge, and the coded vertex beyond it as seen from the vertex to be coded. */
typedef struct {
    int32_t a, b, c, corner; /* the corner at c */
} Flap;

typedef struct { /* what is coded around a vertex */
    int neighbors, flaps;
    int32_t neighbor[MOST_NEIGHBORS];
    Flap flap[MOST_FLAPS];
} Around;

INLINE int32_t next_corner(int32_t k) { return k % 3 == 2 ? k - 2 : k + 1; }
INLINE int32_t previous_corner(int32_t k) { return k % 3 == 0 ? k + 2 : k - 1; }
INLINE int32_t faces_at(const Corners *c, int32_t v) { return c->starts.data[v + 1] - c->starts.data[v]; }

void gather_around(const Corners *corners, int32_t v, Around *around);

int64_t gather_corners(Corners corners);
int64_t link_corners(Corners *corners, Ints scratch);
int64_t link_parts(const Corners *corners, const Corners *whole);
int64_t order_vertices(Corners corners, Ints order, Ints2 scratch);

/* One integer, given predictions of it and what their errors may depend on (specification, V 3 to V 5).
 *
 * Each prediction is taken as the middle of a distribution whose width is learned; each decision about the value then
 * mixes what these distributions and some adaptive slots say. The front-ends (grid, layer) make the predictions.
 */
enum {
    FINE = 16, /* predictions and their errors are in 1/16 */
    PREDICTIONS = 7,
    CONTEXTS = 6,
    TWIN_CONTEXTS = 4, /* where twins foretell values; the last two of two sizes */
    CONTEXT_SIZE = 512, /* values of a context */
    SCALE_CONTEXTS = 512,
    HIT_CONTEXTS = 32,
    WEIGHT_SETS = 3,
    KINDS = 6, /* of decisions */
    MOST_ASKS = 3,
    CONSTANT_INPUT = PREDICTIONS, /* behind it are those of the contexts */
    VALUE_INPUTS = PREDICTIONS + CONTEXTS + 1, /* without twins */
    TWIN_INPUTS = PREDICTIONS + TWIN_CONTEXTS + 1,
    WEIGHT_ROW = 16,
    MODEL_ROW = 8, /* numbers from one row to the next, some beyond the last */
    /* Nodes of the decisions, by kind. */
    ASK_NODE = 0,
    SIDE_NODE = ASK_NODE + 2 * PREDICTIONS,
    CLASS_NODE = SIDE_NODE + 4,
    PLACE_NODE = CLASS_NODE + 2 * 15,
    VALUE_NODES = PLACE_NODE + 2 * 9,
    VALUE_BYTES = 160, /* more than a value can take */
    TWIN_PREDICTIONS = 4,
    TWIN_ROWS = 2 * 96 + 2 * 45,
    TWIN_ROW = 4,
};

/* Predictions that twins replace: by images, and by flaps alike. */
static const int TWIN_AT[TWIN_PREDICTIONS] = {3, 5, 1, 2};

typedef struct {
    Words slots;   /* CONTEXTS x CONTEXT_SIZE x VALUE_NODES */
    uint8_t *begun; /* whether each of these contexts has its first slots: few do in a small mesh */
    Words hits;    /* HIT_CONTEXTS x MODEL_ROW: how often a prediction is exact */
    Ints2 weights; /* VALUE_NODES + WEIGHT_SETS * KINDS rows of WEIGHT_ROW, VALUE_INPUTS of which are used */
    Ints2 scales;  /* SCALE_CONTEXTS rows of MODEL_ROW: mean sizes of errors in 1/4096, and how many were seen */
    Ints2 twins;   /* TWIN_ROWS of a mean size, how many, and how often it is exact: of predictions by twins */
} ValueModel;

typedef struct { /* filled by the front-end */
    int32_t prediction[MODEL_ROW]; /* below 2^28 in magnitude; the last is the best guess */
    int32_t scale;                   /* what to expect of the size of its error, in 1/16; 0 .. 2^28 */
    int32_t scale_context, hit_context, context[CONTEXTS], set;
    int32_t contexts;                /* CONTEXTS or TWIN_CONTEXTS */
    int32_t refuted[MOST_ASKS], refutations; /* what the value is known not to be */
    int32_t twin[TWIN_PREDICTIONS];  /* rows of those of TWIN_AT that are by twins; -1 for others */
} Expectation;

INLINE int32_t whole(int32_t fine) { return (fine + FINE / 2) >> 4; }
INLINE int32_t within(int64_t x, int32_t low, int32_t high) { return x < low ? low : x > high ? high : (int32_t)x; }
INLINE int32_t size_of(int32_t x) { return x < 0 ? -x : x; }
INLINE int32_t bit_length(uint32_t x) { return x != 0 ? 32 - __builtin_clz(x) : 0; }

/* x / n, rounded half away from zero. */
INLINE int32_t divided(int64_t x, int32_t n) { return (int32_t)(x >= 0 ? (x + n / 2) / n : -((-x + n / 2) / n)); }

/* Two to the octave: 0, 1, 2, 3, 4 (to 5), 5 (to 7), 6 (to 11) ... 31. */
INLINE int32_t size_class(int32_t x) {
    if (x < 4) return x;
    int32_t bits = bit_length((uint32_t)x);
    return (int32_t)least(2 * bits - 2 + (x >> (bits - 2) & 1), 31);
}

INLINE int32_t signed_class(int32_t x, int32_t unit) { /* 0 .. 6, 3 in the middle; without branches */
    int32_t size = size_of(x), steps = (size * 2 >= unit) + (size >= unit + (unit >> 1)) + (size >= 4 * unit);
    return x < 0 ? 3 - steps : 3 + steps;
}

INLINE int32_t three_classes(int32_t x, int32_t y, int32_t z, int32_t first, int32_t unit) {
    return (signed_class(x, first) * 7 + signed_class(y, unit)) * 7 + signed_class(z, unit);
}

/* Bit j: prediction j is the value. */
INLINE int32_t hits_of(const Expectation *e, int32_t value) {
    int32_t hits = 0;
    for (int j = 0; j < PREDICTIONS; j++) hits |= (whole(e->prediction[j]) == value) << j;
    return hits;
}

/* Codes an integer less than 2^21 away from the best guess; what a reader returns may be 2^24 away. */
int32_t ISA(code_value)(RangeCoder *coder, const ValueModel *model, const Expectation *e, int32_t value);

/* Which values a component has taken already, a bit each (specification, V 8.7, A 2.5): a row of `words` words. */
INLINE void mark_seen(int64_t *seen, int32_t v) { seen[v >> 6] |= (int64_t)(UINT64_C(1) << (v & 63)); }

/* The value seen that is nearest to v, downwards if two are; v if none is near. */
int32_t nearest_seen(const int64_t *seen, int64_t words, int32_t v);

/* A sum of terms whose weights are learned on the way: recursive least squares, by one sweep of Gauss-Seidel for each
 * sample, in integers (specification, V 6). */
enum {
    MOST_TERMS = 7,
    LEARNER_ROW = 8,
    LEARNER_MEMORY = 11,            /* a sample is forgotten after about 2^LEARNER_MEMORY others */
    RIDGE = 1 << 19,        /* pulls weights towards where they started */
    MOST_WEIGHT = 1 << 18,  /* 1.0 is 2^16 */
    MOST_TERM = 1 << 26,
};

typedef struct { /* a row of what Python keeps */
    /* normal equations of the samples; of `square`, the lower half */
    int64_t square[MOST_TERMS][LEARNER_ROW], product[LEARNER_ROW];
    int64_t weight[LEARNER_ROW], start[LEARNER_ROW];
} Learner;

enum { LEARNER_COLUMNS = sizeof(Learner) / sizeof(int64_t) };

INLINE void start_learner(Longs2 learners, int64_t k, int term, int64_t weight) {
    Learner *learner = (Learner *)learners.data + k;
    learner->weight[term] = learner->start[term] = weight;
}

/* The number of terms is a constant wherever this is called, so that loops are unrolled. */
INLINE int32_t foretell(const Learner *l, int terms, const int32_t *term, int32_t most) {
    int64_t sum = 0;
    for (int i = 0; i < terms; i++) sum += term[i] * l->weight[i];
    sum >>= 16;
    return within(sum, -most, most);
}

/* |term| <= MOST_TERM, |target| < 2^30. Samples count by 1 / scale^2, and less where a term or the target is large
 * against that: so sums stay below 2^40, and no outlier spoils them. By how many bits products are shifted. */
INLINE int fineness(int terms, const int32_t *term, int32_t target, int32_t scale) {
    int32_t unit = (int32_t)largest(scale, size_of(target) >> 4);
    for (int i = 0; i < terms; i++) unit = (int32_t)largest(unit, size_of(term[i]) >> 5);
    return 2 * bit_length((uint32_t)unit + 8) - 8;
}

INLINE void take_sample(Learner *l, int terms, const int32_t *term, int32_t target, int32_t scale) {
    int down = fineness(terms, term, target, scale);
    for (int i = 0; i < terms; i++) {
        for (int j = 0; j <= i; j++)
            l->square[i][j] += ((int64_t)term[i] * term[j] * 256 >> down) - (l->square[i][j] >> LEARNER_MEMORY);
        l->product[i] += ((int64_t)term[i] * target * 256 >> down) - (l->product[i] >> LEARNER_MEMORY);
    }
}

/* Bring the weight of term i to its best, the others as they are. */
INLINE void solve_for(Learner *l, int terms, int i) {
    int64_t left = l->product[i] * ONE - RIDGE * (l->weight[i] - l->start[i]);
    for (int j = 0; j < terms; j++) left -= l->square[i > j ? i : j][i > j ? j : i] * l->weight[j];
    int64_t weight = l->weight[i] + left / (l->square[i][i] + RIDGE);
    l->weight[i] = within(weight, -MOST_WEIGHT, MOST_WEIGHT);
}

INLINE void learn(Learner *l, int terms, const int32_t *term, int32_t target, int32_t scale) {
    take_sample(l, terms, term, target, scale);
    for (int i = 0; i < terms; i++) solve_for(l, terms, i);
}

/* The same for one weight: about as good after many samples, and quicker. */
INLINE void learn_in_turn(Learner *l, int terms, const int32_t *term, int32_t target, int32_t scale, int turn) {
    take_sample(l, terms, term, target, scale);
    solve_for(l, terms, turn);
}

/* A learned sum that tells a value, and one that tells how far off that will be (specification, V 9, A 4.5). */
enum { TERMS = 7, HINTS = 4, VALENCES = 6 };

typedef struct { /* all in 1/16 */
    Learner *guess, *size;
    /* Filled by the kind, 0 behind that; hint 0 is what to expect if there is nothing else. */
    int32_t term[LEARNER_ROW], hint[LEARNER_ROW];
    int32_t shift, typical;           /* value less base; size of its error */
} Forecast;

INLINE int32_t limited(int64_t term) { return within(term, -MOST_TERM, MOST_TERM); }

INLINE void foresee(Forecast *f, int32_t far) {
    for (int i = 0; i < TERMS; i++) f->term[i] = limited(f->term[i]);
    f->shift = foretell(f->guess, TERMS, f->term, far);
}

INLINE void foresee_error(Forecast *f, int32_t far, bool informed) {
    for (int i = 0; i < HINTS; i++) f->hint[i] = limited(f->hint[i]);
    f->typical = f->hint[0];
    if (informed) f->typical = within(foretell(f->size, HINTS, f->hint, far), f->hint[0] / 8 + 1, far);
}

INLINE int32_t gap_seen(const Forecast *f, int32_t gap) {
    return (int32_t)least(size_of(gap), 8 * (int64_t)f->typical + 64);
}

/* The value was `error` above the base; returns by how much it was above the guess. */
INLINE int32_t take(Forecast *f, int32_t error) {
    int32_t gap = error - f->shift;
    learn(f->guess, TERMS, f->term, error, f->typical);
    learn(f->size, HINTS, f->hint, gap_seen(f, gap), f->typical);
    return gap;
}

/* Bring predictions into their range, and say how far they are from the guess. */
INLINE void settle(Expectation *e, int32_t low, int32_t high, int32_t *off) {
    for (int i = 0; i < PREDICTIONS; i++) e->prediction[i] = within(e->prediction[i], low, high);
    for (int i = 0; i < PREDICTIONS; i++) off[i] = e->prediction[i] - e->prediction[PREDICTIONS - 1];
}

/* Shared by the kinds of fields, whose rows are coded in order: code row number i; false if a value is invalid. */
typedef bool CodeRow(void *work, int64_t i);

/* Code `count` rows from `first` on, as far as there is room for `bytes` (writing) or sense (reading); returns how
 * many, or -1 if there are not so many. */
INLINE int64_t code_rows(RangeCoder *coder, int64_t rows, int64_t first, int64_t count, int64_t bytes,
    CodeRow *code_row, void *work) {
    if (first < 0 || count < 0 || first > rows - count) return -1;
    int64_t done = 0;
    while (done < count && has_room(coder, bytes) && !overran(coder) && code_row(work, first + done)) done++;
    return done;
}

/* Sizes of the gaps of a vertex, added. */
int32_t error_at(const Ints2 *gaps, int32_t v);
/* Tell the neighbors of v, which is known now. */
void pass_on(const Corners *corners, const Ints2 *values, const Longs2 *sums, int32_t v);
/* What component j would be, less `otherwise`, if it balanced the others around neighbors where it is all that is
 * missing. */
int32_t balance(const Corners *corners, const Ints2 *values, const Longs2 *sums, const Around *around, int j,
    int32_t otherwise);

/* Tables of integer fields (specification, V 4.1, V 4.2), see tables.c. */
enum { SURVIVAL_REACH = 512, ODDS_SIZE = 544 };

/* -ln of the probability that an error exceeds i / 32 of its scale, from i = -SURVIVAL_REACH on, in 2^-16 nat. */
extern INSIDE int32_t SURVIVAL[2 * SURVIVAL_REACH + 1];
/* ln(e^d - 1) and ln(1 - e^-d) of a d in 2^-16 nat, by its leading bits; in 1 / 256 nat. */
extern INSIDE int16_t ODDS[ODDS_SIZE];
extern INSIDE int16_t LESS[ODDS_SIZE];
/* Fill all tables, if no call before has; kernels that code need them. Any thread may call this. */
void make_tables(void);

/* Where writers put vertices on a grid; `wanted`, n x 4: where each would be, in cells, and the square of how far from
 * there it may come. See placing.c. `tried`: n zeros, for scratch. */
void mend_place(const Corners *corners, Ints2 places, const double *wanted, const int32_t *most, int32_t v);
void mend_places(const Corners *corners, Ints2 places, const double *wanted, const int32_t *most, uint8_t *tried);
/* Put v into another cell, if it may go there. */
bool go_to_cell(const Corners *corners, Ints2 places, const double *wanted, int32_t v, const int32_t *cell);

/* Positions on a grid. See grid.simd.c. */
typedef struct {
    ConstInts largest; /* 3: values of each axis are 0 .. largest, below 2^20 */
    ConstInts order;   /* n: vertices as they are coded */
    Ints2 values;      /* n x 3 */
    Ints2 gaps;        /* n x 3: value less guess, in 1/16 */
    Longs2 sums;       /* n x 4: values of the coded neighbors, added, and how many they are */
    Longs2 seen;       /* 3 x words: bit v of an axis tells that it has taken the value v */
    Longs2 learners;
    struct Twins *twins; /* or NULL */
} Grid;

int64_t ISA(code_grid)(RangeCoder *coder, ValueModel model, Corners corners, Grid grid, int64_t first, int64_t count);

/* Positions on a grid by a small model, vertices as they are numbered. See light.c. */
enum {
    LIGHT_SIZES = 24, /* classes of what is expected of an error */
    LIGHT_KINDS = 12, /* flaps, at most three, and axes before */
    LIGHT_ROW = 12,   /* slots of a size and a kind */
    LIGHT_SPAN = LIGHT_KINDS * LIGHT_ROW + 7, /* slots of a size */
    LIGHT_SLOTS = LIGHT_SIZES * LIGHT_SPAN,
    LEAN_INPUTS = 3, /* where twins foretell values */
    LEAN_CONTEXTS = 392,
    LEAN_NODES = LIGHT_ROW + 7,
    LEAN_SLOTS = LEAN_INPUTS * LEAN_CONTEXTS * LEAN_NODES,
};

typedef struct {
    ConstInts largest; /* 3: values of each axis are 0 .. largest, below 2^20 */
    Ints2 values;      /* n x 3 */
    Ints2 gaps;        /* n x 3: how far values were from guesses, in 1/16 */
    Words slots;       /* LIGHT_SLOTS, or LEAN_SLOTS with twins */
    struct Twins *twins; /* or NULL */
    int32_t *weights;    /* with twins: LEAN_NODES x LEAN_INPUTS */
} Light;

int64_t code_light(RangeCoder *coder, Corners corners, Light light, int64_t first, int64_t count);

/* Which float of the cell of a grid each coordinate is. See light.c. */
#define NO_FLOAT (INT64_C(1) << 40)
typedef struct {
    Words slots;  /* 3 x 9: by the last three answers where a value comes again, and one where it is new */
    Longs latest; /* 3: bits of the last three answers on each axis where a value came again */
    Longs2 known; /* 3 x values: the last float in each cell of an axis, or `NO_FLOAT` */
} Floats;

int64_t code_floats(RangeCoder *coder, Floats floats, ConstInts2 values, ConstLongs2 low, ConstLongs2 nearest,
    ConstLongs2 high, Longs2 chosen);

/* Levels around a prediction. See layer.simd.c. */
/* Each n x 3 but the last. */
typedef struct {
    Ints2 levels; /* at most 2^20 in magnitude */
    Ints2 gaps;   /* level less guess, in 1/16 */
    Ints2 means;  /* of a level and those of its coded neighbors, in 1/16 */
    Longs2 learners;
} Levels;

int64_t ISA(code_levels)(
    RangeCoder *coder, const Bank *bank, Corners corners, Levels levels, int64_t first, int64_t count);
