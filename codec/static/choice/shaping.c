/* Levels chosen so that normals come out right at few bits, instead of rounding. Encoder only: decoders see levels.
 *
 * In: the mesh as it should be, levels, and where they bring the vertices. Out: both, changed in place. Rounding
 * makes each vertex as near as it can be, which leaves normals of small faces to chance; a target that is an angle is
 * kept with a coarser step if vertices give way together. Coordinate descent, vertex after vertex: of the levels
 * nearby, the one at which the faces around are bent least, by area-weighted angle (as the chord, 2 sin(angle / 2),
 * which needs no arc), and cheap to code. A vertex is looked at again when it or a neighbor has moved, so late sweeps
 * cost little. Edges that fold are counted here, too, and mended: a fold is plain to see whatever the mean angle is. */
#include "codec/geometry/geometry.h"
#include "codec/static/choice/choice.h"

enum { FAN = 32, LANES = 8 }; /* faces of one vertex that are looked at, and how many of them at once */
enum { UNFOLDING = 8 };                   /* sweeps over what is turned over */
#define OVER 0.1 /* what a face that is turned over costs, over turning a face of mean area by a radian */
#define FOLD 1.0 /* what an edge costs that is folded farther than it was, for each of `FOLDS` */
/* Squares of the cosines of 100, 120 and 150 degrees. Rounding turns right angles by less than the first. */
static const double FOLDS[] = {0.03015, 0.25, 0.75};

/* The faces at a vertex, `padded` with some of no weight: twice the area times the normal, in coordinates along the
 * wanted normal and across it, in some unit of the vertex; and what a step in each direction adds to that, which is the
 * same wherever the vertex is. */
typedef struct {
    int count, padded;
    double unit, frame[3][3][FAN], edge[3][FAN];
    float normal[3][FAN], slope[3][3][FAN], weight[FAN];
} Fan;

INLINE double size(double x) { return x < 0.0 ? -x : x; }

INLINE void gather(const Wanted *wanted, ConstDoubles2 moved, int32_t v, Fan *fan) {
    const double *x = moved.data + 3 * (int64_t)v;
    double u[3][FAN], w[3][FAN], normal[3][FAN], longest = 0.0;
    int count = 0;
    for (int64_t i = wanted->around_starts.data[v]; i < wanted->around_starts.data[v + 1] && count < FAN; i++,
        count++) {
        int32_t f = wanted->around.data[i];
        const int32_t *face = wanted->faces.data + 3 * (int64_t)f;
        int corner = face[0] == v ? 0 : face[1] == v ? 1 : 2;
        const double *a = moved.data + 3 * (int64_t)face[(corner + 1) % 3];
        const double *b = moved.data + 3 * (int64_t)face[(corner + 2) % 3];
        for (int j = 0; j < 3; j++) {
            u[j][count] = a[j] - x[j], w[j][count] = b[j] - x[j];
            normal[j][count] = wanted->normals.data[3 * (int64_t)f + j];
            double length = size(u[j][count]) + size(w[j][count]);
            longest = length > longest ? length : longest;
        }
        fan->weight[count] = (float)wanted->weights.data[f];
    }
    int padded = (count + LANES - 1) / LANES * LANES;
    for (int k = count; k < padded; k++) {
        for (int j = 0; j < 3; j++) u[j][k] = w[j][k] = normal[j][k] = 0.0;
        fan->weight[k] = 0.0f;
    }
    fan->count = count, fan->padded = padded;
    double unit = fan->unit = longest > 0.0 ? 1.0 / longest : 0.0;
    for (int k = 0; k < padded; k++) {
        /* A frame of the wanted normal (Duff and others, Building an orthonormal basis, revisited, 2017). */
        double n0 = normal[0][k], n1 = normal[1][k], n2 = normal[2][k], sign = n2 < 0.0 ? -1.0 : 1.0;
        double c = -1.0 / (sign + n2), d = n0 * n1 * c;
        double frame[3][3] = {{n0, n1, n2}, {1.0 + sign * n0 * n0 * c, sign * d, -sign * n0},
            {d, sign + n1 * n1 * c, -n1}};
        double u0 = unit * u[0][k], u1 = unit * u[1][k], u2 = unit * u[2][k];
        double w0 = unit * w[0][k], w1 = unit * w[1][k], w2 = unit * w[2][k];
        double now[3] = {u1 * w2 - u2 * w1, u2 * w0 - u0 * w2, u0 * w1 - u1 * w0};
        fan->edge[0][k] = u0 - w0, fan->edge[1][k] = u1 - w1, fan->edge[2][k] = u2 - w2;
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) fan->frame[i][j][k] = frame[i][j];
            fan->slope[0][i][k] = 0.0f;
            fan->normal[i][k] = (float)(frame[i][0] * now[0] + frame[i][1] * now[1] + frame[i][2] * now[2]);
        }
    }
}

/* What a step in a direction adds. */
INLINE void find_slope(Fan *fan, int a, const double *direction) {
    double to[3] = {fan->unit * direction[0], fan->unit * direction[1], fan->unit * direction[2]};
    for (int k = 0; k < fan->padded; k++) {
        double e0 = fan->edge[0][k], e1 = fan->edge[1][k], e2 = fan->edge[2][k];
        double across[3] = {to[1] * e2 - to[2] * e1, to[2] * e0 - to[0] * e2, to[0] * e1 - to[1] * e0};
        for (int i = 0; i < 3; i++)
            fan->slope[a][i][k] = (float)(fan->frame[i][0][k] * across[0] + fan->frame[i][1][k] * across[1]
                + fan->frame[i][2][k] * across[2]);
    }
}

/* The chord between a normal with these coordinates, along what is wanted and across, and what is wanted. */
INLINE float chord(float along, float across, float aside) {
    float off = across * across + aside * aside;
    float length = __builtin_sqrtf(along * along + off + 1e-30f);
    float sum = length + (along < 0.0f ? -along : along);
    return __builtin_sqrtf(2.0f * (along > 0.0f ? off : sum * sum) / (length * sum));
}

/* How bent the faces are with the vertex moved by a number of steps in one direction. */
INLINE double bent_by(const Fan *fan, int a, float by) {
    float chords[FAN];
    double sum = 0.0;
    for (int k = 0; k < fan->padded; k++)
        chords[k] = fan->weight[k] * chord(fan->normal[0][k] + by * fan->slope[a][0][k],
                                           fan->normal[1][k] + by * fan->slope[a][1][k],
                                           fan->normal[2][k] + by * fan->slope[a][2][k]);
    for (int k = 0; k < fan->count; k++) sum += chords[k];
    return sum;
}

static void open_around(const Wanted *wanted, int32_t v, Bytes open) {
    open.data[v] = 1;
    for (int32_t i = wanted->beside_starts.data[v]; i < wanted->beside_starts.data[v + 1]; i++)
        open.data[wanted->beside.data[i]] = 1;
}

static bool fits(const Wanted *wanted, const Shaped *shaped) {
    int64_t n = wanted->positions.rows;
    return wanted->positions.columns == 3 && wanted->faces.columns == 3 && wanted->normals.columns == 3 &&
           wanted->normals.rows == wanted->faces.rows && wanted->weights.size == wanted->faces.rows &&
           wanted->around_starts.size == n + 1 && wanted->beside_starts.size == n + 1 &&
           shaped->moved.rows == n && shaped->moved.columns == 3 && shaped->levels.rows == n && shaped->open.size == n;
}

/* Levels (n x axes) along `directions` (n x 3 axes, a level long); `moved` is where they bring the vertices, and kept
 * in step. A level costs its distance from `pull` times the mean of all neighbors', over the scale of its axis.
 * Returns how often a vertex moved. */
KERNEL int64_t shape_levels(Wanted wanted, Aim aim, Shaped shaped, ConstDoubles2 directions, ConstDoubles scales,
    double pull) {
    Doubles2 moved = shaped.moved;
    Ints2 levels = shaped.levels;
    Bytes open = shaped.open;
    int64_t axes = levels.columns, moves = 0;
    if (!fits(&wanted, &shaped) || axes < 1 || axes > 3 || scales.size != axes ||
        directions.rows != levels.rows || directions.columns != 3 * axes)
        return MISUSED;
    ConstDoubles2 now_at = {moved.data, moved.rows, moved.columns};
    double reach = aim.reach * aim.reach;
    Fan fan;
    for (int64_t v = 0; v < open.size; v++) open.data[v] = 1;
    for (int64_t sweep = 0; sweep < aim.sweeps; sweep++)
        for (int32_t v = 0; v < (int32_t)levels.rows; v++) {
            if (!open.data[v]) continue;
            open.data[v] = 0;
            double direction[3][3];
            for (int64_t i = 0; i < 3 * axes; i++) direction[i / 3][i % 3] = directions.data[3 * v * axes + i];
            gather(&wanted, now_at, v, &fan);
            double *at = moved.data + 3 * (int64_t)v, now = bent_by(&fan, 0, 0.0f);
            const double *place = wanted.positions.data + 3 * (int64_t)v;
            double far = apart(place, at);
            int32_t first = wanted.beside_starts.data[v], end = wanted.beside_starts.data[v + 1];
            bool any = false;
            for (int a = 0; a < (int)axes; a++) {
                double mean = 0.0;
                for (int32_t i = first; i < end; i++) mean += levels.data[wanted.beside.data[i] * axes + a];
                mean = end > first ? pull * mean / (end - first) : 0.0;
                int32_t *level = levels.data + v * axes + a;
                double unit = aim.worth / scales.data[a], stay = unit * size(*level - mean);
                find_slope(&fan, a, direction[a]);
                for (int by = -1; by <= 1; by += 2) {
                    double there[3];
                    for (int j = 0; j < 3; j++) there[j] = at[j] + by * direction[a][j];
                    double away = apart(place, there), most = now + stay - unit * size(*level + by - mean);
                    if ((away > reach && away > far) || most <= 0.0) continue;
                    double then = bent_by(&fan, a, (float)by);
                    if (then >= most) continue;
                    for (int j = 0; j < 3; j++) at[j] = there[j];
                    for (int i = 0; i < 3; i++)
                        for (int k = 0; k < fan.padded; k++) fan.normal[i][k] += (float)by * fan.slope[a][i][k];
                    now = then, far = away, *level += by, any = true;
                    break;
                }
            }
            if (any) {
                moves++;
                open_around(&wanted, v, open);
            }
        }
    return moves;
}

/* Places on a grid (n x 3). `bends`: of each edge the sum of the places of its ends less that of the opposite corners;
 * `rates` is the cost of a bend. Returns how often a vertex moved. */
KERNEL int64_t shape_grid(
    Wanted wanted, Aim aim, Shaped shaped, double step, Flaps edges, Ints2 bends, ConstDoubles rates) {
    Doubles2 moved = shaped.moved;
    Ints2 places = shaped.levels;
    Bytes open = shaped.open;
    ConstInts starts = edges.starts, members = edges.members;
    if (!fits(&wanted, &shaped) || places.columns != 3 || edges.rows.columns != 4 || bends.columns != 3 ||
        bends.rows != edges.rows.rows || starts.size != places.rows + 1 || rates.size < 1)
        return MISUSED;
    ConstDoubles2 now_at = {moved.data, moved.rows, moved.columns};
    double reach = aim.reach * aim.reach;
    int64_t moves = 0;
    Fan fan;
    for (int64_t v = 0; v < open.size; v++) open.data[v] = 1;
    for (int64_t sweep = 0; sweep < aim.sweeps; sweep++)
        for (int32_t v = 0; v < (int32_t)places.rows; v++) {
            if (!open.data[v]) continue;
            open.data[v] = 0;
            gather(&wanted, now_at, v, &fan);
            double *at = moved.data + 3 * (int64_t)v, now = bent_by(&fan, 0, 0.0f);
            const double *place = wanted.positions.data + 3 * (int64_t)v;
            bool any = false;
            for (int a = 0; a < 3; a++) {
                double rate[3] = {0.0}, direction[3] = {0.0}, stay = at[a], far = apart(place, at), best, then = now;
                for (int32_t i = starts.data[v]; i < starts.data[v + 1]; i++)
                    for (int d = -1; d <= 1; d++) {
                        int64_t bend = bends.data[3 * (int64_t)(members.data[i] >> 1) + a];
                        bend += members.data[i] & 1 ? -d : d;
                        rate[d + 1] += rates.data[least(bend < 0 ? -bend : bend, rates.size - 1)];
                    }
                best = now + aim.worth * rate[1];
                direction[a] = step;
                find_slope(&fan, a, direction);
                int pick = 0;
                for (int by = -1; by <= 1; by += 2) {
                    at[a] = stay + by * step;
                    double away = apart(place, at), cost = aim.worth * rate[by + 1];
                    if ((away > reach && away > far) || cost >= best) continue;
                    double bent = bent_by(&fan, a, (float)by);
                    if (cost + bent < best) best = cost + bent, then = bent, pick = by;
                }
                at[a] = stay + pick * step;
                if (!pick) continue;
                any = true, now = then, places.data[3 * (int64_t)v + a] += pick;
                for (int i = 0; i < 3; i++)
                    for (int k = 0; k < fan.padded; k++) fan.normal[i][k] += (float)pick * fan.slope[a][i][k];
                for (int32_t i = starts.data[v]; i < starts.data[v + 1]; i++)
                    bends.data[3 * (int64_t)(members.data[i] >> 1) + a] += members.data[i] & 1 ? -pick : pick;
            }
            if (any) {
                moves++;
                open_around(&wanted, v, open);
            }
        }
    return moves;
}

/* Whether a normal with these coordinates is more than 60 degrees off: two faces that are may be folded onto each
 * other. */
INLINE bool is_over(float along, float across, float aside) {
    return along < 0.0f || across * across + aside * aside > 3.0f * along * along;
}

/* How bent the faces are with the vertex moved by a number of levels, and the cost of faces that turn over. */
INLINE double folded_by(const Fan *fan, const float *by, double over) {
    double sum = 0.0;
    for (int k = 0; k < fan->count; k++) {
        float at[3];
        for (int i = 0; i < 3; i++)
            at[i] = fan->normal[i][k] + by[0] * fan->slope[0][i][k] + by[1] * fan->slope[1][i][k]
                + by[2] * fan->slope[2][i][k];
        sum += fan->weight[k] * chord(at[0], at[1], at[2]) + (is_over(at[0], at[1], at[2]) ? over : 0.0);
    }
    return sum;
}

/* How far an edge between two faces is folded: 1 by more than 90 degrees, 2 to 4 by more than 100, 120 and 150; 0 by
 * less. The vertex `v` lies `there`. */
INLINE int folded_at(const double *positions, const int32_t *flap, int32_t v, const double *there) {
    const double *at[4];
    for (int k = 0; k < 4; k++) at[k] = flap[k] == v ? there : positions + 3 * (int64_t)flap[k];
    double n[3], m[3];
    cross3(at[0], at[1], at[2], n), cross3(at[1], at[0], at[3], m);
    double along = dot3(n, m);
    if (along >= 0.0) return 0;
    double square = along * along / (dot3(n, n) * dot3(m, m));
    return 1 + (square > FOLDS[0]) + (square > FOLDS[1]) + (square > FOLDS[2]);
}

/* How far each edge between faces is folded, as `folded_at` has it. Returns how many are folded at all. */
int64_t count_folds(ConstDoubles2 positions, ConstInts2 flaps, Bytes folded) {
    int64_t count = 0;
    if (positions.columns != 3 || flaps.columns != 4 || folded.size != flaps.rows) return MISUSED;
    for (int64_t f = 0; f < flaps.rows; f++) {
        folded.data[f] = (uint8_t)folded_at(positions.data, flaps.data + 4 * f, -1, positions.data);
        count += folded.data[f] > 0;
    }
    return count;
}

/* By how much more than it may an edge is folded. */
INLINE int folded_more(int now, int most) { return now > most ? now - most : 0; }

/* By how much more than they may the edges around a vertex that lies `there` are folded. */
INLINE int wrong_around(
    const Flaps *edges, const uint8_t *most, const double *positions, int32_t v, const double *there) {
    int sum = 0;
    for (int32_t i = edges->starts.data[v]; i < edges->starts.data[v + 1]; i++) {
        int64_t f = edges->members.data[i] >> 1;
        sum += folded_more(folded_at(positions, edges->rows.data + 4 * f, v, there), most[f]);
    }
    return sum;
}

/* Moves levels (n x 3) by up to two along `directions` (n x 9, or one row for all; a level long) where that unfolds
 * edges that are folded farther than they `were` (at least 1). Where more than `most` edges are, it also turns faces
 * back, however small they are, which rounding has turned over. `moved` is kept in step. No vertex ends up farther from
 * its place than its `reach`, unless it was. Returns how often one moved. */
KERNEL int64_t unfold_levels(Wanted wanted, ConstDoubles reach, Shaped shaped, ConstDoubles2 directions, Flaps edges,
    int64_t most, ConstBytes were) {
    Doubles2 moved = shaped.moved;
    Ints2 levels = shaped.levels;
    Bytes open = shaped.open;
    ConstInts2 flaps = edges.rows;
    if (!fits(&wanted, &shaped) || levels.columns != 3 || directions.columns != 9
        || reach.size != levels.rows || (directions.rows != levels.rows && directions.rows != 1) || flaps.columns != 4
        || edges.starts.size != levels.rows + 1 || were.size != flaps.rows)
        return MISUSED;
    ConstDoubles2 now_at = {moved.data, moved.rows, moved.columns};
    double face = 1.0 / (double)largest(wanted.faces.rows, 1), over = OVER * face, fold = FOLD * face;
    int64_t more = 0, moves = 0;
    Fan fan;
    for (int64_t v = 0; v < open.size; v++) open.data[v] = 0;
    for (int64_t f = 0; f < flaps.rows; f++) {
        const int32_t *flap = flaps.data + 4 * f;
        if (!folded_more(folded_at(moved.data, flap, -1, moved.data), were.data[f])) continue;
        more++;
        for (int k = 0; k < 4; k++) open.data[flap[k]] = 1;
    }
    if (!more) return 0;
    for (int64_t f = 0; f < wanted.faces.rows && more > most; f++) {
        const int32_t *face = wanted.faces.data + 3 * f;
        const double *normal = wanted.normals.data + 3 * f, *at[3];
        for (int k = 0; k < 3; k++) at[k] = moved.data + 3 * (int64_t)face[k];
        double n[3];
        cross3(at[0], at[1], at[2], n);
        double along = dot3(normal, n);
        for (int k = 0; k < 3 && (along < 0.0 || dot3(n, n) > 4.0 * along * along); k++) open.data[face[k]] = 1;
    }
    for (int64_t sweep = 0; sweep < UNFOLDING; sweep++)
        for (int32_t v = 0; v < (int32_t)levels.rows; v++) {
            if (!open.data[v]) continue;
            open.data[v] = 0;
            double *at = moved.data + 3 * (int64_t)v;
            gather(&wanted, now_at, v, &fan);
            int folds = wrong_around(&edges, were.data, moved.data, v, at);
            bool any = folds > 0;
            for (int k = 0; k < fan.count; k++) any |= is_over(fan.normal[0][k], fan.normal[1][k], fan.normal[2][k]);
            if (!any) continue;
            const double *direction = directions.data + (directions.rows == 1 ? 0 : 9 * (int64_t)v);
            const double *place = wanted.positions.data + 3 * (int64_t)v;
            double stay[3] = {at[0], at[1], at[2]}, far = apart(place, at), most_far = reach.data[v] * reach.data[v];
            for (int a = 0; a < 3; a++) find_slope(&fan, a, direction + 3 * a);
            double best = __builtin_inf();
            int pick[3] = {0};
            for (int wide = 0; wide <= 2 && (wide < 2 || folds); wide++)
                for (int side = 2 * wide + 1, c = 0; c < side * side * side; c++) {
                    int move[3] = {c % side - wide, c / side % side - wide, c / side / side - wide};
                    float by[3] = {(float)move[0], (float)move[1], (float)move[2]};
                    double there[3];
                    for (int j = 0; j < 3; j++)
                        there[j] = stay[j] + by[0] * direction[j] + by[1] * direction[3 + j] + by[2] * direction[6 + j];
                    double away = apart(place, there);
                    if (wide && away > most_far && away > far) continue;
                    double then = folded_by(&fan, by, over);
                    if (then >= best) continue;
                    int wrong_then = wrong_around(&edges, were.data, moved.data, v, there);
                    then += fold * wrong_then;
                    if (then >= best) continue;
                    best = then, folds = wrong_then;
                    for (int a = 0; a < 3; a++) pick[a] = move[a];
                }
            if (!pick[0] && !pick[1] && !pick[2]) continue;
            for (int a = 0; a < 3; a++) {
                levels.data[3 * (int64_t)v + a] += pick[a];
                for (int j = 0; j < 3; j++) at[j] += pick[a] * direction[3 * a + j];
            }
            moves++;
            open_around(&wanted, v, open);
        }
    return moves;
}

/* Two faces at an edge, as its ends and the two corners opposite: rows of `flaps`, at most one for each edge. `starts`
 * and `members` are the graph's rows, ascending; `pending` is scratch, as long as `members`. Returns how many. */
int64_t collect_flaps(ConstInts2 faces, ConstInts starts, ConstInts members, Ints pending, Ints2 flaps) {
    if (faces.columns != 3 || flaps.columns != 4 || pending.size != members.size) return MISUSED;
    int64_t count = 0;
    for (int64_t i = 0; i < pending.size; i++) pending.data[i] = -1;
    for (int64_t f = 0; f < faces.rows; f++)
        for (int corner = 0; corner < 3; corner++) {
            const int32_t *face = faces.data + 3 * f;
            int32_t c = face[corner], a = face[(corner + 1) % 3], b = face[(corner + 2) % 3];
            int32_t low = (int32_t)least(a, b), high = (int32_t)largest(a, b);
            if (a == b || a == c || b == c) continue;
            int64_t from = starts.data[low], to = starts.data[low + 1];
            while (to - from > 1) {
                int64_t middle = (from + to) / 2;
                if (members.data[middle] <= high)
                    from = middle;
                else
                    to = middle;
            }
            int32_t before = pending.data[from];
            if (before < 0) {
                pending.data[from] = c;
            } else if (before != c && count < flaps.rows) {
                int32_t *flap = flaps.data + 4 * count++;
                flap[0] = low, flap[1] = high, flap[2] = before, flap[3] = c;
                pending.data[from] = -1;
            }
        }
    return count;
}

/* The flaps of each vertex, from its start on: twice their rows, and 1 where it is an opposite corner. */
int64_t list_flaps(ConstInts2 flaps, Ints starts, Ints members) {
    int64_t size = starts.size - 1, count = 4 * flaps.rows;
    if (size < 0 || flaps.columns != 4 || members.size != count || count > INT32_MAX
        || !all_below(flaps.data, count, size))
        return MISUSED;
    for (int64_t v = 0; v <= size; v++) starts.data[v] = 0;
    for (int64_t i = 0; i < count; i++) starts.data[flaps.data[i]]++;
    int32_t sum = 0;
    for (int64_t v = 0; v <= size; v++) sum += starts.data[v], starts.data[v] = sum;
    /* From the last one back, so that each start falls to its place and rows ascend. */
    for (int64_t f = flaps.rows - 1; f >= 0; f--)
        for (int k = 3; k >= 0; k--) members.data[--starts.data[flaps.data[4 * f + k]]] = (int32_t)(2 * f + (k >= 2));
    return 0;
}
