/* Decodes a BSM stream to an OBJ of its shape: cc -O3 dec.c bsmdec.c -lm -o bsmdec && ./bsmdec mesh.bsm mesh.obj */
#include <stdio.h>
#include <stdlib.h>

#include "bsmdec.h"

/* The bytes of a file; NULL if it cannot be read. */
static char *read_file(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    char *bytes = NULL;
    if (file == NULL) return NULL;
    for (size_t room = 1 << 16, more = 1; more > 0; room *= 2, *size += more) {
        char *larger = realloc(bytes, room);
        if (larger == NULL) exit(BSMDEC_NO_MEMORY);
        bytes = larger;
        more = fread(bytes + *size, 1, room - *size, file);
    }
    fclose(file);
    return bytes;
}

/* Whether all of the mesh is in the file. */
static int write_obj(const bsmdec_mesh *mesh, const char *path) {
    const double *position = mesh->vertex_data;
    const uint32_t *index = mesh->index_data;
    FILE *file = fopen(path, "wb");
    if (file == NULL) return 0;
    for (int64_t v = 0; v < mesh->vertices; v++, position += 3)
        fprintf(file, "v %.9g %.9g %.9g\n", position[0], position[1], position[2]);
    for (int64_t f = 0; f < mesh->faces; f++, index += 3)
        fprintf(file, "f %lu %lu %lu\n", index[0] + 1ul, index[1] + 1ul, index[2] + 1ul);
    int whole = !ferror(file);
    return fclose(file) == 0 && whole;
}

int main(int count, char **arguments) {
    const bsmdec_field position = {BSMDEC_POSITION, NULL, BSMDEC_FLOAT64, 3, 0};
    bsmdec_options options = BSMDEC_OPTIONS;
    bsmdec_mesh *mesh;
    size_t size = 0;
    if (count != 3) return fprintf(stderr, "usage: bsmdec IN.bsm OUT.obj\n"), BSMDEC_MISUSED;
    char *bytes = read_file(arguments[1], &size);
    if (bytes == NULL) return perror(arguments[1]), 9;
    options.fields = &position;
    options.field_count = 1;
    options.index_size = 4;
    int status = (int)bsmdec_decode(bytes, size, &options, &mesh);
    if (status != BSMDEC_OK) {
        fprintf(stderr, "%s: %s\n", arguments[1], mesh->error->message);
    } else if (!write_obj(mesh, arguments[2])) {
        perror(arguments[2]);
        status = 9;
    } else if (bsmdec_attribute_count(mesh->decoder) > 0 || mesh->frames > 1) {
        fprintf(stderr, "%s: left out: attributes, and frames after the first\n", arguments[2]);
    }
    bsmdec_release(mesh);
    free(bytes);
    return status;
}
