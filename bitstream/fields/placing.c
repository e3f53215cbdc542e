/* Where writers put vertices on a grid: faces keep an area, and edges do not fold (encoder only).
 *
 * A vertex that breaks this is put into the cell beside its own that has fewest such faults: before a grid is coded,
 * and again when its turn comes, for others have moved by then. A vertex then goes to the cell of an image, which costs
 * one decision. It does so if it has no more faults there, and stays near the planes of its faces. None comes farther
 * from where it would be than it may. What has no area or is folded in the first place does not count. */
#include "bitstream/fields/fields.h"

enum { AXES = 3, WANTED = 4, FOLD = 256 /* what a folded edge counts */, SWEEPS = 2, TRIES = 4 };
static const double FLAT = 1e-20, HEIGHT = 0.36;
/* Of a face without area, the square of its area over that of its longest side's square; and what `height_of` may be
 * where a vertex goes to an image: in the plane of a surface hardly anything is seen. */

typedef struct {
    const Corners *corners;
    const int32_t *places;
    const double *wanted;
} Sides;

/* Where vertex v is, or would be. */
INLINE void place_of(const Sides *s, int32_t v, bool wanted, double *place) {
    for (int j = 0; j < AXES; j++)
        place[j] = wanted ? s->wanted[WANTED * (int64_t)v + j] : s->places[AXES * (int64_t)v + j];
}

/* The normal of the face of corner k, twice as long as its area. */
INLINE void normal_at(const Sides *s, int32_t k, bool wanted, double *normal) {
    const int32_t *vertex = s->corners->faces.data;
    double a[AXES], b[AXES], c[AXES];
    place_of(s, vertex[k], wanted, a);
    place_of(s, vertex[next_corner(k)], wanted, b);
    place_of(s, vertex[previous_corner(k)], wanted, c);
    for (int j = 0; j < AXES; j++) {
        int p = (j + 1) % 3, q = (j + 2) % 3;
        normal[j] = (b[p] - a[p]) * (c[q] - a[q]) - (b[q] - a[q]) * (c[p] - a[p]);
    }
}

INLINE double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Whether a face with this normal has an area. */
static bool has_area(const Sides *s, int32_t k, bool wanted, const double *normal) {
    const int32_t *vertex = s->corners->faces.data;
    double most = 0.0;
    for (int i = 0; i < 3; i++, k = next_corner(k)) {
        double a[AXES], b[AXES], side[AXES];
        place_of(s, vertex[k], wanted, a);
        place_of(s, vertex[next_corner(k)], wanted, b);
        for (int j = 0; j < AXES; j++) side[j] = b[j] - a[j];
        double square = dot(side, side);
        if (square > most) most = square;
    }
    return dot(normal, normal) > FLAT * most * most;
}

/* Faults of the face of corner k: whether it has lost its area, and how many of its edges are folded. */
static int64_t faults_of(const Sides *s, int32_t k) {
    const int32_t *vertex = s->corners->faces.data, *opposite = s->corners->opposite.data;
    double own[AXES], other[AXES];
    normal_at(s, k, false, own);
    int64_t count = 0;
    if (!has_area(s, k, false, own)) { /* its edges fold as they would where it had one */
        normal_at(s, k, true, own);
        count = has_area(s, k, true, own);
    }
    for (int side = 0; side < 3; side++, k = next_corner(k)) {
        if (opposite[k] < 0) continue;
        normal_at(s, opposite[k], false, other);
        /* One of both may be turned over. */
        double turn = vertex[next_corner(k)] == vertex[next_corner(opposite[k])] ? -1.0 : 1.0;
        if (turn * dot(own, other) >= 0.0) continue;
        double first[AXES], second[AXES];
        normal_at(s, k, true, first);
        normal_at(s, opposite[k], true, second);
        count += FOLD * (turn * dot(first, second) >= 0.0);
    }
    return count;
}

/* Those of the faces around v; counted until there are more than `enough`. */
static int64_t faults_at(const Sides *s, int32_t v, int64_t enough) {
    int64_t count = 0;
    for (int32_t i = s->corners->starts.data[v]; i < s->corners->starts.data[v + 1] && count <= enough; i++)
        count += faults_of(s, s->corners->corners.data[i]);
    return count;
}

/* The square of how far a cell is from where v would be. */
INLINE double square_of(const double *wanted, const int32_t *cell) {
    double x = cell[0] - wanted[0], y = cell[1] - wanted[1], z = cell[2] - wanted[2];
    return x * x + y * y + z * z;
}

/* The mean square of how far a cell is from the planes of the faces around v, where these would be. */
static double height_of(const Sides *s, int32_t v, const int32_t *cell) {
    double off[AXES], sum = 0.0, areas = 0.0, normal[AXES];
    for (int j = 0; j < AXES; j++) off[j] = cell[j] - s->wanted[WANTED * (int64_t)v + j];
    for (int32_t i = s->corners->starts.data[v]; i < s->corners->starts.data[v + 1]; i++) {
        normal_at(s, s->corners->corners.data[i], true, normal);
        if (!has_area(s, s->corners->corners.data[i], true, normal)) continue;
        double area = __builtin_sqrt(dot(normal, normal)), along = dot(normal, off);
        sum += along * along / area;
        areas += area;
    }
    return areas > 0.0 ? sum / areas : 0.0;
}

INLINE void put(int32_t *place, const int32_t *cell) {
    for (int j = 0; j < AXES; j++) place[j] = cell[j];
}

/* Put v into the cell beside its own that has fewest faults, the nearest of these. */
static void mend_vertex(const Sides *s, int32_t *place, const int32_t *most, int32_t v) {
    const double *wanted = s->wanted + WANTED * (int64_t)v;
    int64_t faults = faults_at(s, v, INT64_MAX);
    int32_t own[AXES], best[AXES];
    double nearest = 0.0; /* with as many faults as in its own cell, it stays there */
    if (faults == 0) return;
    put(own, place);
    put(best, place);
    for (int i = 0; i < 27; i++) {
        int32_t cell[AXES] = {own[0] + i / 9 - 1, own[1] + i / 3 % 3 - 1, own[2] + i % 3 - 1};
        double square = square_of(wanted, cell);
        bool inside = square <= wanted[AXES];
        for (int j = 0; j < AXES; j++) inside = inside && cell[j] >= 0 && cell[j] <= most[j];
        if (!inside) continue;
        put(place, cell);
        int64_t left = faults_at(s, v, faults);
        if (left > faults) continue;
        square += 8.0 * height_of(s, v, cell);
        if (left == faults && square >= nearest) continue;
        faults = left;
        nearest = square;
        put(best, cell);
    }
    put(place, best);
}

void mend_place(const Corners *corners, Ints2 places, const double *wanted, const int32_t *most, int32_t v) {
    Sides s = {corners, places.data, wanted};
    mend_vertex(&s, places.data + AXES * (int64_t)v, most, v);
}

void mend_places(const Corners *corners, Ints2 places, const double *wanted, const int32_t *most, uint8_t *tried) {
    const int32_t *vertex = corners->faces.data;
    Sides s = {corners, places.data, wanted};
    for (int64_t i = 0; i < SWEEPS * corners->faces.rows; i++) {
        int32_t k = 3 * (int32_t)(i % corners->faces.rows);
        for (int end = 0; end < 3 && (end > 0 || faults_of(&s, k) > 0); end++) {
            int32_t v = vertex[k + end];
            /* A vertex of many faces would be tried again for each of them, all of which it looks at. */
            if (tried[v] == TRIES) continue;
            tried[v]++;
            mend_vertex(&s, places.data + AXES * (int64_t)v, most, v);
        }
    }
}

bool go_to_cell(const Corners *corners, Ints2 places, const double *wanted, int32_t v, const int32_t *cell) {
    Sides s = {corners, places.data, wanted};
    const double *row = wanted + WANTED * (int64_t)v;
    int32_t *place = places.data + AXES * (int64_t)v, own[AXES];
    if (square_of(row, cell) > row[AXES] || height_of(&s, v, cell) > HEIGHT) return false;
    int64_t faults = faults_at(&s, v, INT64_MAX);
    put(own, place);
    put(place, cell);
    if (faults_at(&s, v, faults) <= faults) return true;
    put(place, own);
    return false;
}
