/* The front of the conquest: closed polygons of nodes, and buckets by free degree (specification, C 5.2 to C 5.4).
 *
 * See front.py for what a node is. A node that was closed has the free degree DEAD.
 */
#ifndef BSM_FRONT_H
#define BSM_FRONT_H

#include "bitstream/kernel.h"

/* As Python keeps it: a row per node, of eight columns; first node of each bucket or -1, how many nodes were made, how
 * many of these are not closed, last node of each bucket. */
typedef struct {
    Ints2 nodes;
    Ints heads;
} Front;

typedef struct {
    int32_t vertex, free;    /* free degree */
    int32_t next, previous;  /* in the polygon */
    int32_t gate;            /* half-edge on the far side of the edge to the next node (encoder only) */
    int32_t apex;            /* vertex behind that edge */
    int32_t up, down;        /* within the bucket */
} Node;

enum { DEAD = -1, BUCKETS = 8, MADE = BUCKETS, ALIVE, TAILS, HEADS = TAILS + BUCKETS, NODE_COLUMNS = 8 };

typedef struct {
    Node *nodes;
    int64_t capacity;
    int32_t *heads;
} Polygons;

/* False for arrays that are no front. */
INLINE bool open_front(Polygons *front, Front given) {
    *front = (Polygons){(Node *)given.nodes.data, given.nodes.rows, given.heads.data};
    return given.nodes.columns == NODE_COLUMNS && given.nodes.rows <= INT32_MAX && given.heads.size == HEADS && front->heads[MADE] >= 0
        && front->heads[MADE] <= front->capacity;
}

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

#endif
