#define isfinite(x) __builtin_isfinite(x)
#define INFINITY __builtin_inff()
