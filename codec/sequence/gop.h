/* Groups of frames of a sequence: what each says, and what all of a mesh build on (specification, S). */
#pragma once

#include "bitstream/payloads/coding.h"
#include "codec/sequence/parts.h"
#include "codec/sequence/temporal.h"

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
    double given;            /* vertices that the user has */
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
