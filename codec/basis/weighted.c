/* Edges weighted by cotangents (U. Pinkall, K. Polthier, "Computing discrete minimal surfaces and their conjugates",
 * 1993, section 4; specification, S 3.1), and parts that hang on others (S 3.2). Decoders know the first frame to
 * rounding, so weights are smooth functions of it, above zero: else L is indefinite where a triangle is obtuse. */
#include "codec/basis/basis.h"

/* Index of the first entry that is not below `value`, in an ascending list from `low` to before `high`. */
static int64_t lower_bound(const int32_t *list, int64_t low, int64_t high, int32_t value) {
    while (low < high) {
        int64_t middle = (low + high) / 2;
        if (list[middle] < value)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* A cotangent is the product of two sides over the doubled area. To its square is added FLATNESS times the square of
 * the sum of the squared sides, and SMALLNESS, in BSM units: so that neither a triangle without area nor one without
 * size makes rounding errors large. A weight is above the smallest, and below the sum of both bounds; BEND says how
 * softly negative sums of cotangents become zero. */
static const double FLATNESS = 0x1p-12, SMALLNESS = 0x1p-48;
static const double SMALLEST_WEIGHT = 0x1p-5, LARGEST_WEIGHT = 8, BEND = 0x1p-6;

INLINE double soft_cotangent(const double *p, const double *q, const double *s) {
    double ux = q[0] - p[0], uy = q[1] - p[1], uz = q[2] - p[2];
    double vx = s[0] - p[0], vy = s[1] - p[1], vz = s[2] - p[2];
    double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    double product = ux * vx + uy * vy + uz * vz;
    double sides = 2.0 * (ux * ux + uy * uy + uz * uz + vx * vx + vy * vy + vz * vz - product);
    return product / __builtin_sqrt(x * x + y * y + z * z + FLATNESS * sides * sides + SMALLNESS);
}

/* Half the sum of the soft cotangents opposite to each edge, softly bounded: `weights`, zeros at first, one for every
 * entry of `neighbors`; the graph has every edge of `faces`. Returns whether all sums are finite. */
bool weigh_by_cotangents(ConstInts offsets, ConstInts neighbors, ConstInts2 faces, ConstDoubles2 positions,
                         Doubles weights) {
    bool finite = true;
    for (int64_t f = 0; f < faces.rows; f++) {
        const int32_t *face = faces.data + 3 * f;
        for (int corner = 0; corner < 3; corner++) {
            int32_t a = face[corner], b = face[(corner + 1) % 3], c = face[(corner + 2) % 3];
            if (a == b || a == c || b == c) continue;
            double half = 0.5 * soft_cotangent(positions.data + 3 * (int64_t)a, positions.data + 3 * (int64_t)b,
                                               positions.data + 3 * (int64_t)c);
            weights.data[lower_bound(neighbors.data, offsets.data[b], offsets.data[b + 1] - 1, c)] += half;
            weights.data[lower_bound(neighbors.data, offsets.data[c], offsets.data[c + 1] - 1, b)] += half;
        }
    }
    for (int64_t i = 0; i < weights.size; i++) {
        double t = weights.data[i], p = 0.5 * (t + __builtin_sqrt(t * t + BEND));
        finite = finite && t - t == 0.0;
        weights.data[i] = SMALLEST_WEIGHT + LARGEST_WEIGHT * p / (LARGEST_WEIGHT + p);
    }
    return finite;
}

/* The weights of a part's edges, `inner`, one for every entry of its own graph, and the springs on which it hangs: its
 * edges to vertices of a lower rank. Row r has those from `starts[r]` on, together as stiff as `springs[r]`. Returns
 * how many there are; there is room for as many as the vertices have neighbors. */
int64_t hold(ConstInts offsets, ConstInts neighbors, ConstDoubles weights, ConstInts rank, ConstInts vertices,
             ConstInts own_offsets, ConstInts own_neighbors, Doubles inner, Doubles springs, Ints starts, Ints outer,
             Doubles stiffness) {
    int64_t count = 0;
    starts.data[0] = 0;
    for (int64_t r = 0; r < vertices.size; r++) {
        int32_t v = vertices.data[r];
        int64_t first = offsets.data[v], last = offsets.data[v + 1];
        for (int64_t i = own_offsets.data[r]; i < own_offsets.data[r + 1]; i++) {
            int32_t w = vertices.data[own_neighbors.data[i]];
            inner.data[i] = weights.data[lower_bound(neighbors.data, first, last - 1, w)];
        }
        springs.data[r] = 0.0;
        for (int64_t i = first; i < last; i++) {
            if (rank.data[neighbors.data[i]] >= rank.data[v]) continue;
            springs.data[r] += weights.data[i];
            outer.data[count] = neighbors.data[i];
            stiffness.data[count++] = weights.data[i];
        }
        starts.data[r + 1] = (int32_t)count;
    }
    return count;
}

/* What the springs of `hold` pull each row to, where `field` has a row for each number in `outer`. */
void pull(ConstInts starts, ConstInts outer, ConstDoubles stiffness, ConstDoubles2 field, Doubles2 pulls) {
    for (int64_t r = 0; r < pulls.rows; r++) {
        double *sums = pulls.data + r * pulls.columns;
        for (int64_t j = 0; j < pulls.columns; j++) sums[j] = 0.0;
        for (int64_t i = starts.data[r]; i < starts.data[r + 1]; i++) {
            const double *other = field.data + outer.data[i] * field.columns;
            for (int64_t j = 0; j < pulls.columns; j++) sums[j] += stiffness.data[i] * other[j];
        }
    }
}
