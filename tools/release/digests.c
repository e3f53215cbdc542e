/* Prints a digest of each decoded stream: `digests STREAM...`. Builds of bsmdec with equal output decode alike. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bsmdec.h"

static uint64_t digest;

static void add(const void *data, size_t size) {
    for (size_t i = 0; i < size; i++) digest = (digest ^ ((const unsigned char *)data)[i]) * 0x100000001b3;
}

static void *need(size_t size) {
    void *memory = malloc(size > 0 ? size : 1);
    if (memory == NULL) exit(2);
    return memory;
}

static void add_attribute(bsmdec *decoder, int index) {
    bsmdec_attribute shape;
    if (bsmdec_attribute_at(decoder, index, &shape) != BSMDEC_OK) return;
    size_t size = (size_t)(shape.rows * shape.components) * bsmdec_kind_size(shape.kind);
    void *values = need(size), *indices = need((size_t)shape.indices * 4);
    bsmdec_attribute_values(decoder, index, values, size);
    add(values, size);
    if (shape.indices > 0) bsmdec_attribute_indices(decoder, index, indices, (size_t)shape.indices);
    add(indices, (size_t)shape.indices * 4);
    free(values);
    free(indices);
}

static void add_event(bsmdec *decoder, const bsmdec_event *event) {
    const int64_t numbers[] = {event->type, event->index, event->count, event->vertices, event->faces, event->frames};
    size_t corners = 3 * (size_t)event->faces, coordinates = 3 * (size_t)event->vertices;
    add(numbers, sizeof numbers);
    if (event->type == BSMDEC_CONNECTIVITY) {
        uint32_t *faces = need(corners * sizeof *faces);
        if (bsmdec_faces(decoder, faces, corners) == BSMDEC_OK) add(faces, corners * sizeof *faces);
        free(faces);
    }
    if (event->type != BSMDEC_FRAME && event->type != BSMDEC_END) return;
    double *positions = need(coordinates * sizeof *positions);
    if (bsmdec_positions(decoder, positions, coordinates) == BSMDEC_OK) add(positions, coordinates * sizeof *positions);
    free(positions);
    for (int index = 0; index < bsmdec_attribute_count(decoder); index++) add_attribute(decoder, index);
}

static bsmdec_status decode(const char *path) {
    char piece[4096];
    bsmdec_event event = {BSMDEC_NEED_DATA, 0, 0, 0, 0, 0};
    FILE *file = fopen(path, "rb");
    bsmdec *decoder = bsmdec_open(NULL);
    if (file == NULL || decoder == NULL) exit(2);
    for (size_t size; (size = fread(piece, 1, sizeof piece, file)) > 0;) bsmdec_push(decoder, piece, size);
    bsmdec_finish(decoder);
    while (bsmdec_next(decoder, &event) == BSMDEC_OK && event.type != BSMDEC_END_OF_STREAM) add_event(decoder, &event);
    bsmdec_status status = bsmdec_last_error(decoder)->status;
    add(bsmdec_last_error(decoder)->message, strlen(bsmdec_last_error(decoder)->message));
    bsmdec_close(decoder);
    fclose(file);
    return status;
}

int main(int count, char **paths) {
    for (int i = 1; i < count; i++) {
        digest = 0xcbf29ce484222325;
        const char *name = bsmdec_status_name(decode(paths[i]));
        printf("%s %08lx%08lx\n", name, (unsigned long)(digest >> 32), (unsigned long)(digest & 0xffffffff));
    }
    return 0;
}
