/* What is reached on a surface without leaving a ball about a place. */
#include "codec/denoise/filters/reach.h"
#include "codec/denoise/filters/vectors3.h"

/* Breadth-first from each centre's seeds over adjacent points within its radius, centre `begin` on. Returns the centre
 * before which it stopped because a row of it might not fit into `reached`. `seen`, one entry a point, holds -1 when the
 * first centre is asked for. */
int64_t reach(ConstDoubles2 centres, ConstLongs seed_starts, ConstInts seeds, ConstDoubles2 points, ConstLongs starts,
              ConstInts members, ConstDoubles radii, int64_t begin, Ints seen, Longs reached_starts, Ints reached) {
    int64_t end = begin > 0 ? reached_starts.data[begin] : 0;
    reached_starts.data[0] = 0;
    for (int64_t i = begin; i < centres.rows; i++) {
        if (end + points.rows > reached.size) return i;
        Vector3 centre = row_of(centres.data, i);
        double squared = radii.data[i] * radii.data[i];
        int64_t head = end;
        for (int64_t k = seed_starts.data[i]; k < seed_starts.data[i + 1]; k++) {
            int32_t p = seeds.data[k];
            Vector3 apart = less(row_of(points.data, p), centre);
            if (seen.data[p] != i && dot(apart, apart) <= squared) reached.data[end++] = p;
            seen.data[p] = (int32_t)i;
        }
        while (head < end) {
            int32_t g = reached.data[head++];
            for (int64_t k = starts.data[g]; k < starts.data[g + 1]; k++) {
                int32_t p = members.data[k];
                if (seen.data[p] == i) continue;
                seen.data[p] = (int32_t)i;
                Vector3 apart = less(row_of(points.data, p), centre);
                if (dot(apart, apart) <= squared) reached.data[end++] = p;
            }
        }
        reached_starts.data[i + 1] = end;
    }
    return centres.rows;
}
