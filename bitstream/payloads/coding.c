#include "bitstream/payloads/coding.h"

enum { AHEAD = 4 };

#ifdef BSMDEC_WRITES
static void begin_writing(Coding *writing) {
    Writing *to = writing->context->writing;
    writing->state[1] = UINT32_MAX;
    writing->coder = (Coder){{writing->state, CODER_STATES}, {to->data + to->size, to->room - to->size}};
}

static bool finish_writing(const Coding *writing) {
    Writing *to = writing->context->writing;
    int64_t size = finish_coder(writing->coder);
    if (size < 0) return FAIL(writing->context, NO_MEMORY, "a payload has no room");
    to->size += size;
    to->ends[to->count++] = to->size;
    return true;
}

bool room_to_write(Coding *writing, int64_t bytes) {
    Writing *to = writing->context->writing;
    int64_t room = to != NULL ? to->size + writing->state[CODER_POSITION] + bytes + AHEAD : 0;
    if (to == NULL || room < to->room) return true;
    uint8_t *data;
    if (!TAKE_OF_HOST(writing->context, 2 * room, data)) return false;
    memcpy(data, to->data, (size_t)to->room);
    host_give(writing->context, to->data, (size_t)to->room);
    to->data = data;
    to->room = 2 * room;
    writing->coder.data = (Bytes){to->data + to->size, to->room - to->size};
    return true;
}
#endif

bool begin_coding(Context *context, Span payload, Coding *coding) {
    uint64_t code = 0;
    for (int i = 0; i < AHEAD; i++) code = code << 8 | (i < payload.size ? payload.data[i] : 0);
    if (failed(context)) return false;
#ifdef BSMDEC_WRITES
    *coding = (Coding){.context = context};
    if (context->writing != NULL) return begin_writing(coding), true;
#endif
    if (code >= UINT32_MAX) return FAIL(context, CORRUPT, "an entropy-coded payload cannot begin with ff ff ff ff");
    *coding = (Coding){.context = context, .state = {(int64_t)code, UINT32_MAX, AHEAD, 1, 0}};
    coding->coder = (Coder){{coding->state, CODER_STATES}, {(uint8_t *)payload.data, payload.size}}; /* only read */
    return true;
}

bool ran_over(const Coding *coding) { return coding->state[CODER_POSITION] > coding->coder.data.size + AHEAD; }

bool nonsense(const Coding *coding, const char *what) {
    if (ran_over(coding))
        return FAIL(coding->context, TRUNCATED, "an entropy-coded payload of # bytes ends before its last symbol",
            coding->coder.data.size);
    return FAIL(coding->context, CORRUPT, what);
}

bool finish_coding(const Coding *coding) {
#ifdef BSMDEC_WRITES
    if (coding->context->writing != NULL) return finish_writing(coding);
#endif
    int64_t left = coding->coder.data.size - coding->state[CODER_POSITION];
    if (ran_over(coding)) return nonsense(coding, "");
    return left <= 0
        || FAIL(coding->context, CORRUPT, "# bytes are left over behind the last symbol of a payload", left);
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
