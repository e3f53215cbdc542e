/* Values of attributes, from whole numbers to what the user is given (specification, D 4). */
#include "library/attribute.h"

#include "codec/geometry/geometry.h"

enum { FARTHEST_EDGE = 1 << 24 };
static const double LEAST_SQUARE = 0x1p-20; /* of a gradient beside the normal */

bool take_values(Arena *arena, const Attribute *attribute, void **values) {
    return is_there(*values = find_zeros(arena, attribute->rows * attribute->declaration.components,
                        kind_size(attribute->declaration.kind)));
}

void store_number(void *values, int64_t place, int kind, double number) {
    switch (kind) {
        case BSMDEC_UINT8: ((uint8_t *)values)[place] = (uint8_t)number; break;
        case BSMDEC_INT8: ((int8_t *)values)[place] = (int8_t)number; break;
        case BSMDEC_UINT16: ((uint16_t *)values)[place] = (uint16_t)number; break;
        case BSMDEC_INT16: ((int16_t *)values)[place] = (int16_t)number; break;
        case BSMDEC_UINT32: ((uint32_t *)values)[place] = (uint32_t)number; break;
        case BSMDEC_INT32: ((int32_t *)values)[place] = (int32_t)number; break;
        case BSMDEC_FLOAT32: ((float *)values)[place] = (float)number; break;
        default: ((double *)values)[place] = number;
    }
}

double load_number(const void *values, int64_t place, int kind) {
    switch (kind) {
        case BSMDEC_UINT8: return ((const uint8_t *)values)[place];
        case BSMDEC_INT8: return ((const int8_t *)values)[place];
        case BSMDEC_UINT16: return ((const uint16_t *)values)[place];
        case BSMDEC_INT16: return ((const int16_t *)values)[place];
        case BSMDEC_UINT32: return ((const uint32_t *)values)[place];
        case BSMDEC_INT32: return ((const int32_t *)values)[place];
        case BSMDEC_FLOAT32: return ((const float *)values)[place];
        default: return ((const double *)values)[place];
    }
}

void relative_values(const Attribute *attribute, Doubles2 beyond) {
    for (int64_t i = 0; i < beyond.rows * beyond.columns; i++)
        beyond.data[i] = load_number(attribute->values, i, attribute->declaration.kind)
            - load_number(attribute->values, i % beyond.columns, attribute->declaration.kind);
}

bool move_values(Context *context, Attribute *attribute, ConstDoubles2 change, void *moved) {
    int kind = attribute->declaration.kind;
    for (int64_t i = 0; i < change.rows * change.columns; i++) {
        double number = load_number(attribute->values, i, kind) + change.data[i];
        if (kind == BSMDEC_FLOAT32 && number * 0.0 == 0.0) number = (float)number;
        if (number * 0.0 != 0.0) return FAIL(context, NUMERIC, "values of an attribute that moves are not finite");
        if (kind < BSMDEC_FLOAT32) {
            number = __builtin_rint(number);
            number = number < LEAST_OF[kind] ? LEAST_OF[kind] : number > UNIT_OF[kind] ? UNIT_OF[kind] : number;
        }
        store_number(moved, i, kind, number);
    }
    attribute->moved = moved;
    return true;
}

void unfold_direction(const int64_t *word, int64_t size, double *direction) {
    int64_t u = word[0] - size, v = word[1] - size, across = u < 0 ? -u : u, along = v < 0 ? -v : v;
    int64_t w = size - across - along;
    if (w < 0) {
        u = (u < 0 ? -1 : 1) * (size - along);
        v = (v < 0 ? -1 : 1) * (size - across);
    }
    double length = __builtin_sqrt((double)(u * u + v * v + w * w));
    direction[0] = (double)u / length;
    direction[1] = (double)v / length;
    direction[2] = (double)w / length;
}

/* The gradient of u on a face, of length 1, and in which sense the face is turned on the texture; 0: it has none. */
static int find_gradient(const TangentPlaces *all, int64_t f, double *gradient) {
    const int32_t *row = all->faces.data + 3 * f, *corner = all->coordinates.data + 3 * f;
    int64_t edge[2][3], side[2][2], across[3];
    for (int k = 0; k < 2; k++) {
        const int32_t *end = all->places.data + 3 * (int64_t)all->vertices[row[k + 1]];
        const int32_t *start = all->places.data + 3 * (int64_t)all->vertices[row[0]];
        for (int j = 0; j < 3; j++)
            edge[k][j] = largest(least((int64_t)end[j] - start[j], FARTHEST_EDGE), -FARTHEST_EDGE);
        for (int j = 0; j < 2; j++)
            side[k][j] = (int64_t)all->words.data[2 * (int64_t)corner[k + 1] + j]
                - all->words.data[2 * (int64_t)corner[0] + j];
    }
    int64_t turned = side[0][0] * side[1][1] - side[1][0] * side[0][1];
    int sense = (turned > 0) - (turned < 0);
    for (int j = 0; j < 3; j++) across[j] = sense * (edge[0][j] * side[1][1] - edge[1][j] * side[0][1]);
    if (across[0] == 0 && across[1] == 0 && across[2] == 0) return 0;
    for (int j = 0; j < 3; j++) gradient[j] = (double)across[j];
    double length = __builtin_sqrt(dot3(gradient, gradient));
    for (int j = 0; j < 3; j++) gradient[j] /= length;
    return sense;
}

bool plan_tangents(Arena *arena, const TangentPlaces *places, TangentPlan *plan) {
    if (!zero_doubles2(arena, places->rows, 3, &plan->gradients) || !zero_ints(arena, places->rows, &plan->turns)
        || !take_ints(arena, places->rows, &plan->normals))
        return false;
    for (int64_t r = 0; r < places->rows; r++) plan->normals.data[r] = -1;
    for (int64_t f = 0; f < places->faces.rows; f++) {
        double gradient[3];
        int sense = find_gradient(places, f, gradient);
        for (int k = 0; k < 3; k++) {
            int32_t row = places->faces.data[3 * f + k];
            if (plan->normals.data[row] < 0) plan->normals.data[row] = places->normals.data[3 * f + k];
            plan->turns.data[row] += sense;
            for (int j = 0; j < 3 && sense != 0; j++) plan->gradients.data[3 * (int64_t)row + j] += gradient[j];
        }
    }
    return true;
}

TangentAxes tangent_axes(const TangentPlan *plan, int64_t row, const double *normal) {
    const double *gradient = plan->gradients.data + 3 * row, *n = normal;
    TangentAxes axes = {.hand = plan->turns.data[row] >= 0 ? 1.0 : -1.0};
    double height = dot3(gradient, n), *along = axes.along;
    for (int j = 0; j < 3; j++) along[j] = gradient[j] - height * n[j];
    double square = dot3(along, along);
    if (square < LEAST_SQUARE) { /* any direction that is not the normal's */
        int axis = 0;
        for (int j = 1; j < 3; j++)
            if (__builtin_fabs(n[j]) < __builtin_fabs(n[axis])) axis = j;
        for (int j = 0; j < 3; j++) along[j] = (j == axis ? 1.0 : 0.0) - n[axis] * n[j];
        square = dot3(along, along);
    }
    double length = __builtin_sqrt(square);
    for (int j = 0; j < 3; j++) along[j] /= length;
    for (int j = 0; j < 3; j++)
        axes.aside[j] = n[(j + 1) % 3] * along[(j + 2) % 3] - n[(j + 2) % 3] * along[(j + 1) % 3];
    return axes;
}

void turn_axes(const TangentAxes *axes, const int64_t *word, int64_t size, double *tangent) {
    int64_t turn = word[0] - 2 * size, far = turn < 0 ? -turn : turn, across = least(far, 2 * size - far);
    double ahead = (double)(size - far), aside = (double)(turn < 0 ? -across : across);
    for (int j = 0; j < 3; j++) tangent[j] = ahead * axes->along[j] + aside * axes->aside[j];
    double length = __builtin_sqrt(dot3(tangent, tangent));
    for (int j = 0; j < 3; j++) tangent[j] /= length;
    tangent[3] = word[1] > 0 ? -axes->hand : axes->hand;
}

static void restore_tangent(const Attribute *attribute, const int64_t *word, int64_t row) {
    const Declaration *d = &attribute->declaration;
    int32_t of_normal = attribute->tangents.normals.data[row];
    double normal[3] = {0.0, 0.0, 1.0}, tangent[4];
    for (int j = 0; j < 3 && of_normal >= 0; j++)
        normal[j] = load_number(attribute->normals->values, 3 * (int64_t)of_normal + j,
            attribute->normals->declaration.kind);
    TangentAxes axes = tangent_axes(&attribute->tangents, row, normal);
    turn_axes(&axes, word, d->largest[0] / 4, tangent);
    for (int j = 0; j < 4; j++) store_number(attribute->values, 4 * row + j, d->kind, tangent[j]);
}

/* The number of the bits that ascend with it, one or two words (D 4.3). */
static double number_of_bits(const int64_t *word, const double *offset, bool is_double) {
    uint64_t bits = 0, top = UINT64_C(1) << (is_double ? 63 : 31);
    for (int i = 0; i <= is_double; i++) bits = bits << 32 | (uint32_t)(word[i] + (int64_t)offset[i]);
    bits = bits & top ? bits ^ top : ~bits;
    double number;
    if (is_double) {
        memcpy(&number, &bits, sizeof number);
    } else {
        uint32_t half = (uint32_t)bits;
        float single;
        memcpy(&single, &half, sizeof single);
        number = single;
    }
    return number - number == 0.0 ? number : 0.0;
}

void restore(const Declaration *d, const int64_t *word, int64_t row, void *values) {
    double number[MOST_COMPONENTS];
    bool is_double = d->kind == BSMDEC_FLOAT64;
    if (d->coding == OCTAHEDRAL) unfold_direction(word, d->largest[0] / 2, number);
    for (int j = 0; j < d->components; j++) {
        if (d->coding == BITS)
            number[j] = number_of_bits(word + j * (1 + is_double), d->offset + j * (1 + is_double), is_double);
        if (d->coding == LEVELS) {
            double product = d->step[j] * (double)word[j];
            number[j] = d->offset[j] + product;
        }
        store_number(values, row * d->components + j, d->kind, number[j]);
    }
}

bool restore_values(Context *context, Attribute *attribute, int64_t first, int64_t count) {
    const Declaration *d = &attribute->declaration;
    for (int64_t i = first; i < first + count; i++) {
        int64_t row = attribute->group[0].order.size > 0 ? attribute->group[0].order.data[i] : i, word[MOST_WORDS];
        int32_t piece[MOST_PIECES];
        int at = 0;
        for (int g = 0; g < attribute->groups; g++)
            for (int j = 0; j < attribute->group[g].columns; j++)
                piece[at++] = attribute->group[g].pieces.data[row * attribute->group[g].columns + j];
        at = 0;
        for (int w = 0; w < d->words; w++) {
            word[w] = piece[at++];
            if (d->largest[w] > MOST_WHOLE) word[w] = word[w] << PIECE_BITS | piece[at++];
            if (word[w] > d->largest[w]) return FAIL(context, CORRUPT, "a level is above #", d->largest[w]);
        }
        for (int w = 0; w < 2 && attribute->words.rows > 0; w++) attribute->words.data[2 * row + w] = (int32_t)word[w];
        if (d->coding == TANGENTS) restore_tangent(attribute, word, row);
        else restore(d, word, row, attribute->values);
    }
    return true;
}

bool recompute(Attribute *attribute, ConstDoubles2 positions, Arena *scratch) {
    int64_t rows = attribute->rows;
    Doubles2 sums; /* of first corners, second ones, third ones */
    if (!zero_doubles2(scratch, 3 * rows, 3, &sums)) return false;
    for (int64_t f = 0; f < attribute->faces.rows; f++) {
        const int32_t *face = attribute->faces.data + 3 * f;
        const double *at[3];
        double across[3];
        for (int k = 0; k < 3; k++) at[k] = positions.data + 3 * (int64_t)attribute->vertices.data[face[k]];
        cross3(at[0], at[1], at[2], across);
        for (int k = 0; k < 3; k++)
            for (int d = 0; d < 3; d++) sums.data[3 * (k * rows + face[k]) + d] += across[d];
    }
    for (int64_t r = 0; r < rows; r++) {
        double normal[3], squares[3];
        for (int d = 0; d < 3; d++) {
            normal[d] = (sums.data[3 * r + d] + sums.data[3 * (rows + r) + d]) + sums.data[3 * (2 * rows + r) + d];
            squares[d] = normal[d] * normal[d];
        }
        double length = __builtin_sqrt((squares[0] + squares[1]) + squares[2]);
        for (int d = 0; d < 3; d++)
            store_number(attribute->values, 3 * r + d, attribute->declaration.kind,
                length > 0.0 ? normal[d] / length
                    : d == 2 ? 1.0
                             : 0.0);
    }
    return attribute->whole = true;
}

static bool by_vertex(const Attribute *attribute, const Numbering *numbering) {
    return is_by_vertex(&attribute->declaration)
        && (attribute->declaration.domain == BSMDEC_VERTEX || numbering->is_split);
}

Given given_shape(const Attribute *attribute, const Numbering *numbering) {
    if (attribute->declaration.domain == BSMDEC_FACE) return (Given){BSMDEC_FACE, attribute->rows};
    if (!by_vertex(attribute, numbering)) return (Given){BSMDEC_CORNER, attribute->rows};
    return (Given){BSMDEC_VERTEX, numbering->size};
}

int32_t row_of_corner(const Attribute *attribute, const Numbering *numbering, int64_t corner) {
    return attribute->faces.data[numbering->corners.size > 0 ? numbering->corners.data[corner] : corner];
}

bool given_rows(const Attribute *attribute, const Numbering *numbering, Arena *scratch, Longs rows) {
    const Declaration *d = &attribute->declaration;
    Ints first = {NULL, 0};
    for (int64_t i = 0; i < rows.size; i++) rows.data[i] = i;
    if (d->domain == BSMDEC_FACE && numbering->corners.size > 0)
        for (int64_t f = 0; f < rows.size; f++) rows.data[f] = numbering->corners.data[3 * f] / 3;
    if (d->domain == BSMDEC_FACE || !by_vertex(attribute, numbering) || numbering->source.size == 0) return true;
    if (d->domain == BSMDEC_CORNER) { /* the value of the first corner of each vertex */
        if (!zero_ints(scratch, numbering->size, &first)) return false;
        for (int64_t i = 3 * numbering->faces.rows - 1; i >= 0; i--)
            first.data[numbering->faces.data[i]] = row_of_corner(attribute, numbering, i);
    }
    int64_t loose = attribute->rows - numbering->loose.rows;
    for (int64_t v = 0; v < rows.size; v++) {
        int32_t coded = numbering->source.data[v];
        rows.data[v] = coded < 0 ? loose++ : d->domain == BSMDEC_CORNER ? first.data[v] : coded;
    }
    return true;
}
