/* Fewer triangles: edges that cost least become points, by quadric errors, many of them in each pass. */
#include "src/bsm/encoding/simplification.h"

enum { TERMS = 10, BUCKETS = 1 << 15, PASSES = 64, TOUCHED = 1, SEAM = 2, FIXED = 4, STEADY = 8 };
static const double TURN = 0.2; /* The least cosine between what a triangle was and becomes. */

typedef struct {
    double *positions;
    int32_t *faces;
    uint8_t *states;
    double *quadrics;
    const int64_t *starts;
    const int32_t *around;
    int32_t *wedges;              /* The values that corners have beside their place. */
    int32_t *ends, *marks, *joins; /* Where each vertex went in this pass, and each wedge. */
    int32_t mark;
    double along, uneven; /* The costs of moving along the surface, and of vertices without six neighbors. */
} WorkingMesh;

/* The quadric of an area: xx, xy, xz, yy, yz, zz, then the linear terms, then the constant. */
INLINE void add_plane(double *q, const double *n, double weight, const double *at) {
    double away = dot3(n, at);
    int term = 0;
    for (int i = 0; i < 3; i++)
        for (int j = i; j < 3; j++) q[term++] += weight * n[i] * n[j];
    for (int i = 0; i < 3; i++) q[6 + i] -= weight * away * n[i];
    q[9] += weight * away * away;
}

INLINE void add_point(double *q, double weight, const double *at) {
    q[0] += weight;
    q[3] += weight;
    q[5] += weight;
    for (int i = 0; i < 3; i++) q[6 + i] -= weight * at[i];
    q[9] += weight * dot3(at, at);
}

/* Half of the gradient at a point. */
INLINE void gradient(const double *q, const double *p, double *g) {
    g[0] = q[0] * p[0] + q[1] * p[1] + q[2] * p[2] + q[6];
    g[1] = q[1] * p[0] + q[3] * p[1] + q[4] * p[2] + q[7];
    g[2] = q[2] * p[0] + q[4] * p[1] + q[5] * p[2] + q[8];
}

/* What it costs to be at a point. */
INLINE double cost_at(const double *q, const double *p) {
    double g[3], cost = q[9];
    gradient(q, p, g);
    for (int i = 0; i < 3; i++) cost += p[i] * (g[i] + q[6 + i]);
    return cost > 0.0 ? cost : 0.0;
}

/* Where the vertex of an edge goes, which one stays, and what that costs. */
static double placed(const WorkingMesh *surface, int32_t a, int32_t b, double *p, int32_t *stays) {
    const double *pa = surface->positions + 3 * (int64_t)a, *pb = surface->positions + 3 * (int64_t)b;
    const double *qa = surface->quadrics + TERMS * (int64_t)a, *qb = surface->quadrics + TERMS * (int64_t)b;
    double q[TERMS], g[3];
    for (int i = 0; i < TERMS; i++) q[i] = qa[i] + qb[i];
    int of_a = surface->states[a] & (SEAM | FIXED), of_b = surface->states[b] & (SEAM | FIXED);
    bool steady = of_a | of_b | (surface->states[a] & STEADY);
    *stays = of_b > of_a || (steady && of_a == of_b && cost_at(q, pb) < cost_at(q, pa)) ? b : a;
    const double *stay = *stays == a ? pa : pb;
    for (int i = 0; i < 3; i++) p[i] = steady ? stay[i] : 0.5 * (pa[i] + pb[i]);
    if (!steady) {
        gradient(q, p, g);
        double xx = q[3] * q[5] - q[4] * q[4], xy = q[2] * q[4] - q[1] * q[5], xz = q[1] * q[4] - q[2] * q[3];
        double yy = q[0] * q[5] - q[2] * q[2], yz = q[1] * q[2] - q[0] * q[4], zz = q[0] * q[3] - q[1] * q[1];
        double volume = q[0] * xx + q[1] * xy + q[2] * xz;
        if (volume > 0.0) {
            p[0] -= (xx * g[0] + xy * g[1] + xz * g[2]) / volume;
            p[1] -= (xy * g[0] + yy * g[1] + yz * g[2]) / volume;
            p[2] -= (xz * g[0] + yz * g[1] + zz * g[2]) / volume;
        }
    }
    double off_a = (double)(surface->starts[a + 1] - surface->starts[a]) - 6.0;
    double off_b = (double)(surface->starts[b + 1] - surface->starts[b]) - 6.0;
    /* (off_a + off_b + 2)^2 - off_a^2 - off_b^2 */
    return cost_at(q, p) * __builtin_exp(surface->uneven * (2.0 * off_a * off_b + 4.0 * (off_a + off_b) + 4.0));
}

/* The corners of a triangle as they are now; false if it is gone. */
INLINE bool corners_now(const WorkingMesh *surface, int64_t face, int32_t *corners) {
    for (int i = 0; i < 3; i++) corners[i] = surface->ends[surface->faces[3 * face + i]];
    return corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0];
}

/* Triangles around a vertex with another one and without, and corners that have a mark. */
typedef struct {
    int shared, others, common;
} FanCount;

/* Whether a triangle around `a` turns around when that goes to `p`; corners that have one mark get the other. */
static bool turns_around(WorkingMesh *surface, int32_t a, int32_t b, const double *p, int32_t had, int32_t given,
    FanCount *found) {
    for (int64_t k = surface->starts[a]; k < surface->starts[a + 1]; k++) {
        int32_t corners[3];
        if (!corners_now(surface, surface->around[k], corners)) continue;
        bool with = corners[0] == b || corners[1] == b || corners[2] == b;
        const double *before[3], *after[3];
        for (int i = 0; i < 3; i++) {
            int32_t corner = corners[i];
            before[i] = after[i] = surface->positions + 3 * (int64_t)corner;
            if (corner == a) {
                after[i] = p;
            } else if (corner != b) {
                found->common += surface->marks[corner] == had;
                surface->marks[corner] = given;
            }
        }
        if (with) {
            found->shared++;
            continue;
        }
        found->others++;
        double old[3], new[3];
        cross3(before[0], before[1], before[2], old);
        cross3(after[0], after[1], after[2], new);
        double along = dot3(old, new), old_square = dot3(old, old), new_square = dot3(new, new);
        if (old_square > 0.0 && (along <= 0.0 || along * along < TURN * TURN * old_square * new_square)) return true;
    }
    return false;
}

/* Whether an edge of two triangles may become a point: what was a surface is one, and none of it turns around. */
static bool may_collapse(WorkingMesh *surface, int32_t a, int32_t b, const double *p) {
    FanCount of_a = {0}, of_b = {0};
    surface->mark += 2;
    if (turns_around(surface, a, b, p, -1, surface->mark, &of_a) || of_a.shared != 2) return false;
    if (turns_around(surface, b, a, p, surface->mark, surface->mark + 1, &of_b)) return false;
    return of_b.common == 2 && of_a.others + of_b.others > 2;
}

/* Whether each wedge of a vertex that goes has one to become at the vertex that stays; if so, notes which. */
static bool wedges_join(WorkingMesh *surface, int32_t goes, int32_t stays) {
    int32_t from[2], to[2], corners[3];
    int known = 0;
    for (int round = 0; round < 2; round++)
        for (int64_t k = surface->starts[goes]; k < surface->starts[goes + 1]; k++) {
            if (!corners_now(surface, surface->around[k], corners)) continue;
            const int32_t *wedges = surface->wedges + 3 * (int64_t)surface->around[k];
            int32_t own = -1, other = -1;
            for (int i = 0; i < 3; i++) {
                if (corners[i] == goes) own = wedges[i];
                if (corners[i] == stays) other = wedges[i];
            }
            int which = 0;
            while (which < known && from[which] != own) which++;
            if (round == 0 && other >= 0 && which == known && known < 2) {
                from[known] = own;
                to[known++] = other;
            } else if (round == 1 && (which == known || (other >= 0 && to[which] != other))) {
                return false;
            }
        }
    for (int i = 0; i < known; i++) surface->joins[from[i]] = to[i];
    return true;
}

/* Whether the k-th side of a triangle is one of the edges that may become points, each of which is one side so. */
INLINE bool is_edge(const WorkingMesh *surface, int64_t k, int32_t *a, int32_t *b) {
    *a = surface->faces[k];
    *b = surface->faces[k % 3 == 2 ? k - 2 : k + 1];
    return *a < *b && !(surface->states[*a] & surface->states[*b] & FIXED);
}

INLINE int64_t bucket_of(float cost) {
    union {
        float number;
        uint32_t bits;
    } value = {cost};
    return value.bits >> 16;
}

/* Add up for each vertex the quadrics of its triangles, and of seams along their sides. */
static void add_quadrics(WorkingMesh *surface, int64_t count) {
    for (int64_t f = 0; f < count; f++) {
        const int32_t *face = surface->faces + 3 * f;
        const double *at[3];
        for (int i = 0; i < 3; i++) at[i] = surface->positions + 3 * (int64_t)face[i];
        double n[3];
        cross3(at[0], at[1], at[2], n);
        double area = __builtin_sqrt(dot3(n, n));
        for (int i = 0; area > 0.0 && i < 3; i++) {
            add_plane(surface->quadrics + TERMS * (int64_t)face[i], n, 1.0 / area, at[0]);
            add_point(surface->quadrics + TERMS * (int64_t)face[i], surface->along * area, at[i]);
            const int other = (i + 1) % 3;
            if (!(surface->states[face[i]] & surface->states[face[other]] & SEAM)) continue;
            double along[3] = {at[other][0] - at[i][0], at[other][1] - at[i][1], at[other][2] - at[i][2]};
            double squared = dot3(along, along);
            for (int end = i; end >= 0; end = end == i ? other : -1) {
                add_point(surface->quadrics + TERMS * (int64_t)face[end], squared, at[end]);
                add_plane(surface->quadrics + TERMS * (int64_t)face[end], along, -1.0, at[end]);
            }
        }
    }
}

/* Make points of about `wanted` edges of `count` triangles, the cheapest, in the order of memory; returns how many. */
static int64_t collapse_edges(WorkingMesh *surface, int64_t count, int64_t wanted, Singles costs, Ints buckets) {
    int32_t a, b, stays;
    double p[3];
    int64_t found = 0, made = 0, most = 0, last = 0, next = 0;
    for (int64_t k = 0; k < BUCKETS; k++) buckets.data[k] = 0;
    for (int64_t k = 0; k < 3 * count && found < costs.size; k++) {
        if (!is_edge(surface, k, &a, &b)) continue;
        costs.data[found] = (float)placed(surface, a, b, p, &stays);
        buckets.data[bucket_of(costs.data[found++])]++;
    }
    while (last < BUCKETS && most < 2 * wanted) most += buckets.data[last++];
    for (int64_t k = 0; next < found && made < wanted; k++) {
        if (!is_edge(surface, k, &a, &b) || bucket_of(costs.data[next++]) >= last) continue;
        if ((surface->states[a] | surface->states[b]) & TOUCHED) continue;
        placed(surface, a, b, p, &stays);
        int32_t goes = stays == a ? b : a;
        if (!may_collapse(surface, a, b, p) || !wedges_join(surface, goes, stays)) continue;
        double *own = surface->quadrics + TERMS * (int64_t)stays, *other = surface->quadrics + TERMS * (int64_t)goes;
        for (int i = 0; i < TERMS; i++) own[i] += other[i];
        for (int i = 0; i < 3; i++) surface->positions[3 * (int64_t)stays + i] = p[i];
        surface->ends[goes] = stays;
        surface->states[a] |= TOUCHED;
        surface->states[b] |= TOUCHED;
        made++;
    }
    return made;
}

/* Move the triangles that are left to the front, with the corners that they have now; returns how many. */
static int64_t drop_faces(WorkingMesh *surface, int64_t count) {
    int64_t kept = 0;
    int32_t corners[3];
    for (int64_t f = 0; f < count; f++) {
        if (!corners_now(surface, f, corners)) continue;
        for (int i = 0; i < 3; i++) {
            surface->faces[3 * kept + i] = corners[i];
            surface->wedges[3 * kept + i] = surface->joins[surface->wedges[3 * f + i]];
        }
        kept++;
    }
    return kept;
}

/* Make fewer of triangles with three different corners, about `target`. `wedges` number the values of their corners: a
 * vertex with several, SEAM of `states`, becomes another one along a seam. `states` is FIXED for vertices that
 * stay where they are, and STEADY for all if none may move. Returns how many triangles there are, which stand first;
 * `owners` are what vertices have become. Scratch: quadrics, `ends` and `marks` for each vertex, one more of
 * `starts`, three of `around` for each triangle, `joins` for each wedge, a cost for each edge. */
int64_t simplify(Doubles2 positions, Ints2 faces, Ints2 wedges, Bytes states, WorkingRoom room, int64_t target,
                 double along, double uneven) {
    Doubles2 quadrics = room.quadrics;
    Longs starts = room.starts;
    Ints around = room.around, ends = room.ends, marks = room.marks, joins = room.joins, owners = room.owners;
    int64_t size = positions.rows, count = faces.rows, made = 0;
    if (states.size != size || quadrics.rows != size || quadrics.columns != TERMS || starts.size != size + 1 ||
        around.size < 3 * count || ends.size != size || marks.size != size || owners.size != size ||
        room.buckets.size != BUCKETS || positions.columns != 3 || faces.columns != 3 || wedges.rows != count ||
        wedges.columns != 3)
        return MISUSED;
    if (!all_below(faces.data, 3 * count, size) || !all_below(wedges.data, 3 * count, joins.size)) return MISUSED;
    WorkingMesh surface = {positions.data, faces.data, states.data, quadrics.data, starts.data, around.data,
                           wedges.data,    ends.data,  marks.data,  joins.data,    0,           along,       uneven};
    for (int64_t v = 0; v < size; v++) {
        marks.data[v] = 0;
        owners.data[v] = (int32_t)v;
        for (int i = 0; i < TERMS; i++) quadrics.data[TERMS * v + i] = 0.0;
    }
    add_quadrics(&surface, count);
    for (int pass = 0, part = 2; part > 0 && pass < PASSES && count > target; pass++, part -= !made) {
        vertex_faces((ConstInts2){faces.data, count, 3}, starts, around);
        for (int64_t v = 0; v < size; v++) {
            ends.data[v] = (int32_t)v;
            states.data[v] &= ~TOUCHED;
        }
        for (int64_t w = 0; w < joins.size; w++) joins.data[w] = (int32_t)w;
        made = collapse_edges(&surface, count, (count - target + 2 * part - 1) / (2 * part), room.costs, room.buckets);
        for (int64_t v = 0; v < size; v++) owners.data[v] = ends.data[owners.data[v]];
        count = drop_faces(&surface, count);
    }
    return count;
}
