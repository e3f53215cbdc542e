/* Pictures of surfaces, and how much two of them differ to the eye. */
#pragma once

#include "codec/geometry/geometry.h"

/* How bright a face is that the light passes, how much brighter one that faces it, and the background. */
#define AMBIENT 0.12f
#define DIFFUSE 0.78f
#define BACKGROUND 1.0f

/* How viewers shade: faces whose bend has a larger cosine are smooth; `half` is that of a little less than half that
 * angle; a vertex with more than `most` faces smooths nothing. */
typedef struct {
    double cosine, half;
    int64_t most;
} Shading;

/* `farthest` has a number for each tile of the picture. `owner` gets the face that each pixel shows, or -1, if it has
 * any rows. Outside of `drawn` (its first row, the one after its last, and columns), `depth` and `picture` are
 * empty. */
typedef struct {
    Singles2 depth, farthest, picture;
    Ints2 owner;
    Ints drawn;
} Canvas;

int64_t averaged(ConstSingles2 samples, Singles2 small);
int64_t contrast(ConstSingles2 first, ConstSingles2 second, ConstSingles half, double steady, Singles2 scratch,
    Doubles sums);
int64_t shown_normals(ConstDoubles2 positions, ConstInts2 faces, ConstInts2 joined, Lists around, Shading shading,
    Doubles2 crosses, Singles2 normals);
int64_t draw_shaded(ConstDoubles2 positions, ConstInts2 faces, ConstSingles2 normals, ConstDoubles camera,
    Doubles2 placed, Ints away, Canvas on);
int64_t paint_colors(ConstInts2 owner, ConstDoubles2 placed, ConstInts2 faces, ConstDoubles2 values,
    ConstSingles2 picture, Singles2 painted);
int64_t paint_checker(ConstInts2 owner, ConstDoubles2 placed, ConstInts2 faces, ConstDoubles2 values,
    ConstDoubles steepness, double dark, Singles2 picture);
int64_t foresee(ConstDoubles2 original, ConstDoubles2 decoded, ConstInts2 faces, ConstInts2 edges, ConstDoubles2 views,
    Doubles2 around, Bytes facing, Doubles2 sums);
int64_t bounds_along(ConstDoubles2 positions, ConstDoubles2 directions, Doubles2 bounds);
int64_t measure_faces(ConstDoubles2 positions, ConstInts2 faces, Doubles2 lengths, Doubles areas, Doubles2 bounds);
