// A difference that dies away ends below the normal floats, where arithmetic takes a hundred times as long: zero there,
// in this thread, while the object lives. Elsewhere than on x86 it does nothing, and costs time alone.
// Source: Intel 64 and IA-32 Architectures Software Developer's Manual, vol. 1, section 10.2.3 (MXCSR: FTZ and DAZ).
#pragma once
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace servodx {

class FlushTiny {
 public:
#if defined(__SSE2__)
  FlushTiny() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040); }
  ~FlushTiny() { _mm_setcsr(before_); }
#else
  FlushTiny() = default;
#endif
  FlushTiny(const FlushTiny&) = delete;

 private:
  unsigned before_ = 0;
};

}  // namespace servodx
