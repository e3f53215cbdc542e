/* Values of attributes as whole numbers that keep a quality (encoder only; specification, A). */
#include "library/encode/encoding.h"


#ifdef BSMDEC_WRITES

enum { NEAR_ZERO = 1 << 20, /* what is below costs less than an offset */ LEAST_NORMAL_BITS = 2, MOST_NORMAL_BITS = 16,
    MOST_ROUNDED_BITS = 24 /* of a float; what is finer is exact */ };
static const double SLACK = 1.0 - 0x1p-20, MOST_LEVEL = UINT32_MAX, USUAL_STEPS[] = {1.0, 1.0 / 255.0, 1.0 / 65535.0};

/* The arc tangent of a number that is not negative: halved until its series is short. */
static double arc_tangent(double x) {
    double sum = 0.0, power, square, factor = 1.0;
    if (!(x < 0x1p60)) return 1.5707963267948966;
    for (; x > 0.1; factor *= 2.0) x = x / (1.0 + __builtin_sqrt(1.0 + x * x));
    square = x * x;
    power = x;
    for (int k = 1; k < 20; k += 2) {
        sum += k % 4 == 1 ? power / k : -power / k;
        power *= square;
    }
    return factor * sum;
}

double degrees_between(const double *vector, const double *unit) {
    double across[3] = {vector[1] * unit[2] - vector[2] * unit[1], vector[2] * unit[0] - vector[0] * unit[2],
        vector[0] * unit[1] - vector[1] * unit[0]};
    double sine = __builtin_sqrt((across[0] * across[0] + across[1] * across[1]) + across[2] * across[2]);
    double cosine = (vector[0] * unit[0] + vector[1] * unit[1]) + vector[2] * unit[2];
    double angle = arc_tangent(sine / (cosine < 0.0 ? -cosine : cosine));
    if (sine == 0.0) angle = 0.0;
    return (cosine < 0.0 ? 3.141592653589793 - angle : angle) * (180.0 / 3.141592653589793);
}

static double number_at(const Table *t, int64_t place) { return load_number(t->values, place, t->kind); }

static bool none_below(const double *low, int count, double least) {
    for (int j = 0; j < count; j++)
        if (low[j] < least) return false;
    return true;
}
static double greatest(const double *high, int count) {
    double most = high[0];
    for (int j = 1; j < count; j++) most = high[j] > most ? high[j] : most;
    return most;
}

/* Declare the largest levels, with offsets and one step. */
static void declare_levels(Quantized *q, int coding, const double *offset, double step) {
    Declaration *d = &q->declaration;
    d->coding = coding;
    d->words = (int)q->levels.columns;
    memset(d->largest, 0, sizeof d->largest);
    for (int64_t i = 0; i < q->levels.rows * d->words; i++)
        if (q->levels.data[i] > d->largest[i % d->words]) d->largest[i % d->words] = (uint32_t)q->levels.data[i];
    for (int j = 0; j < d->words; j++) {
        d->offset[j] = offset != NULL ? offset[j] + 0.0 : 0.0;
        d->step[j] = step;
    }
}

static void note_error(Quantized *q, double error) {
    if (error < 0.0) error = -error;
    if (error > q->outcome.error) q->outcome.error = error;
}

/* Integers: exact, or in steps that are whole numbers, too. */
static void quantize_whole(const Table *t, bsmenc_quality quality, double amount, Quantized *q) {
    double low[MOST_COMPONENTS], high[MOST_COMPONENTS], extent = range_of(t, low, high);
    int64_t step = 1;
    if (quality == BSMENC_BITS) {
        int64_t most = (INT64_C(1) << (int)amount) - 1;
        step = extent > 0.0 ? ((int64_t)extent + most - 1) / most : 1;
    } else if (quality == BSMENC_BOUND || quality == BSMENC_SHARE) {
        double bound = quality == BSMENC_BOUND ? amount : amount / 100.0 * extent;
        step = 2 * (int64_t)(bound < 0x1p40 ? bound : 0x1p40) + 1;
    }
    if (step == 1 && none_below(low, t->components, 0.0) && greatest(high, t->components) < NEAR_ZERO)
        memset(low, 0, sizeof low);
    for (int j = 0; j < t->components; j++) {
        /* The last level may not lie beyond the range of the kind: where it would, begin so much lower. */
        int64_t first = (int64_t)low[j], levels = ((int64_t)high[j] - first + step / 2) / step;
        int64_t beyond = first + levels * step - (int64_t)high[j];
        int64_t room = least(step / 2, first - (int64_t)LEAST_OF[t->kind]);
        low[j] -= (double)largest(least(beyond, room), 0);
    }
    for (int64_t i = 0; i < t->rows * t->components; i++) {
        int64_t first = (int64_t)low[i % t->components], number = (int64_t)number_at(t, i);
        int64_t level = least((number - first + step / 2) / step, ((int64_t)UNIT_OF[t->kind] - first) / step);
        double error = (double)(first + level * step - number);
        q->levels.data[i] = level;
        note_error(q, error);
    }
    q->outcome.step = step > 1 ? (double)step : 0.0;
    declare_levels(q, LEVELS, low, (double)step);
}

/* Floats as multiples of a usual step, if they are that to the bit. */
static bool are_multiples(const Table *t, const double *lowest, double most, double step, Quantized *q) {
    double low[MOST_COMPONENTS] = {0}, offset[MOST_COMPONENTS];
    for (int j = 0; j < t->components; j++) {
        low[j] = __builtin_floor(lowest[j] / step);
        if (!(low[j] < 0x1p40 && low[j] > -0x1p40)) return false;
    }
    bool narrow = t->kind == BSMDEC_FLOAT32;
    double times = narrow ? (double)((float)most / (float)step) : most / step;
    if (none_below(low, t->components, 0.0) && times < NEAR_ZERO) memset(low, 0, sizeof low);
    for (int j = 0; j < t->components; j++) offset[j] = low[j] * step;
    for (int64_t i = 0; i < t->rows * t->components; i++) {
        int j = (int)(i % t->components);
        double number = number_at(t, i);
        double level = __builtin_rint((narrow ? (double)((float)number / (float)step) : number / step) - low[j]);
        if (!(level >= 0.0 && level <= MOST_LEVEL)) return false;
        double product = step * level, back = offset[j] + product;
        if (narrow) back = in_single(back);
        if (memcmp(&back, &number, sizeof back) != 0) return false;
        q->levels.data[i] = (int64_t)level;
    }
    declare_levels(q, LEVELS, offset, step);
    return true;
}

/* The bits of a float as whole numbers of 32 bits that ascend with it; of a double two, the higher first. */
static void words_of(double number, bool wide, int64_t *word) {
    uint64_t bits, top = UINT64_C(1) << (wide ? 63 : 31);
    if (wide) {
        memcpy(&bits, &number, sizeof bits);
    } else {
        float narrow = (float)number;
        uint32_t half;
        memcpy(&half, &narrow, sizeof half);
        bits = half;
    }
    bits = bits & top ? ~bits : bits | top;
    if (wide) *word++ = (int64_t)(bits >> 32);
    *word = (int64_t)(bits & UINT32_MAX);
}

/* Floats, to the bit. */
static bool keep_floats(const Table *t, Arena *arena, Quantized *q) {
    double low[MOST_COMPONENTS], high[MOST_COMPONENTS], offset[MOST_WORDS];
    bool wide = t->kind == BSMDEC_FLOAT64;
    range_of(t, low, high);
    for (int k = 0; k < 3; k++)
        if (are_multiples(t, low, greatest(high, t->components), USUAL_STEPS[k], q)) return true;
    int64_t words = t->components * (1 + wide);
    if (!take_longs2(arena, t->rows, words, &q->levels)) return false;
    for (int64_t i = 0; i < t->rows * t->components; i++)
        words_of(number_at(t, i), wide, q->levels.data + i * (1 + wide));
    for (int64_t j = 0; j < words; j++) {
        int64_t first = INT64_MAX;
        for (int64_t i = 0; i < t->rows; i++) first = least(first, q->levels.data[words * i + j]);
        for (int64_t i = 0; i < t->rows; i++) q->levels.data[words * i + j] -= first;
        offset[j] = (double)first;
    }
    declare_levels(q, BITS, offset, 1.0);
    return true;
}

/* Floats in steps; to the bit, if the bound leaves their rounding no room. */
static bool round_floats(Context *context, const Table *t, bsmenc_quality quality, double amount, Arena *arena,
    Quantized *q) {
    double low[MOST_COMPONENTS], high[MOST_COMPONENTS], extent = range_of(t, low, high), bound, step;
    if (!(extent - extent == 0.0))
        return FAIL(context, MISUSED, "the range of values is beyond that of numbers; keep them exact");
    double most = reach_of(low, high, t->components);
    if (quality == BSMENC_BITS) {
        double levels = (double)((INT64_C(1) << (int)amount) - 1);
        bool unit = q->declaration.semantic == BSMDEC_COLOR && none_below(low, t->components, 0.0)
            && greatest(high, t->components) <= 1.0;
        step = unit ? 1.0 / levels : extent / levels;
        if (unit) memset(low, 0, sizeof low);
        if (!(step > 0.0)) step = 1.0;
        bound = step / 2 * (1.0 + 1e-6) + spacing_of(most, t->kind == BSMDEC_FLOAT32);
    } else {
        bound = quality == BSMENC_BOUND ? amount : amount / 100.0 * extent;
        double rounded = spacing_of(most + bound, t->kind == BSMDEC_FLOAT32) / 2;
        step = 2.0 * (bound - rounded) * SLACK;
        if (step < rounded) return keep_floats(t, arena, q);
    }
    if (!(step >= 1e-300 && step <= 1e300 && most + step <= 1e300))
        return FAIL(context, MISUSED, "values or their step are beyond the range of numbers; keep them exact");
    for (int j = 0; j < t->components && q->declaration.semantic == BSMDEC_NORMAL; j++)
        low[j] = step * __builtin_floor(low[j] / step); /* a normal of no length keeps none */
    for (int j = 0; j < t->components; j++)
        if ((high[j] - low[j]) / step > MOST_LEVEL)
            return FAIL(context, MISUSED, "the bound is too fine for the range of values; keep them exact");
    for (int64_t i = 0; i < t->rows * t->components; i++) {
        int j = (int)(i % t->components);
        double number = number_at(t, i), level = __builtin_rint((number - low[j]) / step), product = step * level;
        double back = low[j] + product;
        if (t->kind == BSMDEC_FLOAT32) back = in_single(back);
        q->levels.data[i] = (int64_t)level;
        note_error(q, back - number);
    }
    declare_levels(q, LEVELS, low, step);
    return q->outcome.error <= bound
        || FAIL(context, UNREACHABLE, "numbers of this kind cannot be kept within the bound");
}

static void fold(int64_t size, int64_t *u, int64_t *v) {
    int64_t across = *u < 0 ? -*u : *u, along = *v < 0 ? -*v : *v;
    *u = (*u < 0 ? -1 : 1) * (size - along);
    *v = (*v < 0 ? -1 : 1) * (size - across);
}

/* The nearest of the four places around a unit vector on the unfolded octahedron, as a decoder has it. */
static void place_of(const double *unit, int64_t size, int64_t *place) {
    double sum = (__builtin_fabs(unit[0]) + __builtin_fabs(unit[1])) + __builtin_fabs(unit[2]), middle = (double)size;
    double x = unit[0] / sum, y = unit[1] / sum, z = unit[2] / sum, closest = 0.0;
    double u = (z < 0.0 ? __builtin_copysign(1.0 - __builtin_fabs(y), x) : x) * middle + middle;
    double v = (z < 0.0 ? __builtin_copysign(1.0 - __builtin_fabs(x), y) : y) * middle + middle;
    for (int k = 0; k < 4; k++) {
        int64_t word[2] = {largest(least((int64_t)__builtin_floor(u) + k / 2, 2 * size), 0),
            largest(least((int64_t)__builtin_floor(v) + k % 2, 2 * size), 0)};
        double direction[3];
        unfold_direction(word, size, direction);
        double close = (direction[0] * unit[0] + direction[1] * unit[1]) + direction[2] * unit[2];
        if (k > 0 && !(close > closest)) continue;
        closest = close;
        memcpy(place, word, sizeof word);
    }
    int64_t a = place[0] - size, b = place[1] - size;
    if ((a < 0 ? -a : a) + (b < 0 ? -b : b) > size) {
        fold(size, &a, &b);
        fold(size, &a, &b);
        place[0] = a + size;
        place[1] = b + size;
    }
}

double direction_of(const double *vector, double *unit) {
    double most = 0.0, scale = 1.0;
    for (int j = 0; j < 3; j++) most = __builtin_fabs(vector[j]) > most ? __builtin_fabs(vector[j]) : most;
    if (most > 0x1p500 || most < 0x1p-500) scale = most > 0.0 ? most : 1.0; /* whose squares overflow or vanish */
    for (int j = 0; j < 3; j++) unit[j] = vector[j] / scale;
    double length = __builtin_sqrt((unit[0] * unit[0] + unit[1] * unit[1]) + unit[2] * unit[2]);
    for (int j = 0; j < 3; j++) unit[j] = length > 0.0 ? unit[j] / length : j == 2 ? 1.0 : 0.0;
    return length > 0.0 ? length * scale : 0.0;
}

static double unit_of(const Table *t, int64_t row, double *unit) {
    const double vector[3] = {number_at(t, 3 * row), number_at(t, 3 * row + 1), number_at(t, 3 * row + 2)};
    return direction_of(vector, unit);
}

/* Levels of normals with so many bits: places on an octahedron; or in a cube, if some have no length and keep none. */
static void place_normals(const Table *t, int bits, Quantized *q) {
    const double below[3] = {-1.0, -1.0, -1.0};
    int64_t size = (INT64_C(1) << (bits - 1)) - 1;
    double step = 2.0 / (double)(INT64_C(1) << bits);
    bool some = q->outcome.zeros > 0;
    q->outcome.error = 0.0;
    for (int64_t i = 0; i < t->rows; i++) {
        double unit[3], back[3], length = unit_of(t, i, unit), zero[3] = {0.0, 0.0, 0.0};
        int64_t *level = q->levels.data + q->levels.columns * i;
        const double *wide = length > 0.0 ? unit : zero;
        if (!some) {
            place_of(unit, size, level);
            unfold_direction(level, size, back);
        }
        for (int j = 0; j < 3 && some; j++) {
            level[j] = (int64_t)__builtin_rint((wide[j] + 1.0) / step);
            back[j] = length > 0.0 ? (double)level[j] * step - 1.0 : unit[j];
        }
        for (int j = 0; j < 3 && !some && t->kind == BSMDEC_FLOAT32; j++) back[j] = in_single(back[j]);
        note_error(q, degrees_between(back, unit));
    }
    declare_levels(q, some ? LEVELS : OCTAHEDRAL, some ? below : NULL, some ? step : 1.0);
    if (!some) q->declaration.largest[0] = q->declaration.largest[1] = (uint32_t)(2 * size);
    q->outcome.bits = bits;
}

static bool quantize_normals(Context *context, const Table *t, bsmenc_quality quality, double amount, Arena *arena,
    Quantized *q) {
    int first = LEAST_NORMAL_BITS, last = MOST_NORMAL_BITS;
    if (quality == BSMENC_BITS) first = last = (int)largest(first, least((int64_t)amount, last));
    for (int64_t i = 0; i < t->rows; i++) {
        double unit[3], length = unit_of(t, i, unit);
        q->outcome.zeros += length == 0.0;
        q->outcome.scaled |= length > 0.0 && __builtin_fabs(length - 1.0) > 1e-3;
    }
    if (!take_longs2(arena, t->rows, q->outcome.zeros > 0 ? 3 : 2, &q->levels)) return false;
    for (int bits = first; bits <= last; bits++) {
        place_normals(t, bits, q);
        if (quality == BSMENC_BITS || q->outcome.error <= amount) return true;
    }
    return FAIL(context, UNREACHABLE, "normals cannot be kept within this angle");
}

bool quantize(Context *context, const void *values, int64_t rows, bsmenc_quality quality, double amount, Arena *arena,
    Quantized *q) {
    Declaration *d = &q->declaration;
    Table t = {values, rows, d->components, d->kind};
    bool floats = d->kind >= BSMDEC_FLOAT32, normals = d->semantic == BSMDEC_NORMAL && d->components == 3 && floats;
    q->outcome = (bsmenc_outcome){0};
    if (quality == BSMENC_RECOMPUTE || quality == BSMENC_ANGLE) {
        if (!normals) return FAIL(context, MISUSED, "this quality is for normals of three floats");
    }
    if (quality == BSMENC_RECOMPUTE) {
        d->coding = RECOMPUTED;
        d->words = 0;
        q->levels = (Longs2){NULL, 0, 0};
        return true;
    }
    if (quality == BSMENC_ANGLE || (quality == BSMENC_BITS && normals))
        return quantize_normals(context, &t, quality, amount, arena, q);
    if (!take_longs2(arena, rows, t.components, &q->levels)) return false;
    if (!floats) {
        quantize_whole(&t, quality, amount, q);
        return true;
    }
    if (quality == BSMENC_EXACT || (quality == BSMENC_BITS && amount > MOST_ROUNDED_BITS))
        return keep_floats(&t, arena, q);
    return round_floats(context, &t, quality, amount, arena, q);
}

#endif
