/* The end of a payload, and single symbols for the few that are coded one by one (specification, C 1 to C 3). */
#include "bitstream/entropy/entropy.h"

enum { MOST_UNARY = 1 << 10, MOST_VALUE = 1 << 25 };

int64_t finish_coder(Coder given) {
    RangeCoder coder;
    int64_t size, unit = INT64_C(1) << 32, value;
    if (!open_coder(&coder, given)) return MISUSED;
    size = coder.position;
    if (coder.full || size + 4 > coder.size) return -1;
    while ((value = ((int64_t)coder.low + unit - 1) / unit * unit) >= (int64_t)(coder.low + coder.range)) {
        unit >>= 8;
        size++;
    }
    for (int64_t i = coder.position; value >> 32 && i > 0 && ++coder.data[i - 1] == 0;) i--;
    for (int64_t i = coder.position, bits = 24; i < size; i++, bits -= 8) coder.data[i] = (uint8_t)(value >> bits);
    return size;
}

int64_t code_one_uniform(Coder given, int64_t value, int64_t count) {
    RangeCoder coder;
    if (!open_coder(&coder, given) || count < 1 || count > INT64_C(1) << 32) return MISUSED;
    value = code_uniform(&coder, value, count);
    close_coder(&coder, given);
    return value;
}

/* Whether the slots of all contexts, and the weights, of `span` nodes are in the bank. */
static bool open_bank_for(Mixer *mixer, Bank bank, ConstLongs contexts, int64_t selector, int64_t span) {
    for (int64_t i = 0; i < contexts.size; i++)
        if (contexts.data[i] < 0 || contexts.data[i] > bank.slots.size - span) return false;
    return contexts.size <= MOST_INPUTS && selector >= 0 && selector <= bank.weights.rows - span
        && open_bank(mixer, bank, 1, 1, (int)contexts.size);
}

int64_t code_one_unsigned(
    Coder given, Bank bank, ConstLongs contexts, int64_t selector, int64_t unary, int64_t value, int64_t node) {
    RangeCoder coder;
    Mixer mixer = {0};
    if (unary < 0 || unary > MOST_UNARY || node < 0 || node > MOST_UNARY || value < 0 || value > MOST_VALUE
        || !open_coder(&coder, given) || !open_bank_for(&mixer, bank, contexts, selector, node + UNSIGNED_SPAN(unary)))
        return MISUSED;
    int inputs = (int)contexts.size;
    value = code_unsigned(&coder, &mixer, inputs, contexts.data, selector, (int)unary, value, node);
    close_coder(&coder, given);
    return value;
}
