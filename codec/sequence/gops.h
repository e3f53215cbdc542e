/* Parts, GOPs and frames of sequences (specification, S). */
#pragma once

#include "bitstream/payloads/payloads.h"
#include "codec/basis/patches.h"
#include "codec/sequence/temporal.h"

/* Parts of a mesh whose frames move: what they hang on, and their dictionaries (specification, S 3, S 8.2). */

/* A part of the mesh (S 3). */
typedef struct {
    Patch patch;
    Doubles springs, stiffness;
    Ints starts, outer, around; /* `outer`: which of the vertices `around` each spring goes to */
    Factor factor;
    /* columns of the dictionary; row of the first vertex around it, where rows of all parts are stacked */
    int64_t width, first;
    /* bytes that stay, and that making the dictionary takes; nanoseconds that it took, -1 before */
    double memory, making, work;
    Singles2 dictionary;  /* no rows unless it is kept */
    Mark before;
} Site;

/* All parts of a mesh, and their dictionaries as far as there is room. */
typedef struct {
    Context *context;
    const Header *header;
    const Graph *graph;
    const Blocks *blocks;
    Arena *arena;         /* what stays */
    Arena dictionaries;
    int64_t count, kept, rows, largest; /* parts; first ones whose dictionaries are kept; stacked rows */
    Site *part;
    double around, reserved, use, making;
} Parts;

bool find_parts(Parts *parts, ConstInts2 faces, ConstDoubles2 first_frame, Arena *scratch);
bool reserve_dictionaries(Parts *parts, double memory, double use, double *work);
void release_dictionaries(Parts *parts);
/* U of a part, until `scratch` is released or room is reserved again. */
bool lend_dictionary(Parts *parts, int64_t index, Arena *scratch, Singles2 *dictionary);
/* What continues a field into a part, of which `ends` are the rows around it. */
bool extend_part(const Site *part, ConstDoubles2 ends, Arena *scratch, Doubles2 extension);

/* Groups of frames of a sequence: what each says, and what all of a mesh build on (specification, S). */
enum { LEARNED, KEY_FRAMES, NEXT_FRAMES, LEARNED_NEXT };

/* A field of a GOP: positions, or an attribute that moves; it is not coded if `step` is 0. */
typedef struct {
    int64_t width, components, back;
    double step;
    Ints exponents;
    Span basis, levels;
} GopField;

typedef struct {
    int method;
    int64_t frames, coded; /* T and Q */
    Longs shown;          /* the coded frame of each frame */
    int count;
    GopField *field;
} Gop;

/* Whether an encoder may choose levels, in place of those that are read. */
#ifdef BSMDEC_WRITES
enum { CHOOSES = 1 };
#else
enum { CHOOSES = 0 };
#endif

INLINE bool has_basis(const Gop *gop) { return gop->method == LEARNED || gop->method == LEARNED_NEXT; }

/* An attribute that moves, and what its first values have beyond those of vertex 0; no rows if they are lost. */
typedef struct {
    int64_t number, width;
    Doubles2 start;
} MovingAttribute;

/* Method and frames, which come first in a GOP. */
bool parse_beginning(Cursor *cursor, int64_t longest, int64_t run, Gop *gop);
/* What a GOP says, whose bytes have to stay; attributes that do not move are passed over if that is `tolerant`. */
bool parse_gop(Context *context, Span data, int64_t longest, int64_t run, const MovingAttribute *moving, int count,
    bool tolerant, Arena *arena, Gop *gop);
double gop_memory(int64_t vertices, const Gop *gop, double around);
/* Bytes besides, while a part is decoded. */
double memory_in_use(const Parts *parts, const Gop *gop);
/* The number of earlier changes between frames that predict those of a GOP, if `kept` are available (S 7.2). */
INLINE int64_t lags_of(int64_t kept) {
    int64_t count = 0;
    while (count < LAGS && LAG[count] < kept) count++;
    return count;
}

/* What is known of a field before its first frame. Of each part, matrices have the rows of what is around it, then one
 * for each column of the dictionary; those of all parts are stacked. */
typedef struct {
    int64_t width, kept;
    Doubles2 known;          /* K_i or F_i; the first `width` columns are F_i */
    bool starts_at_first;    /* low-delay frames start from these */
    /* What GOPs refer to. */
    Doubles2 inherited;      /* first components of the GOP before */
    Bank bank;
    Ints levels;             /* of the low-delay frames before, one part after the other */
    int64_t latest, count;   /* index of the latest frame in the ring, and number of frames */
    Doubles ring[MOST_KEPT];
} Track;

/* Everything that GOPs of a mesh are decoded with. */
typedef struct {
    double given, memory;    /* vertices that the user has; bytes that stay besides those of parts */
    bool begun;
    Arena arena, history, levels, frames; /* what stays; what frames refer to; the present GOP */
    Parts parts;
    int tracks;
    Track *track;
    bool can_follow, can_inherit;
    int64_t together;        /* low-delay frames of the GOP before, 0 without */
    /* The present GOP: a field, and over which basis it is shown. */
    Gop gop;
    ConstDoubles2 wanted;    /* of an encoder: the field whose levels are chosen; otherwise no rows */
    Doubles2 field;
    Doubles2 *basis;         /* of each track: d Q rows */
    Doubles2 *batch;         /* some frames of each track, from `batched` on */
    int64_t batched;
} Gops;

INLINE bool chooses(const Gops *gops) { return CHOOSES && gops->wanted.rows > 0; }

/* Whether there is room for a GOP, and its work is paid for (S 8). */
bool reserve_gop(Gops *gops, const Gop *gop, double received);

/* GOPs to frames (specification, S 3.7 to S 7, S 10). */
bool begin_gops(Gops *gops, Context *context, const Header *header, const Graph *graph, const Blocks *blocks,
    ConstInts2 faces, ConstDoubles2 first_frame, int64_t given, const MovingAttribute *moving, int count,
    Arena *scratch);
/* The orthonormal cosines of T frames: row t, column frequency (S 5.1). */
bool time_cosines(int64_t frames, Arena *arena, Doubles2 *columns);
/* Keep only what a later run of the mesh cannot do without. */
void suspend_gops(Gops *gops);
void end_gops(Gops *gops);
/* Frames are missing here. */
void forget_frames(Gops *gops);
/* After this, frames can be shown. */
bool decode_gop(Gops *gops, const Gop *gop, Arena *scratch);
/* What frame `t` of the GOP is in a track, until the GOP is over. */
bool show_frame(Gops *gops, int64_t t, Arena *scratch, int track, ConstDoubles2 *frame);

#ifdef BSMDEC_WRITES
/* One track, with dictionaries of one that stays, and a history of its own. */
bool copy_gops(const Gops *from, int k, Context *context, Arena *arena, Gops *copy);
/* Write the basis of a field, of which `spectrum` has what is free in it (S 5.2), in steps; then, of one track, the
 * levels of a field over it or of low-delay frames, that is as `wanted`: `gops` goes on from it, and has it. */
bool write_basis(Gops *gops, GopField field, int64_t frames, ConstDoubles2 spectrum, Payload *writing, Arena *scratch,
    Doubles2 *basis);
bool write_gop(Gops *gops, int method, int64_t frames, GopField field, ConstDoubles2 wanted, Payload *writing,
    Arena *scratch);
#endif
