/* What repeats in a mesh: images under transforms, and congruent flaps (specification, V 17).
 *
 * A CAD part repeats itself: sectors, mirrored halves, rows of holes. The encoder sends a few rigid transforms; here
 * both sides find, vertex after vertex, which known vertex is carried to the one at hand: its twin. Twins spread
 * along the surface: the twin of a vertex lies beside the twins of its neighbors, so that few vertices are looked up
 * in space, in a hash of cells. Where no transform explains a vertex, echoes may: earlier vertices over a flap of the
 * same lengths. What is found only predicts (grid.simd.c), so a wrong twin costs bits, never exactness. All is
 * integers, since both sides must find the same. A hostile mesh could make each look-up walk long chains: visits,
 * corners and candidates are bounded, and each cell that is looked at is charged (V 17.9). Changing a bound changes
 * the format. */
#include "bitstream/fields/twins.h"

enum {
    AXES = 3,
    TURN_BITS = 20,
    CELL_BITS = 4,      /* of space, by which known vertices are found */
    MOST_VISITS = 8,   /* of one chain */
    REACH = 29,         /* in 1/16: how far an image may be from its vertex */
    NEAR_CELL_BITS = 6, /* in 1/16: of `near`; at least twice REACH */
    MATCH = 26,         /* in 1/16, on each axis */
    MOST_ADDED = 24,   /* corners around twins of neighbors */
    MOST_AROUND = 12,  /* corners around the twin of an edge */
    MOST_BEYOND = 96,  /* of all such */
    LOOKED_UP = 16,     /* images by which a vertex with a twin is sought among the known ones, too */
    ECHO_BITS = 14,
    PROBES = 8,
    MOST_ECHO = 256, /* distances of flaps, in 1/64 of what they may differ by */
    NEAREST_ECHOES = 4,
    FAR = INT32_MAX / 32 * 32, /* more than any difference */
    UNIT_BITS = 16,
    SURE = ONE / 8 * 7, /* trust from which on an image is enough */
    LANES = 8,
    ABOVE = 1 << 30, /* more than any coordinate of an image */
};

/* Numbers of so many images. */
typedef __attribute__((vector_size(64), __aligned__(8), may_alias)) double Reals;
typedef __attribute__((vector_size(32), __aligned__(4), may_alias)) int32_t Numbers;
typedef __attribute__((vector_size(32), __aligned__(4), may_alias)) uint32_t Wholes;
/* Numbers of the echoes of one chain. */
typedef __attribute__((vector_size(16), __aligned__(4), may_alias)) int32_t Links;
typedef __attribute__((vector_size(16))) float ChainSingles;
typedef __attribute__((vector_size(32))) double ChainReals;

/* The greatest number whose square is at most x < 2^62: exact, however a processor rounds. */
INLINE int64_t root_of(int64_t x) {
    int64_t root = (int64_t)__builtin_sqrt((double)x);
    return root - (root * root > x) + ((root + 1) * (root + 1) <= x);
}

INLINE int32_t most_of(ConstInts values) {
    return (int32_t)largest(largest(values.data[0], values.data[1]), largest(values.data[2], 1));
}

static int fineness_of(ConstInts span) { return (int)least(bit_length((uint32_t)most_of(span)) + 2, MOST_FINENESS); }

/* The axis of which each axis of an axis-parallel image is made. */
INLINE void axes_of(int32_t kind, int *from) {
    int order = kind / 8;
    from[0] = order / 2;
    from[1] = (order / 2 + 1 + order % 2) % 3;
    from[2] = 3 - from[0] - from[1];
}

/* Code the numbers of a transform (V 17.2). */
static void code_transform(RangeCoder *coder, ConstInts span, int32_t *number) {
    number[0] = (int32_t)code_uniform(coder, number[0], AXIS_KINDS + 2);
    if (number[0] < AXIS_KINDS) {
        int from[AXES];
        axes_of(number[0], from);
        for (int j = 0; j < AXES; j++)
            number[5 + j] = (int32_t)code_uniform(coder, number[5 + j], (int64_t)span.data[j] + span.data[from[j]] + 1);
        return;
    }
    int64_t fine = INT64_C(2) << fineness_of(span), shifts = 24 * (int64_t)most_of(span) + 1;
    number[1] = (int32_t)code_uniform(coder, number[1], 4);
    for (int i = 2; i < 5; i++) number[i] = (int32_t)code_uniform(coder, number[i], fine + 1);
    for (int i = 5; i < 8; i++) number[i] = (int32_t)code_uniform(coder, number[i], shifts);
}

void code_transforms(RangeCoder *coder, ConstInts span, Ints2 numbers) {
    for (int64_t i = 0; i < numbers.rows; i++) code_transform(coder, span, numbers.data + TRANSFORM_ROW * i);
}

static void set_parallel(ConstInts span, const int32_t *number, Image *image) {
    int from[AXES];
    axes_of(number[0], from);
    for (int j = 0; j < AXES; j++) {
        bool back = number[0] >> j & 1;
        image->turn[j][from[j]] = back ? -(1 << TURN_BITS) : 1 << TURN_BITS;
        image->shift[j] = FINE * (number[5 + j] - (back ? 0 : span.data[from[j]]));
    }
}

static void set_turned(ConstInts span, const int32_t *number, Image *image) {
    int bits = fineness_of(span);
    int64_t q[4], square = 0;
    for (int i = 0, k = 2; i < 4; i++) {
        q[i] = i == number[1] ? INT64_C(1) << bits : number[k++] - (INT64_C(1) << bits);
        square += q[i] * q[i];
    }
    int64_t a = q[0], b = q[1], c = q[2], d = q[3];
    const int64_t turn[AXES][AXES] = {
        {a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)},
        {2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)},
        {2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d}};
    int64_t sign = number[0] > AXIS_KINDS ? -(1 << TURN_BITS) : 1 << TURN_BITS;
    for (int j = 0; j < AXES; j++) {
        for (int k = 0; k < AXES; k++) image->turn[j][k] = (int32_t)(sign * turn[j][k] / square);
        image->shift[j] = FINE / 4 * (number[5 + j] - 12 * most_of(span));
    }
}

/* Where the image of a place is, in 1/16. */
INLINE void image_of(const Image *image, const int32_t *place, int32_t *to) {
    for (int j = 0; j < AXES; j++) {
        int64_t sum = 1 << (TURN_BITS - 5);
        for (int k = 0; k < AXES; k++) sum += (int64_t)image->turn[j][k] * place[k];
        to[j] = (int32_t)(sum >> (TURN_BITS - 4)) + image->shift[j];
    }
}

/* The image of the inverse; whether that is the same. */
static bool invert(const Image *image, Image *inverse) {
    bool same = true;
    for (int j = 0; j < AXES; j++) {
        int64_t sum = 0;
        for (int k = 0; k < AXES; k++) {
            inverse->turn[j][k] = image->turn[k][j];
            sum += (int64_t)image->turn[k][j] * image->shift[k];
            same = same && size_of(image->turn[k][j] - image->turn[j][k]) <= 1 << 4;
        }
        inverse->shift[j] = (int32_t)(-sum >> TURN_BITS);
        same = same && size_of(inverse->shift[j] - image->shift[j]) <= FINE;
    }
    return same;
}

void list_images(ConstInts span, ConstInts2 numbers, Twins *twins) {
    int32_t images = 0;
    for (int64_t i = 0; i < numbers.rows; i++) {
        const int32_t *number = numbers.data + TRANSFORM_ROW * i;
        Image *image = twins->image + images, *inverse = image + 1;
        *image = *inverse = (Image){.trust = ONE / 2, .inverse = images};
        if (number[0] < AXIS_KINDS) set_parallel(span, number, image);
        else set_turned(span, number, image);
        if (!invert(image, inverse)) image->inverse = ++images;
        images++;
    }
    twins->images = images;
    for (int32_t i = 0; i < images; i++)
        for (int j = 0; j < AXES; j++) {
            const Image *inverse = twins->image + twins->image[i].inverse;
            for (int k = 0; k < AXES; k++) twins->back[j][k][i] = inverse->turn[j][k];
            twins->back[j][AXES][i] = ((double)ABOVE + inverse->shift[j] + 1.0 / 2) * (1 << (TURN_BITS - 4));
        }
}

/* Which chain of 2^bits holds what has these three cells. */
INLINE uint32_t chain_of(int32_t x, int32_t y, int32_t z, int bits) {
    uint32_t mixed = (uint32_t)x * 73856093u ^ (uint32_t)y * 19349663u ^ (uint32_t)z * 83492791u;
    return mixed * 2654435769u >> (32 - bits);
}

/* Of each image the place (1/16) that it takes to x, and the bit of `near` of that place's cell. As `image_of` has it:
 * sums below 2^53 are exact, and above 0, so that they are rounded down. */
KERNEL void move_back(const Twins *t, const int32_t *x, int32_t place[AXES][MOST_IMAGES], uint32_t *bits) {
    static const uint32_t FACTOR[AXES] = {73856093u, 19349663u, 83492791u};
    for (int i = 0; i < t->images; i += LANES) {
        Wholes mixed = {0};
        for (int j = 0; j < AXES; j++) {
            Reals sum = *(const Reals *)(t->back[j][AXES] + i);
            for (int k = 0; k < AXES; k++) sum += *(const Reals *)(t->back[j][k] + i) * (double)x[k];
            Numbers own = __builtin_convertvector(sum * (1.0 / (1 << (TURN_BITS - 4))), Numbers) - ABOVE;
            *(Numbers *)(place[j] + i) = own;
            mixed ^= (Wholes)(own >> NEAR_CELL_BITS) * FACTOR[j];
        }
        *(Wholes *)(bits + i) = mixed * 2654435769u >> (32 - NEAR_BITS);
    }
}

/* The nearest known vertex whose twin by `image` is not known yet, within REACH of a place (1/16); -1: none. */
static int32_t nearest_free(Twins *t, const int32_t *x, int32_t image, const int32_t *place) {
    int32_t first[AXES], last[AXES], best = -1;
    uint32_t least_square = REACH * REACH;
    for (int j = 0; j < AXES; j++) {
        first[j] = (place[j] - REACH) >> (4 + CELL_BITS);
        last[j] = (place[j] + REACH) >> (4 + CELL_BITS);
    }
    for (int32_t a = first[0]; a <= last[0]; a++)
        for (int32_t b = first[1]; b <= last[1]; b++)
            for (int32_t c = first[2]; c <= last[2]; c++) {
                uint32_t chain = chain_of(a, b, c, t->head_bits);
                int32_t u = t->head[chain];
                t->looks--;
                for (int visits = 0; u >= 0 && visits < MOST_VISITS; visits++, u = t->next[u], t->looks--) {
                    uint32_t square = 0;
                    bool near = true;
                    for (int j = 0; j < AXES; j++) {
                        uint32_t away = (uint32_t)size_of(FINE * x[AXES * (int64_t)u + j] - place[j]);
                        near &= away < REACH;
                        square += away * away;
                    }
                    if (!near || square >= least_square || (t->has[u] >> image & 1)) continue;
                    least_square = square;
                    best = u;
                }
            }
    return best;
}

static void add_candidate(Twins *t, const Ints2 *values, int32_t image, int32_t w, int support) {
    const Image *by = t->image + image;
    for (int i = 0; i < t->candidates; i++) {
        Candidate *known = t->candidate + i;
        if (known->image == image && known->vertex == w) {
            known->support += support;
            return;
        }
    }
    if (t->candidates == MOST_CANDIDATES || (t->has[w] >> by->inverse & 1)) return;
    Candidate *new = t->candidate + t->candidates++;
    *new = (Candidate){.image = image, .vertex = w, .support = support};
    image_of(by, values->data + AXES * (int64_t)w, new->place);
}

/* Third vertices of the faces of u that have an edge to w; returns how many corners were looked at. */
static int add_beyond(Twins *t, const Corners *corners, const Ints2 *values, int32_t image, int32_t u, int32_t w,
    int32_t now) {
    int32_t first = corners->starts.data[u], end = (int32_t)least(corners->starts.data[u + 1], first + MOST_AROUND);
    uint32_t ends = (uint32_t)u + (uint32_t)w;
    int32_t third[2 * MOST_AROUND + 1], count = 0;
    for (int32_t k = first; k < end; k++) { /* faces at u: how often w is there, too, and what else is */
        const int32_t *face = corners->faces.data + (uint32_t)corners->corners.data[k] / 3 * 3;
        third[count] = third[count + 1] = (int32_t)((uint32_t)face[0] + (uint32_t)face[1] + (uint32_t)face[2] - ends);
        count += (face[0] == w) + (face[1] == w) + (face[2] == w) - (u == w);
    }
    for (int32_t i = 0; i < count; i++)
        if (corners->rank.data[third[i]] < now) add_candidate(t, values, image, third[i], 2);
    return end - first;
}

/* Images of vertices beyond the twins of edges, or else of those around the twins of neighbors (V 17.4). */
void seek_images(Twins *t, const Corners *corners, const Ints2 *values, const Around *around, int32_t v,
    const int32_t *base) {
    const int32_t *vertex = corners->faces.data, *rank = corners->rank.data;
    int32_t now = rank[v];
    int added = 0;
    t->candidates = t->known_axes = t->echo_class = 0;
    for (int i = 0; i < 2; i++) t->frame[i].is_there = false;
    if (t->images == 0) return;
    for (int i = 0; i < around->flaps && i < 3; i++) {
        Flap flap = around->flap[i];
        const int32_t *a = t->twin + (int64_t)t->images * flap.a, *b = t->twin + (int64_t)t->images * flap.b;
        for (uint32_t both = t->has[flap.a] & t->has[flap.b]; both != 0 && added < MOST_BEYOND; both &= both - 1) {
            int image = __builtin_ctz(both);
            added += add_beyond(t, corners, values, image, a[image], b[image], now);
        }
    }
    added = 0;
    for (int i = 0; i < around->neighbors && i < 4 && t->candidates == 0; i++) {
        const int32_t *row = t->twin + (int64_t)t->images * around->neighbor[i];
        for (uint32_t has = t->has[around->neighbor[i]]; has != 0 && added < MOST_ADDED; has &= has - 1) {
            int image = __builtin_ctz(has);
            int32_t u = row[image];
            for (int32_t k = corners->starts.data[u]; k < corners->starts.data[u + 1] && added < MOST_ADDED; k++) {
                int32_t after = vertex[next_corner(corners->corners.data[k])];
                int32_t before = vertex[previous_corner(corners->corners.data[k])];
                if (rank[after] < now) add_candidate(t, values, image, after, 1);
                if (rank[before] < now) add_candidate(t, values, image, before, 0);
                added++;
            }
        }
    }
    const int32_t *x = values->data;
    int32_t along = 0;
    for (int j = 0; j < AXES && around->flaps > 0; j++)
        along += size_of(x[AXES * (int64_t)around->flap->a + j] - x[AXES * (int64_t)around->flap->b + j]);
    int32_t unit = (int32_t)largest(64, 6 * (int64_t)along);
    for (int i = 0; i < t->candidates; i++) { /* the best first */
        Candidate found = t->candidate[i];
        int64_t away = 0;
        for (int j = 0; j < AXES; j++) away += size_of(found.place[j] - base[j]);
        found.same_degree = faces_at(corners, found.vertex) == faces_at(corners, v);
        found.score = (int32_t)(48 * least(found.support, 4) + 48 * found.same_degree - least(32 * away / unit, 1 << 16)
            + (t->image[found.image].trust >> 10));
        int at = i;
        for (; at > 0 && t->candidate[at - 1].score < found.score; at--) t->candidate[at] = t->candidate[at - 1];
        t->candidate[at] = found;
    }
}

static void add_product(const int64_t *a, const int64_t *b, int64_t *to) {
    for (int j = 0; j < AXES; j++) {
        int s = (j + 1) % 3, t = (j + 2) % 3;
        to[j] = a[s] * b[t] - a[t] * b[s];
    }
}

/* a / b towards zero: exact below 2^53, since a quotient that is not whole is at least 1 / b away from one that is. */
INLINE int64_t quotient_of(int64_t a, int64_t b) { return (int64_t)((double)a / (double)b); }

static void set_frame(const Corners *corners, const Ints2 *values, Flap flap, int32_t v, FlapFrame *f) {
    const int32_t *a = values->data + AXES * (int64_t)flap.a, *b = values->data + AXES * (int64_t)flap.b,
                  *c = values->data + AXES * (int64_t)flap.c;
    int64_t along[AXES], beside[AXES], up[AXES], squares[3] = {0, 0, 0}, most = 1;
    for (int j = 0; j < AXES; j++) {
        along[j] = b[j] - a[j];
        beside[j] = c[j] - a[j];
        int64_t other = c[j] - b[j];
        squares[0] += along[j] * along[j];
        squares[1] += beside[j] * beside[j];
        squares[2] += other * other;
        f->middle[j] = 8 * (a[j] + b[j]);
    }
    for (int i = 0; i < 3; i++) f->length[i] = (int32_t)root_of(squares[i] << 8);
    add_product(along, beside, up);
    for (int j = 0; j < AXES; j++) most |= up[j] < 0 ? -up[j] : up[j];
    int down = (int)largest(44 - __builtin_clzll((uint64_t)most), 0);
    int64_t square = 0;
    for (int j = 0; j < AXES; j++) {
        up[j] = up[j] >> down;
        square += up[j] * up[j];
    }
    int64_t height = root_of(square << 8);
    f->is_there = f->length[0] > 0 && height > 0;
    if (!f->is_there) return;
    int64_t ex[AXES], ez[AXES], ey[AXES];
    for (int j = 0; j < AXES; j++) {
        ex[j] = quotient_of(along[j] * (1 << (UNIT_BITS + 4)), f->length[0]);
        ez[j] = quotient_of(up[j] * (1 << (UNIT_BITS + 4)), height);
    }
    add_product(ez, ex, ey);
    for (int j = 0; j < AXES; j++) {
        f->unit[0][j] = (int32_t)ex[j];
        f->unit[1][j] = (int32_t)(ey[j] >> UNIT_BITS);
        f->unit[2][j] = (int32_t)ez[j];
    }
    f->degrees = (int32_t)(least(faces_at(corners, v), 12) << 16 | least(faces_at(corners, flap.a), 12) << 8
        | least(faces_at(corners, flap.b), 12));
}

/* Classes of lengths (1/16): sixteen to the octave, and half a class. */
INLINE int32_t length_class(int32_t length) {
    int32_t x = (length >> 3) + 128, exponent = 24 - __builtin_clz((uint32_t)x);
    return 32 * exponent + (x >> (exponent + 2)) - 32;
}

INLINE Links sizes_of(Links x) { return (x ^ (x >> 31)) - (x >> 31); }

/* How far a flap is from being congruent with the echoes of a chain, << 5; FAR beyond what counts. */
INLINE Links differences(const Twins *t, const FlapFrame *f, const int32_t *number) {
    int32_t oldest = (int32_t)largest(t->echoes - MOST_ECHOES, 0), may = (f->length[0] >> 5) + 24;
    const int32_t *echo[ECHO_VISITS];
    for (int i = 0; i < ECHO_VISITS; i++) echo[i] = t->echo[number[i] & (MOST_ECHOES - 1)].shape;
    Links sum = {0}, own = *(const Links *)number;
    for (int k = 0; k < 3; k++) sum += sizes_of((Links){echo[0][k], echo[1][k], echo[2][k], echo[3][k]} - f->length[k]);
    Links other = (Links){echo[0][3], echo[1][3], echo[2][3], echo[3][3]} ^ f->degrees;
    other = (other + 0x0f0f0f) >> 4 & 0x010101; /* a bit for each that differs */
    /* 64 sum / may: a half below is more than doubles round. */
    Links away = __builtin_convertvector((__builtin_convertvector(sum, ChainReals) + 1.0 / 128) * (64.0 / may), Links);
    Links age = 2 * ((t->echoes - own) & (MOST_ECHOES - 1)) + 1; /* the exponent of which is the bits of half of it */
    away += 3 * (((Links)__builtin_convertvector(age, ChainSingles) >> 23) - 127);
    away += 19 * ((other + (other >> 8) + (other >> 15)) & 7);
    Links alike = (own > oldest) & (sum <= MOST_ECHO / 64 * may);
    return (away & alike) << 5 | (~alike & FAR);
}

/* The chains of echoes that may be alike, and how many. */
static int list_chains(const Twins *t, FlapFrame *f, int32_t *number) {
    int32_t oldest = (int32_t)largest(t->echoes - MOST_ECHOES, 0), class[2][3];
    int open = 0;
    for (int k = 0; k < 3; k++) {
        int32_t fine = length_class(f->length[k]);
        class[0][k] = fine >> 1;
        class[1][k] = class[0][k] + 2 * (fine & 1) - 1;
    }
    for (int turned = 0; turned < 2; turned++)
        f->chain[turned] = chain_of(class[0][0], class[0][1 + turned], class[0][2 - turned], ECHO_BITS);
    __builtin_prefetch(t->echo_head + f->chain[1]);
    for (int i = 0; i < PROBES; i++) {
        int32_t head = t->echo_head[chain_of(class[i & 1][0], class[i >> 1 & 1][1], class[i >> 2][2], ECHO_BITS)];
        number[ECHO_VISITS * open] = head;
        __builtin_prefetch(t->echo + (head & (MOST_ECHOES - 1)));
        open += head > oldest;
    }
    return open;
}

/* The nearest echoes, in order: how far each is << 5, and where it is in `number`. */
KERNEL void find_alike(const Twins *t, const FlapFrame *f, int open, int32_t *number, int32_t *near) {
    int32_t away[PROBES * ECHO_VISITS];
    for (int i = 0; i < NEAREST_ECHOES; i++) near[i] = FAR;
    for (int32_t *to = number; to < number + ECHO_VISITS * open; to += ECHO_VISITS) {
        *(Links *)to = *(const Links *)t->echo[*to & (MOST_ECHOES - 1)].chain;
        *(Links *)(away + (to - number)) = differences(t, f, to);
    }
    for (int i = 0; i < ECHO_VISITS * open; i++) { /* without branches, which are a toss-up */
        int32_t own = away[i] | i;
        for (int k = 0; k < NEAREST_ECHOES; k++) {
            int32_t nearer = own < near[k] ? own : near[k];
            own = own < near[k] ? near[k] : own;
            near[k] = nearer;
        }
    }
}

/* Flaps alike among those remembered: a vertex in the same place beside each is foretold (V 17.5). */
void seek_echoes(Twins *t, const Corners *corners, const Ints2 *values, const Around *around, int32_t v) {
    const Candidate *first = t->candidate;
    if (t->candidates > 0 && first->same_degree && first->support > 1 && t->image[first->image].trust >= SURE) return;
    int64_t sum[AXES] = {0, 0, 0}, weights = 0;
    int32_t best = INT32_MAX;
    int32_t number[2][PROBES * ECHO_VISITS + 1];
    int open[2] = {0, 0};
    for (int i = 0; i < around->flaps && i < 2; i++) {
        set_frame(corners, values, around->flap[i], v, t->frame + i);
        if (t->frame[i].is_there) open[i] = list_chains(t, t->frame + i, number[i]);
    }
    for (int i = 0; i < 2; i++) {
        const FlapFrame *f = t->frame + i;
        int32_t near[NEAREST_ECHOES];
        find_alike(t, f, open[i], number[i], near);
        for (int k = 0; k < NEAREST_ECHOES && near[k] < FAR; k++) {
            int32_t away = near[k] >> 5;
            int64_t weight = 65536 >> least(away >> 5, 16);
            const int32_t *in_frame = t->echo[number[i][near[k] & 31] & (MOST_ECHOES - 1)].place;
            for (int j = 0; j < AXES; j++) {
                int64_t off = 0;
                for (int axis = 0; axis < AXES; axis++) off += (int64_t)in_frame[axis] * f->unit[axis][j];
                int32_t place = limited(f->middle[j] + (off >> UNIT_BITS));
                sum[j] += weight * place;
                if (away < best) t->echoed[1][j] = place;
            }
            weights += weight;
            if (away < best) best = away;
        }
    }
    if (weights == 0) return;
    int32_t apart = 0;
    for (int j = 0; j < AXES; j++) {
        t->echoed[0][j] = (int32_t)quotient_of(sum[j], weights);
        apart += size_of(t->echoed[0][j] - t->echoed[1][j]);
    }
    int kind = (best >= 26) + (best >= 51) + (best >= 96) + (best >= 160);
    t->echo_class = 1 + 3 * kind + (apart >= 16) + (apart >= 64);
}

void choose_twins(const Twins *t, int *chosen) {
    int found = 0;
    chosen[0] = chosen[1] = -1;
    for (int i = 0; i < t->candidates && found < 2; i++) {
        const int32_t *place = t->candidate[i].place;
        bool fits = true;
        int32_t apart = 0;
        for (int a = 0; a < t->known_axes; a++) fits = fits && size_of(place[t->axis[a]] - FINE * t->value[a]) <= MATCH;
        if (!fits) continue;
        for (int j = 0; j < AXES && found > 0; j++) apart += size_of(place[j] - t->candidate[chosen[0]].place[j]);
        if (found == 0 || apart >= FINE) chosen[found++] = i;
    }
}

/* v is the image of u. */
static void join(Twins *t, int32_t v, int32_t u, int32_t image) {
    int32_t inverse = t->image[image].inverse;
    if ((t->has[v] >> image & 1) || (t->has[u] >> inverse & 1)) return;
    t->twin[(int64_t)t->images * v + image] = u;
    t->twin[(int64_t)t->images * u + inverse] = v;
    t->has[v] |= 1u << image;
    t->has[u] |= 1u << inverse;
}

static void remember_flap(Twins *t, const FlapFrame *f, const int32_t *place, bool turned) {
    if (t->echoes == 1 << 30) return;
    int32_t number = ++t->echoes;
    Echo *echo = t->echo + (number & (MOST_ECHOES - 1));
    int32_t *head = t->echo_head + f->chain[turned];
    const int32_t *chain = t->echo[*head & (MOST_ECHOES - 1)].chain;
    bool known = *head > largest(number - MOST_ECHOES, 0);
    int32_t degrees = f->degrees, back = (degrees & 0xff0000) | (degrees & 255) << 8 | (degrees >> 8 & 255);
    *echo = (Echo){.shape = {f->length[0], f->length[1 + turned], f->length[2 - turned], turned ? back : degrees},
        .place = {turned ? -place[0] : place[0], place[1], place[2]},
        .chain = {number, *head, known ? chain[1] : 0, known ? chain[2] : 0}};
    *head = number;
}

/* Twins of v among the known vertices, by images in turn. */
static void look_up(Twins *t, const Ints2 *values, int32_t v) {
    const int32_t images = t->images, *x = values->data + AXES * (int64_t)v;
    const uint32_t has = t->has[v];
    int32_t place[AXES][MOST_IMAGES], sought[MOST_IMAGES + 1];
    uint32_t bits[MOST_IMAGES];
    int lookups = has != 0 ? (int)least(LOOKED_UP, images) : images, count = 0, image = t->turn;
    move_back(t, x, place, bits);
    for (int k = 0; k < lookups; k++) {
        image = image + 1 < images ? image + 1 : 0;
        sought[count] = image;
        count += (int)(t->near[bits[image] >> 6] >> (bits[image] & 63) & ~has >> image & 1);
    }
    t->turn = image;
    for (int k = 0; k < count; k++) {
        int32_t i = sought[k], cell[AXES];
        for (int j = 0; j < AXES; j++) cell[j] = (place[j][i] - REACH) >> (4 + CELL_BITS);
        __builtin_prefetch(t->head + chain_of(cell[0], cell[1], cell[2], t->head_bits));
    }
    for (int i = 0; i < 8; i++) { /* where an image is within reach of v */
        int32_t at[AXES];
        for (int j = 0; j < AXES; j++) at[j] = (FINE * x[j] + (i >> j & 1 ? REACH : -REACH)) >> NEAR_CELL_BITS;
        uint32_t bit = chain_of(at[0], at[1], at[2], NEAR_BITS);
        t->near[bit >> 6] |= UINT64_C(1) << (bit & 63);
    }
    for (int k = 0; k < count; k++) {
        int32_t i = sought[k], at[AXES] = {place[0][i], place[1][i], place[2][i]};
        int32_t u = nearest_free(t, values->data, t->image[i].inverse, at);
        if (u >= 0) join(t, v, u, i);
    }
}

bool remember_twins(Twins *t, const Ints2 *values, const Around *around, int32_t v) {
    const int32_t *x = values->data + AXES * (int64_t)v;
    for (int i = 0; i < t->candidates; i++) {
        const Candidate *c = t->candidate + i;
        int32_t *trust = &t->image[c->image].trust;
        bool near = true;
        for (int j = 0; j < AXES; j++) near = near && size_of(c->place[j] - FINE * x[j]) <= MATCH;
        if (i == 0) *trust += ((near ? ONE : 0) - *trust) >> 4;
        if (near) join(t, v, c->vertex, c->image);
    }
    if (t->images > 0) {
        uint32_t chain = chain_of(x[0] >> CELL_BITS, x[1] >> CELL_BITS, x[2] >> CELL_BITS, t->head_bits);
        __builtin_prefetch(t->head + chain);
        look_up(t, values, v);
        t->next[v] = t->head[chain];
        t->head[chain] = v;
    }
    for (int i = 0; i < around->flaps && i < 2; i++) {
        const FlapFrame *f = t->frame + i;
        int32_t place[AXES];
        if (!f->is_there) continue;
        for (int axis = 0; axis < AXES; axis++) {
            int64_t sum = 0;
            for (int j = 0; j < AXES; j++) sum += (int64_t)(FINE * x[j] - f->middle[j]) * f->unit[axis][j];
            place[axis] = (int32_t)(sum >> UNIT_BITS);
        }
        remember_flap(t, f, place, false);
        remember_flap(t, f, place, true);
    }
    return t->looks >= 0;
}

void start_learnt(const ValueModel *model, Longs2 learners) {
    const unsigned char *start = START;
    for (int row = 0; row < START_ROWS; row++)
        for (int i = 0; i < TWIN_INPUTS; i++)
            model->weights.data[WEIGHT_ROW * row + i] = (int8_t)*start++ * (ONE / 16);
    for (int i = 0; i < START_LEARNERS * MOST_TERMS; i++)
        start_learner(learners, i / MOST_TERMS, i % MOST_TERMS, (int8_t)*start++ * (ONE / 16));
    for (int i = 0; i < TWIN_ROWS; i++) {
        int32_t *row = model->twins.data + TWIN_ROW * i;
        row[0] = 6 << 8, row[1] = 3, row[2] = (int32_t)((2 * (uint32_t)*start++ + 1) << 27 | START_COUNT);
    }
}

void start_whole(Twins *twins) {
    enum { WEIGHTS = WHOLE_ROWS * WHOLE_CONTEXTS };
    for (int i = 0; i < WEIGHTS; i++) twins->whole_weight[i] = (int8_t)START[START_BYTES - WEIGHTS + i] * (ONE / 16);
}
