/* Bytes to packets, and what packets say: the interface of this room. */
#pragma once

#include "bitstream/container/numbers.h"
#include "bitstream/context.h"

/* The smallest pieces of the format: varints, checksums, payloads read from front to back. */

/* Bytes that somebody else keeps. */
typedef struct {
    const uint8_t *data;
    int64_t size;
} Span;

/* `long_sums[k]`: of a byte followed by k zeros. */
typedef struct {
    uint32_t long_sums[8][256];
    uint16_t short_sums[256];
} Sums;

void make_sums(Sums *sums);
uint32_t crc32_of(const Sums *sums, Span bytes, uint32_t before);
/* Of positions that follow those with the checksum `before` (F 5.10). */
uint32_t crc32_of_positions(const Sums *sums, ConstDoubles2 positions, uint32_t before);
uint16_t crc16_of(const Sums *sums, Span bytes);
/* `size` bytes, at most eight, as a number. */
uint64_t little_endian(const uint8_t *bytes, int size);
uint64_t big_endian(const uint8_t *bytes, int size);

/* Bytes that the varint at the start takes; 0 if `bytes` ends inside it, -1 if it is invalid (F 1.2). */
int parse_varint(Span bytes, int64_t *value);

/* What a payload lacks or has too much is corrupt; a cursor that has failed gives zeros. */
typedef struct {
    Context *context;
    Span left;
} Cursor;

int64_t take_varint(Cursor *cursor);
Span take_span(Cursor *cursor, int64_t count);
INLINE Span take_rest(Cursor *cursor) { return take_span(cursor, cursor->left.size); }
bool at_end(const Cursor *cursor);

/* Canonical msgpack maps (specification, F 1.5), and records of typed fields in them (F 4.1 to F 4.5). */
enum { MOST_ENTRIES = 256 };
typedef enum { NO_VALUE, INTEGER, REAL, TEXT, BINARY, LIST } Kind;

typedef struct {
    Kind kind;
    int first;        /* of a list: its first item */
    int64_t whole;    /* an integer, cut to 64 bits with a sign; of a list: how many items */
    uint64_t bits;    /* an integer above that */
    double number;    /* an integer or a real */
    Span bytes;       /* text or binary */
} Value;

typedef struct {
    int count, items;
    Value key[MOST_ENTRIES], value[MOST_ENTRIES], item[MOST_ENTRIES];
} Map;

/* Whether bytes are UTF-8: no form longer than needed, no surrogates, nothing above U+10FFFF. */
bool is_text(Span bytes);
/* A value that holds no other, behind its first byte; what else begins with that is corrupt. */
Value take_single(Cursor *cursor, uint8_t tag);
/* The entries of a payload, whose bytes they point to. */
bool parse_map(Context *context, Span payload, Map *map);

enum { MOST_KEY = 30, MOST_LIST = 8 };
/* By key: numbers, how many; and the text of the one field that may have one. */
typedef struct {
    double number[MOST_KEY][MOST_LIST];
    int count[MOST_KEY];
    uint32_t stored;  /* bit k: key k */
    Span text;
} Record;

bool parse_record(Context *context, Span payload, Fields fields, Arena *scratch, Record *record);
bool is_default(const Field *field, const Record *record);
/* Set the fields that are not stored to their defaults, and check that every value is in its range. */
bool complete_record(Context *context, Fields fields, Record *record);

/* What a stream says before anything else, and what it declares of attributes (specification, F 4, F 10, D 1). */

/* How blocks are coded; only the paper's codec has other than the law's constants (F 10). */
typedef struct {
    int bits, coarser, exact, power, iterations, key_iterations, springs;
    double shift;
} Paper;

enum { LIGHT = 1, EXACT_FLOATS = 2 };

/* The coarse graph that blocks are on: cells of vertices, how far these are from centers, smoothings that spread places
 * of cells, and how often the step of their levels is halved (M 18). All are 0 without it. */
typedef struct {
    int64_t cells;
    int reach, rounds, halvings;
} Coarse;

typedef struct {
    int64_t vertices, faces, blocks, block_size, coefficients, key_interval, attributes;
    double step, center[3], scale, smoothing;
    bool refined, on_grid, is_sequence;
    double refinement[2]; /* step and ratio */
    Coarse base;
    int32_t grid[3];
    double turn[3]; /* of the axes of a grid: a quaternion, less its 1 (V 18) */
    int64_t cells, points, corner[3]; /* of a lattice, 0 without */
    bool counted;                     /* there is a corner */
    int light, onorm;                 /* solutions before each Onorm in doubles, or 0 */
    int swift;      /* how values of attributes are coded: 0, 1 plain, 2 mixed (A 9) */
    int repeats;    /* 1: faces that repeat a corner are counted on edges (C 13) */
    int congruence; /* 35 more than the transforms of congruent parts, and 17 more with whole vertices; 0: without */
    int64_t frames, gop_frames, run, mesh_of; /* `again`: the run whose mesh this one has, or -1 */
    Paper paper;
    bool brief; /* the frame of the header is the whole stream, and ends with this (F 11) */
    Span connectivity, values, metadata;
    Record record; /* all fields by key, as they were stored */
} Header;

#ifndef BSMDEC_LONG /* whether a build knows no brief streams */
#define BSMDEC_LONG 0
#endif
INLINE bool is_brief(const Header *header) { return !BSMDEC_LONG && header->brief; }

/* Vertices of the graph that blocks are on, and all that have levels. */
INLINE int64_t ground_size(const Header *header) {
    return header->base.cells > 0 ? header->base.cells : header->vertices;
}
INLINE int64_t levels_size(const Header *header) { return header->base.cells + header->vertices; }

/* How positions on a grid are coded. */
INLINE int method_of(const Header *header) { return BSMDEC_LIGHT ? LIGHT : header->light; }

/* Whether faces that repeat a corner are on edges, which small builds of light grids do not know. */
INLINE bool has_edges(const Header *header) { return BSMDEC_LIGHT == 0 && header->repeats > 0; }

/* Whether values of a grid are also foretold from congruent parts. */
INLINE bool is_congruent(const Header *header) { return BSMDEC_LIGHT != 1 && header->congruence > 0; }

/* How many transforms a congruent grid has, and whether it asks for whole vertices (V 17.1, V 17.11). */
enum { LEAST_CONGRUENCE = 35 }; /* drafts had those below */
INLINE int transforms_of(const Header *header) { return (header->congruence - LEAST_CONGRUENCE) % 17; }
INLINE bool asks_whole(const Header *header) { return header->congruence >= LEAST_CONGRUENCE + 17; }

bool parse_header(Context *context, Span payload, Arena *scratch, Header *header);

/* The numbers of a header that the encoder in C writes. */
Record header_record(const Header *header);

/* Blocks of a chain (M 10.1). */
INLINE int64_t chain_length(const Header *header) {
    return header->key_interval > 0 ? header->key_interval : header->blocks;
}

enum { LEVELS, OCTAHEDRAL, BITS, RECOMPUTED, UNKNOWN_CODING, TANGENTS }; /* 4 stays unknown, as vectors have it */
enum { MOST_ATTRIBUTES = 256, MOST_WORDS = 8 };

/* By the kind of numbers: the least of integers; what a fraction of 1 is, the largest of integers. */
static const double LEAST_OF[] = {0, INT8_MIN, 0, INT16_MIN, 0, INT32_MIN};
static const double UNIT_OF[] = {UINT8_MAX, INT8_MAX, UINT16_MAX, INT16_MAX, UINT32_MAX, INT32_MAX, 1, 1};

/* An attribute, but for its values. */
typedef struct {
    char name[MOST_NAME + 1];
    int name_size, domain, origin, semantic, kind, components, coding, words;
    int64_t rows, seams_of;
    int64_t bases[2]; /* of tangents: 1 more than the attributes that are their normals and texture coordinates */
    uint32_t largest[MOST_WORDS];
    double offset[MOST_WORDS], step[MOST_WORDS]; /* one of each for every word */
    bool leans, moves;
} Declaration;

bool parse_declaration(Context *context, Span payload, Arena *scratch, Declaration *declaration);
Record declaration_record(const Declaration *declaration);
/* Whether the user is given values by vertices. */
INLINE bool is_by_vertex(const Declaration *d) {
    return (d->domain == BSMDEC_VERTEX && d->origin == 0) || (d->domain == BSMDEC_CORNER && d->origin == 1);
}

/* Packets: what a frame of the stream holds (specification, F 3). */
typedef enum {
    VALUES_FRAME, HEADER_FRAME, METADATA_FRAME, CONNECTIVITY_FRAME, PARTITION_FRAME, ORDER_FRAME, BLOCK_FRAME,
    GOP_FRAME, GRID_FRAME = 12, REFINEMENT_FRAME, ATTRIBUTE_FRAME, END_FRAME, NO_FRAME = -1,
} FrameType;

/* What a frame says; what a kind has not is 0. Its data are the reader's, until more bytes come. */
typedef struct {
    FrameType type;
    int64_t size;         /* bytes of the payload */
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

/* Which packet may follow which (specification, F 3.5 to F 3.14). */
typedef struct {
    const Header *header; /* of the present run, NULL before the first */
    FrameType last;       /* NO_FRAME before the first */
    uint32_t allowed;     /* bit k: type k */
    bool lossy, resuming, joining, joined; /* resuming: after damage, before anything else has come */
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

/* Metadata: what authors say of their meshes, each name once (specification, F 3.9, F 5.1). */

/* What the author says of a mesh, one entry. */
typedef struct {
    Span name;
    Kind kind;
    int64_t whole;
    double number;
    Span bytes;
} MetadataEntry;

typedef struct Branch Branch;
/* Entries by name: a tree by the first bit in which names differ, so that no names take longer than their bits. */
typedef struct {
    Arena arena;
    void *root;
    MetadataEntry **entries;
    int64_t count, capacity;
} Metadata;

/* The entry of a name, NULL if there is none. */
const MetadataEntry *find_name(const Metadata *metadata, Span name);
bool add_entry(Metadata *metadata, const Value *key, const Value *value);

/* Bytes to packets (specification, F 2, F 3, F 5, F 8). */

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
    int64_t capacity, begin, end, moves; /* moves: how often bytes went elsewhere */
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
/* Look at the frame that starts `*place` bytes after the last packet: true if all of it has come, and it is a sound
 * frame of blocks or refinements that may follow by a copy of the grammar. Then move `*place` to its end and advance
 * the copy. Nothing else changes, and nothing is charged. */
bool peek_packet(Reader *reader, int64_t *place, Grammar *grammar, Packet *packet);
