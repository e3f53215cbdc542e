/* The conquest (specification, C 6) for TypeScript, which keeps the state of a walk between calls in its own arrays. */
#include "bitstream/connectivity/connectivity.h"

typedef struct {
    Bank valence, event, rare;
    int64_t bits;
} Models;

typedef struct {
    Ints2 nodes;
    Ints heads;
    Longs2 vertices;
    Ints2 faces;
    Longs tallies;
} Walk;

enum { VERTICES, REAL, FACES, DUMMIES, TURNS, STEPS, LATEST };

/* Conquer until all faces are made, or more nodes are needed; how it ended. */
int64_t conquer_surface(Coder coder, Models models, Walk walk) {
    int64_t *tallies = walk.tallies.data, valences = ((int64_t)VALENCE_CONTEXTS << models.bits) * VALENCE_NODES;
    Conquest conquest = {
        .model.bits = (int)models.bits,
        .front = {.nodes = (Node *)walk.nodes.data, .capacity = walk.nodes.rows},
        .vertices = (Vertex *)walk.vertices.data, .vertex_room = walk.vertices.rows,
        .faces = walk.faces.data, .face_room = walk.faces.rows,
        .coded_vertices = tallies[VERTICES], .coded_real = tallies[REAL], .coded_faces = tallies[FACES],
        .dummies = tallies[DUMMIES], .turns = tallies[TURNS], .steps = tallies[STEPS],
        .latest = (int32_t)tallies[LATEST],
    };
    for (int i = 0; i < HEADS; i++) conquest.front.heads[i] = walk.heads.data[i];
    if (!open_bank(&conquest.model.valence, models.valence, valences, VALENCE_NODES, VALENCE_CONTEXTS)
        || !open_bank(&conquest.model.event, models.event, EVENT_CONTEXTS * EVENT_SIZE, 1, EVENT_CONTEXTS)
        || !open_bank(&conquest.model.rare, models.rare, RARE_NODES, RARE_NODES, 1))
        return MISUSED;
    int64_t end = conquer(coder, &conquest);
    for (int i = 0; i < HEADS; i++) walk.heads.data[i] = conquest.front.heads[i];
    tallies[VERTICES] = conquest.coded_vertices;
    tallies[REAL] = conquest.coded_real;
    tallies[FACES] = conquest.coded_faces;
    tallies[DUMMIES] = conquest.dummies;
    tallies[TURNS] = conquest.turns;
    tallies[STEPS] = conquest.steps;
    tallies[LATEST] = conquest.latest;
    return end;
}
