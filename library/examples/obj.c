/* Decodes a BSM stream and writes OBJ: cc -O2 obj.c bsmdec.c -lm && ./a.out mesh.bsm > mesh.obj */
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

static void write_obj(const bsmdec_mesh *mesh) {
    const double *position = mesh->vertex_data;
    const uint32_t *index = mesh->index_data;
    for (int64_t v = 0; v < mesh->vertices; v++, position += 3)
        printf("v %.9g %.9g %.9g\n", position[0], position[1], position[2]);
    for (int64_t f = 0; f < mesh->faces; f++, index += 3)
        printf("f %lu %lu %lu\n", index[0] + 1ul, index[1] + 1ul, index[2] + 1ul);
}

int main(int count, char **arguments) {
    const bsmdec_field position = {BSMDEC_POSITION, NULL, BSMDEC_FLOAT64, 3, 0};
    bsmdec_options options = BSMDEC_OPTIONS;
    bsmdec_mesh *mesh;
    size_t size = 0;
    char *bytes = count == 2 ? read_file(arguments[1], &size) : NULL;
    if (bytes == NULL) {
        fprintf(stderr, "usage: %s MESH.bsm > MESH.obj\n", arguments[0]);
        return BSMDEC_MISUSED;
    }
    options.fields = &position;
    options.field_count = 1;
    options.index_size = 4;
    bsmdec_status status = bsmdec_decode(bytes, size, &options, &mesh);
    if (status == BSMDEC_OK) write_obj(mesh);
    else fprintf(stderr, "%s\n", mesh->error->message);
    bsmdec_release(mesh);
    free(bytes);
    return (int)status;
}
