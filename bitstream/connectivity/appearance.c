/* The numbers that a decoder gives vertices: in the order of their first appearance (specification, C 7.2 and C 8.1). */
#include "bitstream/connectivity/appearance.h"

/* The distinct values in the order of their first appearance, and the number of each value there, -1 if it does not
 * occur; both arrays have an entry for each possible value. Returns how many there are. */
int64_t number_by_appearance(ConstInts sequence, Ints order, Ints number) {
    int64_t size = number.size;
    if (order.size != size || size > INT32_MAX) return MISUSED;
    for (int64_t v = 0; v < size; v++) number.data[v] = -1;
    int32_t count = 0;
    for (int64_t i = 0; i < sequence.size; i++) {
        int32_t value = sequence.data[i];
        if (value < 0 || value >= size) return MISUSED;
        if (number.data[value] < 0) {
            number.data[value] = count;
            order.data[count++] = value;
        }
    }
    return count;
}
