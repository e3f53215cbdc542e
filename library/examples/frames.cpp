// Plays a sequence as a game would, without a window: one buffer of vertices, new values for each frame.
// cc -O2 -c bsmdec.c && c++ -std=c++17 frames.cpp bsmdec.o -lm && ./a.out dance.bsm
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bsmdec.h"

// What the graphics card gets: vertices are split where texture coordinates or normals differ.
struct Vertex {
    float position[3];
    int8_t normal[4];
    float texcoord[2];
};

struct Release {
    void operator()(bsmdec_mesh *mesh) const { bsmdec_release(mesh); }
};
using Mesh = std::unique_ptr<bsmdec_mesh, Release>;

static Mesh decode(const std::vector<char> &stream, int64_t start) {
    const bsmdec_field fields[] = {
        {BSMDEC_POSITION, nullptr, BSMDEC_FLOAT32, 3, offsetof(Vertex, position)},
        {BSMDEC_NORMAL, nullptr, BSMDEC_INT8, 3, offsetof(Vertex, normal)},
        {BSMDEC_TEXCOORD, nullptr, BSMDEC_FLOAT32, 2, offsetof(Vertex, texcoord)},
    };
    bsmdec_options options{};
    options.size = sizeof options;
    options.start = start;
    options.fields = fields;
    options.field_count = std::size(fields);
    options.stride = sizeof(Vertex);
    bsmdec_mesh *mesh = nullptr;
    bsmdec_status status = bsmdec_decode(stream.data(), stream.size(), &options, &mesh);
    Mesh owned(mesh);
    if (status != BSMDEC_OK) throw std::runtime_error(mesh->error->message);
    return owned;
}

int main(int count, char **arguments) try {
    if (count < 2) throw std::runtime_error("usage: frames SEQUENCE.bsm [FIRST FRAME]");
    std::ifstream file(arguments[1], std::ios::binary);
    std::vector<char> stream((std::istreambuf_iterator<char>(file)), {});
    Mesh mesh = decode(stream, count > 2 ? std::stoll(arguments[2]) : 0);
    while (mesh->frame >= 0) {
        // Here a game would upload mesh->vertex_data and draw. This program prints how far the shape reaches.
        const Vertex *vertices = static_cast<const Vertex *>(mesh->vertex_data);
        auto [low, high] = std::minmax_element(vertices, vertices + mesh->vertices,
            [](const Vertex &a, const Vertex &b) { return a.position[0] < b.position[0]; });
        std::printf("frame %lld of %lld: %lld faces, x from %.6g to %.6g\n", static_cast<long long>(mesh->frame),
            static_cast<long long>(mesh->frames), static_cast<long long>(mesh->faces), low->position[0],
            high->position[0]);
        if (bsmdec_advance(mesh.get()) != BSMDEC_OK) throw std::runtime_error(mesh->error->message);
    }
    return 0;
} catch (const std::exception &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
