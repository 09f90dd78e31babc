// Freed memory stays with the program: a fit frees and asks for the same few megabytes thousands of times, and every
// page that went back to the system in between has to be cleared anew (a twentieth of a Jacobian's time).
#pragma once
#include <cstdlib>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace servodx {

// At the start of a program; the library itself leaves its caller's allocator alone.
inline void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 512 << 20);
#endif
}

}  // namespace servodx
