/* Payloads written by the functions that read them: those of fields and attributes, for encoders in Python. */
#include "engine/python/inside.h"

#include "engine/decoder.h"

/* A mesh of faces that the caller keeps. */
static Mesh *begin(bsmdec *decoder, const Header *header, const int32_t *faces) {
    begin_mesh(decoder, header);
    decoder->mesh.faces = (Ints2){(int32_t *)faces, header->faces, 3}; /* only read */
    return &decoder->mesh;
}

/* Copy values, which are from `low` to those of `largest`. */
static bool fill(Context *context, Ints2 to, Written given, int64_t first, const int32_t *largest, bool both) {
    for (int64_t i = 0; i < to.rows; i++)
        for (int64_t j = 0; j < to.columns; j++) {
            int32_t value = to.data[to.columns * i + j] = given.values[given.columns * i + first + j];
            if (value > largest[j] || value < (both ? -largest[j] : 0))
                return FAIL(context, NUMERIC, "value # of row # is out of its range", value, i);
        }
    return true;
}

bool write_grid(bsmdec *decoder, Written given, const int32_t *largest, int light, const double *origin, double step,
    const double *exact) {
    Header header = {
        .vertices = given.rows, .faces = given.faces_count, .on_grid = true, .light = light, .scale = step};
    memcpy(header.center, origin, sizeof header.center);
    memcpy(header.grid, largest, sizeof header.grid);
    Mesh *mesh = begin(decoder, &header, given.faces);
    if (!begin_grid(&mesh->grid, &decoder->context, &mesh->header, const_ints2(mesh->faces), &mesh->arena,
            &decoder->scratch))
        return false;
    if (exact != NULL)
        memcpy(mesh->grid.positions.data, exact, (size_t)(3 * given.rows) * sizeof(double));
    return fill(&decoder->context, mesh->grid.values, given, 0, largest, false);
}

bool write_levels(bsmdec *decoder, Written given) {
    static const int32_t MOST[] = {1 << 20, 1 << 20, 1 << 20};
    Mesh *mesh = begin(decoder, &(Header){.vertices = given.rows, .faces = given.faces_count}, given.faces);
    mesh->has_layer = true;
    return begin_levels(&mesh->layer, &decoder->context, &mesh->header, const_ints2(mesh->faces), &decoder->scratch)
        && fill(&decoder->context, mesh->layer.levels.levels, given, 0, MOST, true);
}

bool write_values(bsmdec *decoder, Written given, const uint8_t *declaration, int64_t size, int64_t vertices,
    const int32_t *at, const int32_t *places) {
    Context *context = &decoder->context;
    Mesh *mesh = begin(decoder, &(Header){.vertices = vertices, .faces = given.faces_count}, given.faces);
    Attribute *attribute;
    mesh->has_attributes = true;
    begin_attributes(&mesh->attributes, context, &mesh->header, const_ints2(mesh->faces), &mesh->arena);
    if (!TAKE_ZEROS(&mesh->arena, 1, attribute)) return false;
    mesh->attributes.list[0] = attribute;
    attribute->rows = given.rows;
    attribute->faces = const_ints2(mesh->faces);
    attribute->vertices = (Ints){(int32_t *)at, given.rows}; /* only read */
    for (int64_t r = 0; r < given.rows && at != NULL; r++)
        if (at[r] >= vertices) return FAIL(context, NUMERIC, "row # is at vertex # of #", r, at[r], vertices);
    if (!parse_declaration(context, (Span){declaration, size}, &decoder->scratch, &attribute->declaration)
        || !start_attribute(&mesh->attributes, attribute, (ConstInts2){places, places != NULL ? vertices : 0, 3},
            &decoder->scratch))
        return false;
    for (int g = 0; g < attribute->groups; g++) {
        Group *group = &attribute->group[g];
        bool of_faces = attribute->declaration.domain == BSMDEC_FACE;
        const int32_t *largest = (of_faces ? group->face_values.largest : group->values.largest).data;
        if (!fill(context, group->pieces, given, MOST_COMPONENTS * g, largest, false)) return false;
    }
    return true;
}

bool code_chunk(bsmdec *decoder, int64_t first, int64_t count, const uint8_t *payload, int64_t size, Writing *writing) {
    Mesh *mesh = &decoder->mesh;
    GridField *grid = &mesh->grid;
    Attribute *attribute = mesh->attributes.list[0];
    Span given = {payload, size};
    bool done = true;
    decoder->context.writing = writing;
    if (mesh->header.on_grid) {
        done = code_grid_values(grid, first, count, given);
        if (done && grid->header->light == EXACT_FLOATS)
            done = place_floats(grid, (ConstInts){grid->order.data + first, count}, given, &decoder->scratch);
    } else if (mesh->has_layer) {
        done = code_layer(&mesh->layer, first, count, given);
    }
    for (int g = 0; done && mesh->has_attributes && g < attribute->groups; g++)
        done = code_group(&decoder->context, attribute, &attribute->group[g], given, first, count);
    decoder->context.writing = NULL;
    release_all(&decoder->scratch);
    return done;
}

const int32_t *order_of_field(const bsmdec *decoder) {
    const Mesh *mesh = &decoder->mesh;
    return mesh->has_attributes ? mesh->attributes.list[0]->group[0].order.data : mesh->grid.order.data;
}

const int32_t *values_of_field(const bsmdec *decoder) {
    const Mesh *mesh = &decoder->mesh;
    return mesh->header.on_grid ? mesh->grid.values.data
        : mesh->has_layer ? mesh->layer.levels.levels.data : mesh->attributes.list[0]->group[0].pieces.data;
}
