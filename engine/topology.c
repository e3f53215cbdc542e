/* CONNECTIVITY to faces (specification, C 4 to C 8), and the labels of PARTITION (C 10). */
#include "engine/topology.h"

#include "bitstream/connectivity/connectivity.h"
#include "engine/coding.h"

enum { FIRST_NODES_ROOM = 16, TALLIES = 8, TALLY_DUMMIES = 3, TALLY_TURNS, TALLY_STEPS, FAN_SLOTS = 32,
    EVENT_TRUST = 30 };
/* Bytes that decoding and the graph take at most for each; only fans that are sewn together count (M 14.8). */
static const double FACE_MEMORY = 100, VERTEX_MEMORY = 400, FAN_MEMORY = 240;

static bool make_models(Arena *arena, int64_t vertices, Models *models) {
    int bits = (int)largest(LEAST_HASH_BITS, least(64 - __builtin_clzll((uint64_t)vertices) - 2, MOST_HASH_BITS));
    models->bits = bits;
    return make_bank(arena, (BankPlan){.slots = ((int64_t)VALENCE_CONTEXTS << bits) * VALENCE_NODES,
        .selectors = VALENCE_NODES, .inputs = VALENCE_CONTEXTS, .limit = 1023, .rate = 16}, &models->valence)
        && make_bank(arena, (BankPlan){.slots = EVENT_CONTEXTS * EVENT_SIZE, .selectors = 1, .inputs = EVENT_CONTEXTS,
            .limit = 1023, .rate = 16, .probability = ONE - ONE / 500, .trust = EVENT_TRUST}, &models->event)
        && make_bank(arena, (BankPlan){.slots = RARE_NODES, .selectors = RARE_NODES, .inputs = 1}, &models->rare);
}

static int64_t read_count(Reading *reading, const Models *models) {
    int64_t context = 0;
    return code_one_unsigned(reading->coder, models->rare, (ConstLongs){&context, 1}, 0, RARE_UNARY, 0, RARE_HEADER);
}

/* The conquest (C 6) of faces that do not repeat a corner, with more memory for its front each time it asks. */
static bool read_surface(Reading *reading, const Models *models, Arena *scratch, int64_t fans, int64_t dummies,
    Ints2 faces) {
    Longs tallies;
    Ints heads;
    Longs2 vertices;
    Ints2 nodes;
    if (!zero_longs(scratch, TALLIES, &tallies) || !take_ints(scratch, HEADS, &heads)
        || !take_longs2(scratch, fans + dummies, VERTEX_COLUMNS, &vertices)
        || !take_ints2(scratch, fans + FIRST_NODES_ROOM, NODE_COLUMNS, &nodes))
        return false;
    for (int i = 0; i < HEADS; i++) heads.data[i] = -1;
    heads.data[MADE] = heads.data[ALIVE] = 0;
    tallies.data[TALLY_DUMMIES] = dummies;
    tallies.data[TALLY_TURNS] = 4 * faces.rows;
    tallies.data[TALLY_STEPS] = 65536 + 16 * faces.rows;
    for (;;) {
        int64_t end =
            conquer(reading->coder, *models, (Guide){0}, (Conquest){{nodes, heads}, vertices, faces, tallies});
        if (end == CONQUEST_DONE) return true;
        if (end != CONQUEST_NO_ROOM) return nonsense(reading, "a connectivity payload does not make its triangles");
        Ints2 wider;
        if (!take_ints2(scratch, 2 * nodes.rows, NODE_COLUMNS, &wider)) return false;
        memcpy(wider.data, nodes.data, (size_t)(nodes.rows * NODE_COLUMNS) * sizeof *nodes.data);
        nodes = wider;
    }
}

/* The fans after and before each fan along the boundary (C 7.1). */
static bool find_borders(Arena *scratch, Ints2 faces, Ints after, Ints before) {
    int64_t size = 3 * faces.rows;
    Longs starts;
    Ints by_high, order, twin;
    if (!take_longs(scratch, after.size + 1, &starts) || !take_ints(scratch, size, &by_high)
        || !take_ints(scratch, size, &order) || !take_ints(scratch, size, &twin))
        return false;
    match_halfedges((ConstInts){faces.data, size}, starts, by_high, order, twin);
    for (int64_t i = 0; i < after.size; i++) after.data[i] = before.data[i] = -1;
    for (int64_t i = 0; i < size; i++)
        if (twin.data[i] < 0) after.data[faces.data[i]] = faces.data[next_halfedge((int32_t)i)];
    for (int64_t fan = 0; fan < after.size; fan++)
        if (after.data[fan] >= 0) before.data[after.data[fan]] = (int32_t)fan;
    return true;
}

/* Which fans are the same vertex (C 7): corners become vertices. Returns their number, -1 for nonsense. */
static int64_t join_fans(Reading *reading, Arena *scratch, Ints2 faces, int64_t fans) {
    Ints after, before, known, vertex, sibling, latest;
    Bank bank;
    if (!take_ints(scratch, fans, &after) || !take_ints(scratch, fans, &before) || !take_ints(scratch, fans, &known)
        || !take_ints(scratch, fans, &vertex) || !take_ints(scratch, fans, &sibling)
        || !take_ints(scratch, fans, &latest)
        || !make_bank(scratch, (BankPlan){.slots = FAN_SLOTS, .selectors = 1, .inputs = 1}, &bank)
        || !find_borders(scratch, faces, after, before))
        return -1;
    for (int64_t i = 0; i < fans; i++) known.data[i] = -1;
    int64_t count = code_fans(reading->coder, bank, const_ints(known), (Seams){vertex, after, before, sibling, latest});
    for (int64_t i = 0; count >= 0 && i < 3 * faces.rows; i++) faces.data[i] = vertex.data[faces.data[i]];
    return count;
}

static bool read_faces(Reading *reading, const Header *header, Arena *arena, Arena *scratch, Ints2 *faces) {
    Context *context = reading->context;
    Models models;
    if (!make_models(scratch, header->vertices, &models)) return false;
    int64_t repeated = read_count(reading, &models), lonely = read_count(reading, &models);
    int64_t surplus = read_count(reading, &models), dummies = read_count(reading, &models);
    int64_t proper = header->faces - repeated, regular = header->vertices - lonely, fans = regular + surplus;
    if (proper < 0 || regular < 0 || lonely > 3 * repeated || fans > 3 * proper || dummies > 3 * proper)
        return nonsense(reading, "the counts at the start of a connectivity payload contradict each other");
    double memory = FACE_MEMORY * (double)header->faces + VERTEX_MEMORY * (double)header->vertices
        + FAN_MEMORY * (double)(surplus + dummies);
    if (!WITHIN(context, vertices, fans + dummies)
        || !within_memory(context, memory, header->vertices, (double)reading->coder.data.size))
        return false;
    if (!take_ints2(arena, header->faces, 3, faces)) return false;
    Ints2 surface = {faces->data, proper, 3};
    if (!read_surface(reading, &models, scratch, fans, dummies, surface)) return false;
    int64_t known = surplus > 0 ? join_fans(reading, scratch, surface, fans) : fans;
    if (failed(context)) return false;
    Ints corners = {faces->data + 3 * proper, 3 * repeated};
    if (known != regular || code_degenerate(reading->coder, corners, known) != header->vertices)
        return nonsense(reading, "a connectivity payload does not make its vertices");
    return finish_reading(reading);
}

bool decode_connectivity(Context *context, Span payload, const Header *header, Arena *arena, Arena *scratch,
    Ints2 *faces) {
    Reading reading;
    Mark mark = mark_of(scratch);
    bool done = begin_reading(context, payload, &reading) && read_faces(&reading, header, arena, scratch, faces);
    release_to(scratch, mark);
    return done;
}

bool decode_labels(Context *context, Span payload, const Graph *graph, int64_t parts, Arena *scratch, Ints labels) {
    enum { INPUTS = 3, CANDIDATES = 4, LABEL_CONTEXTS = 16 * (CANDIDATES + 1) };
    Reading reading;
    Bank bank;
    if (!make_bank(scratch, (BankPlan){.slots = INPUTS * LABEL_CONTEXTS, .selectors = CANDIDATES + 1, .inputs = INPUTS},
        &bank)
        || !begin_reading(context, payload, &reading))
        return false;
    int64_t used = code_labels(reading.coder, bank, graph->offsets, graph->neighbors, labels, parts);
    return finish_reading(&reading)
        && (used == parts || FAIL(context, CORRUPT, "the partition has # parts where the header has #", used, parts));
}
