/* Normals as viewers shade: at each corner of a face those of the faces around its vertex, but not across creases. */
#include "codec/geometry/geometry.h"
#include "codec/look/look.h"

/* The sum of the faces around a vertex; returns whether each is so near to it that no two of them have a crease
 * between. */
INLINE bool smoothly(const double *crosses, const int32_t *members, int64_t count, double half, double *sum) {
    sum[0] = sum[1] = sum[2] = 0.0;
    for (int64_t i = 0; i < count; i++)
        for (int d = 0; d < 3; d++) sum[d] += crosses[4 * (int64_t)members[i] + d];
    double bound = half * __builtin_sqrt(dot3(sum, sum));
    bool near = true;
    for (int64_t i = 0; i < count; i++) {
        const double *other = crosses + 4 * (int64_t)members[i];
        near &= dot3(sum, other) > bound * other[3];
    }
    return near;
}

/* The sum of a face, and of those around that have no crease to it. */
INLINE void sum_around(const double *crosses, const int32_t *members, int64_t count, int64_t face, double cosine,
    double *sum) {
    const double *own = crosses + 4 * face;
    double bound = cosine * own[3];
    for (int d = 0; d < 3; d++) sum[d] = own[d];
    for (int64_t i = 0; i < count; i++) {
        const double *other = crosses + 4 * (int64_t)members[i];
        if (other == own || !(dot3(own, other) > bound * other[3])) continue;
        for (int d = 0; d < 3; d++) sum[d] += other[d];
    }
}

INLINE void unit_of(const double *sum, float *unit) {
    double length = __builtin_sqrt(dot3(sum, sum));
    for (int d = 0; d < 3; d++) unit[d] = length > 0.0 ? (float)(sum[d] / length) : 0.0f;
}

/* `joined` has the vertices of faces with those at one place as one, `around` the faces of each. `normals`
 * has nine numbers a face, three of each corner: the sum of the cross products of those around the corner's vertex
 * whose angle to the face has a larger cosine than that of the shading, and of the face itself; of length 1, or zero.
 * Where all faces are within half that angle of their sum, that is the normal of each. `crosses` is room for four
 * numbers a face. */
int64_t shown_normals(ConstDoubles2 positions, ConstInts2 faces, ConstInts2 joined, Lists around, Shading shading,
    Doubles2 crosses, Singles2 normals) {
    const int64_t *starts = around.starts.data, most = shading.most;
    int64_t n = around.starts.size - 1;
    if (positions.columns != 3 || faces.columns != 3 || crosses.columns != 4 || normals.columns != 9 || n < 0 ||
        joined.columns != 3 || joined.rows != faces.rows || crosses.rows < faces.rows || normals.rows < faces.rows)
        return MISUSED;
    for (int64_t v = 0; v < n; v++)
        if (starts[v] < 0 || starts[v] > starts[v + 1] || starts[v + 1] > around.members.size) return MISUSED;
    if (!all_below(around.members.data, around.members.size, faces.rows)
        || !all_below(joined.data, 3 * faces.rows, n) || !all_below(faces.data, 3 * faces.rows, positions.rows))
        return MISUSED;
    for (int64_t f = 0; f < faces.rows; f++) {
        double *own = crosses.data + 4 * f;
        cross_of_face(positions.data, faces.data + 3 * f, own);
        own[3] = __builtin_sqrt(dot3(own, own));
    }
    for (int64_t v = 0; v < n; v++) {
        int64_t from = starts[v], to = starts[v + 1];
        const int32_t *members = around.members.data + from;
        double sum[3] = {0.0, 0.0, 0.0};
        bool smooth = to - from <= most && smoothly(crosses.data, members, to - from, shading.half, sum);
        float normal[3] = {0.0f, 0.0f, 0.0f};
        if (smooth) unit_of(sum, normal);
        for (int64_t i = 0; i < to - from; i++) {
            const int32_t *corners = joined.data + 3 * (int64_t)members[i];
            if (!smooth) {
                sum_around(crosses.data, members, to - from <= most ? to - from : 0, members[i], shading.cosine, sum);
                unit_of(sum, normal);
            }
            float *at = normals.data + 9 * (int64_t)members[i];
            for (int k = 0; k < 3; k++)
                for (int d = 0; d < 3 && corners[k] == v; d++) at[3 * k + d] = normal[d];
        }
    }
    return 0;
}
