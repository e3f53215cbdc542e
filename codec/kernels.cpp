// The kernels of `codec` as functions of Python: by their names in C.
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

void bind_codec(nb::module_ &m) {
    KERNEL(vertex_faces) KERNEL(normals_apart) KERNEL(geometric_laplacian) KERNEL(build_tree)
    KERNEL(nearest_distances) CHECKED(shown_normals) CHECKED(draw_shaded) CHECKED(paint_colors) CHECKED(paint_checker)
    CHECKED(averaged) CHECKED(contrast) KERNEL(add_copies) KERNEL(collect_edges) KERNEL(patch_guidance)
    KERNEL(filter_normals) KERNEL(describe_faces) KERNEL(reach) KERNEL(face_patches)
    KERNEL(face_geometry) KERNEL(pair_distances) KERNEL(follow_normals)
    KERNEL(cosines) KERNEL(project) KERNEL(reconstruct) CHECKED(show_frames) CHECKED(turn_columns)
    CHECKED(smooth_all)
    m.attr("BATCH") = static_cast<int>(BATCH);
    m.attr("LEAST_KEPT") = static_cast<int>(LEAST_KEPT);
    m.def("frames_kept", &frames_kept, "vertices"_a);
    CHECKED(label_components) KERNEL(weighted_angle)
    CHECKED(local_frames) CHECKED(tangent_steps) CHECKED(add_heights) CHECKED(add_slides)
    CHECKED(collect_flaps) CHECKED(shape_levels) CHECKED(collect_creases)
    CHECKED(find_motions) CHECKED(settle_levels) CHECKED(count_folds) CHECKED(unfold_levels) CHECKED(shape_grid)
}
