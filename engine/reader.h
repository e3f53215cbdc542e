/* Bytes to packets: frames, what they hold, and which may follow which (specification, F 2, F 3, F 5, F 8). */
#ifndef BSMDEC_READER_H
#define BSMDEC_READER_H

#include "engine/header.h"

typedef enum {
    VALUES_FRAME, HEADER_FRAME, METADATA_FRAME, CONNECTIVITY_FRAME, PARTITION_FRAME, ORDER_FRAME, BLOCK_FRAME, GOP_FRAME,
    GRID_FRAME = 12, REFINEMENT_FRAME, ATTRIBUTE_FRAME, END_FRAME,
    NO_FRAME = -1,
} FrameType;

/* What a frame says; what a kind has not is 0. Its data are the reader's, until more bytes come. */
typedef struct {
    FrameType type;
    int64_t index;        /* of a block, a GOP's first frame, an attribute */
    int64_t coefficients; /* of a block */
    int64_t first, count; /* of a grid, a layer or values */
    uint32_t sum;         /* of END, whose `count` is that of frames */
    bool has_positions;   /* whether END has their checksum, which is this: */
    uint32_t positions;
    Span data;
    const Header *header;
    const Declaration *declaration;
} Packet;

/* What the author says of a mesh, one entry. */
typedef struct {
    Span name;
    Kind kind;
    int64_t whole;
    double number;
    Span bytes;
} Saying;

typedef struct Branch Branch;
/* Entries by name: a tree by the first bit in which names differ, so that no names take longer than their bits. */
typedef struct {
    Arena arena;
    void *root;
    Saying **said;
    int64_t count, room;
} Metadata;

/* The entry of a name, NULL if there is none. */
const Saying *find_name(const Metadata *metadata, Span name);
bool add_saying(Metadata *metadata, const Value *key, const Value *value);

enum { MOST_ATTRIBUTES = 256 };
typedef struct {
    const Header *header; /* of the present run, NULL before the first */
    FrameType last;       /* NO_FRAME before the first */
    uint32_t allowed;     /* bit k: type k */
    bool lossy, resuming, joining, joined; /* resuming: behind damage, before anything else has come */
    int64_t next_block, next_frame, next_vertex, valued, next_value;
    Declaration *declared[MOST_ATTRIBUTES];
    int declared_count;
} Grammar;

void begin_grammar(Grammar *grammar, bool joining);
bool announces(const Grammar *grammar, int type);
uint32_t expected_types(const Grammar *grammar);
void lose_frames(Grammar *grammar);
bool check_packet(Context *context, const Grammar *grammar, const Packet *packet);
/* What an attribute's packet declares has to stay: `declaration` is the grammar's own copy of it. */
void advance_grammar(Grammar *grammar, const Packet *packet, Declaration *declaration);

/* Bytes that cannot be read, while what follows them is looked for (F 8.2): from a place on, where frames should stand one
 * behind the other if that is `sure`, and then from others. */
typedef struct {
    bool found, sure;
    bsmdec_error why;
    FrameType type;
    int64_t place, by_length; /* where the frame ends by its tag, -1 if that is not there, or was tried */
    bool from_next;           /* the place behind the first byte was not tried */
} Damage;

typedef struct {
    Context *context;
    Sums sums;
    Grammar grammar;
    Metadata metadata;
    Arena meshes, scratch; /* what belongs to the present mesh; what a frame takes while it is read */
    uint8_t *buffer;
    int64_t room, begin, end;
    int64_t last_offset, last_frame; /* where the last packet began, and its number */
    int64_t offset, frames, told; /* bytes and frames behind; bytes of metadata */
    uint32_t sum;
    bool started, finished;
    Header headers[2];            /* that of the present run, and that of a packet */
    int header;
    Declaration declared;
    /* Of a tolerant reader: */
    bool tolerant, damaged, behind_damage, refused;
    Damage damage;
    double scanned;
    int64_t damaged_offset, damaged_size;
} Reader;

typedef enum { A_PACKET, A_DAMAGE, NO_MORE_YET, NO_MORE, NOTHING_BUT_AN_ERROR } Arrival;

void begin_reader(Reader *reader, Context *context, bool tolerant);
void end_reader(Reader *reader);
bool receive(Reader *reader, Span bytes);
/* What comes next; an error is the context's. */
Arrival next_packet(Reader *reader, Packet *packet);
/* Look at the frame that starts `*place` bytes behind the last packet and move `*place` to its end: true if all of it has
 * come and it is a sound frame of blocks or refinements. Nothing else changes, and nothing is charged. */
bool peek_packet(Reader *reader, int64_t *place, Packet *packet);

#endif
