/* One decoder for a page: bsmdec.h, chains that other threads decode, and the fields of the header. */
#include "library/wasm/page.h"

#include "library/state.h"

/* What a page is given: rows of numbers in this memory. */
typedef struct {
    int32_t count;
    const void *vertices, *positions, *more;
} Arrays;

static bsmdec *decoder;
static bsmdec_event event;
static Arrays rows;
static double numbers[3];
static Arena room; /* for a block of a helper, until the next event */

/* `limits`: those of bsmdec.h in their order. Chains are shared by `among`, of whom this is `number`. */
bsmdec *page_open(const double *limits, int tolerant, int number_of_share, int among) {
    static bool made;
    if (!made) {
        make_priors();
        made = true;
    }
    const bsmdec_allocator host = page_host();
    bsmdec_limits bounds = {.size = sizeof bounds};
    memcpy(&bounds.vertices, limits, sizeof bounds - offsetof(bsmdec_limits, vertices));
    decoder = bsmdec_open(&(bsmdec_options){.size = sizeof(bsmdec_options), .limits = &bounds, .allocator = &host,
        .tolerant = tolerant});
    if (decoder == NULL) return NULL;
    decoder->share = (Share){.number = number_of_share, .among = among, .helps = number_of_share > 0};
    room = arena_of(&decoder->context);
    return decoder;
}

void page_close(void) {
    release_all(&room);
    bsmdec_close(decoder);
}

void page_share(int among) { decoder->share.among = among; }

const bsmdec_event *page_next(void) {
    release_all(&room);
    bsmdec_next(decoder, &event);
    return &event;
}

const bsmdec_error *page_error(int of_loss) {
    return of_loss ? bsmdec_last_loss(decoder) : bsmdec_last_error(decoder);
}

/* Bytes that were made use of, work that was charged, vertices that the faces so far have. */
const double *page_state(void) {
    numbers[0] = (double)decoder->reader.offset;
    numbers[1] = decoder->context.spent.spent;
    numbers[2] = (double)decoder->context.spent.vertices;
    return numbers;
}

/* The numbers of each field by its key, and how many they are. */
const Record *page_header(void) { return &decoder->reader.headers[decoder->reader.header].record; }

static const Arrays *row_of(int64_t count, const void *vertices, const void *positions, const void *more) {
    rows = (Arrays){(int32_t)count, vertices, positions, more};
    return &rows;
}

int page_metadata(int index, bsmdec_metadata *entry) { return bsmdec_metadata_at(decoder, index, entry); }

/* The block that a helper decoded last. */
const Arrays *page_handed(void) {
    const DecodedBlock *block = &decoder->share.handed;
    return row_of(block->vertices.size, block->vertices.data, block->positions.data, block->weights.data);
}

/* Room for a block that a helper decoded; `page_add` adds it. */
const Arrays *page_room(int count) {
    Ints vertices;
    Doubles2 positions;
    Doubles weights;
    if (!take_ints(&room, count, &vertices) || !take_doubles2(&room, count, 3, &positions)
        || !take_doubles(&room, count, &weights))
        return NULL;
    return row_of(count, vertices.data, positions.data, weights.data);
}

bool page_add(int index) {
    const Mesh *mesh = &decoder->mesh;
    const int32_t *vertices = rows.vertices;
    if (!mesh->has_chains || index < 0 || index >= mesh->blocks.count
        || rows.count != size_of_block(&mesh->blocks, index))
        return false;
    for (int32_t i = 0; i < rows.count; i++)
        if (vertices[i] < 0 || vertices[i] >= ground_of(mesh)->size) return false;
    DecodedBlock block = {index, {vertices, rows.count}, {rows.positions, rows.count, 3}, {rows.more, rows.count}};
    add_block(&decoder->mesh.assembly, &block);
    return true;
}

/* A block that a helper could not decode: whether the decoder continues. */
bool page_lose(int index) {
    lose_block(&decoder->mesh.assembly, &decoder->mesh.blocks, index);
    return decoder->tolerant && decoder->mesh.header.gop_frames == 0;
}

static const Arrays *row_of_changes(bsmdec_status status, const bsmdec_changes *changes) {
    return status == BSMDEC_OK ? row_of(changes->count, changes->vertices, changes->positions, changes->final) : NULL;
}

/* Changes since the last call; NULL with an error if they are unknown. */
const Arrays *page_changes(void) {
    bsmdec_changes changes;
    return row_of_changes(bsmdec_read_changes(decoder, &changes), &changes);
}

const Arrays *page_loose(void) {
    bsmdec_changes changes;
    return row_of_changes(bsmdec_read_loose(decoder, &changes), &changes);
}

/* Vertices without a position; how many are less exact than they were encoded, and which. */
const Arrays *page_losses(void) {
    bsmdec_losses losses;
    if (bsmdec_read_losses(decoder, &losses) != BSMDEC_OK) return NULL;
    numbers[0] = (double)losses.degraded_count;
    return row_of(losses.missing_count, losses.missing, losses.degraded, numbers);
}
