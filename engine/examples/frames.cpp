// Goes through the frames of a sequence as a game would, without a window: an update for each frame, a mesh for each run.
// cc -c bsmdec.c && c++ -std=c++17 frames.cpp bsmdec.o -lm && ./a.out dance.bsm
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <vector>

#include "bsmdec.h"

// What an engine would hand to the graphics card.
struct Mesh {
    std::vector<uint32_t> corners;
    std::vector<float> positions;
};

class Player {
public:
    explicit Player(const std::vector<char> &stream, int64_t start = 0) {
        bsmdec_options options{};
        options.start = start;
        decoder.reset(bsmdec_open(&options));
        if (!decoder) throw std::bad_alloc();
        bsmdec_push(decoder.get(), stream.data(), stream.size());
        bsmdec_finish(decoder.get());
    }

    // The next frame in `mesh`, or false behind the last one.
    bool next(Mesh &mesh, int64_t &frame) {
        for (bsmdec_event event; bsmdec_next(decoder.get(), &event) == BSMDEC_OK;) {
            if (event.type == BSMDEC_CONNECTIVITY) { // of a run: faces change
                mesh.corners.resize(3 * event.faces);
                mesh.positions.resize(3 * event.vertices);
                bsmdec_faces(decoder.get(), mesh.corners.data(), mesh.corners.size());
            } else if (event.type == BSMDEC_FRAME) {
                frame = event.index;
                return bsmdec_positions_single(decoder.get(), mesh.positions.data(), mesh.positions.size()) == BSMDEC_OK;
            } else if (event.type == BSMDEC_END) {
                return false;
            }
        }
        throw std::runtime_error(bsmdec_last_error(decoder.get())->message);
    }

private:
    struct Close {
        void operator()(bsmdec *decoder) const { bsmdec_close(decoder); }
    };
    std::unique_ptr<bsmdec, Close> decoder;
};

int main(int count, char **arguments) try {
    if (count < 2) throw std::runtime_error("usage: frames SEQUENCE.bsm [FIRST FRAME]");
    std::ifstream file(arguments[1], std::ios::binary);
    std::vector<char> stream((std::istreambuf_iterator<char>(file)), {});
    Player player(stream, count > 2 ? std::stoll(arguments[2]) : 0);
    Mesh mesh;
    for (int64_t frame; player.next(mesh, frame);) {
        float low = 0, high = 0; // here the game would draw; this says how far the shape reaches
        for (size_t v = 0; v < mesh.positions.size(); v += 3) {
            low = v ? std::min(low, mesh.positions[v]) : mesh.positions[v];
            high = v ? std::max(high, mesh.positions[v]) : mesh.positions[v];
        }
        std::printf("frame %lld: %zu faces, x from %.6g to %.6g\n", static_cast<long long>(frame), mesh.corners.size() / 3, low, high);
    }
    return 0;
} catch (const std::exception &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
