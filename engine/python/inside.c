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

bsmdec_status decoder_skim(bsmdec *decoder) {
    Packet packet;
    while (next_packet(&decoder->reader, &packet) == A_PACKET) continue;
    return decoder->context.error.status;
}
