/* Reads a BSM stream and writes OBJ: cc obj.c bsmdec.c -lm && ./a.out mesh.bsm > mesh.obj */
#include <stdio.h>
#include <stdlib.h>

#include "bsmdec.h"

static void write_obj(bsmdec *decoder, size_t vertices, size_t faces) {
    double *positions = malloc(vertices * 3 * sizeof *positions);
    uint32_t *corners = malloc(faces * 3 * sizeof *corners);
    if (positions == NULL || corners == NULL) exit(BSMDEC_NO_MEMORY);
    bsmdec_positions(decoder, positions, vertices * 3);
    bsmdec_faces(decoder, corners, faces * 3);
    for (size_t v = 0; v < vertices; v++)
        printf("v %.9g %.9g %.9g\n", positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]);
    for (size_t f = 0; f < faces; f++)
        printf("f %lu %lu %lu\n", corners[3 * f] + 1ul, corners[3 * f + 1] + 1ul, corners[3 * f + 2] + 1ul);
    free(positions);
    free(corners);
}

/* Tells what has come as soon as it is known; the status of the stream. */
static bsmdec_status take_events(bsmdec *decoder) {
    bsmdec_event event;
    for (;;) {
        bsmdec_status status = bsmdec_next(decoder, &event);
        if (event.type == BSMDEC_BLOCK) fprintf(stderr, "block %ld\n", (long)event.index);
        if (event.type == BSMDEC_END) write_obj(decoder, (size_t)event.vertices, (size_t)event.faces);
        if (event.type == BSMDEC_NEED_DATA || event.type == BSMDEC_END_OF_STREAM || event.type == BSMDEC_ERROR) return status;
    }
}

int main(int count, char **arguments) {
    char piece[4096];
    size_t size;
    FILE *file = count == 2 ? fopen(arguments[1], "rb") : NULL;
    bsmdec *decoder = bsmdec_open(NULL);
    if (file == NULL || decoder == NULL) {
        fprintf(stderr, "usage: %s MESH.bsm > MESH.obj\n", arguments[0]);
        return BSMDEC_MISUSED;
    }
    bsmdec_status status = BSMDEC_OK;
    while (status == BSMDEC_OK && (size = fread(piece, 1, sizeof piece, file)) > 0) {
        bsmdec_push(decoder, piece, size);
        status = take_events(decoder);
    }
    bsmdec_finish(decoder);
    if (status == BSMDEC_OK) status = take_events(decoder);
    if (status != BSMDEC_OK) fprintf(stderr, "%s\n", bsmdec_last_error(decoder)->message);
    bsmdec_close(decoder);
    fclose(file);
    return (int)status;
}
