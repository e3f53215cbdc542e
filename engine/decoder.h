/* A decoder, and the stages of a mesh: what is decoded one after the other behind a header. */
#ifndef BSMDEC_DECODER_H
#define BSMDEC_DECODER_H

#include "engine/assembly.h"
#include "engine/attributes.h"
#include "engine/fields.h"
#include "engine/reader.h"

/* What is known of the present mesh. */
typedef struct {
    Header header;
    Arena arena;
    bool has_faces, has_graph, has_blocks, announced, over;
    Ints2 faces;
    Graph graph;
    Ints labels;         /* of PARTITION, empty without */
    Numbering numbering;
    Blocks blocks;
    bool has_chains, has_grid, has_layer, values_begun;
    Chains chains;
    Assembly assembly;
    int64_t next_block, chunks;
    GridField grid;
    Layer layer;
    bool has_attributes;
    Attributes attributes;
} Mesh;

struct bsmdec {
    Context context;
    Reader reader;
    Arena scratch;
    bool tolerant, has_mesh, ended;
    Mesh mesh;
    /* Events that wait to be told, a ring. */
    bsmdec_event *queue;
    int64_t first, waiting, room;
    /* What positions are asked of: those of the mesh, or of a frame; in the unit of the mesh, as coded. */
    bool has_positions;
    ConstDoubles2 positions;
    Arena shown;
    bsmdec_error loss;
    bsmdec_error *losses; /* of the LOSS events that wait, by index */
    int64_t loss_count, loss_room;
};

bool tell(bsmdec *decoder, bsmdec_event_type type, int64_t index);
/* Take a packet in; what follows from it is told. */
bool accept_packet(bsmdec *decoder, const Packet *packet);
bool accept_damage(bsmdec *decoder);
bool accept_end(bsmdec *decoder);
void end_mesh(Mesh *mesh);
/* Bear an error as a loss of `block`, or of something else if that is -1: false where it is not to be borne. */
bool bear(bsmdec *decoder, int64_t block, bool anywhere);

#endif
