/* Bytes to packets (specification, F 2, F 3, F 5, F 8). */
#pragma once

#include "bitstream/container/grammar.h"
#include "bitstream/container/metadata.h"

/* The search for the next section after damaged bytes (F 8.2). If `place` is `sure`, the lengths of the sections before
 * it say that one begins there; otherwise one place after the other is tried. */
typedef struct {
    bool found, sure;
    bsmdec_error why;
    FrameType type;
    int64_t place, by_length; /* where the frame ends by its tag, -1 if that is not there, or was tried */
    int64_t paid;             /* the last place where a stretch of them was paid for; a place may be looked at again */
    bool from_next;           /* the place after the first byte was not tried */
} Damage;

typedef struct {
    Context *context;
    Sums sums;
    Grammar grammar;
    Metadata metadata;
    Arena meshes, scratch; /* what belongs to the present mesh; what a frame takes while it is read */
    uint8_t *buffer;
    int64_t room, begin, end, moves; /* moves: how often bytes went elsewhere */
    int64_t last_offset, last_frame; /* where the last packet began, and its number */
    int64_t offset, frames, metadata_bytes; /* bytes and frames read; bytes of metadata without binary values */
    int64_t plain_bytes; /* of the last metadata */
    uint32_t sum;
    uint8_t version;
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
/* Look at the frame that starts `*place` bytes after the last packet and move `*place` to its end: true if all of it
 * has come and it is a sound frame of blocks or refinements. Nothing else changes, and nothing is charged. */
bool peek_packet(Reader *reader, int64_t *place, Packet *packet);
