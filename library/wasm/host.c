/* What WebAssembly has no library for: memory, and what compilers call to copy it. */
#include <stdint.h>
#include <string.h>

#include "library/wasm/page.h"

/* Memory that was given back, by address; the last of it is given back to all that is free behind. */
typedef struct Free {
    struct Free *next;
    size_t size;
} Free;

enum { LINE = 64, PAGE = 65536 };
extern unsigned char __heap_base;
static Free *first;
static uintptr_t top;

static size_t lines(size_t size) { return (size + LINE - 1 + (size == 0)) / LINE * LINE; }

void *page_take(size_t size) {
    size = lines(size);
    for (Free **at = &first; *at != NULL; at = &(*at)->next) {
        Free *found = *at;
        if (found->size < size) continue;
        if (found->size == size) {
            *at = found->next;
        } else {
            *at = (Free *)((char *)found + size);
            **at = (Free){found->next, found->size - size};
        }
        return found;
    }
    if (top == 0) top = lines((uintptr_t)&__heap_base);
    size_t all = __builtin_wasm_memory_size(0) * PAGE;
    if (size > UINT32_MAX - top) return NULL;
    if (top + size > all) {
        /* By a quarter at least: each time all views of it are lost. */
        size_t least = top + size - all, more = least > all / 4 ? least : all / 4;
        if (__builtin_wasm_memory_grow(0, (more + PAGE - 1) / PAGE) == SIZE_MAX
            && __builtin_wasm_memory_grow(0, (least + PAGE - 1) / PAGE) == SIZE_MAX)
            return NULL;
    }
    top += size;
    return (void *)(top - size);
}

void page_give(void *memory, size_t size) {
    if (memory == NULL) return;
    Free **at = &first, **last = NULL, *given = memory;
    for (; *at != NULL && *at < given; at = &(*at)->next) last = at;
    *given = (Free){*at, lines(size)};
    *at = given;
    if (given->next != NULL && (char *)given + given->size == (char *)given->next) {
        given->size += given->next->size;
        given->next = given->next->next;
    }
    if (last != NULL && (char *)*last + (*last)->size == (char *)given) {
        (*last)->size += given->size;
        (*last)->next = given->next;
        at = last;
    }
    if ((uintptr_t)*at + (*at)->size == top) {
        top = (uintptr_t)*at;
        *at = NULL;
    }
}

static void *allocate(void *host, size_t size) {
    (void)host;
    return page_take(size);
}

static void release(void *host, void *memory, size_t size) {
    (void)host;
    page_give(memory, size);
}

bsmdec_allocator page_host(void) { return (bsmdec_allocator){sizeof(bsmdec_allocator), allocate, release, NULL}; }

void *memcpy(void *restrict to, const void *restrict from, size_t size) { return __builtin_memcpy(to, from, size); }

void *memmove(void *to, const void *from, size_t size) { return __builtin_memmove(to, from, size); }

void *memset(void *to, int value, size_t size) { return __builtin_memset(to, value, size); }

int memcmp(const void *a, const void *b, size_t size) {
    const unsigned char *x = a, *y = b;
    for (; size > 0 && *x == *y; size--) x++, y++;
    return size > 0 ? *x - *y : 0;
}

size_t strlen(const char *text) {
    size_t size = 0;
    while (text[size] != 0) size++;
    return size;
}

int strcmp(const char *a, const char *b) {
    while (*a != 0 && *a == *b) a++, b++;
    return *(const unsigned char *)a - *(const unsigned char *)b;
}
