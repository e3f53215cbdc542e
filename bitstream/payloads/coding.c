#include "bitstream/payloads/payloads.h"

#ifdef BSMDEC_WRITES
static void begin_writing(Coding *writing) {
    Payload *to = writing->context->writing;
    writing->coder = (RangeCoder){.data = to->data + to->size, .size = to->capacity - to->size, .range = UINT32_MAX};
}

/* Write the fewest bytes that still tell the last decision (C 1.4). */
static bool finish_writing(Coding *writing) {
    Payload *to = writing->context->writing;
    RangeCoder *coder = &writing->coder;
    int64_t size = coder->position, unit = INT64_C(1) << 32, value;
    if (coder->full || size + AHEAD > coder->size) return FAIL(writing->context, NO_MEMORY, "a payload has no room");
    while ((value = ((int64_t)coder->low + unit - 1) / unit * unit) >= (int64_t)(coder->low + coder->range)) {
        unit >>= 8;
        size++;
    }
    for (int64_t i = coder->position; value >> 32 && i > 0 && ++coder->data[i - 1] == 0;) i--;
    for (int64_t i = coder->position, bits = 24; i < size; i++, bits -= 8) coder->data[i] = (uint8_t)(value >> bits);
    to->size += size;
    to->ends[to->count++] = to->size;
    return true;
}

bool room_to_write(Coding *writing, int64_t bytes) {
    Payload *to = writing->context->writing;
    int64_t capacity = to != NULL ? to->size + writing->coder.position + bytes + AHEAD : 0;
    if (to == NULL || capacity < to->capacity) return true;
    uint8_t *data;
    if (!TAKE_OF_HOST(writing->context, 2 * capacity, data)) return false;
    memcpy(data, to->data, (size_t)to->capacity);
    host_give(writing->context, to->data, (size_t)to->capacity);
    to->data = data;
    to->capacity = 2 * capacity;
    writing->coder.data = to->data + to->size;
    writing->coder.size = to->capacity - to->size;
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
    *coding = (Coding){context, {.data = (uint8_t *)payload.data, .size = payload.size, .position = AHEAD, .low = code,
        .range = UINT32_MAX, .reading = true}}; /* bytes are only read */
    return true;
}

bool nonsense(const Coding *coding, const char *what) {
    if (overran(&coding->coder))
        return FAIL(coding->context, TRUNCATED, "an entropy-coded payload of # bytes ends before its last symbol",
            coding->coder.size);
    return FAIL(coding->context, CORRUPT, what);
}

bool finish_coding(Coding *coding) {
#ifdef BSMDEC_WRITES
    if (coding->context->writing != NULL) return finish_writing(coding);
#endif
    int64_t left = coding->coder.size - coding->coder.position;
    if (overran(&coding->coder)) return nonsense(coding, "");
    return left <= 0
        || FAIL(coding->context, CORRUPT, "# bytes are left over behind the last symbol of a payload", left);
}

/* By copies of what is there: WebAssembly makes these at full speed from its first call on, and loops not. */
static void fill_slots(uint32_t *slots, int64_t count, uint32_t value) {
    enum { MOST = 4096 };
    if (count > 0) *slots = value;
    for (int64_t done = 1, more; done < count; done += more) {
        more = least(least(done, MOST), count - done);
        memcpy(slots + done, slots, (size_t)more * sizeof *slots);
    }
}

bool make_bank(Arena *arena, BankPlan plan, Bank *bank) {
    if (!TAKE(arena, plan.slots, bank->slots) || !TAKE(arena, plan.selectors * plan.inputs, bank->weights))
        return false;
    uint32_t probability = (uint32_t)(plan.probability > 0 ? plan.probability : ONE / 2);
    int32_t weight = plan.inputs < 3 ? ONE / plan.inputs : ONE * 5 / (4 * plan.inputs);
    fill_slots(bank->slots, plan.slots, probability << 16 | (uint32_t)plan.trust);
    for (int64_t i = 0; i < plan.selectors * plan.inputs; i++) bank->weights[i] = weight;
    bank->limit = plan.limit > 0 ? plan.limit : 255;
    bank->rate = plan.rate > 0 ? plan.rate : 14;
    return true;
}
