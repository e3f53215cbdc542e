/* What is given to the encoder, and whether its streams keep what they promise. */
#pragma once

#include "library/encode/carrying.h"
#include "library/encode/moving.h"
#include "library/encode/rounding.h"

typedef struct {
    bsmenc_stream stream; /* the user's, first */
    bsmdec_allocator host;
    Writer writer;
    const bsmenc_mesh *mesh;
    bsmenc_options options;
    GivenMesh given;
    JoinedMesh joined;
    CodedMesh coded;
    Rounded rounded;
    Motion motion;        /* of a sequence */
    Doubles2 positions;   /* that a decoder has of the coded vertices */
    bsmenc_attribute *attributes; /* those that are carried, with their qualities */
    Carried *carried;
    int carried_count;
    StreamWriter out;
} Encoder;

/* Check what the user has given, and copy what is needed of it. */
bool check_mesh(Encoder *encoder);
/* Decode the stream with bsmdec and compare it with what was given. */
bool prove_stream(Encoder *encoder);
