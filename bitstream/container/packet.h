/* Packets: what a frame of the stream holds (specification, F 3). */
#pragma once

#include "bitstream/container/header.h"

typedef enum {
    VALUES_FRAME, HEADER_FRAME, METADATA_FRAME, CONNECTIVITY_FRAME, PARTITION_FRAME, ORDER_FRAME, BLOCK_FRAME,
    GOP_FRAME, GRID_FRAME = 12, REFINEMENT_FRAME, ATTRIBUTE_FRAME, END_FRAME, NO_FRAME = -1,
} FrameType;

/* What a frame says; what a kind has not is 0. Its data are the reader's, until more bytes come. */
typedef struct {
    FrameType type;
    int64_t size;         /* bytes of the payload */
    int64_t index;        /* of a block, a GOP's first frame, an attribute */
    int64_t coefficients; /* of a block */
    int64_t first, count; /* of a grid, a layer or values */
    uint32_t sum;         /* of END, whose `count` is that of frames */
    bool has_positions;   /* whether END has their checksum, which is this: */
    uint32_t positions;
    Span data;
    const Header *header;
    const Declaration *declaration;
} Packet;
