/* Vertices as graphics draw them: several of one vertex of the mesh where attributes of its corners differ. */
#include "library/arithmetic.h"
#include "library/state.h"

/* Sort corners by a key of each, below `keys`; corners of one key keep their order. */
static bool sort_corners(ConstInts key, int64_t keys, Arena *scratch, Ints *order, Ints *room) {
    Ints starts;
    if (!zero_ints(scratch, keys + 1, &starts)) return false;
    for (int64_t i = 0; i < key.size; i++) starts.data[key.data[i] + 1]++;
    for (int64_t k = 0; k < keys; k++) starts.data[k + 1] += starts.data[k];
    for (int64_t i = 0; i < order->size; i++) room->data[starts.data[key.data[order->data[i]]]++] = order->data[i];
    Ints sorted = *room;
    *room = *order;
    *order = sorted;
    return true;
}

/* The key of each corner that tells rows of an attribute apart. */
static void rows_of_corners(const Attribute *attribute, const Numbering *numbering, Ints rows) {
    for (int64_t i = 0; i < rows.size; i++) rows.data[i] = row_of_corner(attribute, numbering, i);
}

/* Number drawn vertices: the first of a vertex has its number, others follow behind all of these. `order`: corners
 * sorted by vertices; `differs`: whether one has another vertex or other rows than the one before it. */
static bool number_vertices(Split *split, const Numbering *numbering, ConstInts order, ConstBytes differs) {
    int64_t n = numbering->size, copies = 0;
    ConstInts faces = {numbering->faces.data, order.size};
    for (int64_t i = 1; i < order.size; i++)
        copies += differs.data[i] && faces.data[order.data[i]] == faces.data[order.data[i - 1]];
    if (!take_ints(&split->arena, copies, &split->sources) || !take_ints(&split->arena, n + copies, &split->corners)
        || !take_words(&split->arena, order.size, &split->indices))
        return false;
    for (int64_t v = 0; v < n + copies; v++) split->corners.data[v] = -1;
    int64_t drawn = 0;
    split->vertices = n;
    for (int64_t i = 0; i < order.size; i++) {
        int32_t corner = order.data[i], vertex = faces.data[corner];
        if (differs.data[i] && split->corners.data[vertex] < 0) drawn = vertex;
        else if (differs.data[i]) split->sources.data[(drawn = split->vertices++) - n] = vertex;
        if (differs.data[i]) split->corners.data[drawn] = corner;
        split->indices.data[corner] = (uint32_t)drawn;
    }
    return true;
}

static bool split_corners(bsmdec *decoder, Arena *scratch) {
    const Mesh *mesh = &decoder->mesh;
    const Numbering *numbering = &mesh->numbering;
    Split *split = &decoder->split;
    int64_t corners = 3 * numbering->faces.rows;
    if (corners + numbering->size > INT32_MAX)
        return FAIL(&decoder->context, LIMIT, "# corners are too many for vertices to draw", corners);
    Ints order, room, key;
    Bytes differs;
    if (!take_ints(scratch, corners, &order) || !take_ints(scratch, corners, &room)
        || !take_ints(scratch, corners, &key) || !zero_bytes(scratch, corners, &differs))
        return false;
    for (int64_t i = 0; i < corners; i++) order.data[i] = (int32_t)i;
    for (int k = 0; k < MOST_ATTRIBUTES; k++) {
        if (!split->by[k]) continue;
        rows_of_corners(mesh->attributes.list[k], numbering, key);
        if (!sort_corners(const_ints(key), mesh->attributes.list[k]->rows, scratch, &order, &room)) return false;
    }
    if (!sort_corners((ConstInts){numbering->faces.data, corners}, numbering->size, scratch, &order, &room))
        return false;
    for (int64_t i = 0; i < corners; i++)
        differs.data[i] = i == 0 || numbering->faces.data[order.data[i]] != numbering->faces.data[order.data[i - 1]];
    for (int k = 0; k < MOST_ATTRIBUTES; k++) {
        if (!split->by[k]) continue;
        rows_of_corners(mesh->attributes.list[k], numbering, key);
        for (int64_t i = 1; i < corners; i++) differs.data[i] |= key.data[order.data[i]] != key.data[order.data[i - 1]];
    }
    return number_vertices(split, numbering, const_ints(order), const_bytes(differs));
}

/* Take note that an attribute splits vertices, if it is one of corners. */
static void note_attribute(const bsmdec_attribute *shape, int index, Split *split) {
    split->by[index] = shape->domain == BSMDEC_CORNER;
    split->is_needed |= split->by[index];
}

EXACTLY(bsmdec_status, bsmdec_split,
    (bsmdec *decoder, const int *attributes, int count, int64_t *vertices),
    (decoder, attributes, count, vertices)) {
    if (decoder == NULL) return BSMDEC_MISUSED;
    if (vertices == NULL || (attributes == NULL && count > 0)) return REFUSE(decoder, "attributes or vertices is NULL");
    if (!decoder->mesh.announced) return REFUSE(decoder, "faces are known after CONNECTIVITY");
    Split split = {.arena = arena_of(&decoder->context), .vertices = decoder->mesh.numbering.size, .is_made = true};
    bsmdec_attribute shape;
    for (int k = 0; k < count; k++) {
        if (bsmdec_attribute_at(decoder, attributes[k], &shape) != BSMDEC_OK) return BSMDEC_MISUSED;
        if (shape.domain == BSMDEC_FACE)
            return REFUSE(decoder, "attribute # is of faces, not of vertices", attributes[k]);
        note_attribute(&shape, attributes[k], &split);
    }
    for (int k = 0; count < 0 && k < bsmdec_attribute_count(decoder); k++)
        if (find_shape(decoder, k, &shape)) note_attribute(&shape, k, &split);
    forget_split(decoder);
    decoder->split = split;
    Arena scratch = arena_of(&decoder->context);
    bool done = !split.is_needed || split_corners(decoder, &scratch);
    release_all(&scratch);
    if (!done) {
        forget_split(decoder);
        return decoder->context.error.status;
    }
    *vertices = decoder->split.vertices;
    return BSMDEC_OK;
}

/* Whether numbers of `each` bytes may be written to an array, and to all that is `stride` behind another. */
static bool is_aligned(bsmdec *decoder, const void *array, size_t stride, size_t each) {
    return ((uintptr_t)array | stride) % each == 0
        || (REFUSE(decoder, "array or stride is not a multiple of # bytes", (int64_t)each), false);
}

bsmdec_status bsmdec_split_indices(bsmdec *decoder, size_t index_size, void *indices, size_t count) {
    if (decoder == NULL) return BSMDEC_MISUSED;
    const Split *split = &decoder->split;
    ConstInts2 faces = decoder->mesh.numbering.faces;
    if (!split->is_made) return REFUSE(decoder, "call bsmdec_split first; a new mesh needs a new call");
    if (index_size != SHORT_INDEX && index_size != LONG_INDEX)
        return REFUSE(decoder, "indices have 2 or 4 bytes, not #", (int64_t)index_size);
    if (index_size == SHORT_INDEX && split->vertices > UINT16_MAX)
        return REFUSE(
            decoder, "# vertices are too many for indices of 2 bytes, at most #", split->vertices, UINT16_MAX);
    if (!fits(decoder, indices, count, 3 * faces.rows) || !is_aligned(decoder, indices, 0, index_size))
        return BSMDEC_MISUSED;
    for (size_t i = 0; i < count; i++) {
        uint32_t vertex = split->is_needed ? split->indices.data[i] : (uint32_t)faces.data[i];
        if (index_size == SHORT_INDEX) ((uint16_t *)indices)[i] = (uint16_t)vertex;
        else ((uint32_t *)indices)[i] = vertex;
    }
    return BSMDEC_OK;
}

/* How numbers are converted. Colors and normals are fractions: integers are fractions of their largest value. */
typedef struct {
    int from, to, have, want; /* kinds, components */
    bool of_fractions;
} Conversion;

static double as_fraction(double number, int kind) {
    if (kind >= BSMDEC_FLOAT32) return number;
    double low = LEAST_OF[kind] < 0 ? -1.0 : 0.0;
    return __builtin_rint(UNIT_OF[kind] * (number >= 1.0 ? 1.0 : number >= low ? number : number < low ? low : 0.0));
}

/* Write one value; components that the mesh has not are 0, a fourth is 1. */
static void convert(const Conversion *how, const void *values, int64_t row, char *to) {
    for (int j = 0; j < how->want; j++) {
        bool is_there = j < how->have && row >= 0;
        double number = is_there ? load_number(values, row * how->have + j, how->from) : j == 3 ? 1.0 : 0.0;
        if (how->of_fractions) number = as_fraction(is_there ? number / UNIT_OF[how->from] : number, how->to);
        store_number(to, j, how->to, number);
    }
}

static bool can_convert(bsmdec *decoder, const Conversion *how) {
    if (!is_kind(how->to)) return REFUSE(decoder, "kind # is none", how->to), false;
    if (how->want < 1 || how->want > MOST_COMPONENTS)
        return REFUSE(decoder, "# components, expected 1 to #", how->want, MOST_COMPONENTS), false;
    if (!how->of_fractions && how->to != how->from && how->to < BSMDEC_FLOAT32)
        return REFUSE(decoder, "only colors and normals are converted to integers"), false;
    return true;
}

/* Whether rows of `each` bytes, `stride` from one to the next, fit into an array of a caller. */
static bool rows_fit(bsmdec *decoder, const void *array, size_t stride, size_t each, size_t size) {
    size_t rows = (size_t)decoder->split.vertices;
    if (array == NULL) return REFUSE(decoder, "the array is NULL"), false;
    if (stride < each) return REFUSE(decoder, "stride #, expected at least #", (int64_t)stride, (int64_t)each), false;
    if (rows == 0 || (size >= each && (size - each) / stride >= rows - 1)) return true;
    return REFUSE(
               decoder, "size # is too small for # vertices, stride #", (int64_t)size, (int64_t)rows, (int64_t)stride),
           false;
}

static bsmdec_status write_positions(bsmdec *decoder, const Conversion *how, size_t stride, char *to) {
    const Split *split = &decoder->split;
    int64_t loose = 0, n = decoder->mesh.numbering.size;
    for (int64_t v = 0; v < split->vertices; v++)
        convert(how, place_of(decoder, v < n ? v : split->sources.data[v - n], &loose), 0, to + (size_t)v * stride);
    return BSMDEC_OK;
}

static bsmdec_status write_values(
    bsmdec *decoder, int index, const bsmdec_attribute *shape, const Conversion *how, size_t stride, char *to) {
    const Attribute *attribute = decoder->mesh.attributes.list[index];
    const Numbering *numbering = &decoder->mesh.numbering;
    const Split *split = &decoder->split;
    const void *values = attribute->moved != NULL ? attribute->moved : attribute->values;
    Arena own = arena_of(&decoder->context);
    Longs rows;
    bool done = take_longs(&own, shape->rows, &rows) && given_rows(attribute, numbering, &own, rows);
    for (int64_t v = 0; done && v < split->vertices; v++) {
        int64_t row = v < numbering->size ? v : split->sources.data[v - numbering->size];
        if (shape->domain == BSMDEC_CORNER)
            row = split->corners.data[v] < 0 ? -1 : row_of_corner(attribute, numbering, split->corners.data[v]);
        convert(how, values, row < 0 ? row : rows.data[row], to + (size_t)v * stride);
    }
    release_all(&own);
    return done ? BSMDEC_OK : decoder->context.error.status;
}

EXACTLY(bsmdec_status, bsmdec_split_values,
    (bsmdec *decoder, int attribute, int kind, int components, size_t stride, void *to, size_t size),
    (decoder, attribute, kind, components, stride, to, size)) {
    if (decoder == NULL) return BSMDEC_MISUSED;
    if (!decoder->split.is_made) return REFUSE(decoder, "call bsmdec_split first; a new mesh needs a new call");
    bsmdec_attribute shape = {.domain = BSMDEC_VERTEX, .kind = BSMDEC_FLOAT64, .components = 3};
    if (attribute != BSMDEC_POSITION && bsmdec_attribute_at(decoder, attribute, &shape) != BSMDEC_OK)
        return BSMDEC_MISUSED;
    bsmdec_status status = attribute == BSMDEC_POSITION ? find_places(decoder) : BSMDEC_OK;
    if (status != BSMDEC_OK) return status;
    if (shape.domain == BSMDEC_FACE) return REFUSE(decoder, "attribute # is of faces, not of vertices", attribute);
    if (shape.domain == BSMDEC_CORNER && !decoder->split.by[attribute])
        return REFUSE(decoder, "attribute # was not given to bsmdec_split", attribute);
    Conversion how = {shape.kind, kind, shape.components, components,
        shape.semantic == BSMDEC_COLOR || shape.semantic == BSMDEC_NORMAL};
    if (!can_convert(decoder, &how) || !rows_fit(decoder, to, stride, (size_t)components * kind_size(kind), size)
        || !is_aligned(decoder, to, stride, kind_size(kind)))
        return BSMDEC_MISUSED;
    if (attribute == BSMDEC_POSITION) return write_positions(decoder, &how, stride, to);
    return write_values(decoder, attribute, &shape, &how, stride, to);
}
