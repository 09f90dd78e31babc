#include "prognosis/metrics.h"

#include <algorithm>
#include <cmath>

#include "prognose/life.h"

namespace servodx {

bool alpha_lambda(const Life& life, double remaining, double alpha) {
  return std::abs(life_quantile(life, 0.5) - remaining) <= alpha * remaining;
}

double mass_within(const Life& life, double remaining, double alpha) {
  const auto inside =
      std::count_if(life.begin(), life.end(), [&](double t) { return std::abs(t - remaining) <= alpha * remaining; });
  return static_cast<double>(inside) / static_cast<double>(life.size());
}

double relative_accuracy(const Life& life, double remaining) {
  return 1 - std::abs(life_quantile(life, 0.5) - remaining) / remaining;
}

double cumulative_relative_accuracy(const std::vector<Prediction>& predictions, double end) {
  double sum = 0;
  long n = 0;
  for (const Prediction& p : predictions)
    if (p.at < end) sum += relative_accuracy(p.life, end - p.at), ++n;
  return n ? sum / static_cast<double>(n) : std::nan("");
}

double prognostic_horizon(const std::vector<Prediction>& predictions, double end, double alpha) {
  double from = end;
  for (auto p = predictions.rbegin(); p != predictions.rend(); ++p) {
    if (p->at >= end) continue;
    if (std::abs(life_quantile(p->life, 0.5) - (end - p->at)) > alpha * end) break;
    from = p->at;
  }
  return end - from;
}

double convergence(const std::vector<Prediction>& predictions, double end) {
  double moment = 0, area = 0;
  for (std::size_t k = 0; k + 1 < predictions.size(); ++k) {
    const double step = predictions[k + 1].at - predictions[k].at;
    const double error = std::min(end, std::abs(life_quantile(predictions[k].life, 0.5) - (end - predictions[k].at)));
    area += step * error;
    moment += step * error * (0.5 * (predictions[k].at + predictions[k + 1].at) - predictions.front().at);
  }
  return area > 0 ? moment / area : 0.0;
}

double crps(const Life& life, double remaining, double horizon) {
  const auto n = static_cast<double>(life.size());
  double first = 0, second = 0;
  for (std::size_t i = 0; i < life.size(); ++i) {
    const double t = std::min(life[i], horizon);
    first += std::abs(t - std::min(remaining, horizon));
    second += t * (2 * static_cast<double>(i) + 1 - n);  // sorted: sum over pairs of |t_i - t_j| / 2
  }
  return first / n - second / (n * n);
}

bool covers(const Life& life, double remaining, double coverage) {
  return remaining >= life_quantile(life, 0.5 - coverage / 2) && remaining <= life_quantile(life, 0.5 + coverage / 2);
}

double monotonicity(const std::vector<double>& feature) {
  long rises = 0, falls = 0;
  for (std::size_t k = 1; k < feature.size(); ++k)
    rises += feature[k] > feature[k - 1], falls += feature[k] < feature[k - 1];
  return feature.size() > 1 ? std::abs(static_cast<double>(rises - falls)) / static_cast<double>(feature.size() - 1)
                            : 0.0;
}

namespace {

double correlation_of(const std::vector<double>& a, const std::vector<double>& b) {
  const auto n = static_cast<double>(a.size());
  double ma = 0, mb = 0, ab = 0, aa = 0, bb = 0;
  for (std::size_t k = 0; k < a.size(); ++k) ma += a[k] / n, mb += b[k] / n;
  for (std::size_t k = 0; k < a.size(); ++k)
    ab += (a[k] - ma) * (b[k] - mb), aa += (a[k] - ma) * (a[k] - ma), bb += (b[k] - mb) * (b[k] - mb);
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0.0;
}

// At `n` even parts of the life.
std::vector<double> resampled(const std::vector<double>& x, std::size_t n) {
  std::vector<double> out(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double at = static_cast<double>(k) * static_cast<double>(x.size() - 1) / static_cast<double>(n - 1);
    const auto i = std::min(static_cast<std::size_t>(at), x.size() - 2);
    out[k] = x[i] + (at - static_cast<double>(i)) * (x[i + 1] - x[i]);
  }
  return out;
}

}  // namespace

double trendability(const std::vector<std::vector<double>>& features) {
  constexpr std::size_t parts = 100;
  double least = 1;
  for (std::size_t i = 0; i < features.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      least = std::min(least, std::abs(correlation_of(resampled(features[i], parts), resampled(features[j], parts))));
  return least;
}

double prognosability(const std::vector<std::vector<double>>& features) {
  const auto n = static_cast<double>(features.size());
  double mean = 0, square = 0, range = 0;
  for (const auto& f : features) mean += f.back() / n, range += std::abs(f.back() - f.front()) / n;
  for (const auto& f : features) square += std::pow(f.back() - mean, 2) / n;
  return range > 0 ? std::exp(-std::sqrt(square) / range) : 0.0;
}

}  // namespace servodx
