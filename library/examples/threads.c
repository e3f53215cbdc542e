/* Decodes a mesh with POSIX threads: cc threads.c bsmdec.c -lm -pthread && ./a.out mesh.bsm 4 */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

#include "bsmdec.h"

enum { MOST_BYTES = 1 << 28, MOST_THREADS = 64 };

typedef struct {
    pthread_t thread;
    void (*task)(void *context, int index);
    void *context;
    int index, joins;
} Worker;

static void *work(void *given) {
    Worker *worker = given;
    worker->task(worker->context, worker->index);
    return NULL;
}

/* `count` is at most the number of threads in the options. A task whose thread does not start runs here. */
static void run(void *host, int count, void (*task)(void *context, int index), void *context) {
    Worker workers[MOST_THREADS];
    (void)host;
    for (int i = 0; i < count; i++) {
        workers[i] = (Worker){.task = task, .context = context, .index = i};
        workers[i].joins = i > 0 && pthread_create(&workers[i].thread, NULL, work, &workers[i]) == 0;
    }
    for (int i = 0; i < count; i++)
        if (!workers[i].joins) work(&workers[i]);
    for (int i = 0; i < count; i++)
        if (workers[i].joins) pthread_join(workers[i].thread, NULL);
}

int main(int count, char **arguments) {
    FILE *file = count == 3 ? fopen(arguments[1], "rb") : NULL;
    int64_t threads = count == 3 ? atoi(arguments[2]) : 0;
    if (threads > MOST_THREADS) threads = MOST_THREADS;
    bsmdec_parallel parallel = {.size = sizeof parallel, .run = run, .threads = threads};
    bsmdec_options options = {.size = sizeof options, .parallel = &parallel};
    bsmdec *decoder = bsmdec_open(&options);
    char *bytes = malloc(MOST_BYTES);
    bsmdec_event event;
    if (file == NULL || decoder == NULL || bytes == NULL) {
        fprintf(stderr, "usage: %s MESH.bsm THREADS\n", arguments[0]);
        return BSMDEC_MISUSED;
    }
    bsmdec_push(decoder, bytes, fread(bytes, 1, MOST_BYTES, file));
    bsmdec_finish(decoder);
    do bsmdec_next(decoder, &event);
    while (event.type != BSMDEC_END && event.type != BSMDEC_ERROR && event.type != BSMDEC_NEED_DATA);
    double *positions = malloc((size_t)event.vertices * 3 * sizeof *positions + 1), sum = 0.0;
    bsmdec_status status = bsmdec_last_error(decoder)->status;
    size_t size = (size_t)event.vertices * 3;
    if (status == BSMDEC_OK) status = positions != NULL ? bsmdec_positions(decoder, positions, size) : BSMDEC_NO_MEMORY;
    for (size_t i = 0; status == BSMDEC_OK && i < size; i++) sum += positions[i];
    printf("%ld vertices, sum of all coordinates %.17g\n", (long)event.vertices, sum);
    if (status != BSMDEC_OK) fprintf(stderr, "%s\n", bsmdec_last_error(decoder)->message);
    free(positions);
    free(bytes);
    fclose(file);
    bsmdec_close(decoder);
    return status;
}
