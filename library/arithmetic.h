/* The arithmetic of the processor: the decoder needs that of IEEE 754, rounded to nearest, with subnormal numbers; its
 * host may have set another one. Game engines let small numbers be flushed to 0. */
#pragma once

#include "bitstream/kernel.h"

#if defined(__wasm__) /* has no other */
typedef int Arithmetic;
INLINE Arithmetic begin_arithmetic(void) { return 0; }
INLINE void end_arithmetic(Arithmetic host) { (void)host; }
#define EXACTLY(type, name, parameters, arguments) type name parameters
INLINE bool is_exact(void) { return true; }
#else

#if defined(__SSE2__) || defined(__x86_64__)
typedef struct {
    uint32_t vectors;
    uint16_t stack; /* of 32-bit programs, whose library may use it */
} Arithmetic;
INLINE Arithmetic begin_arithmetic(void) {
    Arithmetic host = {__builtin_ia32_stmxcsr(), 0};
    __builtin_ia32_ldmxcsr(0x1f80);
#if !defined(__x86_64__)
    const uint16_t usual = 0x37f;
    __asm__ volatile("fnstcw %0" : "=m"(host.stack));
    __asm__ volatile("fldcw %0" : : "m"(usual));
#endif
    return host;
}
INLINE void end_arithmetic(Arithmetic host) {
    __builtin_ia32_ldmxcsr(host.vectors);
#if !defined(__x86_64__)
    __asm__ volatile("fldcw %0" : : "m"(host.stack));
#endif
}
#elif defined(__aarch64__)
typedef uint64_t Arithmetic;
INLINE Arithmetic begin_arithmetic(void) {
    Arithmetic host;
    __asm__ volatile("mrs %0, fpcr\n\tmsr fpcr, xzr" : "=&r"(host) : : "memory");
    return host;
}
INLINE void end_arithmetic(Arithmetic host) { __asm__ volatile("msr fpcr, %0" : : "r"(host) : "memory"); }
#elif defined(__arm__) && defined(__ARM_FP)
typedef uint32_t Arithmetic;
INLINE Arithmetic begin_arithmetic(void) {
    Arithmetic host;
    __asm__ volatile("vmrs %0, fpscr\n\tvmsr fpscr, %1" : "=&r"(host) : "r"(0) : "memory");
    return host;
}
INLINE void end_arithmetic(Arithmetic host) { __asm__ volatile("vmsr fpscr, %0" : : "r"(host) : "memory"); }
#else
#include <fenv.h>
typedef fenv_t Arithmetic;
INLINE Arithmetic begin_arithmetic(void) {
    Arithmetic host;
    fegetenv(&host);
    fesetenv(FE_DFL_ENV);
    return host;
}
INLINE void end_arithmetic(Arithmetic host) { fesetenv(&host); }
#endif

/* Begins a function that computes whatever its host has set: inside of it arithmetic is exact, behind it as it was. The
 * body is a function of its own, so that compilers move nothing out of it. */
#define EXACTLY(type, name, parameters, arguments)                                                                     \
    static __attribute__((noinline)) type name##_exactly parameters;                                                   \
    type name parameters {                                                                                             \
        Arithmetic host = begin_arithmetic();                                                                          \
        type result = name##_exactly arguments;                                                                        \
        end_arithmetic(host);                                                                                          \
        return result;                                                                                                 \
    }                                                                                                                  \
    static __attribute__((noinline)) type name##_exactly parameters

/* Whether this build computes as IEEE 754 has it, where nothing else is set: each operation rounded by itself, to its
 * type. */
bool is_exact(void);
#endif
