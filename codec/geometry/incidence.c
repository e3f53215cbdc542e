/* Faces around each vertex, in compressed rows. */
#include "codec/geometry/incidence.h"

/* Whether corner k of a face is the first one at its vertex. */
INLINE bool comes_first(const int32_t *face, int k) {
    return k == 0 || (face[k] != face[0] && (k == 1 || face[k] != face[1]));
}

/* Entries of `faces` are below `starts.size - 1`; `members` has room for three a face. A face that names a vertex twice
 * is listed once. */
void vertex_faces(ConstInts2 faces, Longs starts, Ints members) {
    int64_t n = starts.size - 1;
    for (int64_t v = 0; v <= n; v++) starts.data[v] = 0;
    for (int64_t f = 0; f < faces.rows; f++)
        for (int k = 0; k < 3; k++)
            if (comes_first(faces.data + 3 * f, k)) starts.data[faces.data[3 * f + k]]++;
    int64_t before = 0;
    for (int64_t v = 0; v <= n; v++) {
        int64_t count = starts.data[v];
        starts.data[v] = before;
        before += count;
    }
    for (int64_t f = 0; f < faces.rows; f++)
        for (int k = 0; k < 3; k++)
            if (comes_first(faces.data + 3 * f, k)) members.data[starts.data[faces.data[3 * f + k]]++] = (int32_t)f;
    /* Every start has moved to the end of its row, which is where the next one begins. */
    for (int64_t v = n; v > 0; v--) starts.data[v] = starts.data[v - 1];
    starts.data[0] = 0;
}
