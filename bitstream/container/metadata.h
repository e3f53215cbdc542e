/* Metadata: what authors say of their meshes, each name once (specification, F 3.9, F 5.1). */
#pragma once

#include "bitstream/container/maps.h"

/* What the author says of a mesh, one entry. */
typedef struct {
    Span name;
    Kind kind;
    int64_t whole;
    double number;
    Span bytes;
} MetadataEntry;

typedef struct Branch Branch;
/* Entries by name: a tree by the first bit in which names differ, so that no names take longer than their bits. */
typedef struct {
    Arena arena;
    void *root;
    MetadataEntry **entries;
    int64_t count, room;
} Metadata;

/* The entry of a name, NULL if there is none. */
const MetadataEntry *find_name(const Metadata *metadata, Span name);
bool add_entry(Metadata *metadata, const Value *key, const Value *value);
