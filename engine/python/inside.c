/* What lies inside a decoder, for the binding in C++, which cannot read the engine's own headers. */
#include "engine/python/inside.h"

#include "engine/decoder.h"

void decoder_state(const bsmdec *decoder, double *state) {
    const Spent *spent = &decoder->context.spent;
    const double all[STATE_NUMBERS] = {(double)decoder->reader.offset, spent->spent, (double)spent->vertices,
        (double)(spent->vertices + spent->shown), (double)(spent->vertices - spent->gone), spent->received,
        spent->reserved};
    memcpy(state, all, sizeof all);
}

void decoder_header(const bsmdec *decoder, double *numbers) {
    list_header(&decoder->reader.headers[decoder->reader.header], numbers);
}

const char *decoder_skim(bsmdec *decoder, int64_t *numbers) {
    Reader *reader = &decoder->reader;
    const Header *header = &reader->headers[0];
    Packet p;
    Gop gop = {0};
    numbers[0] = NO_FRAME;
    if (next_packet(reader, &p) != A_PACKET) return "";
    header += reader->header;
    if (p.type == GOP_FRAME
        && !parse_beginning(&(Cursor){&decoder->context, p.data}, header->gop_frames, header->run, &gop))
        return "";
    const Declaration none = {0}, *d = p.type == ATTRIBUTE_FRAME ? p.declaration : &none;
    const int64_t all[SKIMMED_NUMBERS] = {p.type, reader->last_offset, reader->offset - reader->last_offset, p.size,
        p.data.size, p.index, p.coefficients + p.count + gop.frames, reader->metadata.count, reader->version,
        gop.method == LEARNED || gop.method == KEY_FRAMES, p.has_positions ? (int64_t)p.positions : -1, d->domain,
        d->semantic, d->kind, d->components, d->rows, d->coding, d->moves};
    memcpy(numbers, all, sizeof all);
    return p.type == ATTRIBUTE_FRAME ? p.declaration->name : "";
}
