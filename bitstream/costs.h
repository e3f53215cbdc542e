/* What decoding costs, in nanoseconds of a processor core and in bytes (specification, M 14.2, M 14.3),
 * and what encoders hold against the limits of decoders. */
#pragma once

#include "bitstream/kernel.h"

INLINE double above_zero(double x) { return x > 0.0 ? x : 0.0; }
INLINE double mesh_work(double n, double m, double bytes) {
    return 140 * n + 85 * m + 700 * above_zero(m / 2 - n) + 400 * bytes;
}
/* What faces on edges add to it (C 13). */
INLINE double edges_work(double m) { return 150 * m; }
INLINE double mesh_memory(double n, double m) { return 200 * n + 60 * m; }
INLINE double order_work(double n, double m, double bytes) { return 500 * n + 750 * m + 100 * bytes; }
INLINE double order_memory(double n, double m) { return 32 * n + 60 * m; }
INLINE double labels_work(double n, double ends, double bytes) { return 300 * n + 30 * ends + 100 * bytes; }
INLINE double partition_work(double n, double ends, int64_t blocks, double copies) {
    return (n + ends) * (4.0 * (64 - __builtin_clzll((uint64_t)blocks)) + 20) + 2 * n + 100 * (double)blocks
        + 30 * copies;
}
static const double COPY_MEMORY = 4;
INLINE double block_work(double rows, double edges, double levels) {
    return 1.45e5 + 600 * rows + 25 * edges + 90 * levels;
}
INLINE double chain_work(double n) { return 2 * n < 4e6 ? 2 * n : 4e6; }
static const double BLOCK_FRAME_BYTES = 5;

INLINE double grid_work(double n, double m) { return 1650 * n + 150 * m; }
INLINE double light_work(double n, double m) { return 200 * n + 40 * m; }
INLINE double grid_chunk_work(double bytes) { return 3.5e4 + 800 * bytes; }
INLINE double light_chunk_work(double bytes) { return 5e4 + 120 * bytes; }
INLINE double floats_work(double n, double span) { return 400 * n + 4 * span; }
INLINE double chunk_work(double bytes, double values) { return 8e4 + 800 * bytes + 2 * values; }
/* Values of attributes that are quick to decode. */
INLINE double swift_work(double n, double m, double axes) { return n * (300 + 180 * axes) + 160 * m; }
INLINE double swift_chunk_work(double bytes, double values) { return 8e4 + 120 * bytes + 2 * values; }
/* What twins add to a grid, with so many images (V 17). */
INLINE double twins_work(double n, double images) { return (1500 + 200 * images) * n; }
static const double LOOK_WORK = 100; /* at a place that no cache has */
INLINE double twins_bytes(double n, double images) { return (4 * images + 41) * n + (1 << 20); }
INLINE double layer_work(double n, double m, double axes) { return n * (400 + 230 * axes) + 130 * m; }
/* Cells and their places spread to vertices, each round (M 18). */
INLINE double cells_work(double n, double ends, double m, double reach) {
    return 15 * n + 20 * m + (16 + 2 * reach) * ends;
}
INLINE double cells_memory(double n, double ends, double m, double cells) {
    return 60 * n + 8 * ends + 32 * m + 60 * cells;
}
INLINE double prolong_work(double n, double ends) { return 6 * n + 2 * ends; }
static const double VALUE_MODEL_BYTES = 4.0 * (6 * 512 * 66 + 7 * (32 + 2 * 512)),
                    LEVEL_MODEL_BYTES = 4.0 * (2 * 5 * 512 * 32);
INLINE double grid_field_bytes(double n, double m) { return 84 * n + 48 * m + VALUE_MODEL_BYTES + (1 << 20); }
INLINE double grid_memory(double n, double m) { return 80 * n + grid_field_bytes(n, m); }
INLINE double layer_field_bytes(double n, double m) { return (24 + 36) * n + 48 * m + LEVEL_MODEL_BYTES + (1 << 17); }
INLINE double layer_memory(double n, double m) { return (28 + 48 * 3) * n + layer_field_bytes(n, m); }
