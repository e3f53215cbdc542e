// The kernels of `codec` as functions of Python: one line each.
#include "bitstream/kernel.hpp"

extern "C" {
#include "codec/basis/basis.h"
#include "codec/blocks/blocks.h"
#include "codec/denoise/denoise.h"
#include "codec/geometry/geometry.h"
#include "codec/look/look.h"
#include "codec/sequence/temporal.h"
#include "codec/signal/signal.h"
#include "codec/static/choice/choice.h"
}

BSM_STRUCT(Wanted, ConstDoubles2, ConstInts2, ConstLongs, ConstInts, ConstInts, ConstInts, ConstDoubles2, ConstDoubles)
BSM_STRUCT(Aim, double, double, int64_t)
BSM_STRUCT(Creases, ConstInts2, ConstInts2, ConstBytes, ConstDoubles, ConstInts, ConstInts, double)

using namespace nb::literals;

#define NUMBER(name) std::pair<const char *, int>{#name, name}

template <typename T, size_t count> static nb::tuple tuple_of(const T (&numbers)[count]) {
    nb::list all;
    for (T number : numbers) all.append(number);
    return nb::tuple(all);
}

void bind_codec(nb::module_ &m) {
    m.def("vertex_faces", &vertex_faces, "faces"_a, "starts"_a, "members"_a, Unlocked());
    m.def("normals_apart", &normals_apart, "original"_a, "decoded"_a, "faces"_a, "around"_a, Unlocked());
    m.def("geometric_laplacian", &geometric_laplacian, "positions"_a, "starts"_a, "members"_a, "result"_a, Unlocked());
    m.def("build_tree", &build_tree, "lowest"_a, "highest"_a, "order"_a, "low"_a, "high"_a, "first"_a,
          "count"_a, Unlocked());
    m.def("nearest_distances", &nearest_distances, "points"_a, "triangles"_a, "low"_a, "high"_a, "first"_a, "count"_a,
          "distances"_a, Unlocked());
    m.def("shown_normals", checked<&shown_normals>, "positions"_a, "faces"_a, "joined"_a, "starts"_a, "around"_a,
          "cosine"_a, "half"_a, "most"_a, "crosses"_a, "normals"_a, Unlocked());
    m.def("draw_shaded", checked<&draw_shaded>, "positions"_a, "faces"_a, "normals"_a, "camera"_a, "placed"_a,
          "away"_a, "depth"_a, "farthest"_a, "picture"_a, "owner"_a, "drawn"_a, Unlocked());
    m.def("paint_colors", checked<&paint_colors>, "owner"_a, "placed"_a, "faces"_a, "values"_a, "picture"_a,
          "painted"_a, Unlocked());
    m.def("paint_checker", checked<&paint_checker>, "owner"_a, "placed"_a, "faces"_a, "values"_a, "steepness"_a,
          "dark"_a, "picture"_a, Unlocked());
    m.def("averaged", checked<&averaged>, "samples"_a, "small"_a, Unlocked());
    m.def("contrast", checked<&contrast>, "first"_a, "second"_a, "half"_a, "steady"_a, "scratch"_a, "sums"_a,
          Unlocked());
    m.def("add_copies", &add_copies, "sums"_a, "total"_a, "vertices"_a, "positions"_a, "weights"_a, Unlocked());
    m.def("collect_edges", &collect_edges, "faces"_a, "offsets"_a, "filled"_a, "ends"_a, "second"_a, Unlocked());
    m.def("patch_scores", &patch_scores, "normals"_a, "areas"_a, "starts"_a, "members"_a, "steps"_a,
          "inner_starts"_a, "inner"_a, "scores"_a, "means"_a, Unlocked());
    m.def("most_consistent", &most_consistent, "scores"_a, "means"_a, "starts"_a, "members"_a, "guide"_a, Unlocked());
    m.def("filter_normals", &filter_normals, "centroids"_a, "areas"_a, "normals"_a, "guide"_a, "starts"_a, "near"_a,
          "sigma_s"_a, "sigma_r"_a, "packed"_a, "filtered"_a, Unlocked());
    m.def("describe_faces", &describe_faces, "centroids"_a, "areas"_a, "normals"_a, "guide"_a, "smooth"_a, "axes"_a,
          "starts"_a, "near"_a, "distance"_a, "begin"_a, "described"_a, "frames"_a, Unlocked());
    m.def("reach", &reach, "points"_a, "starts"_a, "members"_a, "radius"_a, "begin"_a, "seen"_a, "reached_starts"_a,
          "reached"_a, Unlocked());
    m.def("face_patches", &face_patches, "faces"_a, "around_starts"_a, "around"_a, "crowd"_a, "seen"_a, "starts"_a,
          "members"_a, Unlocked());
    m.def("face_geometry", &face_geometry, "positions"_a, "faces"_a, "centroids"_a, "areas"_a, "normals"_a, Unlocked());
    m.def("pair_distances", &pair_distances, "values"_a, "pairs"_a, "distances"_a, Unlocked());
    m.def("vertex_normals", &vertex_normals, "normals"_a, "starts"_a, "around"_a, "averaged"_a, Unlocked());
    m.def("pull_in", &pull_in, "given"_a, "moved"_a, "normals"_a, "levels"_a, "aside"_a, "most"_a, "held"_a,
          Unlocked());
    m.def("follow_normals", &follow_normals, "positions"_a, "faces"_a, "starts"_a, "around"_a, "normals"_a,
          "iterations"_a, "free"_a, "planes"_a, "sums"_a, Unlocked());
    m.def("cosines", &cosines, "table"_a, "columns"_a, Unlocked());
    m.def("project", &project, "subspace"_a, "values"_a, "coefficients"_a, Unlocked());
    m.def("reconstruct", &reconstruct, "subspace"_a, "coefficients"_a, "values"_a, Unlocked());
    m.def("show_frames", checked<&show_frames>, "field"_a, "first"_a, "weights"_a, "frames"_a, Unlocked());
    m.def("multiply_matrices", checked<&multiply_matrices>, "left"_a, "right"_a, "result"_a, Unlocked());
    m.def("turn_columns", checked<&turn_columns>, "free"_a, "vector"_a, "shares"_a, Unlocked());
    m.def("back_into_unit", checked<&back_into_unit>, "positions"_a, "scale"_a, "center"_a, "moved"_a, Unlocked());
    m.def("place_block", checked<&place_block>, "prediction"_a, "subspace"_a, "levels"_a, "half_step"_a, "scratch"_a,
          "positions"_a, Unlocked());
    m.def("apply_powers", &apply_powers, "offsets"_a, "neighbors"_a, "terms"_a, "degree"_a, Unlocked());
    m.def("combine_powers", &combine_powers, "positions"_a, "terms"_a, "amount"_a, "smoothed"_a, Unlocked());
    m.def("smooth_all", checked<&smooth_all>, "offsets"_a, "neighbors"_a, "positions"_a, "amount"_a, "scratch"_a,
          "smoothed"_a, Unlocked());
    m.def("weigh_by_cotangents", &weigh_by_cotangents, "offsets"_a, "neighbors"_a, "faces"_a, "positions"_a,
          "weights"_a, Unlocked());
    // What both sides of a sequence have.
    for (const auto &[name, number] : {NUMBER(BENDING), NUMBER(INHERITED), NUMBER(BATCH), NUMBER(LEAST_KEPT),
             NUMBER(MOST_KEPT), NUMBER(POSITIONS_KEPT), NUMBER(TRACK_MEMORY), NUMBER(SPARE_MEMORY)})
        m.attr(name) = number;
    m.def("lags", [] { return tuple_of(LAG); }, nb::sig("def lags() -> tuple[int, ...]"));
    m.def("quarters", [] { return tuple_of(QUARTERS); }, nb::sig("def quarters() -> tuple[float, ...]"));
    m.def("bend_columns", &bend_columns, "part"_a, "positions"_a, "columns"_a, Unlocked());
    m.def("learn_around", &learn_around, "known"_a, "field"_a, "moments"_a, "step"_a, "mean"_a, "row"_a,
        Unlocked());
    m.def("search_rows", &search_rows, "known"_a, "targets"_a, "prices"_a, "weight"_a, "levels"_a, "decoded"_a,
        "moments"_a, "step"_a, "factor"_a, "row"_a, "expected"_a, "values"_a, "ways"_a, "origins"_a,
        Unlocked());
    m.def("label_components", checked<&label_components>, "offsets"_a, "neighbors"_a, "waiting"_a, "labels"_a,
          Unlocked());
    m.def("weighted_angle", &weighted_angle, "normals"_a, "weights"_a, "decoded"_a, "faces"_a, "lost"_a, Unlocked());
    m.def("farthest_apart", &farthest_apart, "original"_a, "decoded"_a, Unlocked());
    m.def("local_frames", checked<&local_frames>, "positions"_a, "faces"_a, "frames"_a, Unlocked());
    m.def("tangent_steps", checked<&tangent_steps>, "positions"_a, "faces"_a, "step"_a, "ratio"_a, "scratch"_a,
        "steps"_a, Unlocked());
    m.def("add_heights", checked<&add_heights>, "positions"_a, "frames"_a, "levels"_a, "step"_a, Unlocked());
    m.def("add_slides", checked<&add_slides>, "positions"_a, "frames"_a, "levels"_a, "steps"_a, Unlocked());
    m.def("collect_flaps", checked<&collect_flaps>, "faces"_a, "starts"_a, "members"_a, "pending"_a, "flaps"_a,
          Unlocked());
    m.def("group_flaps", checked<&group_flaps>, "flaps"_a, "starts"_a, "members"_a, Unlocked());
    m.def("shape_levels", checked<&shape_levels>, "wanted"_a, "aim"_a, "moved"_a, "levels"_a, "directions"_a,
          "scales"_a, "pull"_a, "open"_a, Unlocked());
    m.def("collect_creases", checked<&collect_creases>, "positions"_a, "faces"_a, "starts"_a, "around"_a, "most"_a,
          "cosine"_a, "least"_a, "largest"_a, "crosses"_a, "pairs"_a, "sharp"_a, "costs"_a, Unlocked());
    m.def("hang_creases", checked<&hang_creases>, "faces"_a, "pairs"_a, "starts"_a, "members"_a, Unlocked());
    m.def("find_motions", checked<&find_motions>, "positions"_a, "faces"_a, "degrees"_a, "worth"_a, "heads"_a,
          "links"_a, "covered"_a, "room"_a, "found"_a, Unlocked());
    m.def("settle_levels", checked<&settle_levels>, "offsets"_a, "normals"_a, "losses"_a, "steps"_a,
          "reach"_a, "starts"_a, "members"_a, "rates"_a, "pull"_a, "fixed"_a, "creases"_a, "places"_a, "frames"_a,
          "moved"_a, "levels"_a, "counts"_a, Unlocked());
    m.def("count_folds", checked<&count_folds>, "positions"_a, "flaps"_a, Unlocked());
    m.def("unfold_levels", checked<&unfold_levels>, "wanted"_a, "reach"_a, "moved"_a, "levels"_a, "directions"_a,
        "flaps"_a, "starts"_a, "members"_a, "most"_a, "wrong"_a, "open"_a, Unlocked());
    m.def("shape_grid", checked<&shape_grid>, "wanted"_a, "aim"_a, "moved"_a, "places"_a, "step"_a, "flaps"_a,
          "starts"_a, "members"_a, "bends"_a, "rates"_a, "open"_a, Unlocked());
}
