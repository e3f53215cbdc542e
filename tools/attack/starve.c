/* Takes memory from bsmdec: `starve EVERY STREAM...` decodes every EVERY-th stream again and again.
 *
 * In each run one allocation fails, once for every allocation of the stream; then `limits.heap` grows from 0 to the
 * peak in 64 steps. Each stream is decoded at once, tolerantly in pieces, by bsmdec_decode, in three threads, and, if
 * it is a sequence, from frame 3 on. In every run
 *
 *   - all events, and what the getters give behind each, are those of a decoder with enough memory, up to the error;
 *   - the error is BSMDEC_NO_MEMORY, or BSMDEC_LIMIT under a heap, and stays; in threads, which do without, there
 *     may be none;
 *   - the decoder holds no more than the heap, releases each piece with its size, and all of it.
 *
 * Every stream has a process of its own, so that a crash has a place: the number of the allocation, or the heap. Exit
 * code 1 if anything was found. With sanitizers: tools/sanitize.sh. */
#define _GNU_SOURCE
#include <pthread.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tools/processors/digest.h"

enum { STEPS = 64, HEAD = 64, PIECE = 61 };

/* One way of decoding. */
typedef struct {
    const char *name;
    int tolerant;
    size_t piece; /* bytes of a push, 0 for all */
    int64_t start;
    int in_one_call, threads;
} Way;

static const Way WAYS[] = {
    {"at once", 0, 0, 0, 0, 1}, {"tolerantly in pieces", 1, PIECE, 0, 0, 1}, {"in one call", 0, 0, 0, 1, 1},
    {"in threads", 0, 0, 0, 0, 3}, {"from frame 3", 0, 0, 3, 0, 1},
};

/* What a run was, shared with the process that waits. */
typedef struct {
    const char *way;
    long allocation; /* the one that fails, 0 for none */
    double heap;
    long runs, found;
} Place;

typedef struct {
    long calls, failing;
    size_t held, peak;
} Host;

/* Events of a decoder with enough memory: a digest of each, with what the getters gave. */
typedef struct {
    uint64_t *digest;
    size_t count, room;
    bsmdec_status status;
    int has_frames;
    long calls;
    size_t peak;
} Reference;

static Place *place;

static void complain(const char *what) {
    fprintf(stderr, "  %s, allocation %ld, heap %g: %s\n", place->way, place->allocation, place->heap, what);
    place->found++;
}

static pthread_mutex_t one_at_a_time = PTHREAD_MUTEX_INITIALIZER;

static void *take(void *given, size_t size) {
    Host *host = given;
    pthread_mutex_lock(&one_at_a_time);
    int fails = ++host->calls == host->failing;
    if (!fails) host->held += size;
    if (host->held > host->peak) host->peak = host->held;
    pthread_mutex_unlock(&one_at_a_time);
    if (fails) return NULL;
    char *memory = need(malloc(size + HEAD));
    memcpy(memory, &size, sizeof size);
    return memory + HEAD;
}

static void give(void *given, void *memory, size_t size) {
    Host *host = given;
    size_t taken;
    memcpy(&taken, (char *)memory - HEAD, sizeof taken);
    if (taken != size) complain("memory is released with another size");
    pthread_mutex_lock(&one_at_a_time);
    host->held -= taken;
    pthread_mutex_unlock(&one_at_a_time);
    free((char *)memory - HEAD);
}

typedef struct {
    void (*task)(void *context, int index);
    void *context;
    int index;
} Task;

static void *run_task(void *given) {
    Task *own = given;
    own->task(own->context, own->index);
    return NULL;
}

static void run_tasks(void *host, int count, void (*task)(void *context, int index), void *context) {
    pthread_t thread[64];
    Task own[64];
    (void)host;
    for (int i = 0; i < count; i++) {
        own[i] = (Task){task, context, i};
        if (pthread_create(&thread[i], NULL, run_task, &own[i]) != 0) exit((perror("starve"), 2));
    }
    for (int i = 0; i < count; i++) pthread_join(thread[i], NULL);
}

/* Note a digest of a decoder with enough memory, or compare one without, unless the decoder has failed. */
static void look(uint64_t digest, const bsmdec_error *error, size_t number, Reference *reference, int makes) {
    if (makes) {
        if (reference->count == reference->room)
            reference->digest = need(realloc(reference->digest,
                (reference->room = 2 * reference->room + 64) * sizeof *reference->digest));
        reference->digest[reference->count++] = digest;
    } else if (error->status == BSMDEC_OK && (number > reference->count || reference->digest[number - 1] != digest)) {
        complain("another event");
    }
}

/* Events up to where more bytes are needed: whether nothing follows. */
static int drain(bsmdec *decoder, size_t *number, Reference *reference, int makes) {
    for (;;) {
        bsmdec_event event;
        bsmdec_next(decoder, &event);
        if (event.type == BSMDEC_NEED_DATA) return 0;
        if (event.type == BSMDEC_ERROR || event.type == BSMDEC_END_OF_STREAM) return 1;
        uint64_t digest = digest_of(decoder, &event, ++*number);
        reference->has_frames |= event.type == BSMDEC_FRAME;
        look(digest, bsmdec_last_error(decoder), *number, reference, makes);
    }
}

/* Whether a run has ended as it must. */
static void check_end(const Way *way, bsmdec_status status, const Reference *reference, size_t number) {
    int as_usual = status == reference->status && number == reference->count;
    if (way->threads > 1 && as_usual) return;
    if (place->allocation == 0 && place->heap >= (double)reference->peak) {
        if (!as_usual) complain("another end, with as much heap as it takes");
    } else if (status != (place->allocation > 0 ? BSMDEC_NO_MEMORY : BSMDEC_LIMIT)) {
        complain("memory ended, and the status is another");
    }
}

/* Events by a decoder: the status at the end. */
static bsmdec_status decode_events(const bsmdec_options *options, const Way *way, const char *bytes, size_t size,
    Reference *reference, int makes) {
    bsmdec *decoder = bsmdec_open(options);
    size_t number = 0, piece = way->piece > 0 ? way->piece : size;
    int over = 0;
    bsmdec_event event;
    if (decoder == NULL) return BSMDEC_NO_MEMORY;
    for (size_t at = 0; at < size && !over; at += piece) {
        bsmdec_push(decoder, bytes + at, size - at < piece ? size - at : piece);
        over = drain(decoder, &number, reference, makes);
    }
    bsmdec_finish(decoder);
    if (!over) drain(decoder, &number, reference, makes);
    bsmdec_status status = bsmdec_last_error(decoder)->status;
    for (int i = 0; i < 3 && status != BSMDEC_OK; i++)
        if (bsmdec_next(decoder, &event) != status || event.type != BSMDEC_ERROR) complain("the error does not stay");
    if (bsmdec_push(decoder, "x", 1) == BSMDEC_OK) complain("bytes are taken behind the end");
    if (!makes) check_end(way, status, reference, number);
    bsmdec_close(decoder);
    return status;
}

/* The same, as bsmdec_decode has it. */
static bsmdec_status decode_buffers(const bsmdec_options *options, const Way *way, const char *bytes, size_t size,
    Reference *reference, int makes) {
    bsmdec_mesh *mesh;
    size_t number = 0;
    bsmdec_status status = bsmdec_decode(bytes, size, options, &mesh);
    int opened = mesh->decoder != NULL;
    while (status == BSMDEC_OK) {
        look(digest_of_buffers(mesh), mesh->error, ++number, reference, makes);
        if (mesh->frame < 0) break;
        status = bsmdec_advance(mesh);
    }
    if (mesh->error->status != status) complain("the error is another than the status");
    if (!makes && opened) check_end(way, status, reference, number);
    bsmdec_release(mesh);
    return status;
}

static void decode(const Way *way, const char *bytes, size_t size, Reference *reference, int makes) {
    Host host = {.failing = place->allocation};
    bsmdec_allocator allocator = {sizeof allocator, take, give, &host};
    bsmdec_limits limits;
    bsmdec_default_limits(&limits, sizeof limits);
    if (!makes) limits.heap = place->heap;
    bsmdec_parallel parallel = {sizeof parallel, run_tasks, NULL, way->threads};
    bsmdec_options options = {.size = sizeof options, .parallel = &parallel, .limits = &limits, .allocator = &allocator,
        .tolerant = way->tolerant, .start = way->start};
    bsmdec_status status = way->in_one_call ? decode_buffers(&options, way, bytes, size, reference, makes)
                                            : decode_events(&options, way, bytes, size, reference, makes);
    place->runs++;
    if (host.held > 0) complain("memory is not released");
    if ((double)host.peak > (way->threads > 1 ? 2 : 1) * limits.heap) complain("more memory is held than the heap");
    if (makes) reference->status = status, reference->calls = host.calls, reference->peak = host.peak;
}

static void starve(const char *bytes, size_t size) {
    int has_frames = 0;
    for (size_t k = 0; k < sizeof WAYS / sizeof *WAYS; k++) {
        const Way *way = &WAYS[k];
        Reference reference = {0};
        if (way->start > 0 && !has_frames) continue;
        *place = (Place){.way = way->name, .heap = 1e300, .runs = place->runs, .found = place->found};
        decode(way, bytes, size, &reference, 1);
        has_frames |= reference.has_frames;
        for (place->allocation = 1; place->allocation <= reference.calls; place->allocation++)
            decode(way, bytes, size, &reference, 0);
        place->allocation = 0;
        for (int step = 0; step <= STEPS; step++) {
            place->heap = (double)reference.peak * step / STEPS;
            decode(way, bytes, size, &reference, 0);
        }
        free(reference.digest);
    }
}

static void starve_file(const char *path) {
    size_t size;
    char *bytes = read_file(path, &size);
    starve(bytes, size);
    free(bytes);
}

int main(int count, char **arguments) {
    int every = count > 1 ? atoi(arguments[1]) : 0, streams = 0;
    long found = 0;
    place = mmap(NULL, sizeof *place, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (place == MAP_FAILED || every < 1 || count < 3) return fprintf(stderr, "usage: starve EVERY STREAM...\n"), 2;
    for (int i = 2; i < count; i += every) {
        int status;
        long before = place->found;
        fflush(NULL);
        pid_t child = fork();
        if (child == 0) {
            starve_file(arguments[i]);
            exit(0); /* leaks are found here */
        }
        if (child < 0 || waitpid(child, &status, 0) < 0) return perror("starve"), 2;
        if (status != 0) complain("crashed");
        if (place->found > before) fprintf(stderr, "%s: %ld findings\n", arguments[i], place->found - before);
        streams++;
    }
    found = place->found;
    printf("%d streams, %ld decodes without memory, %ld findings\n", streams, place->runs, found);
    return found > 0;
}
