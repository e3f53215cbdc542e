/* Rigid and mirrored transforms that take many vertices of a mesh to others. Encoder only: decoders are told them.
 *
 * Pairs of triangles with sides and valences alike vote for the transform between them; those with most votes are
 * fitted to all vertices that they take to others, and of these the ones are kept that explain what no other does. */
#include "codec/geometry/geometry.h"
#include "codec/static/choice/choice.h"

enum {
    POOL = 256,     /* transforms that are tried on a few vertices */
    FITTED = 48,    /* of these, those that are fitted */
    VOTES = 1 << 13,
    MOST_WALKED = 64,
    MOST_PAIRS = 8,   /* of a triangle */
    MOST_ASKED = 3000, /* triangles whose pairs vote */
    TRIED = 256, FITTING = 1024, COUNTED = 16384, /* vertices */
    CELL = 8, /* twice LOOSE */
    NEAR_BITS = 18,
    ROW = 64, /* vertices that are moved at once */
};
static const double LEAST_SIDE = 3.0, LEAST_AREA = 8.0, ALIKE = 1.0, LOOSE = 4.0, CLOSE = 1.25;

typedef struct {
    double turn[3][3], shift[3];
    int64_t votes;
    uint32_t key;
} Motion;

typedef struct {
    ConstDoubles2 positions;
    int32_t *head, *next; /* of vertices by cells of CELL */
    uint32_t mask;
    uint8_t *near; /* by the lowest of eight cells around a place: which hold vertices, and others */
    int32_t *moved; /* COUNTED: of some vertices, those to which a motion takes them */
} Space;

INLINE int32_t cell_of(double x) { /* a call of floor() takes longer than all of it */
    int32_t whole = (int32_t)(x / CELL);
    return whole - (whole > x / CELL);
}
INLINE uint32_t mixed(uint32_t hash, int64_t x) { return (hash ^ (uint32_t)x) * 2654435769u ^ hash >> 15; }
INLINE uint32_t cell_key(int32_t x, int32_t y, int32_t z, uint32_t mask) {
    return mixed(mixed(mixed(1, x), y), z) >> 7 & mask;
}
INLINE uint32_t near_key(int32_t x, int32_t y, int32_t z) { return cell_key(x, y, z, (1 << NEAR_BITS) - 1); }

INLINE void move(const Motion *m, const double *from, double *to) {
    for (int i = 0; i < 3; i++)
        to[i] = m->turn[i][0] * from[0] + m->turn[i][1] * from[1] + m->turn[i][2] * from[2] + m->shift[i];
}

/* The vertex nearest to a place within `reach`, at most LOOSE, in some of the eight cells from `first` on; -1: none. */
static int32_t nearest_vertex(const Space *s, const double *at, const int32_t *first, uint32_t cells, double reach) {
    double least = reach * reach;
    int32_t best = -1;
    for (; cells != 0; cells &= cells - 1) {
        int k = __builtin_ctz(cells);
        int32_t u = s->head[cell_key(first[0] + (k >> 2), first[1] + (k >> 1 & 1), first[2] + (k & 1), s->mask)];
        for (int visits = 0; u >= 0 && visits < MOST_WALKED; visits++, u = s->next[u]) {
            const double *x = s->positions.data + 3 * (int64_t)u;
            double p = x[0] - at[0], q = x[1] - at[1], r = x[2] - at[2], square = p * p + q * q + r * r;
            if (square < least) least = square, best = u;
        }
    }
    return best;
}

/* To which vertex a motion takes every `stride`th, in `moved`, -1: to none; returns how many it takes to others. */
KERNEL int64_t count_moved(const Space *s, const Motion *m, int64_t stride, double reach) {
    int64_t count = (s->positions.rows - 1) / stride + 1, found = 0;
    for (int64_t start = 0; start < count; start += ROW) {
        double at[ROW][3];
        int32_t first[ROW][3];
        uint32_t key[ROW];
        int64_t row = least(count - start, ROW);
        for (int64_t k = 0; k < row; k++) {
            move(m, s->positions.data + 3 * (start + k) * stride, at[k]);
            for (int i = 0; i < 3; i++) first[k][i] = cell_of(at[k][i] - LOOSE);
            key[k] = near_key(first[k][0], first[k][1], first[k][2]);
        }
        for (int64_t k = 0; k < row; k++) {
            int32_t u = s->near[key[k]] ? nearest_vertex(s, at[k], first[k], s->near[key[k]], reach) : -1;
            found += u >= 0 && u != (start + k) * stride;
            s->moved[start + k] = u;
        }
    }
    return found;
}

/* One step of Gauss and Newton, on at most FITTING vertices, towards what fits best; false if too few vertices fit. */
static bool fit(const Space *s, Motion *m, int64_t stride, double reach) {
    double middle[3] = {0.0, 0.0, 0.0}, off[3] = {0.0, 0.0, 0.0}, square[3][4] = {{0.0}};
    double seen = 0.0;
    count_moved(s, m, stride, reach);
    for (int pass = 0; pass < 2; pass++) {
        for (int64_t v = 0, at = 0; v < s->positions.rows; v += stride, at++) {
            int32_t u = s->moved[at];
            double p[3];
            if (u < 0) continue;
            move(m, s->positions.data + 3 * v, p);
            const double *q = s->positions.data + 3 * (int64_t)u;
            if (pass == 0) {
                for (int i = 0; i < 3; i++) middle[i] += p[i], off[i] += q[i] - p[i];
                seen += 1.0;
                continue;
            }
            double d[3];
            for (int i = 0; i < 3; i++) d[i] = q[i] - p[i] - off[i], p[i] -= middle[i];
            double size = dot3(p, p);
            for (int i = 0; i < 3; i++) {
                for (int j = 0; j < 3; j++) square[i][j] += (i == j ? size : 0.0) - p[i] * p[j];
                square[i][3] += p[(i + 1) % 3] * d[(i + 2) % 3] - p[(i + 2) % 3] * d[(i + 1) % 3];
            }
        }
        if (seen < 4.0) return false;
        for (int i = 0; i < 3 && pass == 0; i++) middle[i] /= seen, off[i] /= seen;
    }
    double ridge = 1e-6 * (square[0][0] + square[1][1] + square[2][2]) + 1e-9, w[3];
    for (int i = 0; i < 3; i++) square[i][i] += ridge;
    for (int i = 0; i < 3; i++) /* positive definite: no pivots */
        for (int k = i + 1; k < 3; k++) {
            double by = square[k][i] / square[i][i];
            for (int j = i; j < 4; j++) square[k][j] -= by * square[i][j];
        }
    for (int i = 2; i >= 0; i--) {
        w[i] = square[i][3];
        for (int j = i + 1; j < 3; j++) w[i] -= square[i][j] * w[j];
        w[i] /= square[i][i];
    }
    /* Cayley's rotation by w about the middle, after the motion. */
    double c = 1.0 / (1.0 + dot3(w, w) / 4.0);
    double spin[3][3] = {{0, -w[2], w[1]}, {w[2], 0, -w[0]}, {-w[1], w[0], 0}}, more[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double twice = 0.0;
            for (int k = 0; k < 3; k++) twice += spin[i][k] * spin[k][j];
            more[i][j] = (i == j) + c * (spin[i][j] + twice / 2.0);
        }
    Motion old = *m;
    for (int i = 0; i < 3; i++) {
        m->shift[i] = middle[i] + off[i];
        for (int k = 0; k < 3; k++) m->shift[i] += more[i][k] * (old.shift[k] - middle[k]);
        for (int j = 0; j < 3; j++) {
            m->turn[i][j] = 0.0;
            for (int k = 0; k < 3; k++) m->turn[i][j] += more[i][k] * old.turn[k][j];
        }
    }
    return true;
}

typedef struct { /* from the end of its longest side on */
    int32_t vertex[3], degree[3];
    double side[3];
} Triangle;

static bool triangle_of(const Space *s, ConstInts2 faces, ConstInts degrees, int64_t f, Triangle *t) {
    const int32_t *face = faces.data + 3 * f;
    double side[3], edge[3][3];
    int first = 0;
    for (int k = 0; k < 3; k++) {
        const double *a = s->positions.data + 3 * (int64_t)face[k];
        const double *b = s->positions.data + 3 * (int64_t)face[(k + 1) % 3];
        for (int i = 0; i < 3; i++) edge[k][i] = b[i] - a[i];
        side[k] = __builtin_sqrt(dot3(edge[k], edge[k]));
        if (side[k] > side[first]) first = k;
        if (!(side[k] > LEAST_SIDE)) return false;
    }
    double area[3];
    cross_of_face(s->positions.data, face, area);
    for (int k = 0; k < 3; k++) {
        t->vertex[k] = face[(first + k) % 3];
        t->degree[k] = degrees.data[t->vertex[k]];
        t->side[k] = side[(first + k) % 3];
    }
    return dot3(area, area) > 4.0 * LEAST_AREA * LEAST_AREA;
}

INLINE uint32_t side_key(const Triangle *t, uint32_t mask) {
    uint32_t hash = 1;
    for (int k = 0; k < 3; k++)
        hash = mixed(hash, (int64_t)(t->side[k] / (2.0 * ALIKE)) * 32 + least(t->degree[k], 31));
    return hash >> 7 & mask;
}

static bool are_alike(const Triangle *a, const Triangle *b) {
    bool same = true;
    for (int k = 0; k < 3; k++)
        same = same && a->degree[k] == b->degree[k] && __builtin_fabs(a->side[k] - b->side[k]) < ALIKE;
    return same;
}

/* The axes of a triangle as columns, and its middle. */
static void stand(const Space *s, const Triangle *t, bool mirror, double axes[3][3], double *middle) {
    const double *x[3];
    double along[3], up[3], length, height;
    for (int k = 0; k < 3; k++) x[k] = s->positions.data + 3 * (int64_t)t->vertex[k];
    for (int i = 0; i < 3; i++) {
        along[i] = x[1][i] - x[0][i];
        middle[i] = (x[0][i] + x[1][i] + x[2][i]) / 3.0;
    }
    cross3(x[0], x[1], x[2], up);
    length = __builtin_sqrt(dot3(along, along)), height = __builtin_sqrt(dot3(up, up));
    for (int i = 0; i < 3; i++) along[i] /= length, up[i] /= height;
    for (int i = 0; i < 3; i++) {
        axes[i][0] = along[i];
        axes[i][1] = up[(i + 1) % 3] * along[(i + 2) % 3] - up[(i + 2) % 3] * along[(i + 1) % 3];
        axes[i][2] = mirror ? -up[i] : up[i];
    }
}

static Motion motion_between(const Space *s, const Triangle *from, const Triangle *to, bool mirror) {
    double a[3][3], b[3][3], p[3], q[3];
    Motion m = {.votes = 1};
    stand(s, from, mirror, a, p);
    stand(s, to, false, b, q);
    for (int i = 0; i < 3; i++) {
        m.shift[i] = q[i];
        for (int j = 0; j < 3; j++) {
            m.turn[i][j] = 0.0;
            for (int k = 0; k < 3; k++) m.turn[i][j] += b[i][k] * a[j][k];
            m.shift[i] -= m.turn[i][j] * p[j];
        }
    }
    return m;
}

static void vote(Motion *votes, Motion m) {
    double off = 0.0, far = 0.0;
    uint32_t hash = 1;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            off += __builtin_fabs(m.turn[i][j] - (i == j));
            hash = mixed(hash, (int64_t)__builtin_floor(m.turn[i][j] * 8.0 + 0.5));
        }
        far += __builtin_fabs(m.shift[i]);
        hash = mixed(hash, (int64_t)__builtin_floor(m.shift[i] / 32.0 + 0.5));
    }
    if (off < 0.05 && far < 6.0) return; /* it moves nothing */
    m.key = hash | 1;
    for (uint32_t probe = 0; probe < 8; probe++) {
        Motion *at = votes + ((hash >> 5) + probe) % VOTES;
        if (at->votes == 0) *at = m;
        else if (at->key == m.key) at->votes++;
        else continue;
        return;
    }
}

static void collect_votes(const Space *s, ConstInts2 faces, ConstInts degrees, int32_t *head, int32_t *next,
    uint32_t mask, Motion *votes) {
    Triangle t, other;
    int64_t stride = faces.rows / MOST_ASKED + 1;
    for (int64_t f = 0; f < faces.rows; f++) {
        if (!triangle_of(s, faces, degrees, f, &t)) continue;
        uint32_t key = side_key(&t, mask);
        next[f] = head[key];
        head[key] = (int32_t)f;
    }
    for (int64_t f = 0; f < faces.rows; f += stride) {
        if (!triangle_of(s, faces, degrees, f, &t)) continue;
        for (int mirror = 0; mirror < 2; mirror++) {
            Triangle own = t;
            if (mirror)
                own = (Triangle){{t.vertex[1], t.vertex[0], t.vertex[2]}, {t.degree[1], t.degree[0], t.degree[2]},
                                 {t.side[0], t.side[2], t.side[1]}};
            int32_t g = head[side_key(&own, mask)];
            int pairs = 0;
            for (int walked = 0; g >= 0 && walked < MOST_WALKED && pairs < MOST_PAIRS; walked++, g = next[g]) {
                if ((g == f && !mirror) || !triangle_of(s, faces, degrees, g, &other) || !are_alike(&own, &other))
                    continue;
                vote(votes, motion_between(s, &own, &other, mirror));
                pairs++;
            }
        }
    }
}

/* Keep a motion if it is among those with most votes, in order; returns how many are kept. */
static int64_t keep(Motion *pool, int64_t count, int64_t most, Motion m) {
    if (count == most && pool[count - 1].votes >= m.votes) return count;
    int64_t end = count < most ? count + 1 : count, at = end - 1;
    for (; at > 0 && pool[at - 1].votes < m.votes; at--) pool[at] = pool[at - 1];
    pool[at] = m;
    return end;
}

/* The motions with most votes, and mirrors at the middle of the box. */
static int64_t choose_pool(Motion *votes) {
    int64_t count = 0, most = POOL - 3;
    for (int64_t i = 0; i < VOTES; i++)
        if (votes[i].votes >= 3) count = keep(votes, count, most, votes[i]);
    for (int axis = 0; axis < 3; axis++) {
        Motion m = {.turn = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        m.turn[axis][axis] = -1.0;
        votes[count++] = m;
    }
    return count;
}

/* Motions of positions (n x 3, in steps of a grid, from the middle of their box) with their faces (m x 3) and valences
 * (n): rows of a turn (9), a shift (3) and the share of vertices that they take to others in `found`, in the order of
 * what each explains that those before do not, each at least `worth` vertices. Returns how many. */
KERNEL int64_t find_motions(ConstDoubles2 positions, ConstInts2 faces, ConstInts degrees, double worth,
    MotionScratch scratch, Doubles2 found) {
    int64_t n = positions.rows, m = faces.rows, count = 0, moving = 0;
    Ints heads = scratch.heads, links = scratch.links;
    Bytes covered = scratch.covered;
    Motion *pool = (Motion *)scratch.pool.data;
    if (n < 1 || positions.columns != 3 || faces.columns != 3 || degrees.size != n || heads.size < 2
        || (heads.size & (heads.size - 1)) != 0 || links.size < n + m || covered.size < FITTED * COUNTED
        || scratch.pool.size * (int64_t)sizeof(double) < (int64_t)(VOTES * sizeof(Motion) + (1 << NEAR_BITS))
        || found.columns != 13)
        return MISUSED;
    if (!all_below(faces.data, 3 * m, n)) return MISUSED;
    for (int64_t k = 0; k < 3 * n; k++)
        if (!(__builtin_fabs(positions.data[k]) < 0x1p30)) return MISUSED;
    Space s = {positions, heads.data, links.data, (uint32_t)heads.size - 1, (uint8_t *)(pool + VOTES),
        (int32_t *)(pool + POOL)};
    for (int64_t i = 0; i < heads.size; i++) heads.data[i] = -1;
    collect_votes(&s, faces, degrees, heads.data, links.data + n, s.mask, pool);
    count = choose_pool(pool);
    for (int64_t i = 0; i < heads.size; i++) heads.data[i] = -1;
    for (int64_t v = 0; v < n; v++) {
        const double *x = positions.data + 3 * v;
        int32_t own[3] = {cell_of(x[0]), cell_of(x[1]), cell_of(x[2])};
        uint32_t key = cell_key(own[0], own[1], own[2], s.mask);
        links.data[v] = heads.data[key];
        heads.data[key] = (int32_t)v;
        for (int k = 0; k < 8; k++)
            s.near[near_key(own[0] - (k >> 2), own[1] - (k >> 1 & 1), own[2] - (k & 1))] |= (uint8_t)(1 << k);
    }
    int64_t tried = n / TRIED + 1, fitting = n / FITTING + 1, counted = n / COUNTED + 1, fitted = 0, kept = 0;
    for (int64_t i = 0; i < count; i++) {
        Motion own = pool[i];
        own.votes = count_moved(&s, &own, tried, LOOSE);
        if (own.votes >= 3) moving = keep(pool, moving, FITTED, own);
    }
    for (Motion *own = pool; own < pool + moving; own++)
        if (fit(&s, own, fitting, LOOSE) && fit(&s, own, fitting, LOOSE / 2.0) && fit(&s, own, fitting, CLOSE))
            pool[fitted++] = *own;
    /* Which vertices each explains: of a vertex and its image the later. */
    int64_t size = (n - 1) / counted + 1;
    for (int64_t i = 0; i < fitted; i++) {
        pool[i].votes = count_moved(&s, pool + i, counted, CLOSE);
        for (int64_t at = 0; at < size; at++) {
            int64_t v = at * counted, u = s.moved[at];
            if (u >= 0 && u != v) covered.data[size * i + largest(u, v) / counted] = 1;
        }
    }
    while (kept < found.rows) {
        int64_t best = -1, most = 0;
        for (int64_t i = 0; i < fitted; i++) {
            int64_t gain = 0;
            for (int64_t v = 0; v < size; v++) gain += covered.data[size * i + v];
            if (gain > most) most = gain, best = i;
        }
        if (best < 0 || (double)(most * counted) < worth) break;
        double *row = found.data + 13 * kept++;
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) row[3 * i + j] = pool[best].turn[i][j];
            row[9 + i] = pool[best].shift[i];
        }
        row[12] = (double)pool[best].votes / (double)size;
        for (int64_t i = 0; i < fitted; i++)
            for (int64_t v = 0; v < size && i != best; v++)
                covered.data[size * i + v] &= !covered.data[size * best + v];
        for (int64_t v = 0; v < size; v++) covered.data[size * best + v] = 0;
    }
    return kept;
}
