/* Values of faces, predicted from coded faces beside them and from the face before (specification, A 7). */
#include "bitstream/attributes/attributes.h"

enum { SIDES = 3, MEMORIES = 256 };

typedef struct { /* known faces beside this one, those that agree in the component before first */
    int number;
    int32_t face[SIDES];
} Beside;

INLINE int32_t of_face(const FaceValues *g, int32_t f, int j) { return g->values.data[g->values.columns * f + j]; }

static void find_beside(const Corners *c, const FaceValues *g, int32_t f, int j, Beside *beside) {
    beside->number = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < SIDES; i++) {
            int32_t beyond = c->opposite.data[3 * (int64_t)f + i], other = beyond / 3;
            if (beyond < 0 || other >= f) continue;
            bool agrees = j == 0 || of_face(g, other, j - 1) == of_face(g, f, j - 1);
            if (agrees == (pass == 0)) beside->face[beside->number++] = other;
        }
}

static bool code_component(RangeCoder *coder, const ValueModel *model, const Corners *c, const FaceValues *g, int32_t f,
    int j, int32_t *hits) {
    Beside b;
    find_beside(c, g, f, j, &b);
    int32_t most = g->largest.data[j], near[SIDES];
    int32_t *memory = g->memory.data + (MEMORIES + 1) * j, *next = memory + MEMORIES;
    int32_t last = f > 0 ? of_face(g, f - 1, j) : 0;
    int64_t sum = 0, errors = 0, spread = 0;
    for (int i = 0; i < b.number; i++) {
        near[i] = of_face(g, b.face[i], j);
        sum += near[i], errors += size_of(g->gaps.data[g->gaps.columns * b.face[i] + j]);
    }
    int32_t mean = b.number > 0 ? divided(sum * FINE, b.number) : last * FINE;
    for (int i = 0; i < b.number; i++) spread += size_of(near[i] * FINE - mean);
    for (int i = b.number; i < SIDES; i++) near[i] = last;
    uint32_t known = (uint32_t)near[0] * 31 + (uint32_t)last;
    for (int i = 0; i < j; i++) known = (i == 0 ? 0 : known * 31) + (uint32_t)of_face(g, f, i);
    int32_t *usual = memory + (known * 0x9E3779B1u >> 24);
    Expectation e = {.contexts = CONTEXTS};
    e.prediction[0] = near[0] * FINE;
    e.prediction[1] = near[1] * FINE;
    e.prediction[2] = near[2] * FINE;
    e.prediction[3] = last * FINE;
    e.prediction[4] = *usual * FINE;
    e.prediction[5] = (int32_t)least(*next, most) * FINE;
    e.prediction[6] = mean;
    e.scale = b.number > 0 ? divided(errors + spread, b.number) + 1 : FINE * most / 4;
    int32_t alike = (near[0] == near[1]) + 2 * (near[1] == near[2]) + 4 * (near[0] == last) + 8 * (*usual == near[0]);
    int32_t later = (int32_t)least(j, 1), bucket = size_class(e.scale);
    e.scale_context = bucket * MOST_COMPONENTS + j;
    e.hit_context = (b.number * 2 + (near[0] == last)) * 2 + (j == 0 ? near[0] == near[1] : *hits != 0) + 16 * later;
    e.context[0] = (alike * 4 + b.number) * MOST_COMPONENTS + j;
    e.context[1] = near[0] & (CONTEXT_SIZE - 1);
    e.context[2] = (near[0] * 23 + last) & (CONTEXT_SIZE - 1);
    e.context[3] = (near[0] * 23 + near[1] * 7 + near[2]) & (CONTEXT_SIZE - 1);
    e.context[4] = bucket * 16 + alike;
    e.context[5] = j == 0 ? f % 3 : *hits + (j << PREDICTIONS);
    e.set = (int32_t)least(j, WEIGHT_SETS - 1);

    int32_t value = code_value(coder, model, &e, coder->reading ? 0 : of_face(g, f, j));
    if (value < 0 || value > most) return false;
    g->values.data[g->values.columns * f + j] = value;
    g->gaps.data[g->gaps.columns * f + j] = value * FINE - mean;
    *hits = hits_of(&e, value);
    *usual = value;
    if (value >= *next) *next = value + 1;
    return true;
}

typedef struct {
    RangeCoder *coder;
    ValueModel model;
    Corners corners;
    FaceValues values;
} Faces;

static bool code_face(void *work, int64_t f) {
    Faces *w = work;
    int32_t hits = 0;
    for (int j = 0; j < w->values.values.columns; j++)
        if (!code_component(w->coder, &w->model, &w->corners, &w->values, (int32_t)f, j, &hits)) return false;
    return true;
}

int64_t code_faces(
    RangeCoder *coder, ValueModel model, Corners corners, FaceValues g, int64_t first, int64_t count) {
    Faces work = {.coder = coder, .model = model, .corners = corners, .values = g};
    return code_rows(coder, corners.faces.rows, first, count, MOST_COMPONENTS * VALUE_BYTES, code_face, &work);
}
