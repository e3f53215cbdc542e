/* Packets to bytes: what bitstream/container/reader.c reads (specification, F 1 to F 5). */
#pragma once

#include "bitstream/container/header.h"
#include "bitstream/payloads/order.h"
#include "bitstream/container/packet.h"
#include "library/writing.h"

/* Bytes that grow with what is put behind them; nothing is put where the context has failed. */
typedef struct {
    Context *context;
    uint8_t *data;
    int64_t size, room;
} Buffer;

void give_buffer(Buffer *buffer);
INLINE Span bytes_of(const Buffer *buffer) { return (Span){buffer->data, buffer->size}; }
void put_bytes(Buffer *buffer, Span bytes);
void put_varint(Buffer *buffer, int64_t value);
void put_little(Buffer *buffer, uint64_t value, int size);
/* The fields that a record has, but for those at their defaults. */
void put_record(Buffer *buffer, Fields fields, const Record *record);
/* A map of entries in the order of their names, at most MOST_ENTRIES. */
void put_metadata(Buffer *buffer, const bsmdec_metadata *const *entries, int count);

/* The payload of ORDER; the numbers of copies and of loose vertices are counted here. `loose`: positions of these. */
void put_order(Buffer *buffer, Arrangement *arrangement, ConstDoubles2 loose, Arena *scratch);

/* A stream as far as it is written, and the payload of its next section. */
typedef struct {
    Buffer bytes, payload;
    Sums sums;
    uint32_t sum;
    int64_t sections;
} StreamWriter;

void start_stream(StreamWriter *writer, Context *context);
/* Write a section with the payload, which is empty then. */
void put_section(StreamWriter *writer, FrameType type);
/* Write END, with the checksum of decoded positions. */
void end_stream(StreamWriter *writer, uint32_t positions);
void give_stream(StreamWriter *writer);
