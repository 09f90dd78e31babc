#include "signals/low_pass.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace servodx {
namespace {

// Within a millionth, by which no filter of use is off by as much as a sensor tells. A long log then costs no memory.
bool are_even(std::span<const double> time) {
  constexpr double within = 1e-6;
  if (time.size() < 2) return true;
  const double h = (time.back() - time.front()) / static_cast<double>(time.size() - 1);
  for (std::size_t k = 1; k < time.size(); ++k)
    if (std::abs(time[k] - time[k - 1] - h) > within * h) return false;
  return true;
}

}  // namespace

LowPass::LowPass(std::span<const double> time, double cutoff, int order)
    : cutoff_(cutoff), order_(order), even_(are_even(time)) {
  if (!(cutoff > 0) || order < 1 || order > highest_low_pass_order)
    throw std::invalid_argument("LowPass: the cutoff must be positive and the order 1 to 8");
  using Complex = std::complex<double>;
  constexpr double pi = std::numbers::pi;
  std::vector<Complex> poles;  // [rad/s] on a half circle; every one but a real one has its conjugate among them
  for (int k = 0; k < order; ++k) poles.push_back(std::polar(2 * pi * cutoff, pi * (0.5 + (k + 0.5) / order)));
  for (int k = 0; k < (order + 1) / 2; ++k) {
    const Complex p = poles[static_cast<std::size_t>(k)];
    Complex residue = std::pow(2 * pi * cutoff, order);
    for (int j = 0; j < order; ++j)
      if (j != k) residue /= p - poles[static_cast<std::size_t>(j)];
    const bool is_real = 2 * k + 1 == order;
    Mode mode{-1.0 / p, is_real ? residue : 2.0 * residue, {}};
    for (std::size_t i = 1; i < (even_ ? std::min<std::size_t>(2, time.size()) : time.size()); ++i) {
      // z' = p z + u, u linear over h: z = e^(p h) z + u0 (e^(p h) - 1) / p + (u1 - u0) (e^(p h) - 1 - p h) / (p^2 h).
      const double h = time[i] - time[i - 1];
      const Complex keep = std::exp(p * h);
      mode.steps.push_back({keep, (keep - 1.0) / p, (keep - 1.0 - p * h) / (p * p * h)});
    }
    modes_.push_back(std::move(mode));
  }
}

void LowPass::operator()(std::span<double> x) const {
  if (x.empty()) return;
  std::vector<double> out(x.size(), 0.0);
  for (const Mode& mode : modes_) {
    std::complex<double> z = mode.at_rest * x[0];
    out[0] += (mode.weight * z).real();
    for (std::size_t k = 1; k < x.size(); ++k) {
      const Step& s = mode.steps[even_ ? 0 : k - 1];
      z = s.keep * z + s.level * x[k - 1] + s.slope * (x[k] - x[k - 1]);
      out[k] += (mode.weight * z).real();
    }
  }
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = out[k];
}

void LowPass::cut(std::size_t from, std::size_t to) {
  if (even_) return;
  for (Mode& mode : modes_) {
    mode.steps.resize(to > 0 ? to - 1 : 0);
    mode.steps.erase(mode.steps.begin(), mode.steps.begin() + static_cast<long>(std::min(from, mode.steps.size())));
  }
}

}  // namespace servodx
