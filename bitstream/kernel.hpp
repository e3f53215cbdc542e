// Numpy arrays to the arrays of kernel.h, checked: type, dimensions, contiguity. Nothing is copied or converted.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <tuple>
#include <type_traits>
#include <utility>

extern "C" {
#include "bitstream/kernel.h"
}

namespace nb = nanobind;

namespace nanobind::detail {

template <typename T, size_t N> using KernelView = ndarray<T, numpy, ndim<N>, c_contig, device::cpu>;

template <typename Array, typename T> void fill(Array &array, const KernelView<T, 1> &view) {
    array.data = view.data();
    array.size = (int64_t)view.shape(0);
}

template <typename Array, typename T> void fill(Array &array, const KernelView<T, 2> &view) {
    array.data = view.data();
    array.rows = (int64_t)view.shape(0);
    array.columns = (int64_t)view.shape(1);
}

template <typename Array, typename T, size_t N> struct ArrayCaster {
    using Inner = make_caster<KernelView<T, N>>;
    NB_TYPE_CASTER(Array, Inner::Name)
    bool from_python(handle source, uint8_t, cleanup_list *cleanup) noexcept {
        Inner inner;
        if (source.is_none() || !inner.from_python(source, 0, cleanup)) return false;
        fill(value, inner.value);
        return true;
    }
};

// A tuple (or NamedTuple) of arrays to a struct of them.
template <typename Struct, typename... Arrays> struct TupleCaster {
    NB_TYPE_CASTER(Struct, const_name("tuple[") + concat(make_caster<Arrays>::Name...) + const_name("]"))
    bool from_python(handle source, uint8_t flags, cleanup_list *cleanup) noexcept {
        if (!isinstance<nanobind::tuple>(source)) return false;
        nanobind::tuple items = borrow<nanobind::tuple>(source);
        return items.size() == sizeof...(Arrays) && take(items, flags, cleanup, std::index_sequence_for<Arrays...>());
    }

  private:
    template <size_t... I>
    bool take(const nanobind::tuple &items, uint8_t flags, cleanup_list *cleanup, std::index_sequence<I...>) noexcept {
        std::tuple<make_caster<Arrays>...> casters;
        if (!(std::get<I>(casters).from_python(items[I], flags, cleanup) && ...)) return false;
        value = Struct{std::get<I>(casters).value...};
        return true;
    }
};

}  // namespace nanobind::detail

// A kernel runs without the interpreter's lock.
using Unlocked = nb::call_guard<nb::gil_scoped_release>;

inline constexpr const char *DO_NOT_FIT = "arrays or numbers that do not fit together, given to a kernel";

// A kernel that checks its arrays itself: MISUSED is an exception.
template <auto kernel> struct Checked;
template <typename Result, typename... Arguments, Result (*kernel)(Arguments...)> struct Checked<kernel> {
    static Result call(Arguments... arguments) {
        if constexpr (std::is_same_v<Result, int64_t>) {
            int64_t result = kernel(arguments...);
            if (result == MISUSED) throw nb::value_error(DO_NOT_FIT);
            return result;
        } else
            return kernel(arguments...);
    }
};

// A kernel whose arrays, or whose indices, a guard with the same arguments checks first.
template <auto kernel, auto guard> struct Guarded;
template <typename Result, typename... Arguments, Result (*kernel)(Arguments...), bool (*guard)(Arguments...)>
struct Guarded<kernel, guard> {
    static Result call(Arguments... arguments) {
        if (!guard(arguments...)) throw nb::value_error(DO_NOT_FIT);
        return Checked<kernel>::call(arguments...);
    }
};

// Bind a kernel of room `m`, with its name and arguments as in C: one that looks at its arrays itself, or one that a
// guard of the same name looks for.
#define CHECKED(name) m.def(#name, &Checked<&name>::call, Unlocked());
#define GUARDED(name) m.def(#name, &Guarded<&name, &guards::name>::call, Unlocked());

#define BSM_CASTER(Array, type, dimensions)                                                                            \
    template <> struct nb::detail::type_caster<Array> : nb::detail::ArrayCaster<Array, type, dimensions> {};
#define BSM_CASTERS(Array, type)                                                                                       \
    BSM_CASTER(Array, type, 1)                                                                                         \
    BSM_CASTER(Array##2, type, 2)                                                                                      \
    BSM_CASTER(Const##Array, const type, 1)                                                                            \
    BSM_CASTER(Const##Array##2, const type, 2)

BSM_CASTERS(Bytes, uint8_t)
BSM_CASTERS(Shorts, int16_t)
BSM_CASTERS(Ints, int32_t)
BSM_CASTERS(Words, uint32_t)
BSM_CASTERS(Longs, int64_t)
BSM_CASTERS(Singles, float)
BSM_CASTERS(Doubles, double)

// A struct of arrays, structs and numbers that Python keeps as a NamedTuple, member for member.
#define BSM_STRUCT(Struct, ...)                                                                                        \
    template <> struct nb::detail::type_caster<Struct> : nb::detail::TupleCaster<Struct, __VA_ARGS__> {};
