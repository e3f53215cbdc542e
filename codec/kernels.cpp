// The kernels of `codec` as functions of Python: one line each.
#include "bitstream/kernel.hpp"

extern "C" {
#include "codec/blocks/bisection.h"
#include "codec/blocks/blend.h"
#include "codec/blocks/overlap.h"
#include "codec/blocks/partition.h"
#include "codec/denoise/estimate.h"
#include "codec/denoise/filters/fast_effective.h"
#include "codec/denoise/filters/guidance.h"
#include "codec/denoise/filters/kernel.h"
#include "codec/denoise/filters/non_iterative.h"
#include "codec/denoise/filters/reach.h"
#include "codec/denoise/filters/topology.h"
#include "codec/denoise/filters/vertex_bilateral.h"
#include "codec/denoise/filters/vertex_update.h"
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
    m.def("minus_mean", &minus_mean, "values"_a, "starts"_a, "members"_a, "rest"_a, Unlocked());
    m.def("average_alike", &average_alike, "normals"_a, "starts"_a, "members"_a, "threshold"_a, "averaged"_a,
          Unlocked());
    m.def("patch_scores", &patch_scores, "normals"_a, "areas"_a, "starts"_a, "members"_a, "steps"_a,
          "inner_starts"_a, "inner"_a, "scores"_a, "means"_a, Unlocked());
    m.def("most_consistent", &most_consistent, "scores"_a, "means"_a, "starts"_a, "members"_a, "guide"_a,
          Unlocked());
    m.def("filter_normals", &filter_normals, "centroids"_a, "areas"_a, "normals"_a, "guide"_a, "starts"_a, "near"_a,
          "sigma_s"_a, "sigma_r"_a, "filtered"_a, Unlocked());
    m.def("mollify", &mollify, "positions"_a, "centroids"_a, "areas"_a, "starts"_a, "near"_a, "width"_a, "moved"_a,
          Unlocked());
    m.def("predict_from_planes", &predict_from_planes, "positions"_a, "centroids"_a, "areas"_a, "normals"_a,
          "starts"_a, "near"_a, "spatial"_a, "influence"_a, "moved"_a, Unlocked());
    m.def("reach", &reach, "centres"_a, "seed_starts"_a, "seeds"_a, "points"_a, "starts"_a, "members"_a, "radii"_a,
          "begin"_a, "seen"_a, "reached_starts"_a, "reached"_a, Unlocked());
    m.def("face_patches", &face_patches, "faces"_a, "around_starts"_a, "around"_a, "crowd"_a, "seen"_a, "starts"_a,
          "members"_a, Unlocked());
    m.def("inner_pairs", &inner_pairs, "starts"_a, "members"_a, "pairs"_a, "first"_a, "own"_a, "inside"_a,
          "inner_starts"_a, "inner"_a, Unlocked());
    m.def("shortest_edges", &shortest_edges, "positions"_a, "starts"_a, "members"_a, "lengths"_a, Unlocked());
    m.def("filter_heights", &filter_heights, "positions"_a, "normals"_a, "widths"_a, "starts"_a, "near"_a, "moved"_a,
          Unlocked());
    m.def("face_geometry", &face_geometry, "positions"_a, "faces"_a, "centroids"_a, "areas"_a, "normals"_a,
          Unlocked());
    m.def("vertex_normals", &vertex_normals, "normals"_a, "starts"_a, "around"_a, "averaged"_a, Unlocked());
    m.def("follow_normals", &follow_normals, "positions"_a, "faces"_a, "starts"_a, "around"_a, "normals"_a,
          "iterations"_a, "free"_a, "offsets"_a, Unlocked());
}
