/* CONNECTIVITY to faces (specification, C 4 to C 8, C 13), and the labels of PARTITION (C 10). */
#include "bitstream/payloads/payloads.h"

#include "bitstream/connectivity/connectivity.h"

enum { FIRST_NODES_ROOM = 16, EVENT_TRUST = 30,
    FAN_BYTES = 32, /* more than the vertex of a fan, or a corner of a face that repeats one, can take */
    EDGE_BYTES = 4 /* more than the last decision of an edge can take */ };
/* Bytes that decoding and the graph take at most for each; only fans that are sewn together count (M 14.8). */
static const double FACE_MEMORY = 100, VERTEX_MEMORY = 400, FAN_MEMORY = 240;

static bool make_models(Arena *arena, int64_t vertices, ValenceModel *models) {
    int bits = (int)largest(LEAST_HASH_BITS, least(64 - __builtin_clzll((uint64_t)vertices) - 2, MOST_HASH_BITS));
    int64_t valences = ((int64_t)VALENCE_CONTEXTS << bits) * VALENCE_NODES;
    models->bits = bits;
    return make_bank(arena, (BankPlan){.slots = valences, .selectors = VALENCE_NODES, .inputs = VALENCE_CONTEXTS,
        .limit = 1023, .rate = 16}, &models->valence)
        && make_bank(arena, (BankPlan){.slots = EVENT_CONTEXTS * EVENT_SIZE, .selectors = 1, .inputs = EVENT_CONTEXTS,
            .limit = 1023, .rate = 16, .probability = ONE - ONE / 500, .trust = EVENT_TRUST}, &models->event)
        && make_bank(arena, (BankPlan){.slots = RARE_NODES, .selectors = RARE_NODES, .inputs = 1}, &models->rare);
}

static int64_t code_count(Coding *coding, const Bank *rare, int64_t count) {
    int64_t context = 0;
    return code_unsigned(&coding->coder, rare, 1, &context, 0, RARE_UNARY, count, RARE_HEADER);
}

/* The conquest (C 6) of faces that do not repeat a corner, with more memory for its front each time it asks. */
static bool code_surface(Coding *coding, Conquest *walk, Arena *scratch, Ints2 faces) {
    walk->faces = faces.data;
    walk->face_room = faces.rows;
    walk->turns = 4 * faces.rows; /* each real face has at most three dummy neighbors */
    walk->steps = 65536 + 16 * faces.rows;
    for (int i = 0; i < HEADS; i++) walk->front.heads[i] = i == MADE || i == ALIVE ? 0 : -1;
    walk->front.capacity = walk->vertex_room + FIRST_NODES_ROOM;
    if (!TAKE(scratch, walk->vertex_room, walk->vertices) || !TAKE(scratch, walk->front.capacity, walk->front.nodes))
        return false;
    for (;;) {
        ConquestEnd end = conquer(walk);
        if (end == CONQUEST_DONE) return true;
        Node *nodes = walk->front.nodes, *wider;
        int64_t made = walk->front.capacity;
        if (end == CONQUEST_NONSENSE || made > INT32_MAX / 2)
            return nonsense(coding, "a connectivity payload does not make its triangles");
        if (!room_to_write(coding, TURN_BYTES)) return false;
        if (walk->front.heads[MADE] + 3 <= made) continue;
        if (!TAKE(scratch, 2 * made, wider)) return false;
        memcpy(wider, nodes, (size_t)made * sizeof *nodes);
        walk->front.nodes = wider;
        walk->front.capacity = 2 * made;
    }
}

/* Half-edges of faces of so many vertices in the order of their ends, where those of each lower end end in it, and the
 * half-edge in the opposite direction of each. */
static bool sort_halfedges(Arena *scratch, ConstInts origin, int64_t vertices, Longs *ends, Ints *order, Ints *twin) {
    Ints by_high;
    if (!take_longs(scratch, vertices + 1, ends) || !take_ints(scratch, origin.size, &by_high)
        || !take_ints(scratch, origin.size, order) || !take_ints(scratch, origin.size, twin))
        return false;
    match_halfedges(origin, *ends, by_high, *order, *twin);
    return true;
}

/* The fans after and before each fan along the boundary (C 7.1). */
static bool find_borders(Arena *scratch, Ints2 faces, Ints after, Ints before) {
    int64_t size = 3 * faces.rows;
    Longs ends;
    Ints order, twin;
    if (!sort_halfedges(scratch, (ConstInts){faces.data, size}, after.size, &ends, &order, &twin)) return false;
    for (int64_t i = 0; i < after.size; i++) after.data[i] = before.data[i] = -1;
    for (int64_t i = 0; i < size; i++)
        if (twin.data[i] < 0) after.data[faces.data[i]] = faces.data[next_halfedge((int32_t)i)];
    for (int64_t fan = 0; fan < after.size; fan++)
        if (after.data[fan] >= 0) before.data[after.data[fan]] = (int32_t)fan;
    return true;
}

/* Which fans are the same vertex (C 7): corners become vertices. Returns their number, -1 for nonsense. */
static int64_t join_fans(Coding *coding, Arena *scratch, Ints2 faces, Ints known) {
    Ints after, before, vertex, sibling, latest;
    int64_t fans = known.size;
    Bank bank;
    if (!take_ints(scratch, fans, &after) || !take_ints(scratch, fans, &before)
        || !take_ints(scratch, fans, &vertex) || !take_ints(scratch, fans, &sibling)
        || !take_ints(scratch, fans, &latest)
        || !make_bank(scratch, FAN_BANK, &bank)
        || !find_borders(scratch, faces, after, before))
        return -1;
    if (known.data == NULL) {
        if (!take_ints(scratch, fans, &known)) return -1;
        for (int64_t i = 0; i < fans; i++) known.data[i] = -1;
    }
    Seams seams = {vertex, after, before, sibling, latest};
    int64_t count = code_fans(&coding->coder, &bank, const_ints(known), seams);
    for (int64_t i = 0; count >= 0 && i < 3 * faces.rows; i++) faces.data[i] = vertex.data[faces.data[i]];
    return count;
}

#ifdef BSMDEC_WRITES
/* Put faces that repeat a corner and are on no edge, in the order in which they were given, after `count` others. */
static void list_others(const Surface *surface, int64_t count, Ints others) {
    const int32_t *given = surface->used.data + surface->used.size - 3 * surface->on_edge.size;
    int32_t *corner = others.data;
    for (int32_t f = 0; f < surface->on_edge.size; f++) {
        if (surface->on_edge.data[f] != NOT_ON_EDGES) continue;
        for (int k = 0; k < 3; k++) *corner++ = given[3 * (int64_t)f + k];
        surface->places.data[count++] = f;
    }
}
#endif

/* Faces that repeat a corner, on edges of the faces before them (C 13): the first of `corners`; `rest` are those of the
 * faces that are on no edge. */
static bool code_on_edges(Coding *coding, const Bank *rare, const Surface *surface, Ints2 faces, int64_t vertices,
    Arena *scratch, Ints corners, Ints *rest) {
    int64_t size = 3 * faces.rows, repeated = corners.size / 3, count = 0;
    Edges edges = {.origin = {faces.data, size}};
    Longs ends;
    Ints order, twin;
    Bank bank;
    if (!sort_halfedges(scratch, edges.origin, vertices, &ends, &order, &twin)
        || !make_bank(scratch, REPEAT_BANK, &bank)
        || !zero_ints(scratch, vertices, &edges.valence) || !zero_ints(scratch, vertices, &edges.met)
        || !zero_ints(scratch, vertices, &edges.repeated)
        || !room_to_write(coding, EDGE_BYTES * size + FAN_BYTES * corners.size))
        return false;
    edges.order = const_ints(order);
    for (int64_t i = 0; i < size; i++) edges.valence.data[faces.data[i]]++;
#ifdef BSMDEC_WRITES
    bool writes = coding->context->writing != NULL;
    if (writes) {
        const int32_t *given = surface->used.data + surface->used.size - corners.size;
        /* Partners of half-edges count no more: there is room for the first face on each edge. */
        edges.given = (FacesOnEdges){{given, corners.size}, twin, surface->on_edge, surface->places};
        count = list_on_edges(&edges, const_longs(ends), vertices);
    }
#else
    (void)surface; /* known to a writer only */
#endif
    count = code_count(coding, rare, count);
    if (count > repeated) return nonsense(coding, "more faces are on edges than repeat a corner");
    if (code_repeats(&coding->coder, &bank, &edges, (Ints){corners.data, 3 * count}) > 0)
        return nonsense(coding, "fewer faces are on edges than a connectivity payload says");
    *rest = (Ints){corners.data + 3 * count, corners.size - 3 * count};
#ifdef BSMDEC_WRITES
    if (writes) list_others(surface, count, *rest);
#endif
    return true;
}

#ifdef BSMDEC_WRITES
/* The numbers that a decoder gives the vertices of fans and of faces that repeat a corner. */
static void number_vertices(const Surface *surface, int64_t fans, Ints corners) {
    Ints used = surface->used;
    for (int64_t i = 0; i < fans; i++) used.data[i] = surface->vertex[surface->guide.fans[i]];
    number_by_appearance(const_ints(used), surface->order, surface->number);
    for (int64_t i = 0; i < used.size; i++) used.data[i] = surface->number.data[used.data[i]];
    for (int64_t i = 0; i < corners.size; i++) corners.data[i] = used.data[fans + i];
}
#endif

static bool code_faces_of(Coding *coding, const Header *header, const Surface *surface, Arena *arena, Arena *scratch,
    Ints2 *faces) {
    Context *context = coding->context;
    Conquest walk = {.coder = &coding->coder, .map = surface->guide};
    const Bank *rare = &walk.model.rare;
    if (!make_models(scratch, header->vertices, &walk.model)) return false;
    int64_t repeated = code_count(coding, rare, surface->repeated);
    int64_t lonely = code_count(coding, rare, surface->lonely);
    int64_t surplus = code_count(coding, rare, surface->surplus);
    int64_t dummies = walk.dummies = code_count(coding, rare, surface->dummies);
    int64_t proper = header->faces - repeated, regular = header->vertices - lonely, fans = regular + surplus;
    if (proper < 0 || regular < 0 || lonely > 3 * repeated || fans > 3 * proper || dummies > 3 * proper
        || header->faces > INT32_MAX / 3 || fans + dummies > INT32_MAX)
        return nonsense(coding, "the counts at the start of a connectivity payload contradict each other");
    double memory = FACE_MEMORY * (double)header->faces + VERTEX_MEMORY * (double)header->vertices
        + FAN_MEMORY * (double)(surplus + dummies);
    if (!WITHIN(context, vertices, fans + dummies)
        || !within_memory(context, memory, header->vertices, (double)coding->coder.size))
        return false;
    if (!take_ints2(arena, header->faces, 3, faces)) return false;
    Ints2 usual = {faces->data, proper, 3};
    Ints corners = {faces->data + 3 * proper, 3 * repeated}, known = {surface->used.data, fans};
    walk.vertex_room = fans + dummies;
    Mark mark = mark_of(scratch);
    if (!code_surface(coding, &walk, scratch, usual) || !room_to_write(coding, FAN_BYTES * (fans + corners.size)))
        return false;
#ifdef BSMDEC_WRITES
    if (context->writing != NULL) number_vertices(surface, fans, corners);
#endif
    int64_t count = surplus > 0 ? join_fans(coding, scratch, usual, known) : fans;
    if (failed(context)) return false;
    if (has_edges(header) && count == regular) {
        release_to(scratch, mark); /* what the conquest took */
        if (!code_on_edges(coding, rare, surface, usual, regular, scratch, corners, &corners)) return false;
    }
    if (count != regular || code_degenerate(&coding->coder, corners, count) != header->vertices)
        return nonsense(coding, "a connectivity payload does not make its vertices");
    return finish_coding(coding);
}

bool code_connectivity(Context *context, Span payload, const Header *header, const Surface *surface, Arena *arena,
    Arena *scratch, Ints2 *faces) {
    Coding coding;
    Mark mark = mark_of(scratch);
    bool done = begin_coding(context, payload, &coding)
        && code_faces_of(&coding, header, surface, arena, scratch, faces);
    release_to(scratch, mark);
    return done;
}

enum { LABEL_BYTES = 8 }; /* more than a label can take */

bool code_partition(Context *context, Span payload, ConstInts offsets, ConstInts neighbors, int64_t parts,
    Arena *scratch, Ints labels) {
    Coding coding;
    Bank bank;
    if (!make_bank(scratch, LABEL_BANK, &bank) || !begin_coding(context, payload, &coding)
        || !room_to_write(&coding, LABEL_BYTES * labels.size))
        return false;
    int64_t used = code_labels(&coding.coder, &bank, offsets, neighbors, labels, parts);
    return finish_coding(&coding)
        && (used == parts || FAIL(context, CORRUPT, "the partition has # parts where the header has #", used, parts));
}
