/* Fuzzing of bsmdec that coverage guides, by libFuzzer. Each input is decoded at once, and again in pieces: strictly, with
 * the same end, or tolerantly. Mutations change a payload, or the order of frames, and make checksums right again, so that
 * they get past the reader. */
#include "tools/processors/digest.h"

enum { PREAMBLE = 5, END = 15, BLOCK = 6, SHORT = 128, FRAMES = 512, MOST = 1 << 16 };

size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t most);

/* ---- Decoding ---- */

static uint64_t decode(const uint8_t *data, size_t size, size_t piece, int tolerant) {
    bsmdec_limits limits;
    bsmdec_default_limits(&limits, sizeof limits);
    limits.vertices = limits.attribute_values = 1 << 13, limits.faces = 1 << 14;
    limits.work = 2e7, limits.memory = limits.heap = 1 << 27;
    limits.work_per_byte = limits.work_per_vertex = limits.memory_per_byte = limits.memory_per_vertex = 0;
    bsmdec_options options = {.size = sizeof options, .limits = &limits, .tolerant = tolerant};
    bsmdec *decoder = need(bsmdec_open(&options));
    uint64_t digest = 0;
    size_t number = 0;
    bsmdec_event event = {.type = BSMDEC_NEED_DATA};
    for (size_t at = 0; at <= size; at += piece) {
        size_t left = size - at;
        if (at == size) bsmdec_finish(decoder);
        else bsmdec_push(decoder, data + at, left < piece ? (piece = left) : piece);
        while (bsmdec_next(decoder, &event) == BSMDEC_OK && event.type != BSMDEC_NEED_DATA
               && event.type != BSMDEC_END_OF_STREAM)
            digest ^= digest_of(decoder, &event, ++number) * (event.type == BSMDEC_END || event.type == BSMDEC_FRAME);
    }
    digest = add_text(digest, bsmdec_last_error(decoder)->message);
    bsmdec_close(decoder);
    return digest;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    size_t piece = 1 + size / 7;
    uint64_t digest = decode(data, size, size + (size == 0), 0);
    if (size % 2 == 0) decode(data, size, piece, 1);
    else if (decode(data, size, piece, 0) != digest) abort();
    return 0;
}

/* ---- Mutations ---- */

typedef struct {
    size_t kind, size;
    const uint8_t *payload;
} Frame;

static uint32_t crc32(const uint8_t *bytes, size_t size) {
    uint32_t sum = ~0u;
    for (size_t i = 0; i < 8 * size; i++) {
        if (i % 8 == 0) sum ^= bytes[i / 8];
        sum = sum >> 1 ^ (0xedb88320 & -(sum & 1));
    }
    return ~sum;
}

static uint32_t crc16(const uint8_t *bytes, size_t size) {
    uint32_t sum = 0;
    for (size_t i = 0; i < 8 * size; i++) {
        if (i % 8 == 0) sum ^= (uint32_t)bytes[i / 8] << 8;
        sum = (sum << 1 ^ (0x1021 & -(sum >> 15 & 1))) & 0xffff;
    }
    return sum;
}

static size_t write_varint(uint8_t *out, size_t value) {
    size_t size = 0;
    for (; value > 0x7f; value >>= 7) out[size++] = (uint8_t)(value | 0x80);
    out[size++] = (uint8_t)value;
    return size;
}

static size_t write_sum(uint8_t *out, uint32_t sum, size_t size) {
    for (size_t i = 0; i < size; i++) out[i] = (uint8_t)(sum >> 8 * i);
    return size;
}

/* Tag, payload and checksum; nothing where they do not fit into `room`. */
static size_t write_frame(uint8_t *out, size_t room, Frame frame) {
    size_t bytes = frame.kind == BLOCK || frame.size < SHORT ? 2 : 4;
    if (frame.size + 16 > room) return 0;
    size_t size = write_varint(out, frame.size << 4 | frame.kind);
    memcpy(out + size, frame.payload, frame.size);
    size += frame.size;
    return size + write_sum(out + size, bytes == 2 ? crc16(out, size) : crc32(out, size), bytes);
}

/* The frames of a stream before END, as far as it has them. */
static size_t frames_of(const uint8_t *data, size_t size, Frame *frames) {
    size_t count = 0;
    for (size_t at = PREAMBLE; count < FRAMES && at < size; count++) {
        size_t tag = 0, shift = 0;
        while (at < size && shift < 28 && data[at] > 0x7f) tag |= (size_t)(data[at++] & 0x7f) << shift, shift += 7;
        if (at < size) tag |= (size_t)data[at++] << shift;
        frames[count] = (Frame){tag % 16, tag / 16, data + at};
        if (tag % 16 == END || tag / 16 > size - at) break;
        at += tag / 16 + (tag % 16 == BLOCK || tag / 16 < SHORT ? 2 : 4);
    }
    return count;
}

/* A stream of frames, with its END. */
static size_t write_stream(uint8_t *out, size_t most, const uint8_t *preamble, const Frame *frames, size_t count) {
    size_t size = PREAMBLE, written = 0;
    uint8_t end[16];
    memcpy(out, preamble, PREAMBLE);
    for (size_t i = 0; i < count; i++) {
        size_t more = write_frame(out + size, most - size, frames[i]);
        size += more, written += more > 0;
    }
    size_t length = write_varint(end, written);
    length += write_sum(end + length, crc32(out, size), 4);
    return size + write_frame(out + size, most - size, (Frame){END, length, end});
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed) {
    static uint8_t old[MOST], payload[MOST];
    Frame frames[FRAMES + 1], taken;
    size_t count = size > MOST || most > MOST || seed % 16 == 0 ? 0 : frames_of(memcpy(old, data, size), size, frames);
    if (count == 0) return LLVMFuzzerMutate(data, size, most);
    size_t here = seed / 16 % count, there = seed / 16 / count % count, length;
    taken = frames[here];
    switch (seed / 7 % 8) {
    case 0: frames[here] = frames[there], frames[there] = taken; break;
    case 1: frames[here] = frames[--count]; break;
    case 2: frames[count++] = taken; break;
    case 3: frames[here].kind = there % 16; break;
    default:
        memcpy(payload, taken.payload, taken.size);
        length = LLVMFuzzerMutate(payload, taken.size, most - size < 64 ? taken.size + 1 : taken.size + 64);
        frames[here] = (Frame){taken.kind, length, payload};
    }
    return write_stream(data, most, old, frames, count);
}

/* The first stream, with a frame of the second in place of its own frame of this kind, or after all. */
size_t LLVMFuzzerCustomCrossOver(const uint8_t *first, size_t size, const uint8_t *second, size_t other, uint8_t *out,
    size_t most, unsigned seed) {
    Frame frames[FRAMES + 1], others[FRAMES];
    size_t count = frames_of(first, size, frames), more = frames_of(second, other, others), at = 0;
    if (count == 0 || more == 0 || most < 64) return 0;
    Frame taken = others[seed % more];
    while (at < count && (frames[at].kind != taken.kind || seed / more % count > at)) at++;
    frames[at] = taken;
    return write_stream(out, most, first, frames, count + (at == count));
}
