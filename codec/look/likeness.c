/* How much two pictures differ: structural dissimilarity, and pixels that differ visibly. */
#include "codec/look/look.h"

#define WIDE 5   /* pixels to each side that the wide blur reaches */
#define NARROW 3 /* those of the narrow one */
#define KEPT (2 * WIDE + 1)
#define NEAR (WIDE + NARROW) /* rows to each side that those that blurs of a row go into are marked by */
#define STRIP 16
#define WINDOW 8 /* pixels of a side of the squares that parts may be gone from */
#define BACKGROUND 1.0f
#define LOUD 1.0f /* what a face is blamed for a pixel that differs visibly, beside its dissimilarity */
#define COVERED 0.999f
#define STEADY_MEAN 1e-4f
#define STEADY_SPREAD 9e-4f
#define HIDING 0.05f /* a standard deviation of shades that hides half of a difference */
enum { X, Y, SQUARES, XY, FIELDS, SUMS = 5, LANES = 8 /* sums side by side */ };

typedef struct {
    int64_t start, end;
} Span;

INLINE bool covered(const float *x, const float *y, int64_t count) {
    int32_t any = 0;
    _Pragma("GCC unroll 1") /* one vector at a time */
    for (int64_t i = 0; i < count; i++) any |= (x[i] < COVERED) | (y[i] < COVERED);
    return any;
}

/* The columns of a row from the first that either picture covers to behind the last one. */
INLINE Span covered_of(ConstSingles2 first, ConstSingles2 second, int64_t row) {
    Span span = {0, 0};
    if (row < 0 || row >= first.rows) return span;
    const float *x = first.data + row * first.columns, *y = second.data + row * first.columns;
    span.end = first.columns;
    while (span.end - span.start >= STRIP && !covered(x + span.start, y + span.start, STRIP)) span.start += STRIP;
    while (span.start < span.end && !covered(x + span.start, y + span.start, 1)) span.start++;
    while (span.end - span.start >= STRIP && !covered(x + span.end - STRIP, y + span.end - STRIP, STRIP))
        span.end -= STRIP;
    while (span.end > span.start && !covered(x + span.end - 1, y + span.end - 1, 1)) span.end--;
    return span;
}

INLINE Span joined(Span a, Span b) {
    if (a.start >= a.end || b.start >= b.end) return a.start < a.end ? a : b;
    return (Span){least(a.start, b.start), largest(a.end, b.end)};
}

/* Where pixels may differ of which some of these rows have some nearby, within the columns of `box`. */
INLINE Span around(const Span *spans, int64_t count, Span box) {
    Span all = spans[0];
    for (int64_t i = 1; i < count; i++) all = joined(all, spans[i]);
    return (Span){largest(all.start - NARROW, box.start), least(all.end + NARROW, box.end)};
}

/* What of a row of both pictures blurs need, with background around it and above and below. */
INLINE void take_row(ConstSingles2 first, ConstSingles2 second, int64_t row, Span span, float *x, float *y) {
    for (int64_t i = span.start; i < span.end + 2 * WIDE; i++) x[i] = y[i] = BACKGROUND;
    if (row < 0 || row >= first.rows) return;
    const float *one = first.data + row * first.columns, *other = second.data + row * first.columns;
    for (int64_t i = largest(span.start - WIDE, 0); i < least(span.end + WIDE, first.columns); i++) {
        x[WIDE + i] = one[i];
        y[WIDE + i] = other[i];
    }
}

INLINE void blur(const float *restrict from, float *restrict to, int64_t start, int64_t end, const float *weights,
                 int64_t reach) {
    for (int64_t i = start; i < end; i++) {
        const float *at = from + i + WIDE;
        float sum = weights[0] * at[0];
        for (int64_t k = 1; k <= reach; k++) sum += weights[k] * (at[-k] + at[k]);
        to[i] = sum;
    }
}

/* The same down a column: `rows` are those that are kept, in a ring, `middle` the place of the one at hand. */
INLINE void blur_down(const float *restrict rows, int64_t stride, int64_t middle, float *restrict to, int64_t start,
                      int64_t end, const float *weights, int64_t reach) {
    const float *center = rows + middle * stride, *above[WIDE], *below[WIDE];
    for (int64_t k = 0; k < reach; k++) {
        above[k] = rows + (middle + KEPT - 1 - k) % KEPT * stride;
        below[k] = rows + (middle + 1 + k) % KEPT * stride;
    }
    for (int64_t i = start; i < end; i++) {
        float sum = weights[0] * center[i];
        for (int64_t k = 0; k < reach; k++) sum += weights[k + 1] * (above[k][i] + below[k][i]);
        to[i] = sum;
    }
}

/* Marks of this row, column sums of the last `WINDOW` rows, and the most marks in a square that ends here. */
INLINE int64_t densest(const float *marks, float *restrict ring, float *restrict columns, int64_t start, int64_t end) {
    int32_t any = 0, most = 0;
    for (int64_t i = start; i < end; i++) {
        columns[i] += marks[i] - ring[i];
        ring[i] = marks[i];
        any |= columns[i] > 0.0f;
    }
    for (int64_t i = start; any && i < end; i++) { /* columns behind the last one are empty */
        float sum = 0.0f;
        for (int64_t k = 0; k < WINDOW; k++) sum += columns[i + k];
        int32_t found = (int32_t)sum;
        most = found > most ? found : most;
    }
    return most;
}

/* `wide` and `narrow` are the halves of both blurs, from the middle. Over pixels that either picture covers, to `sums`:
 * of 1 - SSIM; how many differ by more than `visible` after the narrow blur; how many there are; how many
 * differ by more than `plain` in the square that has most of these; and the fourth powers of differences after
 * the wide blur, each less where shades around it vary. To `blamed`, which may be empty, comes for each
 * face how unlike the pixels are that show it, by `owner`: 1 - SSIM, and up to 1 by the square of a difference. */
KERNEL int64_t likeness(ConstSingles2 first, ConstSingles2 second, ConstSingles wide, ConstSingles narrow,
                        double visible, double plain, Singles2 scratch, Doubles sums, ConstInts2 owner,
                        Doubles blamed) {
    int64_t stride = scratch.columns;
    if (first.rows != second.rows || first.columns != second.columns || wide.size != WIDE + 1 ||
        narrow.size != NARROW + 1 || sums.size != SUMS || stride < first.columns + 2 * WIDE ||
        (blamed.size && (owner.rows != first.rows || owner.columns != first.columns)) ||
        scratch.rows < (FIELDS + 1) * (KEPT + 2) + WINDOW + 2)
        return MISUSED;
    float *padded = scratch.data, *down = padded + (FIELDS + 1) * stride, *ring = down + (FIELDS + 1) * stride;
    float *x = padded, *y = padded + stride, *difference = padded + FIELDS * stride;
    double dissimilar[LANES] = {0.0}, striking[LANES] = {0.0};
    float *marks = ring + (FIELDS + 1) * KEPT * stride, *columns = marks + stride, *marked = columns + stride;
    int64_t seen = 0, count = 0, gone = 0;
    for (int i = 0; i < SUMS; i++) sums.data[i] = 0.0;
    for (int64_t i = 0; i < (WINDOW + 2) * stride; i++) marks[i] = 0.0f;
    Span box = {0, 0}, high = {0, 0}, near[2 * NEAR + 1];
    for (int64_t row = 0; row < first.rows; row++) {
        Span span = covered_of(first, second, row);
        box = joined(box, span);
        if (span.start < span.end) high = joined(high, (Span){row, row + 1});
    }
    if (box.start >= box.end) return 0;
    for (int64_t i = 0; i <= 2 * NEAR; i++) near[i] = covered_of(first, second, high.start - WIDE - NEAR - 1 + i);
    for (int64_t row = high.start - WIDE; row < high.end + WIDE; row++) {
        for (int64_t i = 0; i < 2 * NEAR; i++) near[i] = near[i + 1];
        near[2 * NEAR] = covered_of(first, second, row + NEAR);
        int64_t place = (row + KEPT) % KEPT;
        Span some = around(near, 2 * NEAR + 1, box);
        take_row(first, second, row, some, x, y);
        for (int64_t i = some.start; i < some.end + 2 * WIDE; i++) {
            padded[SQUARES * stride + i] = x[i] * x[i] + y[i] * y[i];
            padded[XY * stride + i] = x[i] * y[i];
            difference[i] = x[i] - y[i];
        }
        for (int field = 0; field < FIELDS; field++)
            blur(padded + field * stride, ring + (field * KEPT + place) * stride, some.start, some.end, wide.data,
                WIDE);
        blur(difference, ring + (FIELDS * KEPT + place) * stride, some.start, some.end, narrow.data, NARROW);
        int64_t at = row - WIDE, middle = (at + KEPT) % KEPT;
        if (at < high.start) continue;
        Span part = around(near, 2 * NARROW + 1, box);
        int64_t from = part.start, to = part.end;
        for (int field = 0; field < FIELDS; field++)
            blur_down(ring + field * KEPT * stride, stride, middle, down + field * stride, from, to, wide.data, WIDE);
        blur_down(ring + FIELDS * KEPT * stride, stride, middle, down + FIELDS * stride, from, to, narrow.data, NARROW);
        float *one_less = down, *strikes = down + XY * stride;
        for (int64_t i = from; i < to; i++) {
            float mx = down[X * stride + i], my = down[Y * stride + i], product = mx * my;
            float squares = mx * mx + my * my, both = down[XY * stride + i] - product;
            float spread = down[SQUARES * stride + i] - squares;
            float same = (2.0f * product + STEADY_MEAN) * (2.0f * both + STEADY_SPREAD);
            one_less[i] = 1.0f - same / ((squares + STEADY_MEAN) * (spread + STEADY_SPREAD));
            float hidden = (mx - my) / (1.0f + __builtin_sqrtf(spread > 0.0f ? 0.5f * spread : 0.0f) / HIDING);
            strikes[i] = hidden * hidden * hidden * hidden;
        }
        const float *own = first.data + at * first.columns, *other = second.data + at * first.columns;
        const float *change = down + FIELDS * stride;
        int32_t inside = 0, differ = 0;
        for (int64_t i = from; i < to; i++) {
            bool counts = own[i] < COVERED || other[i] < COVERED;
            one_less[i] = counts ? one_less[i] : 0.0f;
            strikes[i] = counts ? strikes[i] : 0.0f;
            differ += counts & ((double)__builtin_fabsf(change[i]) > visible);
            inside += counts;
        }
        for (int64_t i = to; i < to + LANES - 1; i++) one_less[i] = strikes[i] = 0.0f;
        for (int64_t i = from; i < to; i += LANES)
            for (int64_t k = 0; k < LANES; k++) {
                dissimilar[k] += (double)one_less[i + k];
                striking[k] += (double)strikes[i + k];
            }
        seen += differ;
        count += inside;
        for (int64_t i = from; blamed.size && i < to; i++) {
            int64_t face = owner.data[at * owner.columns + i];
            float share = change[i] / (float)visible, soft = share * share < 1.0f ? share * share : 1.0f;
            if (face >= blamed.size) return MISUSED;
            if (face >= 0) blamed.data[face] += (double)(one_less[i] + LOUD * soft);
        }
        for (int64_t i = box.start; i < box.end; i++) marks[i] = 0.0f;
        for (int64_t i = from; i < to; i++) marks[i] = (double)__builtin_fabsf(change[i]) > plain ? 1.0f : 0.0f;
        gone = largest(gone, densest(marks, marked + at % WINDOW * stride, columns, box.start, box.end));
    }
    for (int k = 0; k < LANES; k++) sums.data[0] += dissimilar[k], sums.data[4] += striking[k];
    sums.data[1] = (double)seen;
    sums.data[2] = (double)count;
    sums.data[3] = (double)gone;
    return 0;
}
