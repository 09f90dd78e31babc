// The product of small square matrices of N rows, columns one after another, four numbers at a time: nearly all of a
// smoother's time. What is zero in the first costs nothing.
#pragma once

namespace servodx {

// out = b a^T.
template <int N>
inline __attribute__((always_inline)) void product(const double* a, const double* b, double* out) {
  typedef double V __attribute__((vector_size(32), aligned(8), may_alias));
  constexpr int width = 4;
  static_assert(N % width == 0);
  for (int j = 0; j < N; ++j) {
    V sum[N / width] = {};
    for (int k = 0; k < N; ++k) {
      const double f = a[k * N + j];
      if (f == 0) continue;
      const V* column = reinterpret_cast<const V*>(b + k * N);
      for (int i = 0; i < N / width; ++i) sum[i] += f * column[i];
    }
    for (int i = 0; i < N / width; ++i) reinterpret_cast<V*>(out + j * N)[i] = sum[i];
  }
}
template <int N>
void product_anywhere(const double* a, const double* b, double* out) {
  product<N>(a, b, out);
}
#if defined(__x86_64__)
template <int N>
__attribute__((target("avx2"))) void product_avx2(const double* a, const double* b, double* out) {
  product<N>(a, b, out);
}
#endif
template <int N>
auto best_product() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) return &product_avx2<N>;
#endif
  return &product_anywhere<N>;
}

}  // namespace servodx
