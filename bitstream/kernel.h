/* What kernels share: arrays as the caller hands them in, and how they are compiled for several instruction sets.
 *
 * A kernel is C11 without a C library: it allocates nothing (the caller brings scratch space), calls nothing, and keeps
 * every index inside the sizes that come with each array. The same files are compiled to WebAssembly.
 */
#pragma once

#include <float.h>
#include <stdbool.h>
#include <stdint.h>

/* Results are the same to the last bit everywhere (specification, M 1.3): each operation is rounded as IEEE 754 has it.
 * What a compiler says of itself is checked here, and fusing products and sums is switched off for all that follows.
 * What only running shows, the decoder finds (library/arithmetic.c). */
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || defined(_M_FP_FAST) \
    || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0)
#error "compile BSM without -ffast-math, -Ofast, -funsafe-math-optimizations or /fp:fast: they change decoded bits"
#endif
#if !defined(FLT_EVAL_METHOD) || FLT_EVAL_METHOD != 0
#error "compile BSM with arithmetic that is as wide as its types: for 32-bit x86 with -msse2 -mfpmath=sse"
#endif
#if FLT_RADIX != 2 || FLT_MANT_DIG != 24 || DBL_MANT_DIG != 53 || FLT_MAX_EXP != 128 || DBL_MAX_EXP != 1024
#error "BSM needs float and double of IEEE 754"
#endif
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__) && !defined(__cplusplus)
#pragma GCC optimize("fp-contract=off")
#elif defined(_MSC_VER)
#pragma fp_contract(off)
#endif

#ifndef BSMDEC_LIGHT /* 1: a build knows light grids alone, 2: with congruent parts, too */
#define BSMDEC_LIGHT 0
#endif

/* One and two dimensions, row-major, contiguous. */
#define BSM_ARRAY(Name, type)                                                                                          \
    typedef struct {                                                                                                   \
        type *data;                                                                                                    \
        int64_t size;                                                                                                  \
    } Name;                                                                                                            \
    typedef struct {                                                                                                   \
        type *data;                                                                                                    \
        int64_t rows, columns;                                                                                         \
    } Name##2;                                                                                                         \
    typedef struct {                                                                                                   \
        const type *data;                                                                                              \
        int64_t size;                                                                                                  \
    } Const##Name;                                                                                                     \
    typedef struct {                                                                                                   \
        const type *data;                                                                                              \
        int64_t rows, columns;                                                                                         \
    } Const##Name##2;

BSM_ARRAY(Bytes, uint8_t)
BSM_ARRAY(Shorts, int16_t)
BSM_ARRAY(Ints, int32_t)
BSM_ARRAY(Words, uint32_t)
BSM_ARRAY(Longs, int64_t)
BSM_ARRAY(Singles, float)
BSM_ARRAY(Doubles, double)

/* KERNEL before a function compiles it once per instruction set; the loader picks the best that the processor has. (By
 * levels: a processor's name would match that processor alone.) */
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__) && !defined(KERNEL_ONE_TARGET) && __GNUC__ >= 12
#define KERNEL __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define KERNEL
#endif

/* A file *.simd.c is compiled as a whole for each level of x86-64, with a name of its own for what others call, since
 * the shape of its vectors depends on the level; `isa.c` of the room chooses when the program runs. */
#ifdef KERNEL_ISA
#define ISA_OF(name, level) name##_v##level
#define ISA_NAME(name, level) ISA_OF(name, level)
#define ISA(name) ISA_NAME(name, KERNEL_ISA)
#else
#define ISA(name) name
#endif

/* In isa.c: which of these runs. */
#define CHOOSE_1(give, result, name, parameters, arguments)                                                            \
    result name##_v1 parameters;                                                                                       \
    result name parameters { give name##_v1 arguments; }
#define CHOOSE_3(give, result, name, parameters, arguments)                                                            \
    result name##_v1 parameters;                                                                                       \
    result name##_v3 parameters;                                                                                       \
    result name##_v4 parameters;                                                                                       \
    result name parameters {                                                                                           \
        if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&                                 \
            __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"))                                  \
            give name##_v4 arguments;                                                                                  \
        else if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2"))                                     \
            give name##_v3 arguments;                                                                                  \
        else                                                                                                           \
            give name##_v1 arguments;                                                                                  \
    }
#define CHOOSE_ISAS(isas) CHOOSE_##isas
#define CHOOSE_OF(isas) CHOOSE_ISAS(isas)
#define CHOOSE(...) CHOOSE_OF(KERNEL_ISAS)(return, __VA_ARGS__)
#define CHOOSE_VOID(...) CHOOSE_OF(KERNEL_ISAS)(, void, __VA_ARGS__)

/* Copied to every call, but where a decoder is built alone that has to be small: what that costs time is little. */
#ifdef BSM_LEAN
#define INLINE static inline __attribute__((unused))
#else
#define INLINE static inline __attribute__((always_inline))
#endif
#define INSIDE __attribute__((visibility("hidden")))
/* Copied to every call for speed, but to none in a decoder that is built alone, which has one of all files: that is
 * sent to where it is needed. */
#ifdef BSM_DECODER
#define SHARED __attribute__((noinline, weak))
#else
#define SHARED INLINE
#endif

/* Called often, and so not copied to where it is called: what runs WebAssembly compiles a function better from one call
 * to the next, and never while it runs. A decoder that has to be small copies what is called at one place. */
#if defined(BSM_DECODER) && !defined(BSM_LEAN)
#define OFTEN __attribute__((noinline))
#else
#define OFTEN
#endif

/* What a kernel returns that was given arrays which do not fit together: a mistake of its caller, never of a stream. */
#define MISUSED INT64_MIN

INLINE int64_t least(int64_t a, int64_t b) { return a < b ? a : b; }
INLINE int64_t largest(int64_t a, int64_t b) { return a > b ? a : b; }

/* Whether all numbers are from 0 to below `limit`; without a branch, so that many are looked at at once. */
INLINE bool all_below(const int32_t *numbers, int64_t count, int64_t limit) {
    int32_t outside = 0, last = (int32_t)least(limit - 1, INT32_MAX);
    for (int64_t i = 0; i < count; i++) outside |= numbers[i] | (numbers[i] > last ? -1 : 0);
    return outside >= 0;
}
