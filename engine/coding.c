#include "engine/coding.h"

#include <stdlib.h>

enum { AHEAD = 4 };

#ifdef BSMDEC_WRITES
static void begin_writing(Reading *writing) {
    Writing *to = writing->context->writing;
    writing->state[1] = UINT32_MAX;
    writing->coder = (Coder){{writing->state, CODER_STATES}, {to->data + to->size, to->room - to->size}};
}

static bool finish_writing(const Reading *writing) {
    Writing *to = writing->context->writing;
    int64_t size = finish_coder(writing->coder);
    if (size < 0) return FAIL(writing->context, NO_MEMORY, "a payload has no room");
    to->size += size;
    to->ends[to->count++] = to->size;
    return true;
}

bool room_to_write(Reading *writing, int64_t bytes) {
    Writing *to = writing->context->writing;
    int64_t room = to != NULL ? to->size + writing->state[CODER_POSITION] + bytes + AHEAD : 0;
    if (to == NULL || room < to->room) return true;
    uint8_t *data = realloc(to->data, (size_t)(2 * room));
    if (data == NULL) return FAIL(writing->context, NO_MEMORY, "a payload has no room");
    to->data = data;
    to->room = 2 * room;
    writing->coder.data = (Bytes){to->data + to->size, to->room - to->size};
    return true;
}
#endif

bool begin_reading(Context *context, Span payload, Reading *reading) {
    uint64_t code = 0;
    for (int i = 0; i < AHEAD; i++) code = code << 8 | (i < payload.size ? payload.data[i] : 0);
    if (failed(context)) return false;
#ifdef BSMDEC_WRITES
    *reading = (Reading){.context = context};
    if (context->writing != NULL) return begin_writing(reading), true;
#endif
    if (code >= UINT32_MAX) return FAIL(context, CORRUPT, "an entropy-coded payload cannot begin with ff ff ff ff");
    *reading = (Reading){.context = context, .state = {(int64_t)code, UINT32_MAX, AHEAD, 1, 0}};
    reading->coder = (Coder){{reading->state, CODER_STATES}, {(uint8_t *)payload.data, payload.size}}; /* only read */
    return true;
}

bool ran_over(const Reading *reading) { return reading->state[CODER_POSITION] > reading->coder.data.size + AHEAD; }

bool nonsense(const Reading *reading, const char *what) {
    if (ran_over(reading))
        return FAIL(reading->context, TRUNCATED, "an entropy-coded payload of # bytes ends before its last symbol",
            reading->coder.data.size);
    return FAIL(reading->context, CORRUPT, what);
}

bool finish_reading(const Reading *reading) {
#ifdef BSMDEC_WRITES
    if (reading->context->writing != NULL) return finish_writing(reading);
#endif
    int64_t left = reading->coder.data.size - reading->state[CODER_POSITION];
    if (ran_over(reading)) return nonsense(reading, "");
    return left <= 0
        || FAIL(reading->context, CORRUPT, "# bytes are left over behind the last symbol of a payload", left);
}

bool make_bank(Arena *arena, BankPlan plan, Bank *bank) {
    if (!take_words(arena, plan.slots, &bank->slots) || !take_ints2(arena, plan.selectors, plan.inputs, &bank->weights)
        || !take_longs(arena, 2, &bank->settings))
        return false;
    uint32_t probability = (uint32_t)(plan.probability > 0 ? plan.probability : ONE / 2);
    int32_t weight = plan.inputs < 3 ? ONE / plan.inputs : ONE * 5 / (4 * plan.inputs);
    for (int64_t i = 0; i < plan.slots; i++) bank->slots.data[i] = probability << 16 | (uint32_t)plan.trust;
    for (int64_t i = 0; i < plan.selectors * plan.inputs; i++) bank->weights.data[i] = weight;
    bank->settings.data[0] = plan.limit > 0 ? plan.limit : 255;
    bank->settings.data[1] = plan.rate > 0 ? plan.rate : 14;
    return true;
}
