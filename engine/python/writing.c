/* Payloads written by the functions that read them: those of fields and attributes, for encoders in Python. */
#include "engine/python/inside.h"

#include "engine/decoder.h"
#include "engine/topology.h"

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

/* The surface of faces that do not repeat a corner, closed by dummies (C 4), and room for its conquest. */
static bool close_surface(Context *context, ConstInts2 faces, int64_t vertices, Arena *arena, Surface *surface) {
    ConstInts origin = {faces.data, 3 * faces.rows};
    int64_t size = origin.size, closed = size, all;
    Guide *guide = &surface->guide;
    Longs starts;
    Ints by_high, order, twin, corner, vertex, leaving, full_twin, full_corner, valence;
    if (!take_longs(arena, vertices + 1, &starts) || !take_ints(arena, size, &by_high)
        || !take_ints(arena, size, &order) || !take_ints(arena, size, &twin) || !take_ints(arena, size, &corner)
        || !take_ints(arena, size, &vertex))
        return false;
    match_halfedges(origin, starts, by_high, order, twin);
    guide->real = find_fans(origin, const_ints(twin), corner, vertex);
    for (int64_t h = 0; h < size; h++) closed += 3 * (twin.data[h] < 0);
    if (closed > INT32_MAX) return FAIL(context, LIMIT, "# faces are too many", faces.rows);
    if (!take_ints(arena, guide->real, &leaving) || !take_ints(arena, closed, &full_twin)
        || !take_ints(arena, closed, &full_corner))
        return false;
    surface->dummies = fill_loops(const_ints(twin), const_ints(corner), leaving, full_twin, full_corner);
    all = guide->real + surface->dummies;
    if (!zero_ints(arena, all, &valence) || !TAKE(arena, all, guide->number) || !TAKE(arena, closed, guide->node)
        || !TAKE_ZEROS(arena, closed / 3, guide->conquered) || !TAKE(arena, guide->real, guide->fans)
        || !TAKE(arena, faces.rows, guide->faces))
        return false;
    for (int64_t h = 0; h < closed; h++) valence.data[full_corner.data[h]]++;
    for (int64_t i = 0; i < all; i++) guide->number[i] = -1;
    guide->twin = full_twin.data;
    guide->corner = full_corner.data;
    guide->valence = valence.data;
    surface->vertex = vertex.data;
    return true;
}

static bool write_connectivity(Context *context, Written given, int64_t vertices, Arena *arena, Arena *scratch,
    int32_t *order, int32_t *face_order, int32_t *faces) {
    int64_t m = given.faces_count, proper = 0, next = 0;
    Surface surface = {.order = {order, vertices}};
    Ints2 own, coded;
    Ints places;
    if (!take_ints2(arena, m, 3, &own) || !take_ints(arena, m, &places)
        || !take_ints(arena, vertices, &surface.number))
        return false;
    for (int repeated = 0; repeated < 2; repeated++) {
        proper = next;
        for (int64_t f = 0; f < m; f++) {
            const int32_t *face = given.faces + 3 * f;
            if ((face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) != repeated) continue;
            for (int k = 0; k < 3; k++) own.data[3 * next + k] = face[k];
            places.data[next++] = (int32_t)f;
        }
    }
    if (!close_surface(context, (ConstInts2){own.data, proper, 3}, given.rows, arena, &surface)) return false;
    int64_t fans = surface.guide.real, corners = 3 * (m - proper);
    if (!take_ints(arena, fans + corners, &surface.used)) return false;
    memcpy(surface.used.data + fans, own.data + 3 * proper, (size_t)corners * sizeof *own.data);
    for (int64_t i = 0; i < fans && given.values != NULL; i++) surface.vertex[i] = given.values[surface.vertex[i]];
    int64_t regular = number_by_appearance((ConstInts){surface.vertex, fans}, surface.order, surface.number);
    surface.repeated = m - proper;
    surface.lonely = vertices - regular;
    surface.surplus = fans - regular;
    if (!code_connectivity(context, (Span){0}, &(Header){.vertices = vertices, .faces = m}, &surface, arena, scratch,
            &coded))
        return false;
    memcpy(faces, coded.data, (size_t)(3 * m) * sizeof *faces);
    for (int64_t i = 0; i < m; i++) face_order[i] = places.data[i < proper ? surface.guide.faces[i] : i];
    return true;
}

bool write_faces(bsmdec *decoder, Written given, int64_t vertices, Writing *writing, int32_t *order,
    int32_t *face_order, int32_t *faces) {
    Arena arena = arena_of(&decoder->context);
    decoder->context.writing = writing;
    bool done = write_connectivity(&decoder->context, given, vertices, &arena, &decoder->scratch, order, face_order,
        faces);
    release_all(&arena);
    return done;
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
