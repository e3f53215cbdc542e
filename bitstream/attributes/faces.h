/* Values of attributes on faces. See faces.py and faces.c. */
#ifndef BSM_FACE_VALUES_H
#define BSM_FACE_VALUES_H

#include "bitstream/attributes/values.h"

/* As Python keeps it; m faces of c components. */
typedef struct {
    ConstInts largest; /* c: values of each component are 0 .. largest, below 2^20 */
    Ints2 values;      /* m x c */
    Ints2 gaps;        /* m x c: value less guess, in 1/16 */
    Ints2 memory;      /* c x 257: what came last in each of 256 contexts, and one more than the greatest so far */
} FaceValues;

int64_t code_faces(Coder coder, ValueModel model, Corners corners, FaceValues values, int64_t first, int64_t count);

#endif
