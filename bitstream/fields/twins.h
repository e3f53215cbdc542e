/* What repeats in a mesh: images under transforms, and congruent flaps (specification, V 17). */
#pragma once

#include "bitstream/fields/fields.h"

enum {
    MOST_TRANSFORMS = 16,
    MOST_IMAGES = 2 * MOST_TRANSFORMS,
    TRANSFORM_ROW = 8, /* numbers of a transform: its kind, the largest component, three others, a shift */
    AXIS_KINDS = 48,
    MOST_FINENESS = 19, /* bits of a component of a quaternion */
    MOST_CANDIDATES = 12,
    ECHOES = 4, /* of a vertex, at most */
    MOST_ECHOES = 1 << 13, /* flaps that are remembered, a power of two */
    ECHO_HEADS = 1 << 14,
    ECHO_VISITS = 4, /* of one chain */
    TWIN_BYTES = 32, /* more than a transform takes in a payload */
    NEAR_BITS = 19, /* bits of `near`, as a power of two */
    WHOLE_CONTEXTS = 5,
    WHOLE_ROWS = 8,
    MOST_MISSES = 2,
    CERTAINTIES = 4 * 2 * 4 * 3,
};

typedef struct { /* a transform, or the inverse of one */
    int32_t turn[3][3]; /* in 2^-20 */
    int32_t shift[3];   /* in 1/16 */
    int32_t inverse;    /* which of the images */
    int32_t trust;      /* how often it told the place, in 2^-16 */
} Image;

/* The frame of a flap: lengths of its sides, the middle of its edge (1/16), unit vectors along it, across and up
 * (2^-16), and how many faces are at the vertex and at the ends of the edge. */
typedef struct {
    bool is_there;
    uint32_t chain[2]; /* of echoes alike, and of those of the flap turned round */
    int32_t length[3], middle[3], unit[3][3];
    int32_t degrees; /* a byte each, at most 12 */
} FlapFrame;

typedef struct { /* a flap, and where its vertex was in the frame of its coded edge, in 1/16 */
    int32_t shape[4]; /* lengths, and degrees */
    int32_t place[3], chain[ECHO_VISITS]; /* its number, and those of what came before in its chain */
} Echo;

typedef struct {
    int32_t image, vertex, support, score, place[3];
    bool same_degree;
} Candidate;

typedef struct Twins {
    int32_t images, head_bits, echoes;
    Image image[MOST_IMAGES];
    double back[3][4][MOST_IMAGES]; /* turn and shift of the inverse of each */
    int32_t *twin;        /* n x images: of which vertex each is the image */
    int32_t *head, *next; /* known vertices by cell of space: 1 << head_bits, n */
    uint32_t *has;        /* n: by which images each vertex has a twin */
    uint64_t *near;       /* a bit for each cell of space from which a known vertex is within reach, and others */
    int32_t turn;         /* the image that was looked up last */
    int64_t looks;        /* at cells and known vertices that are still granted */
    Echo *echo;           /* MOST_ECHOES */
    int32_t *echo_head;   /* ECHO_HEADS */
    /* What is foretold of the vertex at hand. */
    Candidate candidate[MOST_CANDIDATES];
    int32_t candidates, known_axes, axis[3], value[3];
    int32_t echoed[2][3], echo_class; /* of flaps alike, weighed and the best; 0: there is none */
    FlapFrame frame[2]; /* of the first two flaps */
    /* Whether vertices are where images are, if that is asked: the model, the latest answers of each image, a bit
     * each; of each vertex whether it is in the first cell (0: not asked, 1: no, 2: yes); cells in which the vertex at
     * hand is not. */
    bool asks_whole;
    uint32_t whole_slot[2 * WHOLE_CONTEXTS * CONTEXT_SIZE];
    int32_t whole_weight[WHOLE_ROWS * WHOLE_CONTEXTS], latest[MOST_IMAGES], missed[MOST_MISSES][3], misses;
    uint8_t *hit;
    const double *wanted; /* of writers (see placing.c); NULL: no vertex goes to images */
    int32_t values; /* coded axis by axis: whose turn it is to learn */
} Twins;

/* What other meshes taught: spec/start.bin, of which the build makes an array (V 17.10). */
enum {
    START_ROWS = VALUE_NODES + WEIGHT_SETS * KINDS,
    START_LEARNERS = 60,
    START_COUNT = 16, /* how often each hit rate counts as seen */
    START_BYTES = START_ROWS * TWIN_INPUTS + START_LEARNERS * MOST_TERMS + TWIN_ROWS + WHOLE_ROWS * WHOLE_CONTEXTS,
};
extern const unsigned char START[START_BYTES];
void start_learnt(const ValueModel *model, Longs2 learners);
void start_whole(Twins *twins);

/* Code the transforms of a grid, a row each of `numbers`. */
void code_transforms(RangeCoder *coder, ConstInts largest, Ints2 numbers);
/* The transforms and their inverses. */
void list_images(ConstInts largest, ConstInts2 numbers, Twins *twins);

/* What a vertex with these surroundings may be: its base is in 1/16. */
void seek_images(Twins *twins, const Corners *corners, const Ints2 *values, const Around *around, int32_t v,
    const int32_t *base);
void seek_echoes(Twins *twins, const Corners *corners, const Ints2 *values, const Around *around, int32_t v);
/* Code whether vertex v is where one of two images is, and if so, its values; see images.c. */
bool code_whole(RangeCoder *coder, Twins *twins, const Corners *corners, const Ints2 *values, const Around *around,
    int32_t v, const int32_t *base, const int32_t *near, const int32_t *largest);
/* The two best candidates that agree with the axes known so far; -1: there is none. */
void choose_twins(const Twins *twins, int *chosen);
/* How well a twin is known: its row of scales and hits, less what it is of (V 17.6). */
INLINE int32_t certainty(const Twins *t, const Candidate *c) {
    bool other = false;
    for (int a = 0; a < t->known_axes; a++) other = other || whole(c->place[t->axis[a]]) != t->value[a];
    int32_t trust = t->image[c->image].trust, state = t->known_axes == 0 ? 0 : other ? 2 : 1;
    int32_t level = (trust >= ONE / 5) + (trust >= ONE / 2) + (trust >= ONE / 5 * 4);
    return (((int32_t)least(c->support, 3) * 2 + c->same_degree) * 4 + level) * 3 + state;
}
/* Learn from a vertex, which is known now; false: more looks were needed than are granted. */
bool remember_twins(Twins *twins, const Ints2 *values, const Around *around, int32_t v);
