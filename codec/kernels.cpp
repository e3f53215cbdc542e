// The kernels of `codec` as functions of Python: one line each.
#include "bitstream/kernel.hpp"

extern "C" {
#include "codec/blocks/bisection.h"
#include "codec/blocks/blend.h"
#include "codec/blocks/overlap.h"
#include "codec/blocks/partition.h"
#include "codec/geometry/graph.h"
#include "codec/geometry/incidence.h"
#include "codec/geometry/metrics.h"
#include "codec/geometry/raster.h"
#include "codec/geometry/surface_distance.h"
}

using namespace nb::literals;

NB_MODULE(_kernels, m) {
    m.def("vertex_faces", &vertex_faces, "faces"_a, "starts"_a, "members"_a, Unlocked());
    m.def("face_normals", &face_normals, "positions"_a, "faces"_a, "normals"_a, Unlocked());
    m.def("geometric_laplacian", &geometric_laplacian, "positions"_a, "starts"_a, "members"_a, "result"_a, Unlocked());
    m.def("build_tree", &build_tree, "lowest"_a, "highest"_a, "order"_a, "scratch"_a, "low"_a, "high"_a, "first"_a,
          "count"_a, Unlocked());
    m.def("nearest_distances", &nearest_distances, "points"_a, "triangles"_a, "low"_a, "high"_a, "first"_a, "count"_a,
          "distances"_a, Unlocked());
    m.def("nearest_faces", &nearest_faces, "corners"_a, "owner"_a, "depth"_a, Unlocked());
    m.def("bisection_scratch", &bisection_scratch, "size"_a);
    m.def("bisect", &bisect, "offsets"_a, "neighbours"_a, "order"_a, "bounds"_a, "scratch"_a, Unlocked());
    m.def("refine_partition", &refine_partition, "offsets"_a, "neighbours"_a, "labels"_a, "passes"_a, "sizes"_a,
          "votes"_a, Unlocked());
    m.def("group_by_label", &group_by_label, "labels"_a, "bounds"_a, "order"_a, Unlocked());
    m.def("chain_parts", &chain_parts, "starts"_a, "ends"_a, "edges"_a, "shared"_a, "seen"_a, "trail"_a, "visited"_a,
          "chain"_a, Unlocked());
    m.def("grow_blocks", &grow_blocks, "offsets"_a, "neighbours"_a, "order"_a, "bounds"_a, "chain"_a, "size"_a,
          "seen"_a, "starts"_a, "members"_a, Unlocked());
    m.def("order_scratch", &order_scratch, "rows"_a, "edges"_a);
    m.def("order_block", &order_block, "offsets"_a, "neighbours"_a, "rows"_a, "vertices"_a, "local_offsets"_a,
          "local_neighbours"_a, "scratch"_a, Unlocked());
    m.def("add_copies", &add_copies, "sums"_a, "total"_a, "vertices"_a, "positions"_a, "weights"_a, Unlocked());
    m.def("collect_edges", &collect_edges, "faces"_a, "offsets"_a, "filled"_a, "ends"_a, Unlocked());
}
