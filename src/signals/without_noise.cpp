#include "signals/without_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace servodx {
namespace {

// Solves (I + lambda D'D) z = x, D the second difference, by a banded L D L'.
std::vector<double> smoothed(std::span<const double> x, double lambda) {
  const std::size_t n = x.size();
  std::vector<double> d(n), e(n, 0.0), f(n, 0.0), z(x.begin(), x.end());
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t edge = std::min(i, n - 1 - i);
    const std::size_t coupling = std::min(i, n - 2 - std::min(i, n - 2));  // of i with i + 1
    const double diagonal = edge == 0 ? 1.0 : edge == 1 ? 5.0 : 6.0;
    const double next = coupling == 0 ? -2.0 : -4.0;
    d[i] = 1.0 + lambda * diagonal;
    if (i >= 1) d[i] -= d[i - 1] * e[i - 1] * e[i - 1];
    if (i >= 2) d[i] -= d[i - 2] * f[i - 2] * f[i - 2];
    if (i + 1 < n) e[i] = (lambda * next - (i >= 1 ? d[i - 1] * f[i - 1] * e[i - 1] : 0.0)) / d[i];
    if (i + 2 < n) f[i] = lambda / d[i];
    if (i >= 1) z[i] -= e[i - 1] * z[i - 1];
    if (i >= 2) z[i] -= f[i - 2] * z[i - 2];
  }
  for (std::size_t i = 0; i < n; ++i) z[i] /= d[i];
  for (std::size_t i = n; i-- > 0;) {
    if (i + 1 < n) z[i] -= e[i] * z[i + 1];
    if (i + 2 < n) z[i] -= f[i] * z[i + 2];
  }
  return z;
}

// Of the first difference times its transpose, ends aside.
std::vector<double> eigenvalues(std::size_t n) {
  std::vector<double> out(n);
  for (std::size_t k = 0; k < n; ++k)
    out[k] = 2.0 - 2.0 * std::cos(std::numbers::pi * static_cast<double>(k) / static_cast<double>(n));
  return out;
}

// Trace of the smoother's matrix: D'D has the squares of these eigenvalues.
double freedom(const std::vector<double>& eigenvalues, double lambda) {
  double sum = 0.0;
  for (const double c : eigenvalues) sum += 1.0 / (1.0 + lambda * c * c);
  return sum;
}

}  // namespace

std::vector<double> without_noise(std::span<const double> x) {
  const std::size_t n = x.size();
  std::vector<double> best(x.begin(), x.end());
  if (n < 8) return best;
  const std::vector<double> of_difference = eigenvalues(n);
  // lambda is a length in samples to the fourth power; half-decades from a tenth of a sample to the whole series.
  double least = std::numeric_limits<double>::infinity();
  for (double length = 0.1; length < static_cast<double>(n); length *= std::sqrt(std::sqrt(10.0))) {
    const double lambda = length * length * length * length;
    std::vector<double> z = smoothed(x, lambda);
    double misfit = 0.0;
    for (std::size_t i = 0; i < n; ++i) misfit += (x[i] - z[i]) * (x[i] - z[i]);
    const double left = 1.0 - freedom(of_difference, lambda) / static_cast<double>(n);
    const double score = misfit / (left * left);
    if (score < least) {
      least = score;
      best = std::move(z);
    }
  }
  return best;
}

}  // namespace servodx
