/* How much pictures of two versions of a mesh will differ, without pictures: from the shades of vertices, and from the
 * areas that outlines sweep. */
#include "codec/look/look.h"

enum { VIEW = 9, SUMS = 4, AROUND = 6 };

INLINE void make_unit(double *normal) {
    double length = __builtin_sqrt(dot3(normal, normal)), inverse = length > 0.0 ? 1.0 / length : 0.0;
    for (int d = 0; d < 3; d++) normal[d] *= inverse;
}

/* Sums of the cross products of the faces around vertices in both versions, and which views see the original's faces
 * from the front: a bit for each. */
INLINE void sum_faces(ConstDoubles2 original, ConstDoubles2 decoded, ConstInts2 faces, ConstDoubles2 views,
    Doubles2 around, Bytes facing) {
    for (int64_t i = 0; i < around.rows * around.columns; i++) around.data[i] = 0.0;
    for (int64_t f = 0; f < faces.rows; f++) {
        const int32_t *face = faces.data + 3 * f;
        double own[3], other[3];
        cross_of_face(original.data, face, own);
        cross_of_face(decoded.data, face, other);
        for (int k = 0; k < 3; k++) {
            double *sums = around.data + AROUND * (int64_t)face[k];
            for (int d = 0; d < 3; d++) sums[d] += own[d], sums[3 + d] += other[d];
        }
        uint8_t bits = 0;
        for (int64_t k = 0; k < views.rows; k++) bits |= (uint8_t)((dot3(own, views.data + VIEW * k) > 0.0) << k);
        facing.data[f] = bits;
    }
}

/* Squared differences of how much normals are along the light, by the areas that are seen. Leaves unit normals. */
INLINE void sum_shades(ConstDoubles2 views, Doubles2 around, Doubles2 sums) {
    for (int64_t v = 0; v < around.rows; v++) {
        double *own = around.data + AROUND * v, *other = own + 3, seen[8];
        for (int64_t k = 0; k < views.rows; k++) seen[k] = dot3(own, views.data + VIEW * k);
        make_unit(own);
        make_unit(other);
        for (int64_t k = 0; k < views.rows; k++) {
            const double *light = views.data + VIEW * k + (seen[k] > 0.0 ? 3 : 6);
            double apart = __builtin_fabs(dot3(own, light)) - __builtin_fabs(dot3(other, light));
            sums.data[SUMS * k + (seen[k] > 0.0 ? 0 : 1)] += __builtin_fabs(seen[k]) * apart * apart;
        }
    }
}

/* Areas that edges between front and back sweep, by the squared jump of shades from the ends to the background. */
INLINE void sum_outlines(ConstDoubles2 original, ConstDoubles2 decoded, ConstInts2 edges, ConstDoubles2 views,
    Doubles2 around, Bytes facing, Doubles2 sums) {
    for (int64_t e = 0; e < edges.rows; e++) {
        const int32_t *edge = edges.data + 4 * e;
        unsigned outlines = facing.data[edge[2]] ^ facing.data[edge[3]];
        if (!outlines) continue;
        const double *a = original.data + 3 * (int64_t)edge[0], *b = original.data + 3 * (int64_t)edge[1];
        const double *c = decoded.data + 3 * (int64_t)edge[0], *d = decoded.data + 3 * (int64_t)edge[1];
        const double *first = around.data + AROUND * (int64_t)edge[0];
        const double *second = around.data + AROUND * (int64_t)edge[1];
        double along[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, moved[3];
        for (int i = 0; i < 3; i++) moved[i] = 0.5 * (c[i] - a[i] + d[i] - b[i]);
        double swept[3] = {along[1] * moved[2] - along[2] * moved[1], along[2] * moved[0] - along[0] * moved[2],
                           along[0] * moved[1] - along[1] * moved[0]};
        for (int64_t k = 0; k < views.rows; k++) {
            if (!(outlines >> k & 1)) continue;
            const double *view = views.data + VIEW * k;
            double area = __builtin_fabs(dot3(swept, view));
            for (int side = 0; side < 2; side++) {
                const double *light = view + 3 + 3 * side;
                double lit = 0.5 * (__builtin_fabs(dot3(first, light)) + __builtin_fabs(dot3(second, light)));
                double jump = BACKGROUND - AMBIENT - DIFFUSE * lit;
                sums.data[SUMS * k + 2 + side] += area * jump * jump;
            }
        }
    }
}

/* Rows of `edges` have two vertices and two faces; rows of `views` an axis, the light of the side that it points to,
 * and that of the other side. Rows of `sums` get the squared differences of shades on both sides, over the areas around
 * vertices, which are six areas seen; then the areas swept by outlines. `around`, six numbers for each vertex, and
 * `facing`, one for each face, are scratch. */
KERNEL int64_t foresee(ConstDoubles2 original, ConstDoubles2 decoded, ConstInts2 faces, ConstInts2 edges,
    ConstDoubles2 views, Doubles2 around, Bytes facing, Doubles2 sums) {
    if (original.columns != 3 || decoded.columns != 3 || decoded.rows < original.rows || faces.columns != 3 ||
        edges.columns != 4 || views.columns != VIEW || views.rows > 8 || around.columns != AROUND ||
        around.rows < original.rows || facing.size < faces.rows || sums.columns != SUMS || sums.rows < views.rows ||
        !all_below(faces.data, 3 * faces.rows, original.rows))
        return MISUSED;
    for (int64_t e = 0; e < edges.rows; e++)
        if (!all_below(edges.data + 4 * e, 2, original.rows) || !all_below(edges.data + 4 * e + 2, 2, faces.rows))
            return MISUSED;
    for (int64_t i = 0; i < sums.rows * SUMS; i++) sums.data[i] = 0.0;
    sum_faces(original, decoded, faces, views, around, facing);
    sum_shades(views, around, sums);
    sum_outlines(original, decoded, edges, views, around, facing, sums);
    return 0;
}

/* The least and the largest coordinate of positions along each direction. */
KERNEL int64_t bounds_along(ConstDoubles2 positions, ConstDoubles2 directions, Doubles2 bounds) {
    if (positions.columns != 3 || positions.rows < 1 || directions.columns != 3 || bounds.columns != 2 ||
        bounds.rows < directions.rows)
        return MISUSED;
    for (int64_t k = 0; k < directions.rows; k++) {
        const double *m = directions.data + 3 * k;
        double low = __builtin_inf(), high = -__builtin_inf();
        for (int64_t v = 0; v < positions.rows; v++) {
            const double *p = positions.data + 3 * v;
            double at = p[0] * m[0] + p[1] * m[1] + p[2] * m[2];
            low = at < low ? at : low;
            high = at > high ? at : high;
        }
        bounds.data[2 * k] = low;
        bounds.data[2 * k + 1] = high;
    }
    return 0;
}

/* Of each face, the lengths of its three sides, one row for each, and its area; and the box around all corners. */
KERNEL int64_t measure_faces(ConstDoubles2 positions, ConstInts2 faces, Doubles2 lengths, Doubles areas,
    Doubles2 bounds) {
    if (positions.columns != 3 || faces.columns != 3 || lengths.rows != 3 || lengths.columns != faces.rows ||
        areas.size < faces.rows || bounds.rows != 3 || bounds.columns != 2 ||
        !all_below(faces.data, 3 * faces.rows, positions.rows))
        return MISUSED;
    for (int d = 0; d < 3; d++) bounds.data[2 * d] = __builtin_inf(), bounds.data[2 * d + 1] = -__builtin_inf();
    for (int64_t f = 0; f < faces.rows; f++) {
        const double *corner[3];
        for (int k = 0; k < 3; k++) corner[k] = positions.data + 3 * (int64_t)faces.data[3 * f + k];
        for (int k = 0; k < 3; k++) {
            lengths.data[k * faces.rows + f] = __builtin_sqrt(apart(corner[k], corner[(k + 1) % 3]));
            for (int d = 0; d < 3; d++) {
                double at = corner[k][d], *low = bounds.data + 2 * d;
                low[0] = at < low[0] ? at : low[0];
                low[1] = at > low[1] ? at : low[1];
            }
        }
        double cross[3];
        cross3(corner[0], corner[1], corner[2], cross);
        areas.data[f] = 0.5 * __builtin_sqrt(dot3(cross, cross));
    }
    return 0;
}
