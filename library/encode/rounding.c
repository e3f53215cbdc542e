/* Which grid positions are coded on, and where on it they are (encoder only). */
#include "library/encode/encoding.h"

#ifdef BSMDEC_WRITES

enum { MOST_CELLS = 65535, /* where floats are exact */ MOST_LARGEST = (1 << 20) - 1, MOST_MOVES = 4 };
static const double PART_OF_CELL = 1.0 / 64.0;

static const double TENS[] = {1e-45, 1e-44, 1e-43, 1e-42, 1e-41, 1e-40, 1e-39, 1e-38, 1e-37, 1e-36, 1e-35, 1e-34, 1e-33,
    1e-32, 1e-31, 1e-30, 1e-29, 1e-28, 1e-27, 1e-26, 1e-25, 1e-24, 1e-23, 1e-22, 1e-21, 1e-20, 1e-19, 1e-18, 1e-17,
    1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1e0, 1e1,
    1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21,
    1e22, 1e23, 1e24, 1e25, 1e26, 1e27, 1e28, 1e29, 1e30, 1e31, 1e32, 1e33, 1e34, 1e35, 1e36, 1e37, 1e38};

double range_of(const Table *t, double *low, double *high) {
    double extent = 0.0;
    for (int j = 0; j < t->components; j++) {
        low[j] = high[j] = load_number(t->values, j, t->kind);
        for (int64_t i = 0; i < t->rows; i++) {
            double number = load_number(t->values, i * t->components + j, t->kind);
            if (number < low[j]) low[j] = number;
            if (number > high[j]) high[j] = number;
        }
        if (high[j] - low[j] > extent) extent = high[j] - low[j];
    }
    return extent;
}

double reach_of(const double *low, const double *high, int count) {
    double most = 0.0;
    for (int j = 0; j < count; j++) {
        if (-low[j] > most) most = -low[j];
        if (high[j] > most) most = high[j];
    }
    return most;
}

/* The next number of single or double precision. */
static double next_number(double value, bool narrow, int way) {
    if (narrow) {
        float number = (float)value;
        uint32_t bits;
        memcpy(&bits, &number, sizeof bits);
        bits += (uint32_t)way;
        memcpy(&number, &bits, sizeof bits);
        return number;
    }
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    bits += (uint64_t)(int64_t)way;
    memcpy(&value, &bits, sizeof bits);
    return value;
}

double spacing_of(double value, bool narrow) {
    double number = narrow ? (float)value : value;
    return next_number(number, narrow, 1) - number;
}

static bool within_floats(double value) { return value >= -FLT_MAX && value <= FLT_MAX; }

/* What numbers of single precision are apart from the next: 0 if there is none. */
static double spacing_of_float(double value) { return within_floats((float)value) ? spacing_of(value, true) : 0.0; }

static void note_largest(Rounded *rounded) {
    memset(rounded->largest, 0, sizeof rounded->largest);
    for (int64_t i = 0; i < 3 * rounded->places.rows; i++)
        if (rounded->places.data[i] > rounded->largest[i % 3]) rounded->largest[i % 3] = rounded->places.data[i];
}

/* Whether all positions lie on the grid with a step. */
static bool lies_on(ConstDoubles2 positions, const double *low, double step, Rounded *rounded) {
    memcpy(rounded->origin, low, sizeof rounded->origin);
    rounded->step = step;
    for (int64_t i = 0; i < 3 * positions.rows; i++) {
        double place = __builtin_rint((positions.data[i] - low[i % 3]) / step);
        if (!(place <= INT32_MAX)) return false;
        rounded->places.data[i] = (int32_t)place;
        if (rounded_at(rounded, i / 3, (int)(i % 3)) != positions.data[i]) return false;
    }
    note_largest(rounded);
    return true;
}

/* The grid with so many cells that positions were made on, in single precision or in double. */
static bool was_made_on(ConstDoubles2 positions, const double *low, double extent, double cells, bool narrow,
    Rounded *rounded) {
    double near = extent / cells;
    if (narrow) near = within_floats(near) ? (float)near : 0.0;
    if (!(near > 0.0) || !is_finite(near)) return false;
    for (int way = 0; way < 3; way++) {
        double step = way == 0 ? near : next_number(near, narrow, way == 1 ? -1 : 1);
        if (step > 0.0 && is_finite(step) && lies_on(positions, low, step, rounded)) return true;
    }
    return false;
}

static void round_narrowly(ConstDoubles2 positions, const double *low, const double *high, float cells,
    Rounded *rounded) {
    float extent = 0.0f;
    for (int j = 0; j < 3; j++) {
        float side = (float)in_single(high[j]) - (float)in_single(low[j]);
        if (side > extent) extent = side;
    }
    if (!(extent > 0.0f)) extent = 1.0f;
    float factor = cells / extent;
    for (int j = 0; j < 3; j++) {
        float first = (float)low[j];
        rounded->origin[j] = in_single(low[j]);
        for (int64_t i = 0; i < positions.rows; i++)
            rounded->places.data[3 * i + j] =
                (int32_t)__builtin_floorf(((float)positions.data[3 * i + j] - first) * factor + 0.5f);
    }
    rounded->step = (double)(extent / cells);
}

static void round_widely(ConstDoubles2 positions, const double *low, double extent, double cells, Rounded *rounded) {
    if (!(extent > 0.0)) extent = 1.0;
    double factor = cells / extent;
    for (int64_t i = 0; i < 3 * positions.rows; i++)
        rounded->places.data[i] = (int32_t)__builtin_floor((positions.data[i] - low[i % 3]) * factor + 0.5);
    memcpy(rounded->origin, low, sizeof rounded->origin);
    rounded->step = extent / cells;
}

bool round_to_bits(Context *context, ConstDoubles2 positions, int bits, Rounded *rounded) {
    double low[3], high[3], extent = box_of(positions, low, high), most = reach_of(low, high, 3);
    double cells = (double)((INT64_C(1) << bits) - 1), factor = cells / (extent > 0.0 ? extent : 1.0);
    float apart = (float)spacing_of_float(most) * (float)cells;
    bool narrow = apart > 0.0f && (double)apart < PART_OF_CELL * extent && within_floats(2.0 * (extent + factor));
    rounded->exact = false;
    if (!is_finite(extent) || !is_finite(factor))
        return FAIL(context, UNREACHABLE, "a grid of # bits is beyond the range of numbers for this mesh", bits);
    if (was_made_on(positions, low, extent, cells, narrow, rounded)) return true;
    if (narrow) round_narrowly(positions, low, high, (float)cells, rounded);
    else round_widely(positions, low, extent, cells, rounded);
    note_largest(rounded);
    return (rounded->step > 0.0 && is_finite(rounded->step))
        || FAIL(context, UNREACHABLE, "a grid of # bits is beyond the range of numbers for this mesh", bits);
}

/* Whether places counted from `least` are as they were counted from the origin. */
static bool counts_from(ConstDoubles2 positions, double cell, const double *origin, const double *least,
    Rounded *rounded) {
    const double everywhere = -(double)(MOST_LARGEST / 2 + 1);
    rounded->step = cell;
    for (int j = 0; j < 3; j++) rounded->origin[j] = least[j] * cell + origin[j];
    for (int64_t i = 0; i < 3 * positions.rows; i++) {
        int j = (int)(i % 3);
        double place = __builtin_floor((positions.data[i] - origin[j]) / cell + 0.5), coded = place - least[j];
        if (!(coded >= 0.0 && coded <= MOST_LARGEST)) return false;
        rounded->places.data[i] = (int32_t)coded;
        double wanted = (place - everywhere) * cell + (everywhere * cell + origin[j]);
        if (rounded_at(rounded, i / 3, j) != wanted) return false;
    }
    note_largest(rounded);
    return true;
}

bool round_to_cells(Context *context, ConstDoubles2 positions, double cell, const double *origin, Rounded *rounded) {
    const double everywhere = -(double)(MOST_LARGEST / 2 + 1), all[3] = {everywhere, everywhere, everywhere};
    double low[3], high[3], none[3] = {0.0, 0.0, 0.0};
    bool large = false;
    rounded->exact = false;
    box_of(positions, low, high);
    for (int j = 0; j < 3; j++) {
        low[j] = __builtin_floor((low[j] - origin[j]) / cell + 0.5);
        high[j] = __builtin_floor((high[j] - origin[j]) / cell + 0.5);
        /* Beyond 2^53, the next number is not the next place. */
        if (!(low[j] > -0x1p53 && high[j] < 0x1p53))
            return FAIL(context, UNREACHABLE, "the cells are too small to count from the origin to this mesh");
        large = large || high[j] - low[j] > MOST_LARGEST;
    }
    if (counts_from(positions, cell, origin, low, rounded) || counts_from(positions, cell, origin, none, rounded)
        || counts_from(positions, cell, origin, all, rounded))
        return true;
    return large ? FAIL(context, UNREACHABLE, "this mesh is larger than # cells; choose larger ones", MOST_LARGEST)
                 : FAIL(context, UNREACHABLE, "this mesh is more than # cells from the origin, too far to tell places "
                     "exactly; choose a nearer origin, or a power of two as cell and multiples of it as origin",
                       MOST_LARGEST / 2);
}

/* A power of ten of which all coordinates are multiples, but for rounding to single precision; 0 if there is none. */
static double decimal_step(ConstDoubles2 positions, double least) {
    int power = (int)(sizeof TENS / sizeof *TENS);
    double low[3], high[3], extent = box_of(positions, low, high), reach = extent > least ? extent : least;
    while (power > 0 && TENS[power - 1] > reach) power--;
    while (power-- > 0) {
        double step = TENS[power];
        bool fits = step >= least;
        for (int j = 0; j < 3; j++)
            fits = fits && __builtin_rint(high[j] / step) - __builtin_rint(low[j] / step) < MOST_LARGEST - 1;
        if (!fits) return 0.0;
        for (int64_t i = 0; fits && i < 3 * positions.rows; i++)
            fits = in_single(__builtin_rint(positions.data[i] / step) * step) == positions.data[i];
        if (fits) return step;
    }
    return 0.0;
}

bool round_exactly(Context *context, ConstDoubles2 positions, Rounded *rounded) {
    double low[3], high[3], extent = box_of(positions, low, high);
    double coarsest = 2.0 * spacing_of_float(reach_of(low, high, 3)); /* in a smaller cell there may be no float */
    double step = decimal_step(positions, coarsest);
    if (step == 0.0) step = extent / MOST_CELLS > coarsest ? extent / MOST_CELLS : coarsest;
    if (!is_finite(step)) return FAIL(context, UNREACHABLE, "this mesh is as large as numbers can be; scale it");
    rounded->exact = true;
    rounded->step = step;
    for (int j = 0; j < 3; j++) rounded->origin[j] = (__builtin_floor(low[j] / step) - 1.0) * step;
    for (int64_t i = 0; i < 3 * positions.rows; i++) {
        double origin = rounded->origin[i % 3];
        int64_t place = (int64_t)__builtin_floor((positions.data[i] - origin) / step + 0.5);
        int64_t number = number_of_float(positions.data[i]);
        for (int move = 0; move < MOST_MOVES; move++) { /* where rounding has put it beside its cell */
            double down = ((double)place - 0.5) * step, up = ((double)place + 0.5) * step;
            place += (number >= number_of_float(up + origin)) - (number < number_of_float(down + origin));
        }
        if (!(place >= 0 && place <= MOST_LARGEST))
            return FAIL(context, UNREACHABLE, "this mesh is too large for its smallest coordinates");
        rounded->places.data[i] = (int32_t)place;
    }
    note_largest(rounded);
    return true;
}

#endif
