// The kernels of `codec` as functions of Python: by their names in C.
#include "bitstream/kernel.hpp"
#include "codec/guards.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

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
BSM_STRUCT(Lists, ConstLongs, ConstInts)
BSM_STRUCT(FaceGeometry, ConstDoubles2, ConstDoubles, ConstDoubles2)
BSM_STRUCT(Shading, double, double, int64_t)
BSM_STRUCT(Canvas, Singles2, Singles2, Singles2, Ints2, Ints)
BSM_STRUCT(Bends, double, double, double)
BSM_STRUCT(Tree, ConstDoubles2, ConstDoubles2, ConstDoubles2, ConstLongs, ConstLongs, ConstLongs)
BSM_STRUCT(Aim, double, double, int64_t)
BSM_STRUCT(NearCreases, Ints2, Bytes, Doubles)
BSM_STRUCT(Settled, ConstDoubles2, ConstDoubles2, ConstDoubles2, ConstDoubles2, ConstDoubles2, ConstDoubles)
BSM_STRUCT(Rates, ConstDoubles2, double, Doubles2)
BSM_STRUCT(Shaped, Doubles2, Ints2, Bytes)
BSM_STRUCT(Flaps, ConstInts2, ConstInts, ConstInts)
BSM_STRUCT(MotionScratch, Ints, Ints, Bytes, Doubles)
BSM_STRUCT(Creases, ConstInts2, ConstInts2, ConstBytes, ConstDoubles, ConstInts, ConstInts, double)

using namespace nb::literals;

void bind_codec(nb::module_ &m) {
    CHECKED(equal_rows)
    GUARDED(vertex_faces) GUARDED(geometric_laplacian) GUARDED(build_tree)
    GUARDED(nearest_distances) CHECKED(shown_normals) CHECKED(draw_shaded) CHECKED(paint_colors) CHECKED(paint_checker)
    CHECKED(averaged) CHECKED(contrast) CHECKED(foresee) CHECKED(bounds_along)
    CHECKED(measure_faces) GUARDED(add_copies) GUARDED(collect_edges) GUARDED(patch_guidance)
    GUARDED(weighed_normals) GUARDED(reach)
    GUARDED(face_geometry) GUARDED(follow_normals)
    GUARDED(cosines) GUARDED(project) GUARDED(reconstruct) CHECKED(show_frames) CHECKED(turn_columns)
    GUARDED(smooth_all) GUARDED(prolong) GUARDED(fit_cells)
    GUARDED(couple_cells) GUARDED(level_cells)
    m.attr("BATCH") = static_cast<int>(BATCH);
    m.attr("LEAST_KEPT") = static_cast<int>(LEAST_KEPT);
    // Freed arrays stay with the process, in glibc those below 32 MiB: this returns their pages to the system.
    m.def("return_free_memory", [] {
#ifdef __GLIBC__
        malloc_trim(0);
#endif
    }, nb::call_guard<nb::gil_scoped_release>());
    m.def("frames_kept", &frames_kept, "vertices"_a);
    GUARDED(label_components) GUARDED(weighted_angle)
    GUARDED(local_frames) GUARDED(tangent_steps) CHECKED(add_heights) CHECKED(add_slides)
    CHECKED(list_flaps)
    GUARDED(collect_flaps) GUARDED(shape_levels) CHECKED(collect_creases)
    CHECKED(find_motions) CHECKED(settle_levels) GUARDED(count_folds) GUARDED(unfold_levels) GUARDED(shape_grid)
}
