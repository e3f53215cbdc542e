/* Groups of frames of a sequence: what each says, what all of a mesh build on, and their frames (specification, S). */
#ifndef BSMDEC_GOP_H
#define BSMDEC_GOP_H

#include "codec/sequence/kernels.h"
#include "engine/chain.h"
#include "engine/levels.h"

enum { LEARNT, KEY_FRAMES, NEXT_FRAMES, LEARNT_NEXT };
enum { BENDING = 19, INHERITED = 24, MOST_KEPT = 64, LAGS = 8, BATCH = 8 };

/* A field of a GOP: positions, or an attribute that moves; nothing is told of it if `step` is 0. */
typedef struct {
    int64_t width, components, back;
    double step;
    Ints exponents;
    Span basis, levels;
} GopField;

typedef struct {
    int method;
    int64_t frames, told; /* T and Q */
    Longs shown;          /* which of those told each frame is */
    int count;
    GopField *field;
} Gop;

INLINE bool has_basis(const Gop *gop) { return gop->method == LEARNT || gop->method == LEARNT_NEXT; }

/* An attribute that moves, and what its first values have beyond those of vertex 0; no rows if they are lost. */
typedef struct {
    int64_t number, width;
    Doubles2 start;
} Mover;

/* What a GOP says, whose bytes have to stay; attributes that do not move are passed over if that is `tolerant`. */
bool parse_gop(Context *context, Span data, int64_t longest, int64_t run, const Mover *movers, int count, bool tolerant, Arena *arena, Gop *gop);
double gop_memory(int64_t vertices, const Gop *gop, double around);
/* How many changes between frames before help to predict those of a GOP, where so many are kept (S 7.2). */
int64_t lags_of(int64_t kept);

/* A part of the mesh (S 3). */
typedef struct {
    Patch patch;
    Doubles springs, stiffness;
    Ints starts, outer, around; /* `outer`: which of the vertices `around` each spring goes to */
    Factor factor;
    int64_t width, first; /* columns of the dictionary; row of the first vertex around it, where rows of all parts are stacked */
    double making, work;  /* bytes that making the dictionary takes; nanoseconds that it took, -1 before */
    Singles2 dictionary;  /* no rows unless it is kept */
    Mark before;
} Site;

/* What is known of a field before its first frame. Of each part, matrices have the rows of what is around it, then one for
 * each column of the dictionary; those of all parts are stacked. */
typedef struct {
    int64_t width, kept;
    Doubles2 known;          /* K_i or F_i; the first `width` columns are F_i */
    bool starts_at_first;    /* low-delay frames start from these */
    /* What GOPs refer to. */
    Doubles2 inherited;      /* first components of the GOP before */
    Bank bank;
    Ints levels;             /* of the low-delay frames before, one part after the other */
    int64_t latest, count;   /* place of the latest of so many frames in the ring */
    Doubles ring[MOST_KEPT];
} Track;

/* Everything that GOPs of a mesh are decoded with. */
typedef struct {
    Context *context;
    const Header *header;
    const Graph *graph;
    const Blocks *blocks;
    double given;            /* vertices that the user has */
    bool begun;
    Arena arena, dictionaries, history, levels, frames; /* what stays; dictionaries; what frames refer to; the present GOP */
    int64_t count, kept, rows, wide, largest;   /* parts; first ones whose dictionaries are kept; stacked rows */
    Site *part;
    double around, reserved, use, making;
    int tracks;
    Track *track;
    bool can_follow, can_inherit;
    int64_t together;        /* low-delay frames of the GOP before, 0 without */
    /* The present GOP: a field, and over which basis it is shown. */
    Gop gop;
    Doubles2 field;
    Doubles2 *basis;         /* of each track: d Q rows */
    Doubles2 *batch;         /* some frames of each track, from `batched` on */
    int64_t batched;
} Gops;

bool begin_gops(Gops *gops, Context *context, const Header *header, const Graph *graph, const Blocks *blocks, ConstInts2 faces,
    ConstDoubles2 first_frame, int64_t given, const Mover *movers, int count, Arena *scratch);
/* Keep only what a later run of the mesh cannot do without. */
void suspend_gops(Gops *gops);
void end_gops(Gops *gops);
/* Frames are missing here. */
void forget_frames(Gops *gops);
/* Whether there is room for a GOP, and its work is paid for (S 8). */
bool reserve_gop(Gops *gops, const Gop *gop, double received);
/* After this, frames can be shown. */
bool decode_gop(Gops *gops, const Gop *gop, Arena *scratch);
/* What frame `t` of the GOP is in a track, until the GOP is over. */
bool show_frame(Gops *gops, int64_t t, Arena *scratch, int track, ConstDoubles2 *frame);

/* Parts: what `codec/sequence/dictionaries.py` has. */
bool find_parts(Gops *gops, ConstInts2 faces, ConstDoubles2 first_frame, Arena *scratch);
bool reserve_dictionaries(Gops *gops, double memory, double use, double *work);
void release_dictionaries(Gops *gops);
/* U of a part, until `scratch` is released or room is reserved again. */
bool lend_dictionary(Gops *gops, int64_t index, Arena *scratch, Singles2 *dictionary);
/* What continues a field into a part, of which `ends` are the rows around it. */
bool extend_part(const Site *part, ConstDoubles2 ends, Arena *scratch, Doubles2 extension);

#endif
