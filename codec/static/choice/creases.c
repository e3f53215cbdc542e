/* Creases that shading hangs on. Encoder only.
 *
 * Viewers shade faces that are bent by less than some angle as one smooth surface, and others each by itself. Where the
 * bend is near that angle, an invisible error changes one into the other, and that change is visible. */
#include "codec/geometry/geometry.h"
#include "codec/static/choice/choice.h"

enum { SIDES = 3 };

INLINE bool has(const int32_t *face, int32_t vertex) {
    for (int k = 0; k < SIDES; k++)
        if (face[k] == vertex) return true;
    return false;
}

static bool fits_columns(ConstInts2 rows, int64_t columns, int64_t limit) {
    return rows.columns == columns && all_below(rows.data, columns * rows.rows, limit);
}

bool fits_rows(ConstInts starts, ConstInts members, int64_t rows, int64_t count) {
    if (starts.size != rows + 1 || starts.data[0] != 0 || starts.data[rows] > members.size) return false;
    for (int64_t i = 0; i < rows; i++)
        if (starts.data[i] > starts.data[i + 1]) return false;
    return all_below(members.data, members.size, count);
}

/* How many pairs of faces around a vertex have a bend near that of a crease; `pairs` (k x 2) gets the first k of them,
 * `sharp` whether there is a crease, and `costs` the area of the corners that are shaded otherwise then: a third of
 * both faces at each vertex that they share. Of more than `most` faces around a vertex each is shaded by itself.
 * `crosses` is room for four numbers a face. */
KERNEL int64_t collect_creases(ConstDoubles2 positions, ConstInts2 faces, Lists around, int64_t most, Bends bends,
    Doubles2 crosses, NearCreases near) {
    const int64_t *starts = around.starts.data;
    const int32_t *members = around.members.data;
    int64_t n = positions.rows, found = 0;
    if (positions.columns != 3 || !fits_columns(faces, SIDES, n) || around.starts.size != n + 1 ||
        crosses.rows != faces.rows || crosses.columns != 4 || near.pairs.columns != 2 ||
        near.sharp.size != near.pairs.rows || near.costs.size != near.pairs.rows)
        return MISUSED;
    for (int64_t v = 0; v < n; v++)
        if (starts[v] < 0 || starts[v] > starts[v + 1] || starts[v + 1] > around.members.size) return MISUSED;
    if (!all_below(members, around.members.size, faces.rows)) return MISUSED;
    for (int64_t f = 0; f < faces.rows; f++) {
        double *cross = crosses.data + 4 * f;
        cross_of_face(positions.data, faces.data + SIDES * f, cross);
        cross[3] = __builtin_sqrt(dot3(cross, cross));
    }
    for (int64_t v = 0; v < n; v++) {
        int64_t from = starts[v], to = starts[v + 1];
        for (int64_t i = from; to - from <= most && i < to; i++)
            for (int64_t j = from; j < i; j++) {
                const double *f = crosses.data + 4 * (int64_t)members[i],
                             *g = crosses.data + 4 * (int64_t)members[j];
                double bend = dot3(f, g), unit = f[3] * g[3];
                if (!(bend > bends.least * unit && bend < bends.largest * unit)) continue;
                const int32_t *face = faces.data + SIDES * (int64_t)members[i];
                const int32_t *other = faces.data + SIDES * (int64_t)members[j];
                int shared = 0;
                bool first = true; /* of the vertices that they share */
                for (int k = 0; k < SIDES; k++)
                    if (has(other, face[k])) shared++, first &= face[k] >= v;
                if (!first) continue;
                if (found < near.pairs.rows) {
                    near.pairs.data[2 * found] = members[i], near.pairs.data[2 * found + 1] = members[j];
                    near.sharp.data[found] = !(bend > bends.crease * unit);
                    near.costs.data[found] = shared * (f[3] + g[3]) / SIDES;
                }
                found++;
            }
    }
    return found;
}

bool fits_creases(const Creases *c, int64_t vertices) {
    return fits_columns(c->faces, SIDES, vertices) && fits_columns(c->pairs, 2, c->faces.rows) &&
           c->sharp.size == c->pairs.rows && c->costs.size == c->pairs.rows &&
           fits_rows(c->starts, c->members, vertices, c->pairs.rows);
}

/* What it costs that pairs are wrong whose bend hangs on a vertex. */
double wrong_creases(const Creases *c, const double *positions, int64_t vertex) {
    double sum = 0.0;
    for (int32_t i = c->starts.data[vertex]; i < c->starts.data[vertex + 1]; i++) {
        int64_t pair = c->members.data[i];
        double f[3], g[3];
        cross_of_face(positions, c->faces.data + SIDES * (int64_t)c->pairs.data[2 * pair], f);
        cross_of_face(positions, c->faces.data + SIDES * (int64_t)c->pairs.data[2 * pair + 1], g);
        bool sharp = !(dot3(f, g) > c->cosine * __builtin_sqrt(dot3(f, f) * dot3(g, g)));
        sum += sharp != (c->sharp.data[pair] != 0) ? c->costs.data[pair] : 0.0;
    }
    return sum;
}
