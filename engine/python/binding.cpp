// bsmdec as a class of Python. Arrays are numpy's own; nothing is decoded under the interpreter's lock.
#include <cstring>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

extern "C" {
#include "engine/python/inside.h"
}

namespace nb = nanobind;
using namespace nb::literals;

namespace {

// Fields of bsmdec_limits, which have the names of bsm.Limits.
const struct {
    const char *name;
    double bsmdec_limits::*field;
} LIMITS[] = {
#define LIMIT(name) {#name, &bsmdec_limits::name}
    LIMIT(vertices), LIMIT(faces), LIMIT(blocks), LIMIT(block_size), LIMIT(coefficients), LIMIT(frames),
    LIMIT(gop_frames), LIMIT(frame_bytes), LIMIT(metadata_bytes), LIMIT(attributes), LIMIT(attribute_values),
    LIMIT(sequence_bytes), LIMIT(field_bytes), LIMIT(work), LIMIT(work_per_vertex), LIMIT(work_per_byte),
    LIMIT(most_work), LIMIT(memory), LIMIT(memory_per_vertex), LIMIT(memory_per_byte), LIMIT(most_memory),
#undef LIMIT
};
const char *const KINDS[] = {"uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64"};

struct Array {
    nb::object numpy;
    void *data;
    size_t bytes;
};

Array array_of(const char *kind, size_t rows, size_t columns = 0) {
    nb::object shape = columns > 0 ? nb::object(nb::make_tuple(rows, columns)) : nb::object(nb::int_(rows));
    nb::object made = nb::module_::import_("numpy").attr("empty")(shape, kind);
    auto view = nb::cast<nb::ndarray<nb::c_contig, nb::device::cpu>>(made);
    return {made, view.data(), view.nbytes()};
}

nb::object copy_of(const void *data, const char *kind, size_t rows, size_t columns = 0) {
    Array made = array_of(kind, rows, columns);
    if (made.bytes > 0) std::memcpy(made.data, data, made.bytes);
    return made.numpy;
}

// Text that a message may have cut inside a character.
nb::object text_of(const char *text) {
    return nb::steal(PyUnicode_DecodeUTF8(text, (Py_ssize_t)std::strlen(text), "ignore"));
}

// Runs tasks of a decoder side by side: each on a thread of its own, the first on the caller's.
void run_tasks(void *, int count, void (*task)(void *context, int index), void *context) {
    std::vector<std::thread> threads;
    int next = 1;
    try {
        threads.reserve((size_t)count);
        for (; next < count; next++) threads.emplace_back(task, context, next);
    } catch (const std::exception &) { // no more threads: the caller's does the rest
        for (; next < count; next++) task(context, next);
    }
    task(context, 0);
    for (std::thread &thread : threads) thread.join();
}

class Decoder {
  public:
    Decoder(nb::object limits, int64_t threads, bool tolerant, int64_t start, int64_t layers)
        : given(std::move(limits)) {
        bsmdec_limits bounds;
        bsmdec_default_limits(&bounds, sizeof bounds);
        for (const auto &[name, field] : LIMITS) bounds.*field = nb::cast<double>(nb::float_(given.attr(name)));
        bsmdec_parallel parallel = {sizeof parallel, run_tasks, nullptr, threads};
        bsmdec_options options = {};
        options.size = sizeof options;
        options.limits = &bounds;
        options.tolerant = tolerant;
        options.start = start;
        options.layers = layers;
        if (threads > 1) options.parallel = &parallel;
        decoder = bsmdec_open(&options);
        if (decoder == nullptr) throw std::bad_alloc();
    }
    ~Decoder() { bsmdec_close(decoder); }
    Decoder(const Decoder &) = delete;

    void push(nb::ndarray<const uint8_t, nb::ndim<1>, nb::c_contig, nb::device::cpu> bytes) {
        const void *data = bytes.data();
        size_t size = bytes.size();
        locked([&] { return bsmdec_push(decoder, data, size); });
    }

    void finish() {
        locked([&] { return bsmdec_finish(decoder); });
    }

    // The next event of a wanted type, or one that nothing follows for now: type, index, count, vertices, faces.
    nb::tuple next(uint32_t wanted) {
        wanted |= 1u << BSMDEC_NEED_DATA | 1u << BSMDEC_END_OF_STREAM;
        bsmdec_event event;
        bsmdec_status status;
        do {
            status = locked([&] {
                bsmdec_status found;
                int left = 64;  // then signals are looked at
                do found = bsmdec_next(decoder, &event);
                while (found == BSMDEC_OK && --left > 0 && !(wanted >> event.type & 1));
                return found;
            });
            if (PyErr_CheckSignals() != 0) throw nb::python_error();
            if (status != BSMDEC_OK) raise_error();
        } while (!(wanted >> event.type & 1));
        return nb::make_tuple((int)event.type, event.index, event.count, event.vertices, event.faces);
    }

    // Check the packets that have come without decoding them; no other call makes sense for this decoder.
    void skim() { check(locked([&] { return decoder_skim(decoder); })); }

    nb::object faces(size_t count) {
        Array made = array_of("int32", count, 3);
        check(locked([&] { return bsmdec_faces(decoder, (uint32_t *)made.data, 3 * count); }));
        return made.numpy;
    }

    nb::object positions(size_t count) {
        Array made = array_of("float64", count, 3);
        check(locked([&] { return bsmdec_positions(decoder, (double *)made.data, 3 * count); }));
        return made.numpy;
    }

    nb::tuple changes() {
        bsmdec_changes found;
        check(locked([&] { return bsmdec_read_changes(decoder, &found); }));
        return tuple_of(found);
    }

    nb::tuple loose() {
        bsmdec_changes found;
        check(locked([&] { return bsmdec_read_loose(decoder, &found); }));
        return tuple_of(found);
    }

    nb::tuple losses() {
        bsmdec_losses found;
        check(locked([&] { return bsmdec_read_losses(decoder, &found); }));
        return nb::make_tuple(copy_of(found.missing, "int32", (size_t)found.missing_count),
            copy_of(found.degraded, "int32", (size_t)found.degraded_count));
    }

    nb::tuple metadata(int64_t index) {
        bsmdec_metadata entry;
        check(locked([&] { return bsmdec_metadata_at(decoder, index, &entry); }));
        const char *bytes = (const char *)entry.bytes;
        nb::object value = entry.type == BSMDEC_WHOLE ? nb::object(nb::int_(entry.whole))
            : entry.type == BSMDEC_NUMBER             ? nb::object(nb::float_(entry.number)) : entry.type == BSMDEC_TEXT
            ? nb::object(nb::str(bytes, entry.size)) : nb::object(nb::bytes(bytes, entry.size));
        return nb::make_tuple(nb::str(entry.name), value);
    }

    int attribute_count() { return bsmdec_attribute_count(decoder); }

    // (name, domain, semantic, values, indices or None, whether it moves); None if it is not whole.
    nb::object attribute(int index) {
        bsmdec_attribute shape;
        if (locked([&] { return bsmdec_attribute_at(decoder, index, &shape); }) != BSMDEC_OK) return nb::none();
        Array made = array_of(KINDS[shape.kind], (size_t)shape.rows, (size_t)shape.components);
        check(locked([&] { return bsmdec_attribute_values(decoder, index, made.data, made.bytes); }));
        return nb::make_tuple(shape.name, shape.domain, shape.semantic, made.numpy, indices(index, shape),
            shape.moves != 0);
    }

    // The part that came last: (name, domain, semantic, indices or None, rows, values).
    nb::tuple values(int index) {
        bsmdec_values found;
        check(locked([&] { return bsmdec_read_values(decoder, index, &found); }));
        const bsmdec_attribute &shape = found.attribute;
        return nb::make_tuple(shape.name, shape.domain, shape.semantic, indices(index, shape),
            copy_of(found.rows, "int32", (size_t)found.count),
            copy_of(found.values, KINDS[shape.kind], (size_t)found.count, (size_t)shape.components));
    }

    // The numbers of engine/header.h, in the order of `list_header`.
    nb::list header() {
        double numbers[MOST_HEADER_NUMBERS] = {};
        locked([&] { return decoder_header(decoder, numbers), BSMDEC_OK; });
        nb::list all;
        for (double number : numbers) all.append(number);
        return all;
    }

    nb::list state() {
        double numbers[STATE_NUMBERS];
        locked([&] { return decoder_state(decoder, numbers), BSMDEC_OK; });
        nb::list all;
        for (double number : numbers) all.append(number);
        return all;
    }

    // The loss of the last LOSS event, as an error.
    nb::object loss() { return error_of(*bsmdec_last_loss(decoder)); }

  private:
    bsmdec *decoder;
    nb::object given;
    std::mutex mutex; // threads of Python may share a decoder, which belongs to one at a time

    template <typename Work> bsmdec_status locked(Work work) {
        nb::gil_scoped_release released;
        std::lock_guard<std::mutex> guard(mutex);
        return work();
    }

    static nb::tuple tuple_of(const bsmdec_changes &found) {
        size_t count = (size_t)found.count;
        return nb::make_tuple(copy_of(found.vertices, "int32", count), copy_of(found.positions, "float64", count, 3),
            copy_of(found.final, "bool", count));
    }

    nb::object indices(int index, const bsmdec_attribute &shape) {
        if (shape.indices == 0) return nb::none();
        Array made = array_of("int32", (size_t)shape.indices / 3, 3);
        check(locked(
            [&] { return bsmdec_attribute_indices(decoder, index, (uint32_t *)made.data, (size_t)shape.indices); }));
        return made.numpy;
    }

    nb::object error_of(const bsmdec_error &error) {
        return nb::module_::import_("bsm.bitstream.limits").attr("decoder_error")(
            (int)error.status, text_of(error.message), error.offset, error.frame, error.block, given, state());
    }

    [[noreturn]] void raise_error() {
        nb::object error = error_of(*bsmdec_last_error(decoder));
        PyErr_SetObject((PyObject *)Py_TYPE(error.ptr()), error.ptr());
        throw nb::python_error();
    }

    void check(bsmdec_status status) {
        if (status == BSMDEC_OK) return;
        if (status != BSMDEC_MISUSED) raise_error();
        throw nb::value_error(bsmdec_last_misuse(decoder));
    }
};

}  // namespace

NB_MODULE(_engine, m) {
    nb::set_leak_warnings(false); /* the traceback of an error keeps its decoder until the process ends */
    m.attr("version") = BSM_VERSION;
    nb::class_<Decoder>(m, "Decoder")
        .def(nb::init<nb::object, int64_t, bool, int64_t, int64_t>(), "limits"_a, "threads"_a = 1,
            "tolerant"_a = false, "start"_a = 0, "layers"_a = 0)
        .def("push", &Decoder::push, "bytes"_a)
        .def("finish", &Decoder::finish)
        .def("next", &Decoder::next, "wanted"_a,
            nb::sig("def next(self, wanted: int) -> tuple[int, int, int, int, int]"))
        .def("skim", &Decoder::skim)
        .def("faces", &Decoder::faces, "count"_a,
            nb::sig("def faces(self, count: int) -> numpy.typing.NDArray[numpy.int32]"))
        .def("positions", &Decoder::positions, "count"_a,
            nb::sig("def positions(self, count: int) -> numpy.typing.NDArray[numpy.float64]"))
        .def("changes", &Decoder::changes,
            nb::sig("def changes(self) -> tuple[numpy.typing.NDArray[numpy.int32], "
                    "numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.bool_]]"))
        .def("loose", &Decoder::loose,
            nb::sig("def loose(self) -> tuple[numpy.typing.NDArray[numpy.int32], "
                    "numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.bool_]]"))
        .def("losses", &Decoder::losses,
            nb::sig("def losses(self) -> tuple[numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.int32]]"))
        .def("metadata", &Decoder::metadata, "index"_a,
            nb::sig("def metadata(self, index: int) -> tuple[str, typing.Any]"))
        .def("attribute_count", &Decoder::attribute_count)
        .def("attribute", &Decoder::attribute, "index"_a,
            nb::sig("def attribute(self, index: int) -> tuple[str, int, int, typing.Any, typing.Any, bool] | None"))
        .def("values", &Decoder::values, "index"_a,
            nb::sig("def values(self, index: int) -> tuple[str, int, int, typing.Any, "
                    "numpy.typing.NDArray[numpy.int32], typing.Any]"))
        .def("header", &Decoder::header,
            nb::sig("def header(self) -> list[float]"))
        .def("state", &Decoder::state,
            nb::sig("def state(self) -> list[float]"))
        .def("loss", &Decoder::loss, nb::sig("def loss(self) -> typing.Any"));
}
