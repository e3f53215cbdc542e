// bsmdec as a class of Python. Arrays are numpy's own; nothing is decoded under the interpreter's lock.
#include <cstring>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "bitstream/kernel.hpp"

extern "C" {
#include "library/python/inside.h"
}

namespace nb = nanobind;
using namespace nb::literals;

// An array of numpy that is made here, with its kind in signatures; void: of any kind.
template <typename T> struct Made {
    nb::object numpy;
    T *data;
};

template <typename T> struct Kind;
#define KIND(type, text, word)                                                                                         \
    template <> struct Kind<type> {                                                                                    \
        static constexpr const char *name = text;                                                                      \
        static constexpr auto signature = nb::detail::const_name(word);                                                \
    };
KIND(void, "", "typing.Any")
KIND(uint8_t, "uint8", "numpy.typing.NDArray[numpy.uint8]")
KIND(bool, "bool", "numpy.typing.NDArray[numpy.bool_]")
KIND(int32_t, "int32", "numpy.typing.NDArray[numpy.int32]")
KIND(int64_t, "int64", "numpy.typing.NDArray[numpy.int64]")
KIND(float, "float32", "numpy.typing.NDArray[numpy.float32]")
KIND(double, "float64", "numpy.typing.NDArray[numpy.float64]")
#undef KIND

template <typename T> struct nb::detail::type_caster<Made<T>> {
    NB_TYPE_CASTER(Made<T>, Kind<T>::signature)
    static handle from_cpp(const Made<T> &made, rv_policy, cleanup_list *) noexcept { return made.numpy.inc_ref(); }
};

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

nb::handle numpy_empty; // runs no code of Python, which could call the decoder whose memory is copied

// Not when the module is imported, since an interrupt there would become an error.
void find_numpy() {
    if (!numpy_empty) numpy_empty = nb::object(nb::module_::import_("numpy").attr("empty")).release();
}

template <typename T> Made<T> made_of(int64_t rows, int64_t columns = 0, const char *kind = Kind<T>::name) {
    nb::object shape = columns > 0 ? nb::object(nb::make_tuple(rows, columns)) : nb::object(nb::int_(rows));
    find_numpy();
    nb::object made = numpy_empty(shape, kind);
    auto view = nb::cast<nb::ndarray<nb::c_contig, nb::device::cpu>>(made);
    return {made, (T *)view.data()};
}

template <typename T> Made<T> copy_of(const T *data, int64_t rows, int64_t columns = 0) {
    Made<T> made = made_of<T>(rows, columns);
    size_t bytes = (size_t)(columns > 0 ? rows * columns : rows) * sizeof(T);
    if (bytes > 0) std::memcpy(made.data, data, bytes);
    return made;
}

template <typename Row> auto copied(Row from) { return copy_of(from.data, from.size); }
auto copied(ConstDoubles2 from) { return copy_of(from.data, from.rows, 3); }

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

[[noreturn]] void raise(const nb::object &error) {
    PyErr_SetObject((PyObject *)Py_TYPE(error.ptr()), error.ptr());
    throw nb::python_error();
}

nb::object error_of(const bsmdec_error &error, const nb::object &limits, const DecoderState &state) {
    return nb::module_::import_("bsm.bitstream.limits").attr("decoder_error")(
        (int)error.status, text_of(error.message), error.offset, error.frame, error.block,
        error.limit != nullptr ? error.limit : "", error.value, limits, state);
}

// Python threads that share an object take turns: results are copied before the next call begins.
struct Shared {
    Shared() { find_numpy(); }
    std::recursive_mutex mutex; // a signal handler may call the decoder that it interrupts
};

template <typename Result, typename Class, typename... Given> auto in_turn(Result (Class::*method)(Given...)) {
    return [method](Class &self, Given... given) -> Result {
        std::unique_lock<std::recursive_mutex> turn(self.mutex, std::defer_lock);
        {
            nb::gil_scoped_release released;
            turn.lock();
        }
        return (self.*method)(std::move(given)...);
    };
}

// Work on our own memory, without the interpreter lock.
template <typename Work> auto unlocked(Work work) {
    nb::gil_scoped_release released;
    return work();
}

// The numbers of the fields of a record by their keys.
template <typename Of> auto numbers_by_key(const Of *of, int (*find)(const Of *, int, const double **)) {
    std::map<int, std::vector<double>> all;
    const double *numbers;
    for (int key = 0; key < MOST_FIELD_KEY; key++)
        if (int count = find(of, key, &numbers); count > 0) all[key] = {numbers, numbers + count};
    return all;
}

class Decoder : public Shared {
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
        unlocked([&] { return bsmdec_push(decoder, data, size); });
    }

    void finish() {
        unlocked([&] { return bsmdec_finish(decoder); });
    }

    // The next event of a wanted type, or one that nothing follows for now: type, index, count, vertices, faces.
    auto next(uint32_t wanted) {
        wanted |= 1u << BSMDEC_NEED_DATA | 1u << BSMDEC_END_OF_STREAM;
        bsmdec_event event;
        bsmdec_status status;
        do {
            status = unlocked([&] {
                bsmdec_status found;
                int left = 64;  // then signals are looked at
                do found = bsmdec_next(decoder, &event);
                while (found == BSMDEC_OK && --left > 0 && !(wanted >> event.type & 1));
                return found;
            });
            if (PyErr_CheckSignals() != 0) throw nb::python_error();
            if (status != BSMDEC_OK) raise_error();
        } while (!(wanted >> event.type & 1));
        return std::make_tuple((int)event.type, event.index, event.count, event.vertices, event.faces);
    }

    // The next packet; None: it has not come as a whole.
    std::optional<SkimmedPacket> skim() {
        SkimmedPacket packet;
        bool found = false;
        check(unlocked([&] { return found = decoder_skim(decoder, &packet), bsmdec_last_error(decoder)->status; }));
        return found ? std::optional(packet) : std::nullopt;
    }

    auto faces(size_t count) {
        Made<int32_t> made = made_of<int32_t>((int64_t)count, 3);
        check(unlocked([&] { return bsmdec_faces(decoder, (uint32_t *)made.data, 3 * count); }));
        return made;
    }

    auto positions(size_t count) {
        Made<double> made = made_of<double>((int64_t)count, 3);
        check(unlocked([&] { return bsmdec_positions(decoder, made.data, 3 * count); }));
        return made;
    }

    auto changes() { return changed_by(bsmdec_read_changes); }

    auto loose() { return changed_by(bsmdec_read_loose); }

    auto losses() {
        bsmdec_losses found;
        check(unlocked([&] { return bsmdec_read_losses(decoder, &found); }));
        return std::make_tuple(
            copy_of(found.missing, found.missing_count), copy_of(found.degraded, found.degraded_count));
    }

    auto metadata(int64_t index) {
        bsmdec_metadata entry;
        check(unlocked([&] { return bsmdec_metadata_at(decoder, index, &entry); }));
        const char *bytes = (const char *)entry.bytes;
        nb::object value = entry.type == BSMDEC_WHOLE ? nb::object(nb::int_(entry.whole))
            : entry.type == BSMDEC_NUMBER             ? nb::object(nb::float_(entry.number)) : entry.type == BSMDEC_TEXT
            ? nb::object(nb::str(bytes, entry.size)) : nb::object(nb::bytes(bytes, entry.size));
        return std::make_tuple(nb::str(entry.name), Made<void>{value, nullptr});
    }

    int attribute_count() { return bsmdec_attribute_count(decoder); }

    // (name, domain, semantic, values, indices or None, whether it moves); None if it is not whole.
    std::optional<std::tuple<const char *, int, int, Made<void>, Made<void>, bool>> attribute(int index) {
        bsmdec_attribute shape;
        if (unlocked([&] { return bsmdec_attribute_at(decoder, index, &shape); }) != BSMDEC_OK) return std::nullopt;
        Made<void> made = made_of<void>(shape.rows, shape.components, KINDS[shape.kind]);
        size_t bytes = (size_t)(shape.rows * shape.components) * bsmdec_kind_size(shape.kind);
        check(unlocked([&] { return bsmdec_attribute_values(decoder, index, made.data, bytes); }));
        return std::make_tuple(
            shape.name, shape.domain, shape.semantic, made, indices(index, shape), shape.moves != 0);
    }

    // The part that came last: (name, domain, semantic, indices or None, rows, values).
    auto values(int index) {
        bsmdec_values found;
        check(unlocked([&] { return bsmdec_read_values(decoder, index, &found); }));
        const bsmdec_attribute &shape = found.attribute;
        Made<void> own = made_of<void>(found.count, shape.components, KINDS[shape.kind]);
        size_t bytes = (size_t)(found.count * shape.components) * bsmdec_kind_size(shape.kind);
        if (bytes > 0) std::memcpy(own.data, found.values, bytes);
        return std::make_tuple(
            shape.name, shape.domain, shape.semantic, indices(index, shape), copy_of(found.rows, found.count), own);
    }

    // The numbers of the header's fields by their keys.
    auto header() { return numbers_by_key(decoder, decoder_field); }

    DecoderState state() {
        return unlocked([&] { return decoder_state(decoder); });
    }

    // The loss of the last LOSS event, as an error.
    Made<void> loss() { return {error_of(*bsmdec_last_loss(decoder), given, state()), nullptr}; }

  private:
    bsmdec *decoder;
    nb::object given;

    std::tuple<Made<int32_t>, Made<double>, Made<bool>> changed_by(bsmdec_status (*read)(bsmdec *, bsmdec_changes *)) {
        bsmdec_changes found;
        check(unlocked([&] { return read(decoder, &found); }));
        return {copy_of(found.vertices, found.count), copy_of(found.positions, found.count, 3),
            copy_of((const bool *)found.final, found.count)};
    }

    Made<void> indices(int index, const bsmdec_attribute &shape) {
        if (shape.indices == 0) return {nb::none(), nullptr};
        Made<void> made = made_of<void>(shape.indices / 3, 3, "int32");
        check(unlocked(
            [&] { return bsmdec_attribute_indices(decoder, index, (uint32_t *)made.data, (size_t)shape.indices); }));
        return made;
    }

    [[noreturn]] void raise_error() { raise(error_of(*bsmdec_last_error(decoder), given, state())); }

    void check(bsmdec_status status) {
        if (status == BSMDEC_OK) return;
        if (status != BSMDEC_MISUSED) raise_error();
        throw nb::value_error(bsmdec_last_misuse(decoder));
    }
};

template <typename T, int64_t columns>
using Rows = nb::ndarray<const T, nb::shape<-1, columns>, nb::c_contig, nb::device::cpu>;
template <typename T> using Row = nb::ndarray<const T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using IntRows = nb::ndarray<const int32_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

// What encoders write with, and the payloads that they have written.
class Output {
  public:
    Output() : encoding(open_encoding()) {
        if (encoding == nullptr) throw std::bad_alloc();
    }
    ~Output() { close_encoding(encoding); }
    Output(const Output &) = delete;

    template <typename Work> void run(Work work) {
        if (unlocked(work)) return;
        nb::object limits = nb::module_::import_("bsm.bitstream.limits").attr("DEFAULT_LIMITS");
        raise(error_of(*encoding_error(encoding), limits, DecoderState{}));
    }

    // The payload that work writes.
    template <typename Work> nb::bytes written(Work work) {
        run([&] {
            Payload *writing = encoding_anew(encoding);
            return writing != nullptr && work(writing);
        });
        const Payload &written = *encoding_payloads(encoding);
        return nb::bytes(written.data, (size_t)written.size);
    }

    nb::typed<nb::list, nb::bytes> payloads() const {
        const Payload &written = *encoding_payloads(encoding);
        nb::list all;
        for (int i = 0; i < written.count; i++) {
            int64_t first = i > 0 ? written.ends[i - 1] : 0;
            all.append(nb::bytes(written.data + first, (size_t)(written.ends[i] - first)));
        }
        return all;
    }

    Encoding *encoding;
};

// A given mesh, joined and in the order of coding, and the attributes that are carried there (see inside.h).
class OrderedMesh : public Shared, Output {
  public:
    OrderedMesh(ConstInts2 faces, ConstInts places) : given(faces), places(places) {}
    auto join(bool keep, bool keeps) {
        JoinedArrays found;
        run([&] { return encode_joined(encoding, given, places, keep, keeps, &found); });
        return std::make_tuple(copied(found.index), copied(found.first), copied(found.kept), found.merged, found.loose);
    }
    // The payload of faces, the order of vertices and of faces in it, the decoded faces and their turns, and `repeats`
    // of the header; the given one is 0, 1, or 2 for the smaller payload.
    auto code(std::optional<Row<int32_t>> merged, int repeats) {
        CodedArrays found;
        ConstInts own = {merged ? merged->data() : nullptr, merged ? (int64_t)merged->size() : 0};
        run([&] { return encode_faces(encoding, own, repeats, &found); });
        coded = found.faces.rows;
        return std::make_tuple(nb::bytes(payloads()[0]), copied(found.vertices), copied(found.face_order),
            copy_of(found.faces.data, coded, 3), copied(found.turns), found.repeats);
    }
    nb::bytes order(ConstDoubles2 positions) {
        run([&] { return encode_order(encoding, positions); });
        return nb::bytes(payloads()[0]);
    }
    // The numbers of the declaration, own seams, coded numbers, decoded values, the value of each corner, if that is
    // not its vertex, the vertex of each value, whether it leans; and the outcome: error, step of integers, bits,
    // normals without length, whether others had another length than 1.
    auto carry(bool first, const std::string &name, nb::object array, int kind, int domain, int semantic,
        std::optional<Rows<int32_t, 3>> indices, int quality, double amount) {
        auto values = nb::cast<nb::ndarray<nb::ndim<2>, nb::c_contig, nb::ro, nb::device::cpu>>(array);
        if (kind < 0 || kind > 7 || values.itemsize() != bsmdec_kind_size(kind) || values.shape(0) < 1
            || values.shape(1) < 1 || values.shape(1) > 4)
            throw nb::value_error("values are not of this kind");
        bsmenc_attribute given = {};
        given.name = name.c_str();
        given.values = values.data();
        given.rows = (int64_t)values.shape(0);
        given.components = (int)values.shape(1);
        given.kind = kind;
        given.domain = domain;
        given.semantic = semantic;
        given.indices = indices ? (const uint32_t *)indices->data() : nullptr;
        given.quality = (bsmenc_quality)quality;
        given.amount = amount;
        CarriedOutcome whole;
        run([&] { return encode_carried(encoding, &given, first, &whole); });
        const Payload &seams = *encoding_payloads(encoding);
        Made<void> decoded = made_of<void>(whole.rows, (int64_t)values.shape(1), KINDS[kind]);
        carried_values(encoding, decoded.data);
        const bsmenc_outcome &outcome = whole.outcome;
        auto tangents = whole.tangents.rows == 0 ? std::nullopt
                                                 : std::optional(std::make_tuple(
                                                     copy_of(whole.tangents.data, whole.tangents.rows, 4),
                                                     copied(whole.tangent_rows)));
        return std::make_tuple(numbers_by_key((const Encoding *)encoding, carried_field),
            nb::bytes(seams.data, (size_t)seams.size), copy_of(whole.pieces, whole.rows, whole.columns), decoded,
            whole.faces == nullptr ? std::nullopt : std::optional(copy_of(whole.faces, coded, 3)),
            copy_of(whole.vertices, whole.vertices_count), whole.leans,
            std::make_tuple(outcome.error, outcome.step, outcome.bits, outcome.zeros, outcome.scaled != 0), tangents);
    }

  private:
    ConstInts2 given;
    ConstInts places;
    int64_t coded = 0;
};

// Tangents as turns: words, decoded values and the largest error in degrees; nothing if that is too large.
auto turned_tangents(ConstInts2 faces, ConstInts2 normal_faces, ConstInts2 coordinate_faces, ConstInts2 places,
    ConstInts2 coordinates, ConstInts vertices, ConstInts rows, ConstDoubles2 normals, ConstDoubles2 tangents,
    int64_t size) -> std::optional<std::tuple<Made<int32_t>, Made<double>, double>> {
    if (faces.columns != 3 || normal_faces.columns != 3 || coordinate_faces.columns != 3 || places.columns != 3
        || coordinates.columns != 2 || normals.columns != 3 || tangents.columns != 4)
        throw nb::value_error("arrays of tangents have other columns");
    Output output;
    Made<int32_t> words = made_of<int32_t>(vertices.size, 2);
    Made<double> values = made_of<double>(vertices.size, 4);
    TangentArrays all = {faces, normal_faces, coordinate_faces, places, coordinates, vertices, rows, normals, tangents,
        size};
    double error = 0.0;
    bool near = false;
    output.run([&] { return encode_turns(output.encoding, &all, words.data, values.data, &error, &near); });
    if (!near) return std::nullopt;
    return std::make_tuple(words, values, error);
}

// Positions on a grid: its origin, step and largest places, and the places.
auto places_on_grid(Rows<double, 3> positions, int bits, double cell, Row<double> origin) {
    if (origin.size() != 3 || positions.shape(0) < 1 || bits < 0 || bits > 20)
        throw nb::value_error("a grid has three axes, and at most 20 bits");
    Output output;
    double grid[7];
    Made<int32_t> places = made_of<int32_t>((int64_t)positions.shape(0), 3);
    output.run([&] {
        return encode_rounded(output.encoding, positions.data(), (int64_t)positions.shape(0), bits, cell,
            origin.data(), grid, places.data);
    });
    return std::make_tuple(std::make_tuple(grid[0], grid[1], grid[2]), grid[3],
        std::make_tuple((int)grid[4], (int)grid[5], (int)grid[6]), places);
}

// Writes or reads the values of one field, chunk after chunk.
class FieldCoder : public Shared, Output {
  public:
    FieldCoder(Rows<int32_t, 3> faces, IntRows values) : faces(faces), values(values) {}
    FieldCoder(const FieldCoder &other, IntRows values)
        : faces(other.faces), values(values), like(other.next == 0 && other.rows() == rows() ? other.encoding : NULL) {}

    void grid(Row<int32_t> largest, int light, Row<double> origin, double step, std::optional<Rows<double, 3>> exact,
        std::optional<Rows<int32_t, 8>> transforms, int congruence) {
        if (largest.size() != 3 || values.shape(1) != 3 || origin.size() != 3 || (exact && exact->shape(0) != rows())
            || (transforms ? (int)transforms->shape(0) : 0) != (congruence > 0 ? (congruence - 35) % 17 : 0))
            throw nb::value_error("a grid has three axes, and the transforms of its header");
        begin([&] {
            return encode_positions(encoding, like, given(), largest.data(), light, origin.data(), step,
                exact ? exact->data() : nullptr, transforms ? transforms->data() : nullptr, congruence);
        });
    }
    void go(Rows<double, 4> wanted) {
        if (next != 0 || wanted.shape(0) != rows()) throw nb::value_error("a row for each vertex of a begun field");
        kept = nb::cast(wanted);
        run([&] { return encode_going(encoding, wanted.data()); });
    }
    // Places on a grid, mended.
    auto mended(Rows<int32_t, 3> places, Row<int32_t> largest, Rows<double, 4> wanted) {
        if (next < 0 || places.shape(0) != rows() || wanted.shape(0) != rows() || largest.size() != 3)
            throw nb::value_error("a row for each vertex of a begun field");
        auto kept = copy_of(places.data(), (int64_t)rows(), 3);
        run([&] {
            return encode_mended(encoding, {kept.data, (int64_t)rows(), 3}, largest.data(), wanted.data());
        });
        return kept;
    }
    void levels() {
        if (values.shape(1) != 3) throw nb::value_error("levels have three axes");
        begin([&] { return encode_levels(encoding, given()); });
    }
    void attribute(nb::bytes declaration, int64_t vertices, Row<int32_t> at, std::optional<Rows<int32_t, 3>> places,
        int swift) {
        if ((at.size() > 0 && at.size() != rows()) || (places && (int64_t)places->shape(0) != vertices))
            throw nb::value_error("rows and vertices do not fit together");
        kept = nb::make_tuple(at, places);
        begin([&] {
            return encode_attribute(encoding, given(), (const uint8_t *)declaration.c_str(),
                (int64_t)declaration.size(), vertices, at.size() > 0 ? at.data() : nullptr,
                places ? places->data() : nullptr, swift);
        });
    }

    // The payloads of the next rows.
    auto write(int64_t count) {
        code(count, [&](int64_t first) { return encode_chunk(encoding, first, count); });
        return payloads();
    }

    auto coded() { return copy_of(encoding_values(encoding), (int64_t)rows(), (int64_t)values.shape(1)); }

    // Read the next rows; all values, as far as they are known.
    auto read(nb::bytes payload, int64_t count) {
        const uint8_t *data = (const uint8_t *)payload.c_str();
        int64_t size = (int64_t)payload.size();
        code(count, [&](int64_t first) { return decode_field_chunk(encoding, first, count, data, size); });
        return coded();
    }

    auto order() {
        const int32_t *all = encoding_order(encoding);
        return all == nullptr ? std::nullopt : std::optional(copy_of(all, (int64_t)rows()));
    }

  private:
    Rows<int32_t, 3> faces;
    IntRows values;
    nb::object kept;
    const Encoding *like = nullptr; // that has linked the same faces
    int64_t next = -1; // before it has begun

    size_t rows() const { return values.shape(0); }
    Source given() const {
        return {faces.data(), values.data(), (int64_t)faces.shape(0), (int64_t)values.shape(0),
            (int64_t)values.shape(1)};
    }
    template <typename Work> void begin(Work work) {
        if (next >= 0) throw nb::value_error("a field begins once");
        next = (int64_t)rows(); // nothing goes on after an error
        run(work);
        next = 0;
    }
    template <typename Work> void code(int64_t count, Work work) {
        int64_t first = next;
        if (first < 0 || count < 1 || count > (int64_t)rows() - first)
            throw nb::value_error("so many rows are not left");
        next = (int64_t)rows();
        run([&] { return work(first); });
        next = first + count;
    }
};

// What steps through blocks (see chaining.h).
class Steps : public Shared, protected Output {
  protected:
    Steps() : chain(encoding_chain(encoding)) {
        if (chain == nullptr) throw std::bad_alloc();
    }
    Steps(ConstInts offsets, ConstInts neighbors) : Steps() {
        run([&] { return begin_graph(chain, offsets, neighbors); });
    }
    CodedChain *chain;
};

class Chain : public Steps {
  public:
    Chain(ConstInts offsets, ConstInts neighbors, ConstInts cores, ConstLongs starts, ConstLongs edges,
        ConstInts members, bool exact, bool springs, int power, int iterations, int key_iterations, int apart,
        int64_t key_interval, int64_t whole, double shift, int64_t width)
        : Steps(offsets, neighbors) {
        ChainRules rules = {
            exact, springs, power, iterations, key_iterations, apart, key_interval, whole, width, shift};
        run([&] { return begin_coded_chain(chain, rules, cores, starts, edges, members); });
    }
    // Hang the parts that blocks grew from on each other, by a first frame; see chaining.h.
    double hang(ConstInts2 faces, ConstDoubles2 first_frame, ConstDoubles2 starts, ConstInts widths) {
        double memory = 0;
        run([&] { return hang_parts(chain, faces, first_frame, starts, widths, &memory); });
        return memory;
    }
    double gop_memory(int method, int64_t frames, ConstLongs2 fields) {
        return memory_for_gop(chain, method, frames, fields);
    }
    // Vertices of the next block, what continues the known ones, and weights in a blend.
    auto begin(int64_t index) {
        run([&] { return begin_coded_block(chain, index); });
        const CodedBlock &block = *present_block(chain);
        return std::make_tuple(copied(block.vertices), copied(block.continued), copied(block.weights));
    }
    // Its graph, springs and pulls.
    auto site() {
        const CodedBlock &block = *present_block(chain);
        return std::make_tuple(
            copied(block.offsets), copied(block.neighbors), copied(block.springs), copied(block.pulls));
    }
    auto costs(int64_t width) {
        if (present_block(chain)->vertices.size < 1) throw nb::value_error("no block has begun");
        const BlockCosts costs = costs_of_block(chain, width);
        return std::make_tuple(costs.dictionary, costs.rest, costs.memory);
    }
    auto dictionary(int64_t width) {
        run([&] { return make_coded_dictionary(chain, width); });
        ConstSingles2 made = present_dictionary(chain);
        return copy_of(made.data, made.rows, made.columns);
    }
    void give(ConstSingles2 own) {
        run([&] { return give_dictionary(chain, own); });
    }
    // Levels nearest to coefficients, all or those up to the last that is not 0: their rows, their payload, and the
    // positions that they decode to.
    auto write(ConstDoubles2 prediction, ConstDoubles2 coefficients, double step, bool all) {
        Made<double> made = made_of<double>(prediction.rows, 3);
        int64_t rows = 0;
        nb::bytes payload = written([&](Payload *writing) {
            return write_coded_block(
                chain, prediction, coefficients, step, all, writing, &rows, {made.data, prediction.rows, 3});
        });
        return std::make_tuple(rows, payload, made);
    }
    void commit(int64_t width, ConstDoubles2 positions) {
        run([&] { return commit_coded_block(chain, width, positions); });
    }

    friend class TrackCoder;
};

// Positions or an attribute that moves, as GOPs go on; of a chain that stays.
class TrackCoder : public Steps {
    template <typename Work> auto coded(Work work) {
        ConstDoubles2 found = {nullptr, 0, 0};
        nb::bytes payload = written([&](Payload *writing) { return work(writing, &found); });
        return std::make_tuple(payload, copy_of(found.data, found.columns > 0 ? found.rows : 0, found.columns));
    }

  public:
    TrackCoder(const Chain &whole, int64_t number) {
        run([&] { return begin_track(chain, whole.chain, number); });
    }
    TrackCoder(const TrackCoder &other, const Chain &) {
        run([&] { return begin_track(chain, other.chain, 0); });
    }
    // The payload of a basis, and the basis.
    auto basis(ConstInts exponents, ConstDoubles2 spectrum) {
        return coded([&](Payload *writing, ConstDoubles2 *found) {
            return write_track_basis(chain, exponents, spectrum, writing, found);
        });
    }
    // The payload of levels, and the field.
    auto code(int method, int64_t frames, double step, int64_t back, ConstDoubles2 wanted) {
        return coded([&](Payload *writing, ConstDoubles2 *found) {
            return write_track(chain, method, frames, step, back, wanted, writing, found);
        });
    }
};

// A graph that is cut into parts and blocks, or is one itself.
class Cut : public Steps {
  public:
    Cut(ConstInts offsets, ConstInts neighbors) : Steps(offsets, neighbors), size(offsets.size - 1) {}
    auto labels(int64_t parts) {
        Made<int32_t> made = made_of<int32_t>(size);
        run([&] { return label_graph(chain, parts, {made.data, size}); });
        return made;
    }
    // Of blocks in the order of their chain: vertices of their parts, where members begin, edges, and members.
    auto blocks(ConstInts labels, int64_t parts, int64_t size) {
        GrownBlocks grown;
        run([&] { return grow_parts(chain, labels, parts, size, &grown); });
        return std::make_tuple(copied(grown.cores), copied(grown.starts), copied(grown.edges),
            copied(grown.members));
    }
    // The cell of each vertex, offsets and neighbors of cells, and their faces.
    auto cells(ConstInts2 faces, int64_t reach) {
        GraphCells found;
        run([&] { return cell_graph(chain, faces, reach, &found); });
        return std::make_tuple(copied(found.own), copied(found.offsets), copied(found.neighbors),
            copy_of(found.faces.data, found.faces.rows, 3));
    }
    // The payload of parts that are numbered by their first vertices.
    nb::bytes write(ConstInts labels, int64_t parts) {
        return written([&](Payload *writing) { return write_labels(chain, labels, parts, writing); });
    }
    // Vertices of a block in the order of its rows, and the graph among them.
    auto rows(ConstInts members) {
        run([&] { return order_rows(chain, members); });
        const CodedBlock &block = *present_block(chain);
        return std::make_tuple(copied(block.vertices), copied(block.offsets), copied(block.neighbors));
    }
    // Orthogonal iterations from a start.
    auto iterate(double shift, ConstSingles2 start, int64_t power, int64_t iterations, int64_t apart) {
        Made<float> made = made_of<float>(start.rows, start.columns);
        Singles2 subspace = {made.data, start.rows, start.columns};
        run([&] { return iterate_graph(chain, shift, start, power, iterations, apart, subspace); });
        return made;
    }

  private:
    int64_t size;
};

}  // namespace

// The kernels of each room (kernels.cpp there).
void bind_bitstream(nb::module_ &m);
void bind_codec(nb::module_ &m);
void bind_bsm(nb::module_ &m);

NB_MODULE(_core, m) {
    nb::set_leak_warnings(false); /* the traceback of an error keeps its decoder until the process ends */
    m.attr("version") = BSM_VERSION;
    nb::module_ bitstream = m.def_submodule("bitstream"), codec = m.def_submodule("codec");
    bind_bitstream(bitstream);
    bind_codec(codec);
    bind_bsm(m);
    m.def("rounded", places_on_grid, "positions"_a, "bits"_a, "cell"_a, "origin"_a);
    m.def("turned_tangents", turned_tangents, "faces"_a, "normal_faces"_a, "coordinate_faces"_a, "places"_a,
        "coordinates"_a, "vertices"_a, "rows"_a, "normals"_a, "tangents"_a, "size"_a);
    nb::class_<OrderedMesh>(m, "GivenMesh")
        .def(nb::init<ConstInts2, ConstInts>(), "faces"_a, "places"_a, nb::keep_alive<1, 2>(), nb::keep_alive<1, 3>())
        .def("join", in_turn(&OrderedMesh::join), "keep"_a, "keeps"_a)
        .def("code", in_turn(&OrderedMesh::code), "merged"_a.none() = nb::none(), "repeats"_a = 2)
        .def("order", in_turn(&OrderedMesh::order), "positions"_a)
        .def("carry", in_turn(&OrderedMesh::carry), "first"_a, "name"_a, "values"_a, "kind"_a, "domain"_a, "semantic"_a,
            "indices"_a.none(), "quality"_a, "amount"_a);
    nb::class_<FieldCoder>(m, "Field")
        .def(nb::init<Rows<int32_t, 3>, IntRows>(), "faces"_a, "values"_a)
        .def(nb::init<const FieldCoder &, IntRows>(), "other"_a, "values"_a, nb::keep_alive<1, 2>())
        .def("grid", in_turn(&FieldCoder::grid), "largest"_a, "light"_a, "origin"_a, "step"_a, "exact"_a.none(),
            "transforms"_a.none() = nb::none(), "congruence"_a = 0)
        .def("go", in_turn(&FieldCoder::go), "wanted"_a)
        .def("mended", in_turn(&FieldCoder::mended), "places"_a, "largest"_a, "wanted"_a)
        .def("levels", in_turn(&FieldCoder::levels))
        .def("attribute", in_turn(&FieldCoder::attribute), "declaration"_a, "vertices"_a, "at"_a, "places"_a.none(),
            "swift"_a)
        .def("write", in_turn(&FieldCoder::write), "count"_a)
        .def("read", in_turn(&FieldCoder::read), "payload"_a, "count"_a)
        .def_prop_ro("coded", in_turn(&FieldCoder::coded))
        .def_prop_ro("order", in_turn(&FieldCoder::order));
    nb::class_<Chain>(m, "Chain")
        .def(nb::init<ConstInts, ConstInts, ConstInts, ConstLongs, ConstLongs, ConstInts, bool, bool, int, int, int,
                 int, int64_t, int64_t, double, int64_t>(),
            "offsets"_a, "neighbors"_a, "cores"_a, "starts"_a, "edges"_a, "members"_a, nb::kw_only(), "exact"_a,
            "springs"_a, "power"_a, "iterations"_a, "key_iterations"_a, "apart"_a, "key_interval"_a, "whole"_a,
            "shift"_a, "width"_a, nb::keep_alive<1, 2>(), nb::keep_alive<1, 3>(), nb::keep_alive<1, 4>(),
            nb::keep_alive<1, 5>(), nb::keep_alive<1, 6>(), nb::keep_alive<1, 7>())
        .def("hang", in_turn(&Chain::hang), "faces"_a, "first_frame"_a, "starts"_a, "widths"_a)
        .def("gop_memory", in_turn(&Chain::gop_memory), "method"_a, "frames"_a, "fields"_a)
        .def("begin", in_turn(&Chain::begin), "index"_a)
        .def("site", in_turn(&Chain::site))
        .def("costs", in_turn(&Chain::costs), "width"_a)
        .def("dictionary", in_turn(&Chain::dictionary), "width"_a)
        .def("give", in_turn(&Chain::give), "own"_a)
        .def("write", in_turn(&Chain::write), "prediction"_a, "coefficients"_a, "step"_a, "all"_a)
        .def("commit", in_turn(&Chain::commit), "width"_a, "positions"_a);
    nb::class_<TrackCoder>(m, "Track")
        .def(nb::init<const Chain &, int64_t>(), "whole"_a, "number"_a, nb::keep_alive<1, 2>())
        .def(nb::init<const TrackCoder &, const Chain &>(), "other"_a, "whole"_a, nb::keep_alive<1, 3>())
        .def("basis", in_turn(&TrackCoder::basis), "exponents"_a, "spectrum"_a)
        .def("code", in_turn(&TrackCoder::code), "method"_a, "frames"_a, "step"_a, "back"_a, "wanted"_a);
    nb::class_<Cut>(m, "Cut")
        .def(nb::init<ConstInts, ConstInts>(), "offsets"_a, "neighbors"_a, nb::keep_alive<1, 2>(),
            nb::keep_alive<1, 3>())
        .def("labels", in_turn(&Cut::labels), "parts"_a)
        .def("blocks", in_turn(&Cut::blocks), "labels"_a, "parts"_a, "size"_a)
        .def("cells", in_turn(&Cut::cells), "faces"_a, "reach"_a)
        .def("write", in_turn(&Cut::write), "labels"_a, "parts"_a)
        .def("rows", in_turn(&Cut::rows), "members"_a)
        .def("iterate", in_turn(&Cut::iterate), "shift"_a, "start"_a, "power"_a, "iterations"_a, "apart"_a);
    nb::class_<DecoderState>(m, "DecoderState")
#define NUMBER(name) .def_ro(#name, &DecoderState::name)
        NUMBER(offset) NUMBER(vertices) NUMBER(shown) NUMBER(present) NUMBER(work) NUMBER(received) NUMBER(memory);
#undef NUMBER
    nb::class_<SkimmedPacket>(m, "SkimmedPacket")
        .def_prop_ro("name", [](const SkimmedPacket &packet) { return nb::str(text_of(packet.name)); })
#define NUMBER(name) .def_ro(#name, &SkimmedPacket::name)
        NUMBER(type) NUMBER(offset) NUMBER(length) NUMBER(payload) NUMBER(data) NUMBER(index) NUMBER(count)
        NUMBER(entries) NUMBER(version) NUMBER(positions) NUMBER(begins) NUMBER(domain) NUMBER(semantic) NUMBER(kind)
        NUMBER(components) NUMBER(coding) NUMBER(rows) NUMBER(moves);
#undef NUMBER
    nb::class_<Decoder>(m, "Decoder")
        .def(nb::init<nb::object, int64_t, bool, int64_t, int64_t>(), "limits"_a, "threads"_a = 1,
            "tolerant"_a = false, "start"_a = 0, "layers"_a = 0)
        .def("push", in_turn(&Decoder::push), "bytes"_a)
        .def("finish", in_turn(&Decoder::finish))
        .def("next", in_turn(&Decoder::next), "wanted"_a)
        .def("skim", in_turn(&Decoder::skim))
        .def("faces", in_turn(&Decoder::faces), "count"_a)
        .def("positions", in_turn(&Decoder::positions), "count"_a)
        .def("changes", in_turn(&Decoder::changes))
        .def("loose", in_turn(&Decoder::loose))
        .def("losses", in_turn(&Decoder::losses))
        .def("metadata", in_turn(&Decoder::metadata), "index"_a)
        .def("attribute_count", in_turn(&Decoder::attribute_count))
        .def("attribute", in_turn(&Decoder::attribute), "index"_a)
        .def("values", in_turn(&Decoder::values), "index"_a)
        .def("header", in_turn(&Decoder::header))
        .def("state", in_turn(&Decoder::state))
        .def("loss", in_turn(&Decoder::loss));
}
