/* Patches of faces, and the pairs of neighbouring faces inside each patch. */
#include "codec/denoise/filters/topology.h"

/* First place in an ascending row that is not below `value`. */
static int64_t place_of(const int32_t *row, int64_t size, int32_t value) {
    int64_t low = 0, high = size;
    while (low < high) {
        int64_t middle = (low + high) / 2;
        if (row[middle] < value) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

/* Each face with the faces that share a vertex with it, itself first; in a fan of more than 2 `crowd` faces only the
 * `crowd` before and behind. Returns the number of members; `seen` is scratch, one entry a face. */
int64_t face_patches(ConstInts2 faces, ConstLongs around_starts, ConstInts around, int64_t crowd, Ints seen, Longs starts,
                     Ints members) {
    int64_t end = 0;
    for (int64_t f = 0; f < faces.rows; f++) seen.data[f] = -1;
    starts.data[0] = 0;
    for (int64_t f = 0; f < faces.rows; f++) {
        seen.data[f] = (int32_t)f;
        members.data[end++] = (int32_t)f;
        for (int corner = 0; corner < 3; corner++) {
            int32_t v = faces.data[3 * f + corner];
            int64_t first = around_starts.data[v], last = around_starts.data[v + 1];
            if (last - first > 2 * crowd) {
                int64_t place = first + place_of(around.data + first, last - first, (int32_t)f);
                first = largest(first, place - crowd);
                last = least(last, place + crowd + 1);
            }
            for (int64_t k = first; k < last; k++) {
                int32_t g = around.data[k];
                if (seen.data[g] != f) {
                    seen.data[g] = (int32_t)f;
                    members.data[end++] = g;
                }
            }
        }
        starts.data[f + 1] = end;
    }
    return end;
}

/* For each patch, the rows of `pairs` of which both faces lie in it. Returns how many there are, and lists as many as
 * `inner` has room for. `first`, `own`, `inside` are scratch: one entry a face and one more, a pair, a face. */
int64_t inner_pairs(ConstLongs starts, ConstInts members, ConstInts2 pairs, Longs first, Ints own, Ints inside,
                    Longs inner_starts, Ints inner) {
    int64_t m = starts.size - 1, end = 0;
    for (int64_t f = 0; f <= m; f++) first.data[f] = 0;
    for (int64_t p = 0; p < pairs.rows; p++) first.data[pairs.data[2 * p]]++;
    int64_t before = 0;
    for (int64_t f = 0; f <= m; f++) {
        int64_t count = first.data[f];
        first.data[f] = before;
        before += count;
    }
    for (int64_t p = 0; p < pairs.rows; p++) own.data[first.data[pairs.data[2 * p]]++] = (int32_t)p;
    for (int64_t f = m; f > 0; f--) first.data[f] = first.data[f - 1];
    first.data[0] = 0;
    for (int64_t f = 0; f < m; f++) inside.data[f] = -1;
    inner_starts.data[0] = 0;
    for (int64_t f = 0; f < m; f++) {
        for (int64_t k = starts.data[f]; k < starts.data[f + 1]; k++) inside.data[members.data[k]] = (int32_t)f;
        for (int64_t k = starts.data[f]; k < starts.data[f + 1]; k++) {
            int32_t g = members.data[k];
            for (int64_t q = first.data[g]; q < first.data[g + 1]; q++) {
                if (inside.data[pairs.data[2 * (int64_t)own.data[q] + 1]] != f) continue;
                if (end < inner.size) inner.data[end] = own.data[q];
                end++;
            }
        }
        inner_starts.data[f + 1] = end;
    }
    return end;
}
