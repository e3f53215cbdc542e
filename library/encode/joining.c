/* A given mesh as it is coded: one vertex at each position (encoder only). */
#include "library/encode/encoding.h"

#ifdef BSMDEC_WRITES

/* The seed differs from run to run, so an attacker cannot choose rows of one hash. */
static uint64_t hash_of(const int64_t *row, int width, uint64_t seed) {
    uint64_t hash = seed;
    for (int i = 0; i < width; i++) hash = ((hash ^ hash >> 29) ^ (uint64_t)row[i]) * (seed << 1 | 1);
    return hash ^ hash >> 32;
}

int64_t number_rows(const int64_t *rows, int64_t count, int width, Arena *scratch, Ints numbers) {
    int64_t size = 16, known = 0;
    Ints place, first; /* the number of the rows with a hash, or the next free place; the first row of a number */
    Mark mark = mark_of(scratch);
    while (size < 2 * count) size *= 2;
    if (!take_ints(scratch, size, &place) || !take_ints(scratch, count, &first)) return -1;
    uint64_t seed = (uint64_t)(uintptr_t)place.data * UINT64_C(0xBF58476D1CE4E5B9);
    for (int64_t i = 0; i < size; i++) place.data[i] = -1;
    for (int64_t i = 0; i < count; i++) {
        const int64_t *row = rows + width * i;
        uint64_t at = hash_of(row, width, seed ^ seed >> 32) & (uint64_t)(size - 1);
        for (; place.data[at] >= 0; at = (at + 1) & (uint64_t)(size - 1)) {
            const int64_t *other = rows + width * (int64_t)first.data[place.data[at]];
            int same = 0;
            while (same < width && other[same] == row[same]) same++;
            if (same == width) break;
        }
        if (place.data[at] < 0) {
            first.data[known] = (int32_t)i;
            place.data[at] = (int32_t)known++;
        }
        numbers.data[i] = place.data[at];
    }
    release_to(scratch, mark);
    return known;
}

static bool repeats(int32_t a, int32_t b, int32_t c) { return a == b || b == c || c == a; }

/* Connect a corner to the one that waits at its edge (counted from 1), or let it wait there. */
static void pair_up(const uint32_t *corners, int32_t *waiting, int64_t corner, Ints joined) {
    if (*waiting > 0) join_two(joined.data, (int32_t)corners[corner], (int32_t)corners[*waiting - 1]);
    *waiting = *waiting > 0 ? 0 : (int32_t)corner + 1;
}

/* Number positions anew: closed bodies share none. Vertices connect faces, and so do edges of two faces; at others,
 * faces that follow each other are connected, unless an even number of them already are. */
static bool keep_apart(const GivenMesh *given, Arena *scratch, Ints place) {
    int64_t n = given->vertices, size = 3 * given->faces;
    const uint32_t *corners = given->corners;
    Ints edge, count, alike, is_odd, waiting, joined, closed;
    Longs2 rows, ends;
    if (!take_ints(scratch, size, &edge) || !zero_ints(scratch, size, &count) || !take_ints(scratch, size, &alike)
        || !zero_ints(scratch, size, &is_odd) || !zero_ints(scratch, size, &waiting) || !take_ints(scratch, n, &joined)
        || !zero_ints(scratch, n, &closed) || !take_longs2(scratch, n, 2, &rows)
        || !take_longs2(scratch, size, 2, &ends))
        return false;
    for (int64_t v = 0; v < n; v++) joined.data[v] = (int32_t)v;
    for (int64_t i = 0; i < size; i++) {
        int32_t a = place.data[corners[i]], b = place.data[corners[i % 3 == 2 ? i - 2 : i + 1]];
        ends.data[2 * i] = a < b ? a : b;
        ends.data[2 * i + 1] = a < b ? b : a;
        join_two(joined.data, (int32_t)corners[i], (int32_t)corners[i / 3 * 3]);
    }
    if (number_rows(ends.data, size, 2, scratch, edge) < 0) return false;
    for (int64_t i = 0; i < size; i++) count.data[edge.data[i]]++;
    for (int64_t i = 0; i < size; i++)
        if (count.data[edge.data[i]] == 2) pair_up(corners, waiting.data + edge.data[i], i, joined);
    for (int64_t i = 0; i < size; i++) {
        count.data[i] = ends.data[2 * i] != ends.data[2 * i + 1]; /* from here on: whether the edge has a length */
        ends.data[2 * i] = edge.data[i];
        ends.data[2 * i + 1] = first_joined(joined.data, (int32_t)corners[i]);
    }
    if (number_rows(ends.data, size, 2, scratch, alike) < 0) return false;
    for (int64_t i = 0; i < size; i++) is_odd.data[alike.data[i]] ^= 1;
    for (int64_t i = 0; i < size; i++)
        if (is_odd.data[alike.data[i]]) pair_up(corners, waiting.data + edge.data[i], i, joined);
    for (int64_t i = 0; i < size; i++) { /* the corners of each shell; of one that is open less than 0 */
        int32_t *of_shell = closed.data + first_joined(joined.data, (int32_t)corners[i]);
        *of_shell = count.data[i] && waiting.data[edge.data[i]] == i + 1 ? INT32_MIN : *of_shell + 1;
    }
    for (int64_t v = 0; v < n; v++) {
        int32_t shell = first_joined(joined.data, (int32_t)v);
        rows.data[2 * v] = place.data[v];
        rows.data[2 * v + 1] = closed.data[shell] > 9 ? shell : -1; /* four faces */
    }
    return number_rows(rows.data, n, 2, scratch, place) >= 0;
}

/* The given vertices in faces that are kept, by the number of their position. */
static void number_used(const GivenMesh *given, Ints place, Ints seen, JoinedMesh *joined) {
    for (int64_t v = 0; v < given->vertices; v++) joined->index.data[v] = seen.data[v] = -1;
    for (int64_t i = 0; i < 3 * joined->kept.size; i++) {
        uint32_t corner = given->corners[3 * (int64_t)joined->kept.data[i / 3] + i % 3];
        joined->index.data[corner] = place.data[corner];
    }
    joined->first.size = 0;
    for (int64_t v = 0; v < given->vertices; v++) {
        int32_t *index = joined->index.data + v;
        if (*index < 0) continue;
        if (seen.data[*index] < 0) {
            seen.data[*index] = (int32_t)joined->first.size;
            joined->first.data[joined->first.size++] = (int32_t)v;
        }
        *index = seen.data[*index];
    }
}

bool join_places(const GivenMesh *given, Ints place, bool keep, PayloadWriter *writer, JoinedMesh *joined) {
    Arena *arena = &writer->arena, *scratch = &writer->scratch;
    int64_t n = given->vertices, m = given->faces, mentioned = 0, places = 0, kept = 0;
    const uint32_t *corners = given->corners;
    Mark mark = mark_of(scratch);
    Ints seen;
    *joined = (JoinedMesh){0};
    if (!take_ints(arena, n, &joined->index) || !take_ints(arena, n, &joined->first)
        || !take_ints(arena, m, &joined->kept) || !take_ints2(arena, m, 3, &joined->faces)
        || !zero_ints(scratch, n, &seen))
        return false;
    for (int64_t v = 0; v < n; v++) places = largest(places, place.data[v] + 1);
    if (places < n && !keep_apart(given, scratch, place)) return false;
    for (int64_t i = 0; i < 3 * m; i++) {
        mentioned += !seen.data[corners[i]];
        seen.data[corners[i]] = 1;
    }
    for (int64_t f = 0; f < m; f++) {
        const uint32_t *face = corners + 3 * f;
        bool was = repeats((int32_t)face[0], (int32_t)face[1], (int32_t)face[2]);
        if (keep || was || !repeats(place.data[face[0]], place.data[face[1]], place.data[face[2]]))
            joined->kept.data[kept++] = (int32_t)f;
    }
    if (kept == 0) /* without any, all of them stay */
        for (; kept < m; kept++) joined->kept.data[kept] = (int32_t)kept;
    joined->kept.size = joined->faces.rows = kept;
    number_used(given, place, seen, joined);
    for (int64_t i = 0; i < 3 * kept; i++)
        joined->faces.data[i] = joined->index.data[corners[3 * (int64_t)joined->kept.data[i / 3] + i % 3]];
    joined->merged = mentioned - joined->first.size;
    joined->loose = n - mentioned;
    joined->collapsed = m - kept;
    release_to(scratch, mark);
    return true;
}

bool join_mesh(const GivenMesh *given, bool exact, bool keep, PayloadWriter *writer, JoinedMesh *joined) {
    Arena *scratch = &writer->scratch;
    int64_t n = given->vertices;
    Mark mark = mark_of(scratch);
    Ints place;
    Longs2 bits;
    if (!zero_ints(scratch, n, &place) || !take_longs2(scratch, n, 4, &bits)) return false;
    for (int64_t t = 0; t < given->frames; t++) {
        for (int64_t i = 0; i < 3 * n; i++) {
            double value = given->positions.data[3 * n * t + i];
            if (!exact) value += 0.0;
            memcpy(bits.data + i / 3 * 4 + i % 3, &value, sizeof value);
            bits.data[i / 3 * 4 + 3] = place.data[i / 3];
        }
        if (number_rows(bits.data, n, 4, scratch, place) < 0) return false;
    }
    bool done = join_places(given, place, keep, writer, joined);
    release_to(scratch, mark);
    return done;
}

bool order_faces(PayloadWriter *writer, const int32_t *merged, int64_t vertices, Payload *writing, CodedMesh *coded) {
    Arena *arena = &writer->arena;
    const JoinedMesh *joined = coded->joined;
    int64_t m = joined->faces.rows;
    Source given = {joined->faces.data, merged, m, joined->first.size, 1};
    return take_ints(arena, vertices, &coded->vertex_order) && take_ints(arena, m, &coded->face_order)
        && take_ints2(arena, m, 3, &coded->faces) && take_bytes(arena, m, &coded->turns)
        && write_faces(writer, given, vertices, &coded->repeats, writing, coded->vertex_order.data,
            coded->face_order.data, coded->faces.data, coded->turns.data);
}

#endif
