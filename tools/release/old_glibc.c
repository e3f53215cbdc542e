/* Linked into wheels: what they would otherwise take from a newer glibc than wheels ask for. */
#define HIDDEN __attribute__((visibility("hidden")))

/* glibc 2.32 tells the C++ library whether locks are needless; 0: it keeps them. */
HIDDEN char __libc_single_threaded = 0;

/* glibc 2.29 has an exp without errno; every glibc has the one with it. */
double first_exp(double x);
__asm__(".symver first_exp,exp@GLIBC_2.2.5");
HIDDEN double exp(double x) { return first_exp(x); }
