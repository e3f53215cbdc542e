// bsmdec as a class of Python. Arrays are numpy's own; nothing is decoded under the interpreter's lock.
#include <cstring>
#include <memory>
#include <memory>
#include <mutex>
#include <optional>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
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
const nb::dlpack::dtype KINDS[] = {nb::dtype<uint8_t>(), nb::dtype<int8_t>(), nb::dtype<uint16_t>(),
    nb::dtype<int16_t>(),
    nb::dtype<uint32_t>(), nb::dtype<int32_t>(), nb::dtype<float>(), nb::dtype<double>()};

// Numbers of our own, which become an array of numpy without another copy.
template <typename Number = uint8_t> struct Array {
    size_t rows = 0, columns = 0, bytes = 0;
    nb::dlpack::dtype kind = nb::dtype<Number>();
    std::unique_ptr<uint8_t[]> memory;

    Array() = default;
    Array(size_t rows, size_t columns, nb::dlpack::dtype kind = nb::dtype<Number>())
        : rows(rows), columns(columns), bytes(rows * (columns > 0 ? columns : 1) * kind.bits / 8), kind(kind),
          memory(new uint8_t[bytes]) {}
    Array(const void *from, size_t rows, size_t columns = 0, nb::dlpack::dtype kind = nb::dtype<Number>())
        : Array(rows, columns, kind) {
        if (bytes > 0) std::memcpy(memory.get(), from, bytes);
    }

    Number *data() { return (Number *)memory.get(); }
    nb::object numpy() {
        const size_t shape[] = {rows, columns};
        uint8_t *all = memory.release();
        nb::capsule owner(all, [](void *held) noexcept { delete[] (uint8_t *)held; });
        return nb::cast(nb::ndarray<nb::numpy>(all, columns > 0 ? 2 : 1, shape, owner, nullptr, kind));
    }
};

// What the decoder said about a call, copied while it could not say anything else.
struct Outcome {
    bsmdec_status status;
    bsmdec_error error;
    std::string misuse;
    double state[STATE_NUMBERS];
};

struct Changed {
    Array<int32_t> vertices;
    Array<double> positions;
    Array<bool> final;
    explicit Changed(const bsmdec_changes &found)
        : vertices(found.vertices, (size_t)found.count), positions(found.positions, (size_t)found.count, 3),
          final(found.final, (size_t)found.count) {}
};

nb::list list_of(const double *numbers, size_t count) {
    nb::list all;
    for (size_t i = 0; i < count; i++) all.append(numbers[i]);
    return all;
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

// Only `locked` touches the decoder: each call copies what it returns before another thread can have the decoder.
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
        do {
            Outcome outcome = locked([&] {
                bsmdec_status found;
                int left = 64; // then signals are looked at
                do found = bsmdec_next(decoder, &event);
                while (found == BSMDEC_OK && --left > 0 && !(wanted >> event.type & 1));
                return found;
            });
            if (PyErr_CheckSignals() != 0) throw nb::python_error();
            check(outcome);
        } while (!(wanted >> event.type & 1));
        return nb::make_tuple((int)event.type, event.index, event.count, event.vertices, event.faces);
    }

    // Name and numbers of the next packet (see inside.h); None: it has not come as a whole.
    nb::object skim() {
        int64_t numbers[SKIMMED_NUMBERS] = {};
        const char *name = "";
        check(locked([&] { return name = decoder_skim(decoder, numbers), bsmdec_last_error(decoder)->status; }));
        if (numbers[0] < 0) return nb::none();
        nb::list all;
        for (int64_t number : numbers) all.append(number);
        return nb::make_tuple(text_of(name), all);
    }

    nb::object faces(size_t count) {
        Array<uint32_t> made(count, 3, nb::dtype<int32_t>());
        check(locked([&] { return bsmdec_faces(decoder, made.data(), 3 * count); }));
        return made.numpy();
    }

    nb::object positions(size_t count) {
        Array<double> made(count, 3);
        check(locked([&] { return bsmdec_positions(decoder, made.data(), 3 * count); }));
        return made.numpy();
    }

    nb::tuple changes() { return changed_by(bsmdec_read_changes); }

    nb::tuple loose() { return changed_by(bsmdec_read_loose); }

    nb::tuple losses() {
        Array<int32_t> missing, degraded;
        check(locked([&] {
            bsmdec_losses found;
            bsmdec_status status = bsmdec_read_losses(decoder, &found);
            if (status != BSMDEC_OK) return status;
            missing = {found.missing, (size_t)found.missing_count};
            degraded = {found.degraded, (size_t)found.degraded_count};
            return status;
        }));
        return nb::make_tuple(missing.numpy(), degraded.numpy());
    }

    nb::tuple metadata(int64_t index) {
        bsmdec_metadata entry;
        std::string name, bytes;
        check(locked([&] {
            bsmdec_status status = bsmdec_metadata_at(decoder, index, &entry);
            if (status != BSMDEC_OK) return status;
            name = entry.name;
            bytes.assign((const char *)entry.bytes, entry.size);
            return status;
        }));
        nb::object value = entry.type == BSMDEC_WHOLE ? nb::object(nb::int_(entry.whole))
            : entry.type == BSMDEC_NUMBER             ? nb::object(nb::float_(entry.number)) : entry.type == BSMDEC_TEXT
            ? nb::object(nb::str(bytes.data(), bytes.size())) : nb::object(nb::bytes(bytes.data(), bytes.size()));
        return nb::make_tuple(name, value);
    }

    int attribute_count() {
        int count = 0;
        locked([&] { return count = bsmdec_attribute_count(decoder), BSMDEC_OK; });
        return count;
    }

    // (name, domain, semantic, values, indices or None, whether it moves); None if it is not whole.
    nb::object attribute(int index) {
        bsmdec_attribute shape = {};
        std::string name;
        Array<> values;
        Array<uint32_t> corners;
        Outcome outcome = locked([&] {
            bsmdec_status status = bsmdec_attribute_at(decoder, index, &shape);
            if (status != BSMDEC_OK) return status;
            name = shape.name;
            values = {(size_t)shape.rows, (size_t)shape.components, KINDS[shape.kind]};
            status = bsmdec_attribute_values(decoder, index, values.data(), values.bytes);
            return status == BSMDEC_OK ? read_indices(index, shape, &corners) : status;
        });
        if (outcome.status == BSMDEC_MISUSED) return nb::none();
        check(outcome);
        return nb::make_tuple(name, shape.domain, shape.semantic, values.numpy(), or_none(corners), shape.moves != 0);
    }

    // The part that came last: (name, domain, semantic, indices or None, rows, values).
    nb::tuple values(int index) {
        bsmdec_attribute shape = {};
        std::string name;
        Array<uint32_t> corners;
        Array<int32_t> rows;
        Array<> values;
        check(locked([&] {
            bsmdec_values found;
            bsmdec_status status = bsmdec_read_values(decoder, index, &found);
            if (status != BSMDEC_OK) return status;
            shape = found.attribute;
            name = shape.name;
            rows = {found.rows, (size_t)found.count};
            values = {found.values, (size_t)found.count, (size_t)shape.components, KINDS[shape.kind]};
            return read_indices(index, shape, &corners);
        }));
        return nb::make_tuple(name, shape.domain, shape.semantic, or_none(corners), rows.numpy(), values.numpy());
    }

    // The numbers of engine/header.h, in the order of `list_header`.
    nb::list header() {
        double numbers[MOST_HEADER_NUMBERS] = {};
        locked([&] { return decoder_header(decoder, numbers), BSMDEC_OK; });
        return list_of(numbers, MOST_HEADER_NUMBERS);
    }

    nb::list state() {
        double numbers[STATE_NUMBERS];
        locked([&] { return decoder_state(decoder, numbers), BSMDEC_OK; });
        return list_of(numbers, STATE_NUMBERS);
    }

    // The loss of the last LOSS event, as an error.
    nb::object loss() {
        Outcome outcome;
        locked([&] {
            outcome.error = *bsmdec_last_loss(decoder);
            return decoder_state(decoder, outcome.state), BSMDEC_OK;
        });
        return error_of(outcome);
    }

  private:
    bsmdec *decoder;
    nb::object given;
    std::mutex mutex; // threads of Python may share a decoder, which belongs to one at a time

    template <typename Work> Outcome locked(Work work) {
        nb::gil_scoped_release released;
        std::lock_guard<std::mutex> guard(mutex);
        Outcome outcome = {};
        outcome.status = work();
        if (outcome.status == BSMDEC_OK) return outcome;
        outcome.error = *bsmdec_last_error(decoder);
        outcome.misuse = bsmdec_last_misuse(decoder);
        decoder_state(decoder, outcome.state);
        return outcome;
    }

    nb::tuple changed_by(bsmdec_status (*read)(bsmdec *, bsmdec_changes *)) {
        std::optional<Changed> changed;
        check(locked([&] {
            bsmdec_changes found;
            bsmdec_status status = read(decoder, &found);
            if (status == BSMDEC_OK) changed.emplace(found);
            return status;
        }));
        return nb::make_tuple(changed->vertices.numpy(), changed->positions.numpy(), changed->final.numpy());
    }

    // Called under the lock.
    bsmdec_status read_indices(int index, const bsmdec_attribute &shape, Array<uint32_t> *corners) {
        if (shape.indices == 0) return BSMDEC_OK;
        *corners = {(size_t)shape.indices / 3, 3, nb::dtype<int32_t>()};
        return bsmdec_attribute_indices(decoder, index, corners->data(), (size_t)shape.indices);
    }

    static nb::object or_none(Array<uint32_t> &corners) {
        return corners.memory == nullptr ? nb::none() : corners.numpy();
    }

    nb::object error_of(const Outcome &outcome) {
        const bsmdec_error &error = outcome.error;
        return nb::module_::import_("bsm.bitstream.limits").attr("decoder_error")((int)error.status,
            text_of(error.message), error.offset, error.frame, error.block, given,
            list_of(outcome.state, STATE_NUMBERS));
    }

    void check(const Outcome &outcome) {
        if (outcome.status == BSMDEC_OK) return;
        if (outcome.error.status != outcome.status) throw nb::value_error(outcome.misuse.c_str());
        nb::object error = error_of(outcome);
        PyErr_SetObject((PyObject *)Py_TYPE(error.ptr()), error.ptr());
        throw nb::python_error();
    }
};

template <typename T, int64_t columns>
using Rows = nb::ndarray<const T, nb::shape<-1, columns>, nb::c_contig, nb::device::cpu>;
template <typename T> using Row = nb::ndarray<const T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Table = nb::ndarray<const int32_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

// Writes or reads the values of one field, chunk after chunk.
class Field {
  public:
    Field(Rows<int32_t, 3> faces, Table values) : faces(faces), values(values) {
        bsmdec_limits bounds;
        bsmdec_default_limits(&bounds, sizeof bounds);
        for (const auto &limit : LIMITS) bounds.*limit.field = 1e300;
        bsmdec_options options = {};
        options.size = sizeof options;
        options.limits = &bounds;
        writer = bsmdec_open(&options);
        if (writer == nullptr) throw std::bad_alloc();
    }
    ~Field() { bsmdec_close(writer); }
    Field(const Field &) = delete;

    void grid(Row<int32_t> largest, int light, Row<double> origin, double step, std::optional<Rows<double, 3>> exact) {
        if (largest.size() != 3 || values.shape(1) != 3 || origin.size() != 3 || (exact && exact->shape(0) != rows()))
            throw nb::value_error("a grid has three axes");
        begin([&] {
            return write_grid(
                writer, given(), largest.data(), light, origin.data(), step, exact ? exact->data() : nullptr);
        });
    }
    void levels() {
        if (values.shape(1) != 3) throw nb::value_error("levels have three axes");
        begin([&] { return write_levels(writer, given()); });
    }
    void attribute(nb::bytes declaration, int64_t vertices, Row<int32_t> at, std::optional<Rows<int32_t, 3>> places) {
        if ((at.size() > 0 && at.size() != rows()) || (places && (int64_t)places->shape(0) != vertices))
            throw nb::value_error("rows and vertices do not fit together");
        kept = nb::make_tuple(at, places);
        begin([&] {
            return write_values(writer, given(), (const uint8_t *)declaration.c_str(), (int64_t)declaration.size(),
                vertices, at.size() > 0 ? at.data() : nullptr, places ? places->data() : nullptr);
        });
    }

    // The payloads of the next rows.
    nb::list write(int64_t count) {
        if (count < 1 || count > (int64_t)rows() - next) throw nb::value_error("so many rows are not left");
        Writing writing = {};
        writing.room = 1024 + 160 * count * (int64_t)(values.shape(1) + 4);
        std::unique_ptr<uint8_t[]> data(new uint8_t[(size_t)writing.room]);
        writing.data = data.get();
        code(count, nullptr, 0, &writing);
        nb::list payloads;
        for (int i = 0; i < writing.count; i++) {
            int64_t first = i > 0 ? writing.ends[i - 1] : 0;
            payloads.append(nb::bytes(writing.data + first, (size_t)(writing.ends[i] - first)));
        }
        return payloads;
    }

    // Read the next rows; all values, as far as they are known.
    nb::object read(nb::bytes payload, int64_t count) {
        if (count < 1 || count > (int64_t)rows() - next) throw nb::value_error("so many rows are not left");
        code(count, (const uint8_t *)payload.c_str(), (int64_t)payload.size(), nullptr);
        return Array<int32_t>(values_of_field(writer), rows(), values.shape(1)).numpy();
    }

    nb::object order() {
        const int32_t *all = order_of_field(writer);
        return all == nullptr ? nb::none() : Array<int32_t>(all, rows()).numpy();
    }

  private:
    bsmdec *writer;
    Rows<int32_t, 3> faces;
    Table values;
    nb::object kept;
    int64_t next = 0;

    size_t rows() const { return values.shape(0); }
    Written given() const {
        return {faces.data(), values.data(), (int64_t)faces.shape(0), (int64_t)values.shape(0),
            (int64_t)values.shape(1)};
    }
    void code(int64_t count, const uint8_t *payload, int64_t size, Writing *writing) {
        int64_t first = next;
        next = (int64_t)rows(); // nothing goes on after an error
        begin([&] { return code_chunk(writer, first, count, payload, size, writing); });
        next = first + count;
    }
    template <typename Work> void begin(Work work) {
        bool done;
        {
            nb::gil_scoped_release released;
            done = work();
        }
        if (done) return;
        const bsmdec_error &error = *bsmdec_last_error(writer);
        nb::module_ limits = nb::module_::import_("bsm.bitstream.limits");
        nb::object found = limits.attr("decoder_error")((int)error.status, text_of(error.message), -1, -1, -1,
            limits.attr("DEFAULT_LIMITS"), nb::make_tuple(0, 0, 0, 0, 0, 0, 0));
        PyErr_SetObject((PyObject *)Py_TYPE(found.ptr()), found.ptr());
        throw nb::python_error();
    }
};

}  // namespace

NB_MODULE(_engine, m) {
    nb::set_leak_warnings(false); /* the traceback of an error keeps its decoder until the process ends */
    m.attr("version") = BSM_VERSION;
    nb::class_<Field>(m, "Field")
        .def(nb::init<Rows<int32_t, 3>, Table>(), "faces"_a, "values"_a)
        .def("grid", &Field::grid, "largest"_a, "light"_a, "origin"_a, "step"_a, "exact"_a.none())
        .def("levels", &Field::levels)
        .def("attribute", &Field::attribute, "declaration"_a, "vertices"_a, "at"_a, "places"_a.none())
        .def("write", &Field::write, "count"_a, nb::sig("def write(self, count: int) -> list[bytes]"))
        .def("read", &Field::read, "payload"_a, "count"_a,
            nb::sig("def read(self, payload: bytes, count: int) -> numpy.typing.NDArray[numpy.int32]"))
        .def_prop_ro("order", &Field::order, nb::sig("def order(self) -> typing.Any"));
    nb::class_<Decoder>(m, "Decoder")
        .def(nb::init<nb::object, int64_t, bool, int64_t, int64_t>(), "limits"_a, "threads"_a = 1,
            "tolerant"_a = false, "start"_a = 0, "layers"_a = 0)
        .def("push", &Decoder::push, "bytes"_a)
        .def("finish", &Decoder::finish)
        .def("next", &Decoder::next, "wanted"_a,
            nb::sig("def next(self, wanted: int) -> tuple[int, int, int, int, int]"))
        .def("skim", &Decoder::skim, nb::sig("def skim(self) -> tuple[str, list[int]] | None"))
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
