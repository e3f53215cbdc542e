/* How much two pictures differ: structural dissimilarity, and pixels that differ visibly. */
#include "codec/look/likeness.h"

#define WIDE 5   /* pixels to each side that the wide blur reaches */
#define NARROW 3 /* those of the narrow one */
#define KEPT (2 * WIDE + 1)
#define WINDOW 8 /* pixels of a side of the squares that parts may be gone from */
#define BACKGROUND 1.0f
#define LOUD 1.0f /* what a pixel that differs visibly counts in the map, beside its dissimilarity */
#define COVERED 0.999f
#define STEADY_MEAN 1e-4f
#define STEADY_SPREAD 9e-4f
enum { X, Y, SQUARES, XY, FIELDS };

INLINE bool covered(float a, float b) { return a < COVERED || b < COVERED; }

/* One row of both pictures, with background around it and above and below. */
INLINE void take_row(ConstSingles2 first, ConstSingles2 second, int64_t row, float *x, float *y) {
    int64_t width = first.columns, padded = width + 2 * WIDE;
    for (int64_t i = 0; i < padded; i++) x[i] = y[i] = BACKGROUND;
    if (row < 0 || row >= first.rows) return;
    for (int64_t i = 0; i < width; i++) {
        x[WIDE + i] = first.data[row * width + i];
        y[WIDE + i] = second.data[row * width + i];
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
    const float *centre = rows + middle * stride, *above[WIDE], *below[WIDE];
    for (int64_t k = 0; k < reach; k++) {
        above[k] = rows + (middle + KEPT - 1 - k) % KEPT * stride;
        below[k] = rows + (middle + 1 + k) % KEPT * stride;
    }
    for (int64_t i = start; i < end; i++) {
        float sum = weights[0] * centre[i];
        for (int64_t k = 0; k < reach; k++) sum += weights[k + 1] * (above[k][i] + below[k][i]);
        to[i] = sum;
    }
}

/* What is covered: behind the last column and from the first one; returns whether anything is. */
INLINE bool extent(ConstSingles2 first, ConstSingles2 second, int64_t *box) {
    box[0] = first.rows, box[1] = 0, box[2] = first.columns, box[3] = 0;
    for (int64_t row = 0; row < first.rows; row++) {
        const float *x = first.data + row * first.columns, *y = second.data + row * first.columns;
        int64_t left = 0, right = first.columns;
        while (left < right && !covered(x[left], y[left])) left++;
        if (left == right) continue;
        while (!covered(x[right - 1], y[right - 1])) right--;
        box[0] = least(box[0], row);
        box[1] = row + 1;
        box[2] = least(box[2], left);
        box[3] = largest(box[3], right);
    }
    return box[0] < box[1];
}

/* Marks of this row, those of the last `WINDOW` rows together by column, and the most of them in a square that ends here. */
INLINE int64_t densest(const float *marks, float *ring, float *columns, int64_t start, int64_t end) {
    float any = 0.0f;
    for (int64_t i = start; i < end; i++) {
        columns[i] += marks[i] - ring[i];
        ring[i] = marks[i];
        any = columns[i] > any ? columns[i] : any;
    }
    if (any == 0.0f) return 0;
    float sum = 0.0f, most = 0.0f;
    for (int64_t i = start; i < end; i++) {
        sum += columns[i] - (i >= start + WINDOW ? columns[i - WINDOW] : 0.0f);
        most = sum > most ? sum : most;
    }
    return (int64_t)most;
}

/* `wide` and `narrow` are the halves of both blurs, from the middle. Over pixels that either picture covers, to `sums`:
 * of 1 - SSIM; how many differ by more than `visible` after the narrow blur; how many there are; and how many
 * differ by more than `plain` in the square that has most of these. `map`, which may be empty, gets for each pixel how unlike
 * it is: 1 - SSIM, and up to as much again by the square of its difference. */
KERNEL int64_t likeness(ConstSingles2 first, ConstSingles2 second, ConstSingles wide, ConstSingles narrow,
                        double visible, double plain, Singles2 scratch, Doubles sums, Singles2 map) {
    int64_t stride = scratch.columns, box[4];
    if (first.rows != second.rows || first.columns != second.columns || wide.size != WIDE + 1 ||
        narrow.size != NARROW + 1 || sums.size != 4 || stride < first.columns + 2 * WIDE ||
        (map.rows && (map.rows != first.rows || map.columns != first.columns)) ||
        scratch.rows < (FIELDS + 1) * (KEPT + 2) + WINDOW + 2)
        return MISUSED;
    float *padded = scratch.data, *down = padded + (FIELDS + 1) * stride, *ring = down + (FIELDS + 1) * stride;
    float *x = padded, *y = padded + stride, *difference = padded + FIELDS * stride;
    double dissimilar = 0.0;
    float *marks = ring + (FIELDS + 1) * KEPT * stride, *columns = marks + stride, *marked = columns + stride;
    int64_t seen = 0, count = 0, gone = 0;
    for (int i = 0; i < 4; i++) sums.data[i] = 0.0;
    for (int64_t i = 0; i < (WINDOW + 2) * stride; i++) marks[i] = 0.0f;
    if (!extent(first, second, box)) return 0;
    int64_t from = box[2], to = box[3], width = first.columns + 2 * WIDE;
    for (int64_t row = box[0] - WIDE; row < box[1] + WIDE; row++) {
        int64_t place = (row + KEPT) % KEPT;
        take_row(first, second, row, x, y);
        for (int64_t i = 0; i < width; i++) {
            padded[SQUARES * stride + i] = x[i] * x[i] + y[i] * y[i];
            padded[XY * stride + i] = x[i] * y[i];
            difference[i] = x[i] - y[i];
        }
        for (int field = 0; field < FIELDS; field++)
            blur(padded + field * stride, ring + (field * KEPT + place) * stride, from, to, wide.data, WIDE);
        blur(difference, ring + (FIELDS * KEPT + place) * stride, from, to, narrow.data, NARROW);
        int64_t at = row - WIDE, middle = (at + KEPT) % KEPT;
        if (at < box[0]) continue;
        for (int field = 0; field < FIELDS; field++)
            blur_down(ring + field * KEPT * stride, stride, middle, down + field * stride, from, to, wide.data, WIDE);
        blur_down(ring + FIELDS * KEPT * stride, stride, middle, down + FIELDS * stride, from, to, narrow.data, NARROW);
        float *one_less = down;
        for (int64_t i = from; i < to; i++) {
            float mx = down[X * stride + i], my = down[Y * stride + i], product = mx * my;
            float squares = mx * mx + my * my, both = down[XY * stride + i] - product;
            float spread = down[SQUARES * stride + i] - squares;
            float same = (2.0f * product + STEADY_MEAN) * (2.0f * both + STEADY_SPREAD);
            one_less[i] = 1.0f - same / ((squares + STEADY_MEAN) * (spread + STEADY_SPREAD));
        }
        const float *own = first.data + at * first.columns, *other = second.data + at * first.columns;
        const float *change = down + FIELDS * stride;
        int32_t inside = 0, differ = 0;
        for (int64_t i = from; i < to; i++) {
            bool counts = covered(own[i], other[i]);
            one_less[i] = counts ? one_less[i] : 0.0f;
            differ += counts & ((double)__builtin_fabsf(change[i]) > visible);
            inside += counts;
        }
        for (int64_t i = from; i < to; i++) dissimilar += (double)one_less[i];
        seen += differ;
        count += inside;
        for (int64_t i = from; i < to && map.rows; i++) {
            float part = change[i] / (float)visible, soft = part * part < 1.0f ? part * part : 1.0f;
            map.data[at * first.columns + i] = covered(own[i], other[i]) ? one_less[i] + LOUD * soft : 0.0f;
        }
        for (int64_t i = from; i < to; i++) marks[i] = (double)__builtin_fabsf(change[i]) > plain ? 1.0f : 0.0f;
        gone = largest(gone, densest(marks, marked + at % WINDOW * stride, columns, from, to));
    }
    sums.data[0] = dissimilar;
    sums.data[1] = (double)seen;
    sums.data[2] = (double)count;
    sums.data[3] = (double)gone;
    return 0;
}
