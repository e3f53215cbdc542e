/* What authors say of their meshes, each name once. */
#include "bitstream/container/container.h"

struct Branch {
    int64_t bit;       /* the first in which the names on both sides differ; after its end a name is a 0, then a 1 */
    void *side[2];     /* branches, or entries with their lowest bit set */
};

/* Bit `bit` of a name that is followed by a length of its own: no name begins another then. */
static int bit_of(Span name, int64_t bit) {
    int64_t byte = bit / 9;
    if (byte >= name.size) return 0;
    return bit % 9 == 0 ? 1 : name.data[byte] >> (8 - bit % 9) & 1;
}

static MetadataEntry *leaf_entry(void *node) { return (MetadataEntry *)((char *)node - 1); }
static bool is_entry(const void *node) { return (uintptr_t)node & 1; }

static MetadataEntry *nearest(const Metadata *metadata, Span name) {
    void *node = metadata->root;
    while (node != NULL && !is_entry(node)) {
        Branch *branch = node;
        node = branch->side[bit_of(name, branch->bit)];
    }
    return node != NULL ? leaf_entry(node) : NULL;
}

/* The first bit in which two names differ; -1 for the same name. */
static int64_t difference(Span a, Span b) {
    int64_t common = least(a.size, b.size), byte = 0;
    while (byte < common && a.data[byte] == b.data[byte]) byte++;
    if (byte == a.size && byte == b.size) return -1;
    int64_t bit = 9 * byte;
    while (bit_of(a, bit) == bit_of(b, bit)) bit++;
    return bit;
}

const MetadataEntry *find_name(const Metadata *metadata, Span name) {
    const MetadataEntry *entry = nearest(metadata, name);
    return entry != NULL && difference(entry->name, name) < 0 ? entry : NULL;
}

static bool copy_span(Arena *arena, Span *bytes) {
    uint8_t *copy;
    if (!TAKE(arena, bytes->size + 1, copy)) return false;
    if (bytes->size > 0) memcpy(copy, bytes->data, (size_t)bytes->size);
    copy[bytes->size] = 0;
    bytes->data = copy;
    return true;
}

static bool list_entry(Metadata *metadata, MetadataEntry *entry) {
    if (metadata->count == metadata->capacity) {
        int64_t capacity = 2 * metadata->capacity + 16;
        MetadataEntry **entries;
        if (!TAKE(&metadata->arena, capacity, entries)) return false;
        if (metadata->count > 0) memcpy(entries, metadata->entries, (size_t)metadata->count * sizeof *entries);
        metadata->entries = entries;
        metadata->capacity = capacity;
    }
    metadata->entries[metadata->count++] = entry;
    return true;
}

/* Take note of an entry whose name is not known yet. */
bool add_entry(Metadata *metadata, const Value *key, const Value *value) {
    Arena *arena = &metadata->arena;
    MetadataEntry *entry, *beside = nearest(metadata, key->bytes);
    Branch *branch = NULL;
    Span name = key->bytes, bytes = value->bytes;
    if (!TAKE(arena, 1, entry) || !copy_span(arena, &name) || !copy_span(arena, &bytes)
        || (beside != NULL && !TAKE(arena, 1, branch)) || !list_entry(metadata, entry))
        return false;
    *entry = (MetadataEntry){name, value->kind, value->whole, value->number, bytes};
    void *leaf = (char *)entry + 1;
    if (branch == NULL) {
        metadata->root = leaf;
        return true;
    }
    branch->bit = difference(beside->name, name);
    void **place = &metadata->root;
    while (!is_entry(*place) && ((Branch *)*place)->bit < branch->bit) {
        Branch *above = *place;
        place = &above->side[bit_of(name, above->bit)];
    }
    int side = bit_of(name, branch->bit);
    branch->side[side] = leaf;
    branch->side[!side] = *place;
    *place = branch;
    return true;
}
