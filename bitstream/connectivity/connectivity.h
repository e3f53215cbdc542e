/* Faces: the front of a conquest, its model, and the kernels of this room. */
#pragma once

#include "bitstream/entropy/entropy.h"

/* The front of the conquest: closed polygons of nodes, and buckets by free degree (specification, C 5.2 to C 5.4).
 * A node that was closed has the free degree DEAD. */
typedef struct {
    int32_t vertex, free;    /* free degree */
    int32_t next, previous;  /* in the polygon */
    int32_t gate;            /* half-edge on the far side of the edge to the next node (encoder only) */
    int32_t apex;            /* vertex beyond that edge */
    int32_t up, down;        /* within the bucket */
} Node;

/* Heads: first node of each bucket or -1, the number of nodes made, the number of these that are not closed, last node
 * of each bucket. */
enum { DEAD = -1, BUCKETS = 8, MADE = BUCKETS, ALIVE, TAILS, HEADS = TAILS + BUCKETS };

typedef struct {
    Node *nodes;
    int64_t capacity;
    int32_t heads[HEADS];
} Polygons;

INLINE int bucket_of(int32_t free) { return free < BUCKETS - 1 ? free : BUCKETS - 1; }

INLINE void enter_bucket(Polygons *front, int32_t node) {
    int bucket = bucket_of(front->nodes[node].free);
    int32_t last = front->heads[TAILS + bucket];
    front->nodes[node].up = last;
    front->nodes[node].down = -1;
    if (last >= 0) front->nodes[last].down = node;
    else front->heads[bucket] = node;
    front->heads[TAILS + bucket] = node;
}

INLINE void leave_bucket(Polygons *front, int32_t node) {
    int bucket = bucket_of(front->nodes[node].free);
    int32_t up = front->nodes[node].up, down = front->nodes[node].down;
    if (up >= 0) front->nodes[up].down = down;
    else front->heads[bucket] = down;
    if (down >= 0) front->nodes[down].up = up;
    else front->heads[TAILS + bucket] = up;
}

/* Make a node that is not linked to any other yet and has no gate; the caller has seen to the capacity. */
INLINE int32_t add_node(Polygons *front, int32_t vertex, int32_t free) {
    int32_t node = front->heads[MADE]++;
    front->heads[ALIVE]++;
    front->nodes[node] = (Node){.vertex = vertex, .free = free, .next = node, .previous = node, .apex = vertex};
    enter_bucket(front, node);
    return node;
}

/* Make a polygon edge. */
INLINE void link_nodes(Polygons *front, int32_t node, int32_t following) {
    front->nodes[node].next = following;
    front->nodes[following].previous = node;
}

/* Change the free degree of a node that is not closed; DEAD closes it. */
INLINE void set_free(Polygons *front, int32_t node, int32_t free) {
    leave_bucket(front, node);
    front->nodes[node].free = free;
    if (free == DEAD) front->heads[ALIVE]--;
    else enter_bucket(front, node);
}

/* The node to go on with, -1 if there is none. */
INLINE int32_t first_node(const Polygons *front) {
    for (int bucket = 0; bucket < BUCKETS; bucket++)
        if (front->heads[bucket] >= 0) return front->heads[bucket];
    return -1;
}

/* The probability model of connectivity: contexts of valences and events, and the rarer symbols (specification, C 4.1,
 * C 6.9 to C 6.11).
 *
 * All functions serve both directions, by the coder they are given, and look only at what a decoder knows.
 */
enum {
    VALENCE_CONTEXTS = 14,
    VALENCE_NODES = 16, /* slots of a context: one line of the cache */
    LAST_UNARY = 16,    /* longer valences escape */
    EVENT_CONTEXTS = 3,
    EVENT_SIZE = 4096,
    RARE_UNARY = 2,
    RARE_SPAN = UNSIGNED_SPAN(RARE_UNARY),
    RARE_LOOP = 0,
    RARE_VALENCE = RARE_SPAN,
    RARE_DUMMY = 2 * RARE_SPAN,
    RARE_WAY = 3 * RARE_SPAN,
    RARE_STEPS = 4 * RARE_SPAN,
    RARE_HEADER = 5 * RARE_SPAN,
    RARE_NODES = 6 * RARE_SPAN,
    LEAST_HASH_BITS = 6,
    MOST_HASH_BITS = 12,
};

/* What contexts see of a vertex. */
typedef struct {
    int64_t sum;    /* of the known neighbors' labels less 6 each */
    int32_t label;  /* valence up to 15, 0 for a dummy */
    int32_t rank;   /* number among the real vertices, -1 for a dummy */
} Vertex;

typedef struct {
    Bank valence, event, rare;
    int bits; /* binary logarithm of the number of contexts in each hashed table of valences */
    int64_t contexts[VALENCE_CONTEXTS], event_contexts[EVENT_CONTEXTS];
} ValenceModel;

/* Code an unsigned integer of a rare kind. */
static inline int64_t code_rare(RangeCoder *coder, const ValenceModel *model, int kind, int64_t value) {
    const int64_t context = 0;
    return code_unsigned(coder, &model->rare, 1, &context, 0, RARE_UNARY, value, kind);
}

/* Code a decision of a rare kind. */
static inline int code_rare_bit(RangeCoder *coder, const ValenceModel *model, int kind, int bit) {
    const int64_t context = 0;
    return code_mixed_bit(coder, &model->rare, 1, &context, kind, 0, bit);
}

/* Set the contexts for the first vertices of a component. */
INLINE void look_nowhere(ValenceModel *model) {
    for (int i = 0; i < VALENCE_CONTEXTS; i++) model->contexts[i] = ((int64_t)i << model->bits) * VALENCE_NODES;
}

INLINE uint64_t nibble(int64_t value) { return value < 0 ? 0 : (uint64_t)least(value, 15); }

/* Set the contexts for what lies beyond the gate of node `f`.
 *
 * The third vertex of the triangle beyond the edge from f to n, its next node, is neighbor to both; p is the node
 * before f. Labels (l), labels of apexes (a), free degrees (g) and sums (s) of these and of the nodes further along are
 * the evidence, and the label of the latest vertex. */
INLINE void look_beyond(
    ValenceModel *model, const Polygons *front, const Vertex *vertices, int32_t latest, int32_t node) {
    const Node *nodes = front->nodes;
    const Node *f = nodes + node, *p = nodes + f->previous, *n = nodes + f->next;
    const Node *pp = nodes + p->previous, *nn = nodes + n->next, *nnn = nodes + nn->next;
    uint64_t l_f = (uint64_t)vertices[f->vertex].label, a_f = (uint64_t)vertices[f->apex].label;
    uint64_t l_n = (uint64_t)vertices[n->vertex].label, a_n = (uint64_t)vertices[n->apex].label;
    uint64_t l_p = (uint64_t)vertices[p->vertex].label, a_p = (uint64_t)vertices[p->apex].label;
    uint64_t l_nn = (uint64_t)vertices[nn->vertex].label, l_pp = (uint64_t)vertices[pp->vertex].label;
    uint64_t l_nnn = (uint64_t)vertices[nnn->vertex].label;
    uint64_t g_f = nibble(f->free), g_n = nibble(n->free), g_p = nibble(p->free);
    uint64_t g_nn = nibble(nn->free), g_pp = nibble(pp->free);
    uint64_t s_f = nibble(vertices[f->vertex].sum + 7), s_n = nibble(vertices[n->vertex].sum + 7);
    uint64_t s_p = nibble(vertices[p->vertex].sum + 7);
    uint64_t k_f = nibble((int64_t)l_f - (int64_t)g_f), k_n = nibble((int64_t)l_n - (int64_t)g_n);
    uint64_t k_p = nibble((int64_t)l_p - (int64_t)g_p);
    uint64_t b = (uint64_t)(l_f == 0) << 2 | (uint64_t)(l_n == 0) << 1 | (uint64_t)(l_p == 0);
    uint64_t m = (uint64_t)latest;

    const uint64_t digits[VALENCE_CONTEXTS] = {
        0,
        l_f << 8 | l_n << 4 | a_f,
        l_f << 4 | s_f,
        l_f << 12 | l_n << 8 | a_f << 4 | s_f,
        l_n << 8 | a_f << 4 | s_n,
        l_p << 12 | s_p << 8 | a_p << 4 | g_f,
        g_p << 12 | g_n << 8 | l_p << 4 | g_nn,
        b << 8 | g_nn << 4 | l_nn,
        b << 4 | g_pp,
        b << 16 | a_p << 12 | k_f << 8 | l_p << 4 | g_n,
        g_f << 16 | g_p << 12 | l_f << 8 | l_n << 4 | l_p,
        l_p << 24 | l_nn << 20 | k_p << 16 | k_n << 12 | a_n << 8 | g_pp << 4 | l_pp,
        a_p << 24 | s_n << 20 | m << 16 | s_f << 12 | g_f << 8 | s_p << 4 | g_nn,
        b << 24 | g_nn << 20 | a_f << 16 | g_p << 12 | g_n << 8 | l_nnn << 4 | k_n,
    };
    for (int i = 0; i < VALENCE_CONTEXTS; i++) {
        uint64_t hashed = ((digits[i] + 1) * UINT64_C(0x1E3779B97F4A7C15)) >> (64 - model->bits);
        model->contexts[i] = (((int64_t)i << model->bits) + (int64_t)hashed) * VALENCE_NODES;
        __builtin_prefetch(model->valence.slots + model->contexts[i], 1);
    }
    model->event_contexts[0] = (int64_t)(g_f << 4 | g_n);
    model->event_contexts[1] = EVENT_SIZE + (int64_t)(g_f << 8 | g_p << 4 | g_n);
    model->event_contexts[2] = 2 * EVENT_SIZE + (int64_t)b;
}

/* Code whether a gate leads to a new, real vertex. */
INLINE int code_usual(RangeCoder *coder, const ValenceModel *model, int bit) {
    return code_mixed_bit(coder, &model->event, EVENT_CONTEXTS, model->event_contexts, 0, 0, bit);
}

INLINE int code_valence_bit(RangeCoder *coder, const ValenceModel *model, int node, int bit) {
    return code_mixed_bit(coder, &model->valence, VALENCE_CONTEXTS, model->contexts, node, 0, bit);
}

/* Code a valence, at least 2: is it 6, is it less, and then one by one away from 6. */
static inline int64_t code_valence(RangeCoder *coder, const ValenceModel *model, int64_t valence) {
    if (code_valence_bit(coder, model, 0, valence == 6)) return 6;
    if (code_valence_bit(coder, model, 1, valence < 6)) {
        for (int k = 0; k < 3; k++)
            if (code_valence_bit(coder, model, 2 + k, valence == 5 - k)) return 5 - k;
        return 2;
    }
    for (int v = 7; v <= LAST_UNARY; v++)
        if (code_valence_bit(coder, model, v - 2, valence == v)) return v;
    return LAST_UNARY + 1 + code_rare(coder, model, RARE_VALENCE, valence - LAST_UNARY - 1);
}

/* Known to the encoder only: its surface (half-edges 3 i .. 3 i + 2 belong to face i) and the part that is already
 * coded. `fans` and `faces` are in the order of coding. */
typedef struct {
    const int32_t *twin, *corner, *valence;
    int64_t real; /* fans; the numbers after them are those of dummies */
    uint8_t *conquered;
    int32_t *node, *number, *fans, *faces;
} Guide;

/* The conquest: triangle by triangle over a closed surface (specification, C 6). */
typedef struct {
    RangeCoder *coder;
    ValenceModel model;
    Guide map;
    Polygons front;
    Vertex *vertices;
    int64_t vertex_room;
    int32_t *faces;
    int64_t face_room;
    int64_t coded_vertices, coded_real, coded_faces;
    int64_t dummies, turns, steps; /* dummies, triangles and steps along the front that are still allowed */
    int64_t start;                 /* first face that the encoder may have left */
    int32_t latest;                /* label of the latest real vertex */
} Conquest;

/* How a call ends; without room for more nodes or TURN_BYTES, make some and call again. */
typedef enum { CONQUEST_DONE, CONQUEST_NONSENSE, CONQUEST_NO_ROOM } ConquestEnd;
enum { TURN_BYTES = 1024 /* more than one triangle can take */ };

ConquestEnd conquer(Conquest *walk);

/* Half-edges of a triangle list: number 3 i + k runs from corner k of face i to corner k + 1. */
INLINE int32_t next_halfedge(int32_t h) { return h % 3 != 2 ? h + 1 : h - 2; }
INLINE int32_t previous_halfedge(int32_t h) { return h % 3 != 0 ? h - 1 : h + 2; }

INLINE int32_t low_end(const int32_t *origin, int32_t h) {
    return (int32_t)least(origin[h], origin[next_halfedge(h)]);
}

INLINE int32_t high_end(const int32_t *origin, int32_t h) {
    return (int32_t)largest(origin[h], origin[next_halfedge(h)]);
}

/* Where the half-edges of the edge end that begins at `begin` of their order, and its ends. */
INLINE int64_t end_of_edge(ConstInts origin, ConstInts order, int64_t begin, int32_t *low, int32_t *high) {
    int64_t end = begin + 1;
    *low = low_end(origin.data, order.data[begin]);
    *high = high_end(origin.data, order.data[begin]);
    while (end < order.size && low_end(origin.data, order.data[end]) == *low
        && high_end(origin.data, order.data[end]) == *high)
        end++;
    return end;
}

void match_halfedges(ConstInts origin, Longs starts, Ints by_high, Ints order, Ints twin);
void join_sheets(ConstInts origin, ConstInts order, Ints twin);
int64_t find_fans(ConstInts origin, ConstInts twin, Ints corner, Ints vertex);
int64_t fill_loops(ConstInts twin, ConstInts corner, Ints leaving, Ints full_twin, Ints full_corner);

/* The part of each vertex. See partition.c. */
extern INSIDE const BankPlan LABEL_BANK;
int64_t code_labels(
    RangeCoder *coder, const Bank *bank, ConstInts offsets, ConstInts neighbors, Ints labels, int64_t parts);

/* Permutations and rotations. See permutation.c. */
extern INSIDE const BankPlan STEP_BANK, TURN_BANK;
bool code_steps(RangeCoder *coder, const Bank *bank, Ints values, Ints tree);
void code_turns(RangeCoder *coder, const Bank *bank, Ints values);

/* Fans that are the same vertex, and faces that repeat a corner: an entry per fan, -1 for none or an unknown one. */
typedef struct {
    Ints vertex, after, before, sibling, latest;
} Seams;

extern INSIDE const BankPlan FAN_BANK;
int64_t code_fans(RangeCoder *coder, const Bank *bank, ConstInts known, Seams seams);
int64_t code_degenerate(RangeCoder *coder, Ints corners, int64_t count);

/* Faces that repeat a corner, on the edges of the others (C 13). See repeats.c. */

/* Known to a writer only: its faces by their corners, the first of them at the first half-edge of an edge, the next one
 * on the same edge (-1: there is none), and room for all, those on edges first, in the order of coding. */
typedef struct {
    ConstInts corners;
    Ints first, next, order;
} FacesOnEdges;
enum { NOT_ON_EDGES = -2 };

/* Half-edges by their lower and then their higher end, and of each vertex: how many corners of the other faces are
 * there, how many faces with a repeated corner were met there, and how many of these repeat it. */
typedef struct {
    ConstInts origin, order;
    Ints valence, met, repeated;
    FacesOnEdges given;
} Edges;

INLINE bool repeats_corner(const int32_t *face, int32_t v) {
    return (face[0] == v) + (face[1] == v) + (face[2] == v) > 1;
}

extern INSIDE const BankPlan REPEAT_BANK;
int64_t code_repeats(RangeCoder *coder, const Bank *bank, const Edges *edges, Ints corners);
#ifdef BSMDEC_WRITES
int64_t list_on_edges(const Edges *edges, ConstLongs ends, int64_t vertices);
#endif

/* Numbering by first appearance. */
int64_t number_by_appearance(ConstInts sequence, Ints order, Ints number);
