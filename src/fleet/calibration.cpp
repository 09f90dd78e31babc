#include "fleet/calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/median.h"
#include "base/random.h"
#include "base/wilson.h"

namespace servodx {
namespace {

// Tenths, the last of them in three: there most verdicts lie, and 0.95 says another thing than 0.9999.
constexpr std::array ends = {0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.99, 0.999, 1.0};
constexpr std::size_t n_bins = ends.size() - 1;
constexpr std::uint32_t draws = 1000;  // the ends of an interval then scatter by some 3 % of its width
enum Stream : std::uint32_t { again, as_stated };

// An end between two bins belongs to the upper one.
std::size_t bin_of(double probability) {
  const auto *first = ends.begin() + 1, *last = ends.end() - 1;
  return static_cast<std::size_t>(std::upper_bound(first, last, probability) - first);
}

// The calibration error of statements that come one by one.
struct Misses {
  std::array<double, n_bins> of = {};  // right less stated, summed
  double n = 0;

  void add(double probability, bool is_right) { of[bin_of(probability)] += (is_right ? 1.0 : 0.0) - probability, ++n; }
  double error() const {
    return std::accumulate(of.begin(), of.end(), 0.0, [](double sum, double miss) { return sum + std::abs(miss); }) / n;
  }
};

double error_of(const std::vector<Statement>& all) {
  Misses misses;
  for (const Statement& s : all) misses.add(s.probability, s.is_right);
  return misses.error();
}

double drawn_again(const std::vector<Statement>& all, Random random) {
  Misses misses;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Statement& s = all[random.below(static_cast<std::uint32_t>(all.size()))];
    misses.add(s.probability, s.is_right);
  }
  return misses.error();
}

double drawn_as_stated(const std::vector<Statement>& all, Random random) {
  Misses misses;
  for (const Statement& s : all) misses.add(s.probability, random.uniform() < s.probability);
  return misses.error();
}

// Right in all, and stated on average, may be as far apart.
double farthest_overall(const Calibration& of) {
  const RateInterval right = wilson_95(static_cast<double>(of.right.counted), static_cast<double>(of.right.of));
  return std::max(of.stated - right.lower, right.upper - of.stated);
}

void put_interval(Calibration& out, const std::vector<Statement>& all, std::uint64_t seed) {
  std::vector<double> redrawn, chance;
  for (std::uint32_t k = 0; k < draws; ++k) {
    redrawn.push_back(drawn_again(all, Random(seed, Stream::again, k)));
    chance.push_back(drawn_as_stated(all, Random(seed, Stream::as_stated, k)));
  }
  out.by_chance = quantile(chance, 0.95);
  const double mean = std::accumulate(redrawn.begin(), redrawn.end(), 0.0) / draws;
  const double lower = quantile(redrawn, 0.025) - 2 * (mean - out.error);
  out.lower = out.error <= out.by_chance ? 0.0 : std::clamp(lower, 0.0, out.error);
  out.upper = std::max({out.error, quantile(redrawn, 0.975), farthest_overall(out)});
}

std::vector<Calibration::Bin> bins_of(const std::vector<Statement>& all) {
  std::array<Calibration::Bin, n_bins> bins;
  for (const Statement& s : all) {
    Calibration::Bin& bin = bins[bin_of(s.probability)];
    bin.stated += s.probability, bin.right.counted += s.is_right, ++bin.right.of;
  }
  std::vector<Calibration::Bin> out;
  for (std::size_t b = 0; b < n_bins; ++b) {
    if (bins[b].right.of == 0) continue;
    out.push_back(bins[b]);
    out.back().from = ends[b], out.back().to = ends[b + 1];
    out.back().stated /= static_cast<double>(bins[b].right.of);
  }
  return out;
}

}  // namespace

Calibration calibration_of(std::vector<Statement> statements, std::uint64_t seed) {
  std::erase_if(statements, [](const Statement& s) { return !(s.probability >= 0 && s.probability <= 1); });
  Calibration out;
  out.stated = out.error = out.by_chance = NAN;
  if (statements.empty()) return out;
  out.bins = bins_of(statements);
  out.stated = 0;
  for (const Statement& s : statements) out.stated += s.probability, out.right.counted += s.is_right, ++out.right.of;
  out.stated /= static_cast<double>(statements.size());
  out.error = error_of(statements);
  put_interval(out, statements, seed);
  return out;
}

}  // namespace servodx
