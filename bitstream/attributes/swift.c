/* Values that are quick to decode: one guess, and plain decisions or mixed ones of three contexts (specification, A 9).
 *
 * Numbers are guessed from parallelograms, shapes or neighbors, normals from the surface, its drift or neighbors:
 * whichever was nearest around. Rows come as they are numbered. */
#include "bitstream/attributes/attributes.h"
#include "bitstream/fields/distances.h"

enum {
    CANDIDATES = 3, TALLIES = SWIFT_TALLIES, ERROR = CANDIDATES, /* columns of a row */
    SPACE = 3, PAIR = 2, OWN = 0, SURFACE = 3,                   /* columns of directions */
    MOST_ENDS = 32,
    FARTHEST_EDGE = 1 << 24, FARTHEST_TALLY = 1 << 20, FARTHEST_ERROR = 1 << 24, NEW_ERROR = 128, /* in 1/16 */
    FEW = 8, UNKNOWN_NEAR = FEW - 1,
    NORMAL_SIZE = 10 * FINE,
};

typedef struct { /* what is known around a row before its values */
    int ends, bases, flaps, best;
    int32_t end[MOST_ENDS], latest;
    Base base[MOST_BASES];
    int32_t size; /* of errors to expect, in 1/16 */
} RowPlace;

typedef struct {
    int32_t at[CANDIDATES];
} Candidates;

INLINE const int32_t *tally_of(const Swift *s, int32_t v) { return s->tallies.data + TALLIES * (int64_t)v; }
INLINE int32_t row_value(const Swift *s, int32_t v, int j) { return s->own.values.data[s->own.values.columns * v + j]; }
INLINE int32_t few(int32_t x) { return (int32_t)least(size_class(size_of(x) >> 3), FEW - 1); }

static void survey_row(const Swift *s, int32_t v, RowPlace *place) {
    const Corners *c = &s->corners;
    const int32_t *row = c->faces.data;
    int32_t tally[TALLIES] = {0, 0, 0, 0}; /* of at most MOST_ENDS rows */
    int columns = (int)s->own.values.columns;
    place->ends = place->bases = place->flaps = place->best = 0;
    place->latest = -1;
    for (int32_t i = c->starts.data[v]; i < c->starts.data[v + 1]; i++) {
        int32_t k = c->corners.data[i], end[2] = {row[next_corner(k)], row[previous_corner(k)]};
        for (int side = 0; side < 2 && place->ends < MOST_ENDS; side++) {
            if (end[side] >= v) continue;
            const int32_t *of_end = tally_of(s, end[side]);
            place->end[place->ends++] = end[side];
            place->latest = (int32_t)largest(place->latest, end[side]);
            for (int q = 0; q < TALLIES; q++) tally[q] += of_end[q];
        }
        if (s->normals || end[0] >= v || end[1] >= v || end[0] == end[1] || place->bases == MOST_BASES) continue;
        int32_t tip = c->opposite.data[k], beyond = tip >= 0 && row[tip] < v ? row[tip] : -1;
        place->base[place->bases++] = (Base){.a = end[0], .b = end[1], .c = beyond, .tip = tip};
        place->flaps += beyond >= 0;
    }
    for (int q = 1; q < CANDIDATES; q++)
        if (tally[q] < tally[place->best]) place->best = q;
    if (place->ends > 0) place->size = tally[ERROR] / (place->ends * columns);
    else place->size = s->normals ? NORMAL_SIZE : FINE * s->own.largest.data[0];
}

/* Code component j of a row around its guess; false if it is invalid. */
INLINE bool code_number(Swift *s, RangeCoder *coder, const RowPlace *place, int j, const Candidates *all, int32_t guess,
    int32_t kind, int32_t low, int32_t high, int32_t *value, int32_t *gaps) {
    int32_t level = whole(guess), error = 0, before = j > 0 ? gaps[j - 1] : 0;
    DistanceModel m = {.coder = coder, .slots = s->slots.data + j * s->slots_of_one,
        .weights = s->mixed ? s->weights.data + j * LEAN_NODES * LEAN_INPUTS : NULL};
    for (int i = 0; i < j; i++) error += size_of(gaps[i]);
    m.size = (int32_t)(((8 - j) * (int64_t)place->size + error) >> 3);
    m.kind = j == 0 ? 3 * kind + place->best : (int32_t)least(size_class(size_of(before) >> 3), LIGHT_KINDS - 1);
    if (s->mixed) {
        int32_t near = place->latest >= 0 ? few(tally_of(s, place->latest)[ERROR]) : UNKNOWN_NEAR;
        int32_t apart = FEW * few(all->at[0] - all->at[1]) + few(all->at[0] - all->at[2]);
        int32_t context[LEAN_INPUTS] = {size_class_of(m.size) * LIGHT_KINDS + m.kind, CANDIDATES * apart + place->best,
            j == 0 ? FEW * near + few(m.size) : (FEW * near + few(before)) * 2 + (before > 0)};
        for (int i = 0; i < LEAN_INPUTS; i++)
            m.context[i] = (int64_t)(i * SWIFT_CONTEXTS + context[i]) * LEAN_NODES;
    }
    *value = level + code_distance(&m, guess - FINE * level, is_reading(coder) ? 0 : *value - level);
    gaps[j] = FINE * *value - guess;
    return *value >= low && *value <= high;
}

static void keep_tallies(Swift *s, int32_t v, const RowPlace *place, const int64_t *away, const int32_t *gaps) {
    int32_t *own = s->tallies.data + TALLIES * (int64_t)v;
    int64_t error = 0;
    for (int j = 0; j < s->own.values.columns; j++) error += size_of(gaps[j]);
    for (int q = 0; q < CANDIDATES; q++) own[q] = (int32_t)least(away[q], FARTHEST_TALLY);
    own[ERROR] = place->ends > 0 ? (int32_t)least(error, FARTHEST_ERROR) : NEW_ERROR;
}

/* Where the parallelograms are, or the shapes of triangles, and the mean of the ends (A 9.4). */
static void guess_numbers(const Swift *s, int32_t v, const RowPlace *place, Candidates *all) {
    int columns = (int)s->own.values.columns;
    bool shaped = s->own.geometry.rows > 0 && columns == 2;
    int64_t affine[2] = {0, 0}, similar[2] = {0, 0}, weights = 0;
    for (int i = 0; shaped && i < place->bases; i++) {
        Claim claim = claim_of(&s->own, v, &place->base[i]);
        for (int j = 0; j < 2; j++) {
            affine[j] += (int64_t)claim.weight * claim.affine[j];
            similar[j] += (int64_t)claim.weight * claim.similar[j];
        }
        weights += claim.weight;
    }
    for (int j = 0; j < columns; j++) {
        int64_t sum = 0, across = 0;
        for (int i = 0; i < place->ends; i++) sum += row_value(s, place->end[i], j);
        for (int i = 0; i < place->bases; i++) {
            const Base *b = &place->base[i];
            if (b->c >= 0) across += (int64_t)row_value(s, b->a, j) + row_value(s, b->b, j) - row_value(s, b->c, j);
        }
        int32_t last = v > 0 ? FINE * row_value(s, v - 1, j) : FINE / 2 * s->own.largest.data[j];
        int32_t mean = place->ends > 0 ? divided(FINE * sum, place->ends) : last;
        int32_t straight = place->flaps > 0 ? divided(FINE * across, place->flaps) : mean;
        all[j] = (Candidates){{straight, mean, last}};
        if (!shaped) continue;
        bool some = weights > 0;
        int32_t own = some ? divided(affine[j], (int32_t)weights) : straight;
        all[j] = (Candidates){{own, straight, some ? divided(similar[j], (int32_t)weights) : mean}};
    }
}

static void pass_turns(const Swift *s, int32_t v, const RowPlace *place) {
    for (int i = 0; i < place->bases; i++)
        s->own.chart.data[0] += turn_of(&s->own, place->base[i].a, place->base[i].b, v);
}

static bool code_numbers(Swift *s, RangeCoder *coder, int32_t v) {
    RowPlace place;
    Candidates all[MOST_COMPONENTS];
    int columns = (int)s->own.values.columns;
    int32_t *own = s->own.values.data + columns * (int64_t)v, gaps[MOST_COMPONENTS] = {0};
    int64_t away[CANDIDATES] = {0, 0, 0};
    survey_row(s, v, &place);
    guess_numbers(s, v, &place, all);
    for (int j = 0; j < columns; j++) {
        int32_t most = s->own.largest.data[j], guess = within(all[j].at[place.best], 0, FINE * most);
        if (!code_number(s, coder, &place, j, &all[j], guess, (int32_t)least(place.flaps, 3), 0, most, own + j, gaps))
            return false;
        for (int q = 0; q < CANDIDATES; q++) away[q] += size_of(all[j].at[q] - FINE * own[j]);
    }
    keep_tallies(s, v, &place, away, gaps);
    if (s->own.geometry.rows > 0 && columns == 2) pass_turns(s, v, &place);
    return true;
}

INLINE int32_t *direction_at(const Swift *s, int32_t v, int role) {
    return s->directions.data + 2 * SPACE * (int64_t)v + role;
}

/* Where the surface, its drift and the ends have a normal (A 9.5). */
static void guess_normal(const Swift *s, int32_t v, const RowPlace *place, int64_t (*at)[SPACE]) {
    int32_t size = FINE * middle(&s->own), *surface = direction_at(s, v, SURFACE);
    int64_t mean[SPACE] = {0, 0, v > 0 ? 0 : size}, drift[SPACE] = {0, 0, 0};
    for (int j = 0; j < SPACE && v > 0 && place->ends == 0; j++) mean[j] = direction_at(s, v - 1, OWN)[j];
    if (place->ends > 0) mean[2] = 0;
    for (int i = 0; i < place->ends; i++) {
        const int32_t *of_end = direction_at(s, place->end[i], OWN);
        for (int j = 0; j < SPACE; j++) mean[j] += of_end[j], drift[j] += of_end[j] - of_end[SURFACE + j];
    }
    if (place->ends > 0)
        for (int j = 0; j < SPACE; j++)
            mean[j] = divided(mean[j], place->ends), drift[j] = divided(drift[j], place->ends);
    if (surface[0] == 0 && surface[1] == 0 && surface[2] == 0) {
        Direction d = scaled_direction(mean, size);
        for (int j = 0; j < SPACE; j++) surface[j] = d.axis[j];
    }
    for (int j = 0; j < SPACE; j++) {
        at[0][j] = surface[j];
        at[1][j] = surface[j] + drift[j];
        at[2][j] = mean[j];
    }
}

static bool code_direction(Swift *s, RangeCoder *coder, int32_t v) {
    RowPlace place;
    Candidates all[PAIR];
    int32_t k = middle(&s->own), *own = s->own.values.data + PAIR * (int64_t)v;
    int32_t pair[PAIR] = {0, 0}, guess[PAIR], gaps[PAIR];
    int64_t at[CANDIDATES][SPACE], away[CANDIDATES] = {0, 0, 0};
    View front = {.first = 0, .second = 1, .pole = 2, .sign = 1, .size = FINE * k};
    survey_row(s, v, &place);
    guess_normal(s, v, &place, at);
    Direction best = scaled_direction(at[place.best], FINE * k);
    View view = view_from(&best, FINE * k);
    see(&view, &best, guess);
    if (!is_reading(coder)) {
        int32_t given[PAIR] = {(own[0] - k) * FINE, (own[1] - k) * FINE};
        Direction d = seen_as(&front, given);
        see(&view, &d, pair);
    }
    for (int j = 0; j < PAIR; j++) {
        int axis = j == 0 ? view.first : view.second;
        int32_t value = pair[j] / FINE, around = (int32_t)least((place.ends + 1) >> 1, 3);
        for (int q = 0; q < CANDIDATES; q++) all[j].at[q] = (int32_t)at[q][axis];
        if (!code_number(s, coder, &place, j, &all[j], guess[j], around, -k, k, &value, gaps)) return false;
        pair[j] = value * FINE;
    }
    Direction d = seen_as(&view, pair);
    see(&front, &d, pair);
    for (int j = 0; j < PAIR; j++) own[j] = pair[j] / FINE + k;
    for (int j = 0; j < SPACE; j++) {
        direction_at(s, v, OWN)[j] = d.axis[j];
        for (int q = 0; q < CANDIDATES; q++) away[q] += largest(at[q][j] - d.axis[j], d.axis[j] - at[q][j]);
    }
    keep_tallies(s, v, &place, away, gaps);
    return true;
}

/* Add the normal of a face to those of its rows, by its angles there (A 9.5). */
static void add_normal(const Swift *s, int64_t f, int64_t *sums) {
    const int32_t *row = s->corners.faces.data + 3 * f, *p = s->own.geometry.data;
    int64_t edge[3][SPACE], normal[SPACE], most = 0, square = 0, unit[SPACE];
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < SPACE; j++)
            edge[k][j] = within((int64_t)p[SPACE * (int64_t)row[(k + 1) % 3] + j] - p[SPACE * (int64_t)row[k] + j],
                -FARTHEST_EDGE, FARTHEST_EDGE);
    for (int j = 0; j < SPACE; j++) {
        int a = (j + 1) % 3, b = (j + 2) % 3;
        normal[j] = edge[2][a] * edge[0][b] - edge[2][b] * edge[0][a];
        most |= normal[j] < 0 ? -normal[j] : normal[j];
    }
    int shift = most > 0 ? (int)largest(36 - __builtin_clzll((uint64_t)most), 0) : 0;
    for (int j = 0; j < SPACE; j++) square += (normal[j] >> shift) * (normal[j] >> shift);
    int64_t length = square_root(square);
    if (length == 0) return;
    for (int j = 0; j < SPACE; j++) unit[j] = quotient((normal[j] >> shift) * (1 << 14), length);
    for (int k = 0; k < 3; k++) {
        const int64_t *out = edge[k], *in = edge[(k + 2) % 3];
        int64_t angle = angle_of(-(out[0] * in[0] + out[1] * in[1] + out[2] * in[2]) >> shift, length);
        for (int j = 0; j < SPACE; j++) sums[SPACE * (int64_t)row[k] + j] += unit[j] * angle;
    }
}

void expect_directions(Swift *s, int64_t *sums) {
    for (int64_t f = 0; f < s->corners.faces.rows; f++) add_normal(s, f, sums);
    for (int32_t v = 0; v < s->own.values.rows; v++) {
        const int64_t *sum = sums + SPACE * (int64_t)v;
        if (sum[0] == 0 && sum[1] == 0 && sum[2] == 0) continue;
        Direction d = scaled_direction(sum, FINE * middle(&s->own));
        for (int j = 0; j < SPACE; j++) direction_at(s, v, SURFACE)[j] = d.axis[j];
    }
}

typedef struct {
    RangeCoder *coder;
    Swift *swift;
} Rows;

static bool code_row(void *work, int64_t v) {
    Rows *rows = work;
    if (rows->swift->normals) return code_direction(rows->swift, rows->coder, (int32_t)v);
    return code_numbers(rows->swift, rows->coder, (int32_t)v);
}

int64_t code_swift(RangeCoder *coder, Swift *swift, int64_t first, int64_t count) {
    Rows rows = {coder, swift};
    return code_rows(coder, swift->own.values.rows, first, count, MOST_COMPONENTS * VALUE_BYTES, code_row, &rows);
}
