/* Prints a line for each stream: name, status, events, digests of these and of buffers, the error.
 *
 *     fingerprint [-u] STREAM... or @LIST
 *
 * Lines are equal where all bits are, on every processor. With -u the host has unusual arithmetic: it rounds upward and
 * flushes small numbers to 0, as game engines do. That must change nothing, and be as it was behind every call. */
#include <fenv.h>

#include "tools/processors/digest.h"

static int unusual;

/* The control word of the processor's arithmetic, and the bits of it that flush small numbers. */
#if defined(__SSE2__)
typedef unsigned Control;
enum { FLUSHES = 0x8040 };
static Control control(void) { return __builtin_ia32_stmxcsr() & ~0x3fu; }
static void set_control(Control value) { __builtin_ia32_ldmxcsr(value); }
#elif defined(__aarch64__)
typedef uint64_t Control;
enum { FLUSHES = 1 << 24 };
static Control control(void) {
    Control value;
    __asm__ volatile("mrs %0, fpcr" : "=r"(value));
    return value;
}
static void set_control(Control value) { __asm__ volatile("msr fpcr, %0" : : "r"(value)); }
#else
typedef int Control;
enum { FLUSHES = 0 };
static Control control(void) { return fegetround(); }
static void set_control(Control value) { (void)value; }
#endif

static Control of_host;

static void begin_host(void) {
#ifdef FE_UPWARD
    fesetround(FE_UPWARD);
#endif
    set_control(control() | FLUSHES);
    of_host = control();
}

static void check_host(const char *call) {
    if (!unusual || control() == of_host) return;
    printf("%s leaves other arithmetic\n", call);
    exit(1);
}

/* Digest of the bytes of a mesh that is encoded anew, on a grid and exactly; without bsmenc.h nothing is encoded. */
static uint64_t add_encoded(uint64_t digest, bsmdec *decoder, const bsmdec_event *event) {
#ifdef BSMENC_H
    size_t corners = 3 * (size_t)event->faces, coordinates = 3 * (size_t)event->vertices;
    uint32_t *faces = need(malloc(corners * sizeof *faces + 1));
    double *positions = need(malloc(coordinates * sizeof *positions + 1));
    bsmenc_mesh mesh = {.size = sizeof mesh, .vertices = event->vertices, .faces = event->faces};
    mesh.positions = positions, mesh.corners = faces;
    bsmdec_faces(decoder, faces, corners);
    bsmdec_positions(decoder, positions, coordinates);
    for (int exact = 0; exact < 2; exact++) {
        bsmenc_options options = BSMENC_OPTIONS;
        bsmenc_stream *stream;
        options.positions = exact ? BSMENC_LOSSLESS : BSMENC_GRID;
        digest = add_number(digest, bsmenc_encode(&mesh, &options, &stream));
        digest = add(digest, stream->bytes, stream->size, 1);
        bsmenc_release(stream);
    }
    free(positions);
    free(faces);
#endif
    return digest;
}

static void print_stream(const char *path) {
    size_t size, count = 0;
    char *bytes = read_file(path, &size);
    bsmdec *decoder = need(bsmdec_open(NULL));
    check_host("bsmdec_open");
    bsmdec_status status = bsmdec_push(decoder, bytes, size);
    bsmdec_finish(decoder);
    uint64_t digest = 0xcbf29ce484222325, buffers = digest;
    bsmdec_event event = {.type = BSMDEC_NEED_DATA};
    while (event.type != BSMDEC_ERROR && event.type != BSMDEC_END_OF_STREAM) {
        status = bsmdec_next(decoder, &event);
        check_host("bsmdec_next");
        digest = add_number(digest, (int64_t)digest_of(decoder, &event, ++count));
        check_host("a getter");
        if (event.type == BSMDEC_END) digest = add_encoded(digest, decoder, &event);
    }
    bsmdec_mesh *mesh;
    for (bsmdec_status status = bsmdec_decode(bytes, size, NULL, &mesh); status == BSMDEC_OK;
        status = bsmdec_advance(mesh)) {
        check_host("bsmdec_decode or bsmdec_advance");
        buffers = add_number(buffers, (int64_t)digest_of_buffers(mesh));
        if (mesh->frame < 0) break;
    }
    bsmdec_release(mesh);
    const bsmdec_error *error = bsmdec_last_error(decoder);
    const char *base = strrchr(path, '/');
    printf("%s %d %lu %016llx %016llx %ld/%ld/%ld %s\n", base != NULL ? base + 1 : path, (int)status,
        (unsigned long)count, (unsigned long long)digest, (unsigned long long)buffers, (long)error->offset,
        (long)error->frame, (long)error->block, error->message);
    bsmdec_close(decoder);
    free(bytes);
}

int main(int count, char **arguments) {
    char name[1024];
    int first = 1;
    if (count > 1 && strcmp(arguments[1], "-u") == 0) {
        unusual = first++;
        begin_host();
    }
    for (int i = first; i < count; i++) {
        FILE *names = arguments[i][0] == '@' ? need(fopen(arguments[i] + 1, "r")) : NULL;
        if (names == NULL) print_stream(arguments[i]);
        while (names != NULL && fgets(name, sizeof name, names) != NULL) {
            name[strcspn(name, "\r\n")] = 0;
            print_stream(name);
        }
    }
    return 0;
}
