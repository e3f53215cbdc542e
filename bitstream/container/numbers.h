/* Numbers of the container that its writers and its readers need (specification, F, S 2.1). */
#pragma once

enum {
    MAJOR = 1,            /* version of the format */
    SHORT_PAYLOAD = 128,  /* a payload of fewer bytes has a short checksum */
    MOST_NAME = 255,      /* bytes */
    MOST_GIVEN = 1 << 24, /* vertices, so that every number of one can be coded */
    MOST_COPIES = 16, FREE_COPIES = 1 << 16, /* rows of all blocks, at most: for each vertex, and in addition */
    METHODS = 8, RUNS = 32, WITH_ATTRIBUTES = 4, /* in the first byte of a GOP */
};
