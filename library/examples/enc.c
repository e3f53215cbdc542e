/* Encodes the shape of an OBJ on a grid of 14 or other bits, or exactly in single precision with 0 bits:
 * cc -O3 enc.c bsm.c -lm -o bsmenc && ./bsmenc mesh.obj mesh.bsm 14 */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bsmenc.h"

enum { FORMAT = 3, FILES = 9 };

/* An array with room for one more row; its room doubles. */
static void *grown(void *rows, size_t count, size_t row) {
    if (count & (count - 1)) return rows;
    void *larger = realloc(rows, (count ? 2 * count : 1) * row);
    if (larger == NULL) exit(BSMENC_NO_MEMORY);
    return larger;
}

/* The text of the next line, valid until the next call; NULL at the end. */
static char *next_line(FILE *file) {
    static char *line;
    size_t size = 0;
    for (int c = fgetc(file); c != EOF; c = fgetc(file)) {
        line = grown(line, size, 1);
        line[size] = (char)(c == '\n' ? '\0' : c);
        if (line[size++] == '\0') return line;
    }
    if (size == 0) return NULL;
    line = grown(line, size, 1);
    line[size] = '\0';
    return line;
}

/* Read vertices and faces; polygons become fans. Returns the number of the wrong line, or 0.
 * `more`: whether the OBJ has texture coordinates, normals or materials. */
static long read_obj(FILE *file, bsmenc_mesh *mesh, double **positions, uint32_t **corners, int *more) {
    long number = 1;
    for (char *line; (line = next_line(file)) != NULL; number++) {
        double place[3];
        char *text = line + strspn(line, " \t"), kind = *text, *end;
        if (strncmp(text, "vt", 2) == 0 || strncmp(text, "vn", 2) == 0 || strncmp(text, "usemtl", 6) == 0) *more = 1;
        if (kind == '\0' || !isspace((unsigned char)text[1])) continue;
        text++;
        if (kind == 'v') {
            for (int axis = 0; axis < 3; axis++, text = end) {
                place[axis] = strtod(text, &end);
                if (end == text) return number;
            }
            for (int axis = 0; axis < 3; axis++) {
                *positions = grown(*positions, (size_t)(3 * mesh->vertices + axis), sizeof **positions);
                (*positions)[3 * mesh->vertices + axis] = place[axis];
            }
            mesh->vertices++;
        } else if (kind == 'f') {
            uint32_t fan[3];
            for (int corner = 0;; corner++) {
                long long index = strtoll(text, &end, 10);
                if (end == text && corner < 3) return number;
                if (end == text) break;
                index = index < 0 ? index + mesh->vertices : index - 1;
                if (index < 0 || index > INT32_MAX) return number;
                fan[corner < 2 ? corner : 2] = (uint32_t)index;
                for (int k = 0; corner >= 2 && k < 3; k++) {
                    *corners = grown(*corners, (size_t)(3 * mesh->faces + k), sizeof **corners);
                    (*corners)[3 * mesh->faces + k] = fan[k];
                }
                if (corner >= 2) fan[1] = fan[2], mesh->faces++;
                text = end + strcspn(end, " \t\r");
            }
        }
    }
    return 0;
}

int main(int count, char **arguments) {
    bsmenc_mesh mesh = {sizeof mesh, 0, 0, NULL, NULL, NULL, NULL, 0, NULL, 0};
    bsmenc_options options = BSMENC_OPTIONS;
    bsmenc_stream *stream;
    double *positions = NULL;
    uint32_t *corners = NULL;
    int more = 0;
    if (count < 3 || count > 4) return fprintf(stderr, "usage: bsmenc IN.obj OUT.bsm [BITS]\n"), BSMENC_MISUSED;
    FILE *file = fopen(arguments[1], "rb");
    if (file == NULL) return perror(arguments[1]), FILES;
    long wrong = read_obj(file, &mesh, &positions, &corners, &more);
    fclose(file);
    if (wrong != 0) return fprintf(stderr, "%s: line %ld is not one of an OBJ\n", arguments[1], wrong), FORMAT;
    mesh.positions = positions;
    mesh.corners = corners;
    options.bits = count == 4 ? atoi(arguments[3]) : 14;
    if (options.bits == 0) options.positions = BSMENC_LOSSLESS;
    int status = (int)bsmenc_encode(&mesh, &options, &stream);
    if (status != BSMENC_OK) {
        fprintf(stderr, "%s: %s\n", arguments[1], stream ? stream->message : "no memory");
    } else if ((file = fopen(arguments[2], "wb")) == NULL || fwrite(stream->bytes, 1, stream->size, file) < stream->size
               || fclose(file) != 0) {
        perror(arguments[2]);
        status = FILES;
    } else if (more) {
        fprintf(stderr, "%s: left out: texture coordinates, normals and materials\n", arguments[2]);
    }
    bsmenc_release(stream);
    free(positions);
    free(corners);
    return status;
}
