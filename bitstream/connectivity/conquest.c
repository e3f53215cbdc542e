/* The conquest: triangle by triangle over a closed surface, the same walk for both directions (specification, C 6).
 *
 * A front of edges separates triangles that are known from others; a node of it is a vertex with so many edges to
 * come. The next triangle closes a corner of the front, adds a vertex, whose valence is coded, or meets the front
 * elsewhere (C. Touma, C. Gotsman, "Triangle mesh compression", 1998). Valences suffice where nothing splits, about
 * two bits a vertex; contexts are what the front already tells about the vertices there. Borders are closed with
 * dummies before, so that the walk knows one case less.
 *
 * An encoder has a guide, which tells each third vertex; without one, the coder's payload does. Whatever a payload
 * says, indices stay inside: a node is made by add_node, a vertex by add_vertex, a face by emit, each of which
 * counts. */
#include "bitstream/connectivity/connectivity.h"

enum { REACH = 4096 /* a node further along the front than this is named by its number instead */ };

/* Code the valence of a new vertex and enter it in the table; -1 if there are too many. */
INLINE int64_t add_vertex(Conquest *walk, int32_t fan, bool dummy) {
    int64_t vertex = walk->coded_vertices, valence = 2;
    if (vertex == walk->vertex_room) return -1;
    if (!is_reading(walk->coder)) {
        valence = walk->map.valence[fan];
        walk->map.number[fan] = (int32_t)vertex;
    }
    if (dummy) {
        valence = 2 + code_rare(walk->coder, &walk->model, RARE_LOOP, valence - 2);
        walk->vertices[vertex] = (Vertex){.label = 0, .sum = 0, .rank = -1};
        walk->dummies--;
    } else {
        if (vertex + walk->dummies >= walk->vertex_room) return -1;
        valence = code_valence(walk->coder, &walk->model, valence);
        int32_t label = (int32_t)least(valence, 15);
        walk->vertices[vertex] = (Vertex){.label = label, .sum = 0, .rank = (int32_t)walk->coded_real};
        if (!is_reading(walk->coder)) {
            if (walk->coded_real >= walk->map.real) return -1;
            walk->map.fans[walk->coded_real] = fan;
        }
        walk->coded_real++;
        walk->latest = label;
    }
    walk->coded_vertices++;
    return valence;
}

/* Mark triangle (a, b, c) as conquered, and add it to the faces unless it has a dummy (C 5.5). */
INLINE bool emit(Conquest *walk, int32_t a, int32_t b, int32_t c, int32_t face) {
    if (!is_reading(walk->coder)) walk->map.conquered[face] = 1;
    if (a == b || b == c || c == a) return false;
    int32_t rank_a = walk->vertices[a].rank, rank_b = walk->vertices[b].rank, rank_c = walk->vertices[c].rank;
    if (rank_a < 0 || rank_b < 0 || rank_c < 0) return true;
    int64_t number = walk->coded_faces;
    if (number == walk->face_room) return false;
    int32_t *row = walk->faces + 3 * number;
    row[0] = rank_a;
    row[1] = rank_b;
    row[2] = rank_c;
    if (!is_reading(walk->coder)) walk->map.faces[number] = face;
    walk->coded_faces++;
    return true;
}

/* Tell the contexts of a new edge (C 5.6). */
INLINE void meet(Conquest *walk, int32_t a, int32_t b) {
    Vertex *one = walk->vertices + a, *other = walk->vertices + b;
    if (one->label != 0) other->sum += one->label - 6;
    if (other->label != 0) one->sum += other->label - 6;
}

/* The edge from `node` to its next one has become a gate, with `halfedge` on the conquered side. */
INLINE void set_gate(Conquest *walk, int32_t node, int32_t apex, int32_t halfedge) {
    walk->front.nodes[node].apex = apex;
    if (!is_reading(walk->coder)) {
        int32_t gate = walk->map.twin[halfedge];
        walk->front.nodes[node].gate = gate;
        walk->map.node[gate] = node;
    }
}

/* Make the border of the first face that is left, of three new vertices, the front (C 6.3). */
static bool start_component(Conquest *walk) {
    int32_t first = (int32_t)walk->coded_vertices, node = walk->front.heads[MADE];
    int32_t start = (int32_t)walk->start;
    if (!is_reading(walk->coder)) {
        while (start < walk->face_room && walk->map.conquered[start]) start++;
        if (start == walk->face_room) return false;
        walk->start = start;
    }
    look_nowhere(&walk->model);
    for (int k = 0; k < 3; k++) {
        int32_t fan = is_reading(walk->coder) ? 0 : walk->map.corner[3 * start + k];
        int64_t valence = add_vertex(walk, fan, false);
        if (valence < 0) return false;
        add_node(&walk->front, first + k, (int32_t)valence - 2);
    }
    for (int k = 0; k < 3; k++) {
        link_nodes(&walk->front, node + k, node + (k + 1) % 3);
        meet(walk, first + k, first + (k + 1) % 3);
        set_gate(walk, node + k, first + (k + 2) % 3, 3 * start + k);
    }
    return emit(walk, first, first + 1, first + 2, start);
}

/* Add the triangle of a node without free edges and its neighbors p and n, which makes an edge from p to n (C 6.4). */
INLINE bool close_node(Conquest *walk, int32_t f) {
    Polygons *front = &walk->front;
    Node *nodes = front->nodes;
    int32_t p = nodes[f].previous, n = nodes[f].next, gate = nodes[f].gate;
    int32_t v_f = nodes[f].vertex, v_n = nodes[n].vertex, v_p = nodes[p].vertex;
    if (p == n || !emit(walk, v_n, v_f, v_p, gate / 3)) return false;
    set_free(front, f, DEAD);
    if (nodes[n].next == p && nodes[p].free == 0 && nodes[n].free == 0) {
        set_free(front, n, DEAD);
        set_free(front, p, DEAD);
        return true;
    }
    if (nodes[p].free == 0 || nodes[n].free == 0) return false;
    link_nodes(front, p, n);
    set_gate(walk, p, v_f, previous_halfedge(gate));
    meet(walk, v_p, v_n);
    set_free(front, n, nodes[n].free - 1);
    set_free(front, p, nodes[p].free - 1);
    return true;
}

/* Find a node on the polygon of f: 0 and the candidates passed going forward from the node after f, or 1 and those
 * going backward from f, whichever is nearer; 2 if it is not within reach. */
static int search(const Node *nodes, int32_t f, int32_t node, int64_t reach, int64_t *passed) {
    int32_t a = nodes[f].next, b = f;
    int64_t forward = 0, backward = 0;
    for (int64_t k = 0; k < reach; k++) {
        a = nodes[a].next;
        if (a == node) {
            *passed = forward;
            return 0;
        }
        b = nodes[b].previous;
        if (b == node) {
            *passed = backward;
            return 1;
        }
        if (a == f) break;
        forward += nodes[a].free >= 2;
        backward += nodes[b].free >= 2;
    }
    *passed = 0;
    return 2;
}

/* Code the node where a split happens: how many candidates along the front away, or else its number (C 6.8).
 *
 * Candidates have two free edges. All steps together are bounded, so that work is, too. Returns -1 for nonsense. */
static int32_t code_node(Conquest *walk, int32_t f, int32_t node) {
    const Node *nodes = walk->front.nodes;
    RangeCoder *coder = walk->coder;
    int64_t reach = least(REACH, walk->steps), count = 0;
    int way = is_reading(coder) ? 2 : search(nodes, f, node, reach, &count);
    if (code_rare_bit(coder, &walk->model, RARE_WAY, way >> 1)) {
        walk->steps -= reach;
        return (int32_t)code_uniform(coder, node, walk->front.heads[MADE]);
    }
    way = code_rare_bit(coder, &walk->model, RARE_WAY + 1, way);
    count = code_rare(coder, &walk->model, RARE_STEPS, count);
    int32_t a = way ? f : nodes[f].next;
    for (int64_t k = 0; k < reach; k++) {
        a = way ? nodes[a].previous : nodes[a].next;
        walk->steps--;
        if (nodes[a].free >= 2 && --count < 0) return a;
    }
    return -1;
}

/* Node at the third vertex of the triangle at `gate`, and its free edges between that triangle and its own gate.
 *
 * Turns around the vertex both ways at once until one side is conquered: a hub is not searched again and again. */
static int32_t find_node(const Conquest *walk, int32_t gate, int32_t *free) {
    const Guide *map = &walk->map;
    int32_t inward = next_halfedge(gate), outward = previous_halfedge(gate);
    for (*free = -1;; ++*free) {
        if (map->conquered[map->twin[inward] / 3]) return map->node[inward];
        if (map->conquered[map->twin[outward] / 3]) {
            int32_t node = walk->front.nodes[map->node[outward]].next;
            *free = walk->front.nodes[node].free - 2 - *free;
            return node;
        }
        inward = previous_halfedge(map->twin[inward]);
        outward = next_halfedge(map->twin[outward]);
    }
}

/* Add the triangle beyond the edge from f to n, the next node; all nodes have free edges (C 6.5 to C 6.7). */
SHARED bool pass_gate(Conquest *walk, int32_t f) {
    Polygons *front = &walk->front;
    Node *nodes = front->nodes;
    RangeCoder *coder = walk->coder;
    int32_t n = nodes[f].next, gate = nodes[f].gate, v_f = nodes[f].vertex, v_n = nodes[n].vertex;
    /* The node to split at, its free edges on the side of f, or else the new vertex. */
    int32_t node = -1, free = 0, fan = 0;
    int usual = 1, loop = 0;
    if (!is_reading(coder)) {
        fan = walk->map.corner[previous_halfedge(gate)];
        if (walk->map.number[fan] >= 0) node = find_node(walk, gate, &free);
        usual = node < 0 && fan < walk->map.real;
    }
    look_beyond(&walk->model, front, walk->vertices, walk->latest, f);
    usual = code_usual(coder, &walk->model, usual);
    if (!usual && walk->dummies > 0) loop = code_rare_bit(coder, &walk->model, RARE_DUMMY, node < 0);

    int32_t vertex, other;
    if (!usual && !loop) {
        node = code_node(walk, f, node);
        if (node < 0 || nodes[node].free < 2) return false;
        free = (int32_t)code_uniform(coder, free, nodes[node].free - 1);
        vertex = nodes[node].vertex;
        int32_t before = nodes[node].previous;
        other = add_node(front, vertex, nodes[node].free - 2 - free);
        set_free(front, node, free);
        link_nodes(front, before, other);
    } else {
        vertex = (int32_t)walk->coded_vertices;
        int64_t valence = add_vertex(walk, fan, loop);
        if (valence < 0) return false;
        other = node = add_node(front, vertex, (int32_t)valence - 2);
    }
    if (!emit(walk, v_n, v_f, vertex, gate / 3)) return false;
    link_nodes(front, f, node);
    link_nodes(front, other, n);
    set_gate(walk, f, v_n, next_halfedge(gate));
    set_gate(walk, other, v_f, previous_halfedge(gate));
    meet(walk, vertex, v_f);
    meet(walk, vertex, v_n);
    set_free(front, n, nodes[n].free - 1);
    set_free(front, f, nodes[f].free - 1);
    return true;
}

/* Code the surface, from where the last call ran out of room. */
ConquestEnd conquer(Conquest *walk) {
    Polygons *front = &walk->front;
    while (front->heads[ALIVE] > 0 || walk->coded_faces < walk->face_room) {
        if (front->heads[MADE] + 3 > front->capacity || !has_room(walk->coder, TURN_BYTES)) return CONQUEST_NO_ROOM;
        if (--walk->turns < 0 || overran(walk->coder)) return CONQUEST_NONSENSE;
        int32_t f = first_node(front);
        bool legal = f < 0              ? start_component(walk)
            : front->nodes[f].free == 0 ? close_node(walk, f)
                                        : pass_gate(walk, f);
        if (!legal) return CONQUEST_NONSENSE;
    }
    return walk->coded_vertices == walk->vertex_room ? CONQUEST_DONE : CONQUEST_NONSENSE;
}
