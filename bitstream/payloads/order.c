/* ORDER: vertices and faces as they were given (specification, F 9, C 9).
 *
 * The conquest numbers vertices and faces anew. Who needs the old numbers gets them as a permutation: each step says
 * how many numbers that are still free lie between the last one and this, which is 0 or small where the given order
 * follows the surface, as it does in most files. Free numbers are counted in a tree, since steps through them one by
 * one would be quadratic for a shuffled mesh. Copies of a vertex and loose vertices, which the conquest does not see,
 * are named here, and each face tells by which corner it began. */
#include "bitstream/payloads/payloads.h"

#include "bitstream/coefficients/coefficients.h"
#include "bitstream/connectivity/connectivity.h"
#include "bitstream/costs.h"

enum { FIRST, COPY, LOOSE };

static bool code_permutation(Coding *coding, Arena *scratch, Ints values) {
    Bank bank;
    Ints tree;
    if (!make_bank(scratch, STEP_BANK, &bank) || !take_ints(scratch, values.size + 1, &tree)) return false;
    bool legal = code_steps(&coding->coder, &bank, values, tree);
    return (legal && !overran(&coding->coder)) || nonsense(coding, "a payload is not a permutation");
}

static bool code_small(Coding *coding, Arena *scratch, Ints values) {
    Bank bank;
    if (!make_bank(scratch, TURN_BANK, &bank)) return false;
    code_turns(&coding->coder, &bank, values);
    return !overran(&coding->coder) || nonsense(coding, "");
}

/* Whole numbers, as a matrix of one column (F 9.3); a writer says how many come before all that are 0. */
static bool code_column(Coding *coding, Arena *scratch, Ints values, int64_t used) {
    Bank bank;
    Longs slow;
    if (!make_bank(scratch, MATRIX_BANK, &bank) || !take_longs(scratch, 1, &slow)) return false;
    Ints2 column = {values.data, values.size, 1};
    Stairs stairs = {used, 1, 0, values.size, 1};
    code_matrix(&coding->coder, &bank, column, (ConstInts2){values.data, 0, 1}, &stairs, slow);
    return !overran(&coding->coder) || nonsense(coding, "");
}

/* Corner k of a face, of the three in ascending order. */
static int32_t sorted_corner(const int32_t *face, int k) {
    int32_t a = face[0], b = face[1], c = face[2], t;
    if (a > b) t = a, a = b, b = t;
    if (b > c) t = b, b = c, c = t;
    if (a > b) t = a, a = b, b = t;
    return k == 0 ? a : k == 1 ? b : c;
}

/* Faces by their largest corner, then the middle one, then the smallest, stably (C 9.5): sorted by the last first. */
static bool suggest(ConstInts2 faces, int64_t vertices, Arena *scratch, Ints *order) {
    int64_t m = faces.rows;
    Ints from, to, ends;
    if (!take_ints(scratch, m, &from) || !take_ints(scratch, m, &to) || !take_ints(scratch, vertices + 1, &ends))
        return false;
    for (int64_t f = 0; f < m; f++) from.data[f] = (int32_t)f;
    for (int k = 0; k < 3; k++) {
        memset(ends.data, 0, (size_t)(vertices + 1) * sizeof *ends.data);
        for (int64_t f = 0; f < m; f++) ends.data[sorted_corner(faces.data + 3 * f, k) + 1]++;
        for (int64_t v = 0; v < vertices; v++) ends.data[v + 1] += ends.data[v];
        for (int64_t i = 0; i < m; i++)
            to.data[ends.data[sorted_corner(faces.data + 3 * (int64_t)from.data[i], k)]++] = from.data[i];
        Ints swapped = from;
        from = to;
        to = swapped;
    }
    *order = from;
    return true;
}

/* Where the values of each number below `count` are in an array whose entries below 0 count for nothing. */
static bool invert(ConstInts values, int64_t count, Arena *arena, Ints *starts, Ints *members) {
    if (!zero_ints(arena, count + 2, starts) || !take_ints(arena, values.size, members)) return false;
    int32_t *ends = starts->data + 1;
    for (int64_t i = 0; i < values.size; i++)
        if (values.data[i] >= 0) ends[values.data[i] + 1]++;
    for (int64_t k = 0; k < count; k++) ends[k + 1] += ends[k];
    for (int64_t i = 0; i < values.size; i++)
        if (values.data[i] >= 0) members->data[ends[values.data[i]]++] = (int32_t)i;
    return true;
}

/* The faces and corners that the user had (C 9.6); `numbers` are those of vertices. */
static void arrange(ConstInts2 faces, Ints numbers, Ints order, Ints places, Ints turns, Ints2 arranged, Ints corners) {
    for (int64_t rank = 0; rank < faces.rows; rank++) {
        int64_t face = order.data[rank], place = places.data[rank];
        int32_t renumbered[3];
        int first = 0;
        for (int k = 0; k < 3; k++) renumbered[k] = numbers.data[faces.data[3 * face + k]];
        for (int k = 1; k < 3; k++)
            if (renumbered[k] < renumbered[first]) first = k;
        first += turns.data[place];
        for (int k = 0; k < 3; k++) {
            arranged.data[3 * place + k] = renumbered[(first + k) % 3];
            corners.data[3 * place + k] = (int32_t)(3 * face + (first + k) % 3);
        }
    }
}

/* What each given vertex is, as C 9 numbers vertices, -1 for a loose one (F 9.2, F 9.3). */
static bool read_sources(Coding *coding, int64_t vertices, int64_t copies, Arena *scratch, Ints met) {
    Context *context = coding->context;
    Ints kinds, back;
    if (!zero_ints(scratch, met.size, &kinds) || !zero_ints(scratch, copies, &back)
        || !code_small(coding, scratch, kinds) || !code_column(coding, scratch, back, 0))
        return false;
    int64_t counted[3] = {0}, known = 0, copied = 0;
    for (int64_t i = 0; i < met.size; i++) counted[kinds.data[i]]++;
    if (counted[FIRST] != vertices || counted[COPY] != copies)
        return FAIL(context, CORRUPT, "the kinds of given vertices do not match their counts");
    for (int64_t i = 0; i < met.size; i++) {
        int64_t vertex = -1;
        if (kinds.data[i] == FIRST) vertex = known++;
        if (kinds.data[i] == COPY) {
            int64_t behind = back.data[copied++];
            vertex = known - 1 - behind;
            if (behind < 0 || vertex < 0)
                return FAIL(context, CORRUPT, "a given vertex is a copy of one that does not come before it");
        }
        met.data[i] = (int32_t)vertex;
    }
    return true;
}

/* Corners as given vertices (F 9.4): the copies of vertex v are `members` from starts[v] on. */
static bool read_corners(Coding *coding, int64_t copies, Ints starts, Ints members, Arena *scratch, Ints2 faces) {
    Ints steps, visits;
    if (!zero_ints(scratch, 3 * faces.rows, &steps) || !zero_ints(scratch, starts.size, &visits)
        || (copies > 0 && !code_column(coding, scratch, steps, 0)))
        return false;
    for (int64_t i = 0; i < 3 * faces.rows; i++) {
        int64_t v = faces.data[i], count = starts.data[v + 1] - starts.data[v];
        if (steps.data[i] < 0 || steps.data[i] >= count)
            return FAIL(coding->context, CORRUPT, "a corner refers to a missing copy");
        faces.data[i] = members.data[starts.data[v] + (visits.data[v]++ + steps.data[i]) % count];
    }
    return true;
}

static bool read_order(Coding *coding, ConstInts2 faces, int64_t vertices, int64_t copies, int64_t loose,
    Arena *arena, Arena *scratch, Numbering *numbering) {
    int64_t m = faces.rows;
    Ints numbers, places, turns, order, corners, source, starts, members, coded;
    Ints2 arranged, renumbered;
    if (!zero_ints(scratch, vertices, &numbers) || !zero_ints(scratch, m, &places) || !zero_ints(scratch, m, &turns)
        || !take_ints2(arena, m, 3, &arranged) || !take_ints2(scratch, m, 3, &renumbered)
        || !take_ints(arena, 3 * m, &corners) || !take_ints(arena, vertices + copies + loose, &source)
        || !code_permutation(coding, scratch, numbers) || !code_permutation(coding, scratch, places)
        || !code_small(coding, scratch, turns))
        return false;
    for (int64_t i = 0; i < 3 * m; i++) renumbered.data[i] = numbers.data[faces.data[i]];
    if (!suggest(const_ints2(renumbered), vertices, scratch, &order)
        || !invert(const_ints(numbers), vertices, scratch, &starts, &coded))
        return false;
    arrange(faces, numbers, order, places, turns, arranged, corners);
    if (copies + loose > 0) {
        if (!read_sources(coding, vertices, copies, scratch, source)
            || !invert(const_ints(source), vertices, scratch, &starts, &members)
            || !read_corners(coding, copies, starts, members, scratch, arranged))
            return false;
        for (int64_t i = 0; i < source.size; i++) source.data[i] = source.data[i] < 0 ? -1 : coded.data[source.data[i]];
    } else {
        memcpy(source.data, coded.data, (size_t)vertices * sizeof *coded.data);
    }
    *numbering = (Numbering){.size = source.size, .faces = const_ints2(arranged), .source = const_ints(source),
        .corners = const_ints(corners), .is_split = copies + loose > 0};
    return true;
}

bool decode_order(Context *context, Span data, ConstInts2 faces, const Header *header, Arena *arena, Arena *scratch,
    Numbering *numbering) {
    double n = (double)header->vertices, m = (double)header->faces, bytes = (double)data.size;
    Cursor cursor = {context, data};
    if (!reserve(context, order_memory(n, m), bytes) || !charge(context, order_work(n, m, bytes), bytes)) return false;
    int64_t copies = take_varint(&cursor), loose = take_varint(&cursor), size = header->vertices + copies + loose;
    if (failed(context) || !WITHIN(context, vertices, size)) return false;
    if (header->vertices + copies > 3 * faces.rows || size >= MOST_GIVEN)
        return FAIL(context, CORRUPT, "# copies of # vertices, and # in no face", copies, header->vertices, loose);
    Span bytes_of_loose = take_span(&cursor, 24 * loose);
    Doubles2 positions;
    if (failed(context) || !take_doubles2(arena, loose, 3, &positions)) return false;
    for (int64_t i = 0; i < 3 * loose; i++) {
        uint64_t bits = little_endian(bytes_of_loose.data + 8 * i, 8);
        memcpy(positions.data + i, &bits, sizeof bits);
        if (!(positions.data[i] - positions.data[i] == 0.0))
            return FAIL(context, CORRUPT, "the position of a loose vertex is not finite");
    }
    Coding coding;
    Mark mark = mark_of(scratch);
    bool done = begin_coding(context, take_rest(&cursor), &coding)
        && read_order(&coding, faces, header->vertices, copies, loose, arena, scratch, numbering)
        && finish_coding(&coding);
    release_to(scratch, mark);
    if (!done) return false;
    numbering->loose = const_doubles2(positions);
    if (loose > 0 && header->gop_frames > 0)
        return FAIL(context, CORRUPT, "a sequence of frames with vertices in no face");
    return true;
}

#ifdef BSMDEC_WRITES
enum { STEP_BYTES = 128, COLUMN_BYTES = 16, TURN_BYTES_EACH = 4, SLACK_BYTES = 64 }; /* more than one entry can take */

static bool write_permutation(Coding *coding, Arena *scratch, Ints values) {
    if (values.size >= MOST_GIVEN)
        return FAIL(coding->context, MISUSED, "# vertices or faces are too many to keep their order", values.size);
    return room_to_write(coding, STEP_BYTES * values.size + SLACK_BYTES) && code_permutation(coding, scratch, values);
}

static bool write_turns(Coding *coding, Arena *scratch, Ints values) {
    return room_to_write(coding, TURN_BYTES_EACH * values.size + SLACK_BYTES) && code_small(coding, scratch, values);
}

static bool write_column(Coding *coding, Arena *scratch, Ints values) {
    int64_t used = values.size;
    while (used > 0 && values.data[used - 1] == 0) used--;
    return room_to_write(coding, COLUMN_BYTES * values.size + SLACK_BYTES)
        && code_column(coding, scratch, values, used);
}

/* The order of faces, and the corner of each given face that decoders would take for the first (C 9.5, C 9.6). */
static bool write_faces_order(Coding *coding, const Arrangement *a, Arena *scratch) {
    int64_t m = a->coded.rows, n = a->vertices.size;
    Ints2 numbers;
    Ints order, places, turns, vertices;
    if (!take_ints2(scratch, m, 3, &numbers) || !take_ints(scratch, m, &places) || !take_ints(scratch, m, &turns)
        || !take_ints(scratch, n, &vertices))
        return false;
    memcpy(vertices.data, a->vertices.data, (size_t)n * sizeof *vertices.data);
    for (int64_t i = 0; i < 3 * m; i++) numbers.data[i] = a->vertices.data[a->coded.data[i]];
    if (!suggest(const_ints2(numbers), n, scratch, &order)) return false;
    for (int64_t rank = 0; rank < m; rank++) {
        const int32_t *face = numbers.data + 3 * (int64_t)order.data[rank];
        int64_t place = places.data[rank] = a->face_places.data[order.data[rank]];
        int first = 0;
        for (int k = 1; k < 3; k++)
            if (face[k] < face[first]) first = k;
        for (int k = 2; k >= 0; k--) {
            bool same = true;
            for (int j = 0; j < 3; j++) same = same && face[(first + k + j) % 3] == a->faces.data[3 * place + j];
            if (same) turns.data[place] = k;
        }
    }
    return write_permutation(coding, scratch, vertices) && write_permutation(coding, scratch, places)
        && write_turns(coding, scratch, turns);
}

/* Which given vertices are copies of others or in no face (F 9.2, F 9.3), and which of them each corner has (F 9.4). */
static bool write_sources(Coding *coding, const Arrangement *a, Arena *scratch) {
    int64_t given = a->source.size, n = a->vertices.size, size = 3 * a->corners.rows, known = 0, copied = 0;
    Ints kinds, back, ranks, counts, visits, steps;
    if (given >= MOST_GIVEN)
        return FAIL(coding->context, MISUSED, "# vertices are too many for an order that is kept", given);
    if (!take_ints(scratch, given, &kinds) || !take_ints(scratch, a->copies, &back)
        || !take_ints(scratch, given, &ranks) || !zero_ints(scratch, n, &counts)
        || !zero_ints(scratch, n, &visits) || !take_ints(scratch, size, &steps))
        return false;
    for (int64_t v = 0; v < given; v++) {
        int32_t source = a->source.data[v];
        kinds.data[v] = source < 0 ? LOOSE : counts.data[source] > 0 ? COPY : FIRST;
        if (source < 0) continue;
        if (kinds.data[v] == FIRST) known++;
        else back.data[copied++] = (int32_t)(known - 1 - source);
        ranks.data[v] = counts.data[source]++;
    }
    for (int64_t i = 0; i < size; i++) {
        int32_t v = a->corners.data[i], source = a->source.data[v], count = counts.data[source];
        int32_t step = (ranks.data[v] - visits.data[source]++ % count) % count;
        steps.data[i] = step < 0 ? step + count : step;
    }
    return write_turns(coding, scratch, kinds) && write_column(coding, scratch, back)
        && (a->copies == 0 || write_column(coding, scratch, steps));
}

bool write_order(Context *context, const Arrangement *arrangement, Arena *scratch, Payload *writing) {
    Coding coding;
    Mark mark = mark_of(scratch);
    context->writing = writing;
    bool done = begin_coding(context, (Span){0}, &coding) && write_faces_order(&coding, arrangement, scratch)
        && (arrangement->copies + arrangement->loose == 0 || write_sources(&coding, arrangement, scratch))
        && finish_coding(&coding);
    context->writing = NULL;
    release_to(scratch, mark);
    return done;
}
#endif
