/* A decoder of light grids for a page that reads the sections of a stream itself: the smallest. */
#include "library/wasm/page.h"

#include "bitstream/costs.h"
#include "bitstream/payloads/payloads.h"

static Context context;
static Arena arena, scratch;
static Header header;
static Ints2 faces;
static GridField field;
static Sums sums;

/* `limits`: those of bsmdec.h in their order. */
bool light_open(const double *limits) {
    make_mixer_tables();
    make_sums(&sums);
    context = (Context){.host = page_host()};
    memcpy(&context.limits.vertices, limits, sizeof context.limits - offsetof(bsmdec_limits, vertices));
    arena = scratch = arena_of(&context);
    field.context = NULL;
    return true;
}

void light_close(void) {
    release_all(&arena);
    release_all(&scratch);
}

bool light_charge(double work, double received) { return charge(&context, work, received); }

/* Checksums of bytes of the stream, and of the positions. */
uint32_t light_sum(const uint8_t *bytes, size_t size, uint32_t before) {
    return crc32_of(&sums, (Span){bytes, (int64_t)size}, before);
}
uint32_t light_short_sum(const uint8_t *bytes, size_t size) { return crc16_of(&sums, (Span){bytes, (int64_t)size}); }
uint32_t light_sum_of_positions(void) { return crc32_of_positions(&sums, const_doubles2(field.positions), 0); }

bsmdec_status light_error(void) { return context.error.status; }

/* `numbers`: vertices, faces, scale, those of grid, center, corner and lattice, and congruence. */
bool light_begin(const double *numbers) {
    header = (Header){.vertices = (int64_t)numbers[0], .faces = (int64_t)numbers[1], .scale = numbers[2],
        .light = LIGHT, .cells = (int64_t)numbers[12], .points = (int64_t)numbers[13],
        .congruence = (int)numbers[14]};
    for (int j = 0; j < 3; j++) {
        header.grid[j] = (int32_t)numbers[3 + j];
        header.center[j] = numbers[6 + j];
        header.corner[j] = (int64_t)numbers[9 + j];
    }
    bool is_known = header.congruence == 0 || (is_congruent(&header) && header.congruence >= LEAST_CONGRUENCE);
    return is_known || FAIL(&context, UNSUPPORTED, "congruent parts, which this build has not");
}

/* Corners of faces; NULL if something is wrong. */
const int32_t *light_faces(const uint8_t *payload, size_t size) {
    double n = (double)header.vertices, m = (double)header.faces, bytes = (double)size;
    if (!code_connectivity(&context, (Span){payload, (int64_t)size}, &header, &(Surface){0}, &arena, &scratch, &faces))
        return NULL;
    context.spent.vertices = header.vertices;
    return reserve(&context, mesh_memory(n, m), bytes) && charge(&context, mesh_work(n, m, bytes), bytes) ? faces.data
                                                                                                          : NULL;
}

/* Positions of all vertices up to `count` from `first` on; NULL if something is wrong. */
const double *light_positions(const uint8_t *payload, size_t size, int first, int count) {
    bool begun = field.context != NULL
        || begin_grid(&field, NULL, &context, &header, const_ints2(faces), &arena, &scratch);
    bool done = begun && decode_grid(&field, first, count, (Span){payload, (int64_t)size}, &scratch);
    release_all(&scratch);
    return done ? field.positions.data : NULL;
}
