/* Digests of what bsmdec gives: the same wherever bits are the same, whatever the order of bytes is. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bsmdec.h"

static void *need(void *memory) {
    if (memory == NULL) exit((perror("no memory"), 2));
    return memory;
}

/* FNV-1a over numbers of `width` bytes, each from its lowest byte up. */
static uint64_t add(uint64_t digest, const void *numbers, size_t count, size_t width) {
    const uint16_t one = 1;
    const unsigned char *byte = numbers;
    size_t turn = *(const unsigned char *)&one == 1 ? 0 : width - 1;
    for (size_t i = 0; i < count * width; i++)
        digest = (digest ^ byte[i / width * width + (i % width ^ turn)]) * 0x100000001b3;
    return digest;
}

static uint64_t add_number(uint64_t digest, int64_t number) { return add(digest, &number, 1, sizeof number); }
static uint64_t add_text(uint64_t digest, const char *text) { return add(digest, text, strlen(text), 1); }

/* What a getter says and fills: an array that is as long as it must be, so that sanitizers see who writes behind it. */
#define ADD_ARRAY(digest, count, width, call)                                   \
    do {                                                                        \
        size_t length = (size_t)(count), bytes = length * (width);              \
        void *array = need(malloc(bytes + (bytes == 0)));                       \
        bsmdec_status got = (call);                                             \
        digest = add_number(digest, got);                                       \
        if (got == BSMDEC_OK) digest = add(digest, array, length, width);       \
        free(array);                                                            \
    } while (0)

static uint64_t add_attributes(uint64_t digest, bsmdec *decoder) {
    for (int i = 0; i < bsmdec_attribute_count(decoder); i++) {
        bsmdec_attribute shape;
        if (bsmdec_attribute_at(decoder, i, &shape) != BSMDEC_OK) continue;
        size_t width = bsmdec_kind_size(shape.kind);
        digest = add_number(add_number(add_text(digest, shape.name), shape.rows), shape.components);
        ADD_ARRAY(digest, shape.rows * shape.components, width, bsmdec_attribute_values(decoder, i, array, bytes));
        ADD_ARRAY(digest, shape.indices, 4, bsmdec_attribute_indices(decoder, i, array, length));
    }
    return digest;
}

static uint64_t add_split(uint64_t digest, bsmdec *decoder, int64_t faces) {
    int64_t vertices = 0;
    bsmdec_attribute shape;
    digest = add_number(digest, bsmdec_split(decoder, NULL, BSMDEC_ALL, &vertices));
    ADD_ARRAY(digest, 3 * faces, 4, bsmdec_split_indices(decoder, 4, array, length));
    for (int i = BSMDEC_POSITION; i < bsmdec_attribute_count(decoder); i++)
        if (i == BSMDEC_POSITION
            || (bsmdec_attribute_at(decoder, i, &shape) == BSMDEC_OK && shape.domain != BSMDEC_FACE))
            ADD_ARRAY(digest, 3 * vertices, 4, bsmdec_split_values(decoder, i, BSMDEC_FLOAT32, 3, 12, array, bytes));
    return digest;
}

static uint64_t add_changes(uint64_t digest, bsmdec *decoder) {
    bsmdec_changes changes = {0};
    digest = add_number(digest, bsmdec_read_changes(decoder, &changes));
    size_t count = (size_t)changes.count;
    digest = add(add(digest, changes.vertices, count, 4), changes.positions, 3 * count, 8);
    return add(digest, changes.final, count, 1);
}

/* An event, and all that can be asked for behind it: partial positions behind events 1, 2, 4, 8, ... */
static uint64_t digest_of(bsmdec *decoder, const bsmdec_event *event, size_t number) {
    uint64_t digest = 0xcbf29ce484222325;
    bsmdec_metadata entry;
    int rests = event->type == BSMDEC_FRAME || event->type == BSMDEC_END;
    digest = add_number(add_number(add_number(digest, event->type), event->index), event->count);
    digest = add_number(add_number(add_number(digest, event->vertices), event->faces), event->frames);
    if (event->type == BSMDEC_LOSS) digest = add_text(digest, bsmdec_last_loss(decoder)->message);
    if (event->type == BSMDEC_CONNECTIVITY)
        ADD_ARRAY(digest, 3 * event->faces, 4, bsmdec_faces(decoder, array, length));
    if (rests || (number & (number - 1)) == 0) {
        ADD_ARRAY(digest, 3 * event->vertices, 8, bsmdec_positions(decoder, array, length));
        ADD_ARRAY(digest, 3 * event->vertices, 4, bsmdec_positions_single(decoder, array, length));
        if (event->type == BSMDEC_BLOCK || event->type == BSMDEC_REFINEMENT) digest = add_changes(digest, decoder);
    }
    if (rests || event->type == BSMDEC_ATTRIBUTE) digest = add_attributes(digest, decoder);
    if (rests) digest = add_split(digest, decoder, event->faces);
    for (int64_t i = 0; event->type == BSMDEC_METADATA && bsmdec_metadata_at(decoder, i, &entry) == BSMDEC_OK; i++)
        digest = add(add(add_text(digest, entry.name), &entry.number, 1, 8), entry.bytes,
            entry.bytes != NULL ? entry.size : 0, 1);
    return digest;
}

/* Buffers of a mesh, or of a frame, with default options: numbers of four bytes, indices of two or four. */
static uint64_t digest_of_buffers(const bsmdec_mesh *mesh) {
    uint64_t digest = add_number(add_number(0xcbf29ce484222325, mesh->frame), mesh->vertices);
    digest = add(digest, mesh->vertex_data, mesh->vertex_bytes / 4, 4);
    return add(digest, mesh->index_data, 3 * (size_t)mesh->faces, mesh->index_size);
}

static char *read_file(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    if (file == NULL) exit((perror(path), 2));
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    char *bytes = need(malloc(*size + 1));
    rewind(file);
    if (fread(bytes, 1, *size, file) != *size) exit((perror(path), 2));
    fclose(file);
    return bytes;
}
