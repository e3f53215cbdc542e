/* Reads a scene with EXT_bsm_compression by cgltf (github.com/jkuhlmann/cgltf), and gives each primitive buffers.
 * cc -O2 -c bsmdec.c && cc gltf.c bsmdec.o -lm && ./a.out scene.glb */
#define CGLTF_IMPLEMENTATION
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bsmdec.h"
#include "cgltf.h"

typedef struct {
    float position[3], normal[3], texcoord[2];
} Vertex;

/* The bufferView whose bytes are the stream of an accessor; NULL: it is a plain array. */
static const cgltf_buffer_view *stream_of(const cgltf_data *scene, const cgltf_accessor *accessor) {
    const cgltf_buffer_view *view = accessor->buffer_view;
    for (cgltf_size i = 0; view && i < view->extensions_count; i++) {
        if (strcmp(view->extensions[i].name, "EXT_bsm_compression")) continue;
        const char *named = strstr(view->extensions[i].data, "\"stream\"");
        unsigned long number = named ? strtoul(named + strcspn(named, "0123456789"), NULL, 10) : 0;
        return named && number < scene->buffer_views_count ? &scene->buffer_views[number] : NULL;
    }
    return NULL;
}

int main(int count, char **arguments) {
    cgltf_options usual = {0};
    cgltf_data *scene = NULL;
    if (count < 2 || cgltf_parse_file(&usual, arguments[1], &scene) || cgltf_load_buffers(&usual, scene, arguments[1]))
        return fprintf(stderr, "this scene cannot be read\n"), 1;
    const bsmdec_field fields[] = {
        {BSMDEC_POSITION, NULL, BSMDEC_FLOAT32, 3, offsetof(Vertex, position)},
        {BSMDEC_NORMAL, NULL, BSMDEC_FLOAT32, 3, offsetof(Vertex, normal)},
        {BSMDEC_TEXCOORD, NULL, BSMDEC_FLOAT32, 2, offsetof(Vertex, texcoord)},
    };
    bsmdec_options options = BSMDEC_OPTIONS;
    options.fields = fields;
    options.field_count = 3;
    options.stride = sizeof(Vertex);
    for (cgltf_size m = 0; m < scene->meshes_count; m++)
        for (cgltf_size p = 0; p < scene->meshes[m].primitives_count; p++) {
            const cgltf_accessor *positions =
                cgltf_find_accessor(&scene->meshes[m].primitives[p], cgltf_attribute_type_position, 0);
            const cgltf_buffer_view *stream = positions ? stream_of(scene, positions) : NULL;
            if (!stream || !stream->buffer->data || stream->offset + stream->size > stream->buffer->size) continue;
            bsmdec_mesh *mesh; /* of a stream that several primitives name, keep it */
            if (bsmdec_decode((char *)stream->buffer->data + stream->offset, stream->size, &options, &mesh))
                return fprintf(stderr, "%s\n", mesh ? mesh->error->message : "no memory"), 1;
            const float *first = ((const Vertex *)mesh->vertex_data)->position;
            printf("%s: %zu vertices, %lld triangles, the first at %.6g %.6g %.6g\n", scene->meshes[m].name,
                   mesh->vertex_bytes / sizeof(Vertex), (long long)mesh->faces, first[0], first[1], first[2]);
            bsmdec_release(mesh);
        }
    cgltf_free(scene);
}
