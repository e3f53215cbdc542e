/* What a decoder has come to know: of the present mesh, of a sequence, and of what its caller has asked. */
#pragma once

#include "bitstream/container/container.h"
#include "bitstream/payloads/payloads.h"
#include "bitstream/pool.h"
#include "codec/sequence/gops.h"
#include "codec/signal/decoding.h"
#include "library/attribute.h"

typedef struct Ahead Ahead;

/* What is known of the present mesh. */
typedef struct {
    Header header;
    Arena arena;
    bool has_faces, has_graph, announced, over;
    Ints2 faces;
    Graph graph;
    CellMesh cells;         /* of a base: blocks are on their graph, and a first layer on their faces */
    Ints labels;         /* of PARTITION, empty without */
    Numbering numbering;
    Blocks blocks;
    bool has_chains, has_grid, has_cell_layer, has_layer, values_begun;
    Chains chains;
    Assembly assembly;
    Ahead *ahead;         /* what other threads decoded, or NULL */
    int64_t next_block, chunks;
    GridField grid;
    Layer cell_layer, layer;
    bool has_attributes;
    Attributes attributes;
    /* Of a sequence: */
    bool in_gops;
    Doubles2 first_frame; /* in BSM units */
    MovingAttribute *moving;
    int moving_count;
    Gops gops;
} Mesh;

INLINE bool has_base(const Mesh *mesh) { return mesh->header.base.cells > 0; }
/* The graph that blocks are on, and whether a block has brought a vertex, or its cell. */
INLINE const Graph *ground_of(const Mesh *mesh) { return has_base(mesh) ? &mesh->cells.graph : &mesh->graph; }
INLINE bool is_placed(const Mesh *mesh, int64_t v) {
    return mesh->assembly.blend.weights.data[has_base(mesh) ? mesh->cells.own.data[v] : v] > 0.0;
}

/* A mesh that runs have had, the memory that is counted for it, and its vertices. */
enum { MOST_CACHED = 8 };
typedef struct {
    int64_t run;
    double memory;
    int64_t vertices;
    Mesh mesh;
} CachedMesh;

/* A GOP before the wanted frames, which later ones may need. */
typedef struct Skipped {
    struct Skipped *next;
    Span data;
} Skipped;

/* How far a sequence has come, over all of its runs (specification, S 1.3, S 9). */
typedef struct {
    bool active, lost, lossy, damaged;
    int64_t start, next, announced, missing; /* frames: the first wanted, the next, of all runs, lost so far */
    int64_t mesh, gop; /* the run that brought the present mesh; first frame of the GOP that is shown */
    bsmdec_error damage, why;                /* the first since frames were lost; why the run is */
    CachedMesh *cache[MOST_CACHED];                   /* the one used last at the end */
    int cached;
    double kept;
    int64_t vertices;                        /* when the run began */
    Arena waiting;
    Skipped *first, *last;
} Sequence;

/* Who decodes which chains of a static mesh or a first frame: chain c is that of number c % `among`, the decoder's is
 * 0; all are its own where `among` is 0. One that helps decodes nothing else, and hands its blocks over. */
typedef struct {
    int64_t number, among;
    bool helps;
    DecodedBlock handed;
} Share;

INLINE bool is_own(const Share *share, const Header *header, int64_t index) {
    return share->among == 0 || index / chain_length(header) % share->among == share->number;
}

/* Vertices for graphics: those of the mesh, then copies of some, whose vertices are `sources`. `corners` has a corner
 * of each, -1 if no face has it; `indices` has the vertex of each corner. The arrays are empty if nothing is split. */
typedef struct {
    Arena arena;
    bool is_made, is_needed, by[MOST_ATTRIBUTES];
    int64_t vertices;
    Ints sources, corners;
    Words indices;
} Split;

/* Reported for a block that a helper decodes: it has to be added before anything else is asked for. */
enum { BLOCK_OF_HELPER = BSMDEC_VALUES + 1 };

/* The state of the present mesh at the last call for changes, and the last answer. */
typedef struct {
    Arena memory, answer;
    bool begun, late;        /* `late`: vertices that may be final wait for the last block */
    bool spread;             /* whether the vertices were read to which levels of cells bring them */
    double work;             /* of all answers */
    Ints missing;            /* copies of each vertex that have not come */
    Bytes final, marks;
    Doubles2 blended;
    Ints number, ringed;     /* of vertices around others */
    Ints starts, members;    /* the user's numbers of each coded vertex; empty: the same */
    int64_t blocks, reached; /* those of which changes were read: blocks; vertices of a grid or of refinement */
} Changes;

/* An event that waits, and what a LOSS event is about. */
typedef struct {
    bsmdec_event event;
    bsmdec_error loss;
} Report;

struct bsmdec {
    Context context;
    Share share;
    bsmdec_parallel parallel;
    Reader reader;
    Arena scratch;
    bool tolerant, base_alone, has_mesh, ended, over; /* `over`: nothing more is read */
    Mesh mesh;
    Sequence sequence;
    Changes changes;
    /* The queue of events, a ring. */
    Report *queue;
    int64_t first, waiting, slots;
    /* What positions are asked of: those of the mesh, or of a frame; in the unit of the mesh, as coded. */
    bool has_positions;
    ConstDoubles2 positions;
    Arena shown;
    bool has_checksum;    /* whether the stream has a checksum of all positions: */
    uint32_t expected_sum, shown_sum; /* the stream's, and that of all frames so far */
    Split split;
    char misuse[128];     /* why the last call was refused */
    bsmdec_error loss;    /* of the last LOSS event */
    Pool pool; /* of memory, where the caller brings none */
};

void forget_changes(Changes *changes);
INLINE void forget_split(bsmdec *decoder) {
    release_all(&decoder->split.arena);
    decoder->split = (Split){.arena = decoder->split.arena};
}

void begin_mesh(bsmdec *decoder, const Header *header);
/* An event of the present mesh: what its header claims, and what it is once the faces are known. */
bsmdec_event event_of(const bsmdec *decoder, bsmdec_event_type type, int64_t index, int64_t count);
/* Queue an event. */
bool emit_event(bsmdec *decoder, bsmdec_event_type type, int64_t index, int64_t count);
/* Report an error as a loss: of `count` frames of a sequence from `index` on, or of a block. */
bool emit_loss(bsmdec *decoder, bsmdec_error error, int64_t index, int64_t count);
/* Build the graph of the faces, or the blocks with their chains and assembly, unless that was done. */
bool graph_of(bsmdec *decoder);
bool build(bsmdec *decoder);
/* Where all blocks, and levels of cells, bring the vertices; unknown ones are anywhere. */
bool place_base(bsmdec *decoder, Arena *arena, Doubles2 *positions);
/* The same of some vertices alone, in their order, where blocks are on cells. */
bool place_some(bsmdec *decoder, ConstInts vertices, Arena *arena, Doubles2 *positions);
/* Mark the vertices that they bring where the encoder had them, they and those at most `beyond` edges away. */
bool mark_base(bsmdec *decoder, int beyond, Arena *arena, Bytes *whole);
/* What levels of vertices refine. */
bool blend(bsmdec *decoder, Refined *refined);
/* Report once that faces are known. Without tolerance, attributes must have as many rows as the faces ask for. */
bool announce(bsmdec *decoder);
/* Record the error as a loss of `block`, or with -1 of something else, and continue; false if it is fatal. */
bool tolerate_error(bsmdec *decoder, int64_t block, bool anywhere);

/* Chains of blocks, and levels of refinements, that threads of the host decode before their packets are accepted.
 *
 * Decoding ahead changes nothing but time. A chain that fails ahead, for whatever reason, is decoded again in its turn.
 * A chain that does not fail leaves its charges in ledgers, and they are made in its turn. */

/* Build blocks from the graph; meanwhile another thread reads levels of refinements, which need faces alone. */
bool build_beside(bsmdec *decoder);
/* Decode the chain that begins with this block and the next ones, as far as all of their bytes have come. */
void look_ahead(bsmdec *decoder, const Packet *packet);
/* A block that was decoded ahead; NULL if it was not. */
const ReadyBlock *find_ready(const bsmdec *decoder, const Packet *packet);
/* Chains are over: keep levels alone. */
void end_chains_ahead(Mesh *mesh);
/* `blend`; meanwhile another thread reads the levels that are left. All become those of the mesh, if there are any. */
bool blend_beside(bsmdec *decoder, Refined *refined);
void end_ahead(Mesh *mesh);

/* The stages of one mesh: faces, blocks or grids, refinements, attributes (specification, F 3.8, F 8.3). */

/* Accept a packet, and queue its events. */
bool accept_section(bsmdec *decoder, const Packet *packet);
/* The error is the context's. */
bool accept_damage_in_mesh(bsmdec *decoder);
/* Nothing follows. */
bool finish_mesh(bsmdec *decoder);
void end_mesh(Mesh *mesh);
/* Positions of a mesh that is not whole yet, as far as they are known. */
bool look_at_positions(bsmdec *decoder);
/* Whether the checksum of all positions is the stream's; a tolerant decoder reports a difference as a loss. */
bool check_sum(bsmdec *decoder, uint32_t found);

/* Sequences: consecutive runs, each a mesh and its GOPs (specification, S 1, S 9). */
bool accept_in_sequence(bsmdec *decoder, const Packet *packet);
/* The error is the context's. */
bool accept_damage_in_sequence(bsmdec *decoder);
/* Nothing follows. */
bool end_sequence(bsmdec *decoder);
/* Make a reported frame the current one. */
bool show(bsmdec *decoder, int64_t index);
void close_sequence(bsmdec *decoder);

/* What the functions of bsmdec.h have in common. */

/* Bytes of an index; a short one is below 65535, which restarts a strip in graphics APIs. */
enum { SHORT_INDEX = 2, LONG_INDEX = 4 };

/* Note why a call is refused; returns BSMDEC_MISUSED. */
bsmdec_status refuse(bsmdec *decoder, Message message);
#ifdef BSMDEC_TERSE
INLINE bsmdec_status refuse_tersely(const bsmdec *decoder) { return (void)decoder, BSMDEC_MISUSED; }
#define REFUSE(decoder, ...) refuse_tersely(decoder)
#else
#define REFUSE(decoder, ...) refuse(decoder, (Message){.text = __VA_ARGS__})
#endif

/* Copy the options of a caller over `options`, the defaults; false if their size is wrong. */
bool copy_options(const bsmdec_options *given, bsmdec_options *options);
/* Whether an array of a caller is there and has as many elements, or bytes, as it must. */
bool fits(bsmdec *decoder, const void *array, size_t count, int64_t expected);
/* Whether positions are available: BSMDEC_OK, the error of a decoder that has failed, or why is noted. */
bsmdec_status find_places(bsmdec *decoder);
/* Where vertex v of the user is; `loose` counts those in no face. */
const double *place_of(const bsmdec *decoder, int64_t v, int64_t *loose);
/* An attribute of which values may have come; NULL, and the reason is noted, if there is none. */
const Attribute *started_attribute(bsmdec *decoder, int index);
bsmdec_attribute shape_of(const bsmdec *decoder, const Attribute *attribute);
/* Describe one of the attributes if it is available; nothing is noted. */
bool find_shape(const bsmdec *decoder, int index, bsmdec_attribute *shape);
