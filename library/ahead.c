/* Decoding ahead in threads of the host. */
#include "library/state.h"

#include "library/arithmetic.h"
#include "bitstream/payloads/payloads.h"

enum { MOST_LANES = 64, CHAINS_OF_LANE = 4, MOST_ROWS = 1 << 20, AT_ONCE = 1024 };

/* What one thread decodes chains with. */
typedef struct {
    Context context;
    Chains chains;
    Arena known, scratch, results;
} Lane;

typedef enum { NOT_BEGUN, UNDER_WAY, ALL_READ, GIVEN_UP } Progress;

/* Levels of refinements: chunk `at` is read up to its vertex number `inside`. */
typedef struct {
    Context context;
    Progress progress;
    Arena chunks, scratch;
    Layer layer;
    Packet *chunk;
    int64_t count, at, inside, moves; /* moves: of the bytes of the chunks */
    Coding coding;
} LevelsAhead;

/* Blocks `first` to `first + count` of whole chains are ready, or failed ahead. */
struct Ahead {
    Context context;
    bsmdec *decoder;
    int lanes;
    Lane lane[MOST_LANES];
    Arena arena;
    ReadyBlock *ready;
    int64_t first, count;
    LevelsAhead levels;
    int64_t job, chains, jobs; /* of a run: the next job; the first ones are chains, and one more may read levels */
    bool done, is_done; /* what levels are read beside */
    int64_t running;    /* chains that are not over */
    Refined *refined;
};

static int64_t threads_of(const bsmdec *decoder) { return least(decoder->parallel.threads, MOST_LANES); }

/* A context for one thread: all of them have as much memory as the decoder itself may have. */
static Context beside(const bsmdec *decoder) {
    const Context *context = &decoder->context;
    Context own = {.limits = context->limits, .host = context->host, .error = context->error};
    own.limits.heap = context->limits.heap / (double)(threads_of(decoder) + 2);
    return own;
}

static bool is_parallel(const bsmdec *decoder) {
    return decoder->parallel.threads > 1 && decoder->share.among == 0;
}

/* What threads of the host do, with the arithmetic of the decoder. */
typedef struct {
    void (*task)(void *context, int index);
    void *context;
} HostTask;

static void work(void *context, int index) {
    const HostTask *own = context;
    Arithmetic host = begin_arithmetic();
    own->task(own->context, index);
    end_arithmetic(host);
}

static void run_tasks(const bsmdec *decoder, int64_t tasks, void (*task)(void *context, int index), void *context) {
    HostTask own = {task, context};
    decoder->parallel.run(decoder->parallel.host, (int)tasks, work, &own);
}

/* NULL without memory for it: then nothing is decoded ahead. */
static Ahead *ahead_of(bsmdec *decoder) {
    Mesh *mesh = &decoder->mesh;
    Context own = beside(decoder);
    Ahead *ahead;
    if (mesh->ahead != NULL) return mesh->ahead;
    if (!TAKE_OF_HOST(&own, 1, ahead)) return NULL;
    *ahead = (Ahead){.context = own, .decoder = decoder};
    ahead->arena = arena_of(&ahead->context);
    ahead->levels.context = beside(decoder);
    ahead->levels.chunks = ahead->levels.scratch = arena_of(&ahead->levels.context);
    return mesh->ahead = ahead;
}

/* What failed ahead fails in its turn, or not. */
static void forget_error(Context *context) {
    context->starved = false;
    take_error(context);
}

static void give_up_levels(LevelsAhead *levels) {
    if (levels->progress == GIVEN_UP) return;
    end_layer(&levels->layer);
    release_all(&levels->chunks);
    release_all(&levels->scratch);
    forget_error(&levels->context);
    levels->progress = GIVEN_UP;
}

/* Find the refinements that directly follow all blocks, if they may be read. */
static void find_levels(Ahead *ahead, int64_t next_block) {
    bsmdec *decoder = ahead->decoder;
    Reader *reader = &decoder->reader;
    LevelsAhead *levels = &ahead->levels;
    const Header *header = &decoder->mesh.header;
    double n = (double)header->vertices, m = (double)decoder->mesh.faces.rows;
    int64_t place = 0, capacity = 0, cells = header->base.cells;
    Grammar grammar = reader->grammar;
    Packet packet;
    const Context *context = &decoder->context;
    levels->moves = reader->moves;
    if (!header->refined || layer_field_bytes(n, m) > context->limits.field_bytes
        || layer_memory(n, m) > memory_left(context))
        return;
    for (; next_block < header->blocks; next_block++)
        if (!peek_packet(reader, &place, &grammar, &packet) || packet.type != BLOCK_FRAME || packet.index != next_block)
            return;
    while (grammar.next_vertex < levels_size(header) && peek_packet(reader, &place, &grammar, &packet)
           && packet.type == REFINEMENT_FRAME) {
        packet.first -= cells;
        if (packet.first < 0) continue;
        if (levels->count == capacity) {
            capacity = 2 * capacity + 16;
            Packet *chunk;
            if (!TAKE(&levels->chunks, capacity, chunk)) {
                give_up_levels(levels);
                return;
            }
            if (levels->count > 0) memcpy(chunk, levels->chunk, (size_t)levels->count * sizeof *chunk);
            levels->chunk = chunk;
        }
        levels->chunk[levels->count++] = packet;
    }
}

/* Whether levels are left to be read, and their bytes where they were. */
static bool are_left(const LevelsAhead *levels, const Reader *reader) {
    return levels->count > 0 && levels->progress <= UNDER_WAY && levels->moves == reader->moves;
}

/* Read some more levels; false if there are no more or one failed. */
static bool read_stretch(LevelsAhead *levels) {
    const Packet *chunk = levels->chunk + levels->at;
    Layer *layer = &levels->layer;
    if (levels->inside == 0 && !begin_coding(&levels->context, chunk->data, &levels->coding)) return false;
    int64_t first = chunk->first + levels->inside, count = least(chunk->count - levels->inside, AT_ONCE);
    int64_t done = code_levels(&levels->coding.coder, &layer->bank, layer->corners, layer->levels, first, count);
    levels->inside += count;
    if (done < count) return nonsense(&levels->coding, "");
    if (levels->inside < chunk->count) return true;
    if (!check_chunk_done(&levels->coding, done, count)) return false;
    layer->read += chunk->count;
    levels->inside = 0;
    return ++levels->at < levels->count;
}

/* Read levels, until what goes on beside them is done. */
static void read_levels_ahead(Ahead *ahead) {
    LevelsAhead *levels = &ahead->levels;
    const Mesh *mesh = &ahead->decoder->mesh;
    bool more = true;
    if (levels->progress == NOT_BEGUN) {
        levels->progress = UNDER_WAY;
        LayerPlan plan = plan_of_layer(&mesh->header, const_ints2(mesh->faces));
        more = begin_levels(&levels->layer, &levels->context, plan, &levels->scratch);
    }
    while (more && !__atomic_load_n(&ahead->is_done, __ATOMIC_ACQUIRE)) more = read_stretch(levels);
    if (failed(&levels->context)) give_up_levels(levels);
    else if (!more) levels->progress = ALL_READ;
}

static void build_or_read(void *context, int index) {
    Ahead *ahead = context;
    (void)index;
    if (__atomic_fetch_add(&ahead->job, 1, __ATOMIC_RELAXED) == 0) {
        ahead->done = build(ahead->decoder);
        __atomic_store_n(&ahead->is_done, true, __ATOMIC_RELEASE);
    } else {
        read_levels_ahead(ahead);
    }
}

bool build_beside(bsmdec *decoder) {
    Ahead *ahead = is_parallel(decoder) ? ahead_of(decoder) : NULL;
    if (ahead == NULL) return build(decoder);
    find_levels(ahead, decoder->mesh.next_block + 1);
    if (ahead->levels.count == 0 || ahead->levels.progress == GIVEN_UP) return build(decoder);
    ahead->job = 0;
    run_tasks(decoder, 2, build_or_read, ahead);
    return ahead->done;
}

static void decode_chain(Ahead *ahead, Lane *lane, ReadyBlock *ready, int64_t count) {
    Context *context = &lane->context;
    bool done = true;
    context->spent = ahead->decoder->context.spent;
    for (int64_t i = 0; i < count && done; i++) {
        Mark mark = mark_of(&lane->scratch);
        ReadyBlock *slot = ready + i;
        DecodedBlock block;
        slot->ledger = (Ledger){.count = 0};
        context->ledger = &slot->ledger;
        done = decode_block(&lane->chains, slot->index, slot->coefficients, slot->data, &lane->scratch, &block)
            && copy_block(&block, &lane->results, &slot->block);
        release_to(&lane->scratch, mark);
    }
    for (int64_t i = 0; i < count; i++) ready[i].done = done;
    leave_chain(&lane->chains);
    forget_error(context);
}

static void take_jobs(void *context, int index) {
    Ahead *ahead = context;
    Lane *lane = ahead->lane + index;
    int64_t length = chain_length(&ahead->decoder->mesh.header);
    for (;;) {
        int64_t job = __atomic_fetch_add(&ahead->job, 1, __ATOMIC_RELAXED), start = job * length;
        if (job >= ahead->jobs) return;
        if (job < ahead->chains) {
            decode_chain(ahead, lane, ahead->ready + start, least(length, ahead->count - start));
            bool last = __atomic_sub_fetch(&ahead->running, 1, __ATOMIC_RELAXED) == 0;
            if (last) __atomic_store_n(&ahead->is_done, true, __ATOMIC_RELEASE);
        } else {
            read_levels_ahead(ahead);
        }
    }
}

/* Find chains all of whose bytes have come, at most `most`, from a packet on that begins one. Return their number. */
static int64_t find_chains(Ahead *ahead, const Packet *first, int64_t most) {
    Reader *reader = &ahead->decoder->reader;
    const Blocks *blocks = &ahead->decoder->mesh.blocks;
    int64_t length = chain_length(&ahead->decoder->mesh.header),
            end = least(first->index + most * length, blocks->count);
    int64_t place = 0, rows = 0, whole = 0;
    Grammar grammar = reader->grammar;
    Packet packet = *first;
    if (!TAKE(&ahead->arena, end - first->index, ahead->ready)) return 0;
    for (int64_t i = first->index; i < end; i++) {
        if (i > first->index && !peek_packet(reader, &place, &grammar, &packet)) break;
        if (packet.type != BLOCK_FRAME || packet.index != i) break;
        ahead->ready[i - first->index] = (ReadyBlock){
            .index = i, .coefficients = packet.coefficients, .end = reader->offset + place, .data = packet.data};
        rows += size_of_block(blocks, i);
        bool is_last = (i + 1) % length == 0 || i + 1 == blocks->count;
        if (is_last && rows > MOST_ROWS && whole > 0) break;
        if (is_last) whole++, ahead->count = i + 1 - first->index;
    }
    return whole;
}

static bool open_lanes(Ahead *ahead, int64_t count) {
    const bsmdec *decoder = ahead->decoder;
    const Mesh *mesh = &decoder->mesh;
    for (; ahead->lanes < count; ahead->lanes++) {
        Lane *lane = ahead->lane + ahead->lanes;
        lane->context = beside(decoder);
        lane->known = lane->scratch = lane->results = arena_of(&lane->context);
        if (!begin_chains(&lane->chains, &lane->context, &mesh->header, ground_of(mesh), &mesh->blocks, &lane->known)) {
            release_all(&lane->known);
            return false;
        }
    }
    return true;
}

static void forget_ready(Ahead *ahead) {
    for (int i = 0; i < ahead->lanes; i++) release_all(&ahead->lane[i].results);
    release_all(&ahead->arena);
    forget_error(&ahead->context);
    ahead->count = 0;
}

void look_ahead(bsmdec *decoder, const Packet *packet) {
    bool begins = packet->index % chain_length(&decoder->mesh.header) == 0;
    Ahead *ahead = begins && is_parallel(decoder) ? ahead_of(decoder) : NULL;
    if (ahead == NULL || (packet->index >= ahead->first && packet->index < ahead->first + ahead->count)) return;
    LevelsAhead *levels = &ahead->levels;
    int64_t threads = threads_of(decoder);
    forget_ready(ahead);
    ahead->first = packet->index;
    ahead->chains = find_chains(ahead, packet, CHAINS_OF_LANE * threads);
    ahead->jobs = ahead->chains + are_left(levels, &decoder->reader);
    if (ahead->chains > 0 && ahead->jobs > 1 && open_lanes(ahead, least(ahead->jobs, threads))) {
        ahead->job = 0;
        ahead->running = ahead->chains;
        ahead->is_done = false;
        run_tasks(decoder, least(ahead->jobs, threads), take_jobs, ahead);
    } else {
        forget_ready(ahead);
    }
}

const ReadyBlock *find_ready(const bsmdec *decoder, const Packet *packet) {
    const Ahead *ahead = decoder->mesh.ahead;
    if (ahead == NULL || packet->index < ahead->first || packet->index >= ahead->first + ahead->count) return NULL;
    const ReadyBlock *ready = ahead->ready + (packet->index - ahead->first);
    return ready->done && ready->end == decoder->reader.offset ? ready : NULL;
}

void end_chains_ahead(Mesh *mesh) {
    Ahead *ahead = mesh->ahead;
    if (ahead == NULL) return;
    forget_ready(ahead);
    for (int i = 0; i < ahead->lanes; i++) {
        Lane *lane = ahead->lane + i;
        end_chains(&lane->chains);
        release_all(&lane->known);
        release_all(&lane->scratch);
    }
    ahead->lanes = 0;
}

/* Make levels that were read ahead those of the mesh. */
static void adopt_levels(Ahead *ahead) {
    Context *context = &ahead->decoder->context;
    Mesh *mesh = &ahead->decoder->mesh;
    LevelsAhead *levels = &ahead->levels;
    release_all(&levels->chunks);
    release_all(&levels->scratch);
    double heap = context->heap + levels->context.heap;
    if (levels->progress == ALL_READ && heap <= context->limits.heap) {
        mesh->layer = levels->layer;
        mesh->layer.context = mesh->layer.models.context = mesh->layer.own.context = context;
        context->heap = heap;
        levels->layer = (Layer){.context = NULL};
    }
    give_up_levels(levels);
}

static void blend_or_read(void *context, int index) {
    Ahead *ahead = context;
    (void)index;
    if (__atomic_fetch_add(&ahead->job, 1, __ATOMIC_RELAXED) == 0) ahead->done = blend(ahead->decoder, ahead->refined);
    else read_levels_ahead(ahead);
}

bool blend_beside(bsmdec *decoder, Refined *refined) {
    Ahead *ahead = decoder->mesh.ahead;
    if (ahead == NULL) return blend(decoder, refined);
    ahead->job = 0;
    ahead->refined = refined;
    ahead->is_done = false;
    if (are_left(&ahead->levels, &decoder->reader)) run_tasks(decoder, 2, blend_or_read, ahead);
    else ahead->done = blend(decoder, refined);
    adopt_levels(ahead);
    return ahead->done;
}

void end_ahead(Mesh *mesh) {
    Ahead *ahead = mesh->ahead;
    if (ahead == NULL) return;
    end_chains_ahead(mesh);
    give_up_levels(&ahead->levels);
    Context own = ahead->context;
    host_give(&own, ahead, sizeof *ahead);
    mesh->ahead = NULL;
}
