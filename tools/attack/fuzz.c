/* Fuzzing of bsmdec that coverage guides, by libFuzzer (tools/fuzz.sh). Each input is decoded at once, and again in
 * pieces: strictly, with the same end, or tolerantly. Mutations change a payload, or the order of frames, and make
 * checksums right again, so that they get past the reader. */
#include "bsmdec.c"
#include "tools/processors/digest.h"

enum { FRAMES = 120, MOST = 1 << 16 };

static Sums sums;

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
        if (at == size)
            bsmdec_finish(decoder);
        else
            bsmdec_push(decoder, data + at, left < piece ? (piece = left) : piece);
        while (bsmdec_next(decoder, &event) == BSMDEC_OK && event.type != BSMDEC_NEED_DATA &&
               event.type != BSMDEC_END_OF_STREAM)
            digest ^= digest_of(decoder, &event, ++number) * (event.type == BSMDEC_END || event.type == BSMDEC_FRAME);
    }
    digest = add_text(digest, bsmdec_last_error(decoder)->message);
    bsmdec_close(decoder);
    return digest;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    size_t piece = 1 + size / 7;
    make_sums(&sums);
    uint64_t digest = decode(data, size, size + (size == 0), 0);
    if (size % 2 == 0)
        decode(data, size, piece, 1);
    else if (decode(data, size, piece, 0) != digest)
        abort();
    return 0;
}

/* ---- Mutations ---- */

static size_t add_bytes(uint8_t *out, uint64_t number, size_t size) {
    for (size_t i = 0; i < size; i++) out[i] = (uint8_t)(number >> 8 * i);
    return size;
}

/* Tag, payload and checksum; nothing where they do not fit. */
static size_t put_frame(uint8_t *out, size_t room, Section frame) {
    size_t size = 0, bytes = (size_t)frame.payload.size, tag = bytes << 4 | (size_t)frame.type;
    if (bytes + 16 > room) return 0;
    for (; tag > 0x7f; tag >>= 7) out[size++] = (uint8_t)(tag | 0x80);
    out[size++] = (uint8_t)tag;
    memcpy(out + size, frame.payload.data, bytes);
    Span body = {out, (int64_t)(size += bytes)};
    int is_short = frame.type == BLOCK_FRAME || bytes < SHORT_PAYLOAD;
    return size + add_bytes(out + size, is_short ? crc16_of(&sums, body) : crc32_of(&sums, body, 0), is_short ? 2 : 4);
}

/* A stream of frames, with an END that fits them while they are few. */
static size_t put_stream(uint8_t *out, size_t most, const uint8_t *preamble, const Section *frames, size_t count) {
    size_t size = PREAMBLE;
    uint8_t end[5] = {(uint8_t)count};
    memcpy(out, preamble, PREAMBLE);
    for (size_t i = 0; i < count; i++) size += put_frame(out + size, most - size, frames[i]);
    add_bytes(end + 1, crc32_of(&sums, (Span){out, (int64_t)size}, 0), 4);
    return size + put_frame(out + size, most - size, (Section){.type = END_FRAME, .payload = {end, sizeof end}});
}

/* The frames of a stream before END, as far as it has them. */
static size_t frames_of(const uint8_t *data, size_t size, Section *frames) {
    size_t count = 0;
    Span left = {data + PREAMBLE, (int64_t)size - PREAMBLE};
    for (; count < FRAMES; count++) {
        Section *frame = frames + count;
        int head = read_tag(left, frame);
        if (head <= 0 || frame->size > left.size || frame->type == END_FRAME) break;
        frame->payload.data = left.data + head;
        left.data += frame->size, left.size -= frame->size;
    }
    return count;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed) {
    static uint8_t old[MOST], payload[MOST];
    Section frames[FRAMES + 1], taken;
    size_t count = size > MOST || most > MOST || seed % 16 == 0 ? 0 : frames_of(memcpy(old, data, size), size, frames);
    if (count == 0) return LLVMFuzzerMutate(data, size, most);
    size_t here = seed / 16 % count, there = seed / 16 / count % count, length;
    taken = frames[here];
    switch (seed / 7 % 8) {
    case 0: frames[here] = frames[there], frames[there] = taken; break;
    case 1: frames[here] = frames[--count]; break;
    case 2: frames[count++] = taken; break;
    case 3: frames[here].type = (int)(there % 16); break;
    default:
        length = (size_t)taken.payload.size;
        memcpy(payload, taken.payload.data, length);
        length = LLVMFuzzerMutate(payload, length, length + (most - size < 64 ? 1 : 64));
        frames[here].payload = (Span){payload, (int64_t)length};
    }
    return put_stream(data, most, old, frames, count);
}

/* The first stream, with a frame of the second in place of its own frame of
 * this kind, or after all. */
size_t LLVMFuzzerCustomCrossOver(
    const uint8_t *first, size_t size, const uint8_t *second, size_t other, uint8_t *out, size_t most, unsigned seed) {
    Section frames[FRAMES + 1], others[FRAMES];
    size_t count = frames_of(first, size, frames), more = frames_of(second, other, others), at = 0;
    if (count == 0 || more == 0 || most < 64) return 0;
    Section taken = others[seed % more];
    while (at < count && (frames[at].type != taken.type || seed / more % count > at)) at++;
    frames[at] = taken;
    return put_stream(out, most, first, frames, count + (at == count));
}
