#include "prognose/seeded.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "base/normal.h"
#include "base/student.h"
#include "model/state.h"
#include "prognose/constants.h"
#include "simulate/scenario.h"

namespace servodx {

using namespace prognose_constants;

namespace {

// Means of values that were meant to be the same, rising.
std::vector<double> levels_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  std::vector<double> levels;
  for (std::size_t from = 0, to = 0; from < values.size(); from = to) {
    double sum = 0;
    while (to < values.size() && (to == from || values[to] - values[to - 1] <= apart * (values.back() - values[0])))
      sum += values[to++];
    levels.push_back(sum / static_cast<double>(to - from));
  }
  return levels;
}

std::size_t nearest(const std::vector<double>& levels, double value) {
  const auto away = [&](double a, double b) { return std::abs(a - value) < std::abs(b - value); };
  return static_cast<std::size_t>(std::min_element(levels.begin(), levels.end(), away) - levels.begin());
}

// One standard deviation of another value by so few that scatter about nought, or about their mean: Student's factor at
// 90 %, and the error of that mean.
double spread_of(const std::vector<double>& off) {
  const auto n = static_cast<double>(off.size());
  if (n < 2) return 0;
  double square = 0;
  for (double x : off) square += x * x;
  return student_quantile(0.1, n - 1) / normal_95_one_sided * std::sqrt(square / (n - 1) * (1 + 1 / n));
}

double mean_of(const std::vector<double>& v) {
  double sum = 0;
  for (double x : v) sum += x;
  return sum / static_cast<double>(v.size());
}

}  // namespace

double log_viscosity(double kelvin) { return std::log(oil_at(860, 14e-6, kelvin).viscosity_ratio); }

ReadingCurve::ReadingCurve(const std::vector<SeededReading>& readings, std::optional<double> origin) {
  learn_readings(readings);
  const std::vector<Off> offs = offs_of(readings);
  learn_spreads(offs);
  learn_errors(offs, origin.value_or(sizes_.front()));
}

void ReadingCurve::learn_readings(const std::vector<SeededReading>& readings) {
  std::vector<double> truths, oils;
  for (const SeededReading& r : readings) truths.push_back(r.truth), oils.push_back(r.log_viscosity);
  sizes_ = levels_of(truths), viscosities_ = levels_of(oils);
  if (sizes_.size() < 2) throw std::invalid_argument("needs readings of two sizes of wear");
  std::vector<std::vector<std::vector<double>>> cells(viscosities_.size(),
                                                      std::vector<std::vector<double>>(sizes_.size()));
  for (const SeededReading& r : readings)
    cells[nearest(viscosities_, r.log_viscosity)][nearest(sizes_, r.truth)].push_back(r.reading);
  for (const auto& of_oil : cells) {
    std::vector<double> means;
    for (const std::vector<double>& cell : of_oil) {
      if (cell.empty()) throw std::invalid_argument("needs a reading of every size at every oil temperature");
      means.push_back(means.empty() ? mean_of(cell) : std::max(means.back(), mean_of(cell)));
    }
    if (!(means.back() > means.front())) throw std::invalid_argument("reads no more of the largest than of the least");
    readings_.push_back(std::move(means));
  }
}

std::vector<ReadingCurve::Off> ReadingCurve::offs_of(const std::vector<SeededReading>& readings) const {
  std::vector<Off> out;
  for (const SeededReading& r : readings)
    out.push_back({r.valve, nearest(viscosities_, r.log_viscosity), nearest(sizes_, r.truth), r.truth, r.log_viscosity,
                   at(r.reading, r.log_viscosity).truth - r.truth});
  return out;
}

// Of each size, by the means of the valves over their oils.
void ReadingCurve::learn_spreads(const std::vector<Off>& offs) {
  std::vector<std::map<std::string, std::vector<double>>> of_size(sizes_.size());
  for (const Off& off : offs) of_size[off.size][off.valve].push_back(off.by);
  for (const auto& of_valves : of_size) {
    std::vector<double> means;
    for (const auto& [valve, by] : of_valves) means.push_back(mean_of(by));
    spreads_.push_back(spread_of(means));
  }
}

// Each valve by itself: off = base + size * grown + (d1 z + d2 z2) acted, by how far valves are off there.
void ReadingCurve::learn_errors(const std::vector<Off>& offs, double origin) {
  constexpr long unknowns = 4;
  const double least = least_scatter * (sizes_.back() - sizes_.front());
  using Cells = std::vector<std::vector<std::vector<double>>>;  // [oil][size]
  Cells cells(viscosities_.size(), std::vector<std::vector<double>>(sizes_.size())), left = cells;
  std::map<std::string, std::vector<Off>> of_valve;
  for (const Off& off : offs) cells[off.oil][off.size].push_back(off.by), of_valve[off.valve].push_back(off);
  std::vector<std::vector<double>> scatter;
  for (const auto& of_oil : cells) {
    scatter.emplace_back();
    for (const std::vector<double>& cell : of_oil) scatter.back().push_back(std::max(spread_of(cell), least));
  }
  std::vector<double> size, tilt;
  for (const auto& [valve, its] : of_valve) {
    Eigen::MatrixXd x(std::ssize(its), unknowns);
    Eigen::VectorXd y(std::ssize(its));
    for (long i = 0; i < std::ssize(its); ++i) {
      const Off& off = its[static_cast<std::size_t>(i)];
      const double z = off.log_viscosity, acted = off.truth - origin;
      const double known_to = scatter[off.oil][off.size];
      x.row(i) << 1, off.truth - sizes_.front(), z * acted, z * z * acted;
      x.row(i) /= known_to, y[i] = off.by / known_to;
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(x);
    if (qr.rank() < unknowns || std::ssize(its) <= unknowns) continue;
    const Eigen::VectorXd b = qr.solve(y), residual = y - x * b;
    const auto n = static_cast<double>(its.size());
    for (long i = 0; i < std::ssize(its); ++i) {
      const Off& off = its[static_cast<std::size_t>(i)];
      left[off.oil][off.size].push_back(std::sqrt(n / (n - unknowns)) * residual[i] * scatter[off.oil][off.size]);
    }
    size.push_back(b[1]), tilt.push_back(b[2]), tilt.push_back(b[3]);
  }
  if (size.size() < least_valves) return;
  differing_ = {spread_of(size), spread_of(tilt)};
  for (std::size_t oil = 0; oil < cells.size(); ++oil)
    for (std::size_t k = 0; k < sizes_.size(); ++k)
      scatter[oil][k] = std::min(spread_of(left[oil][k]), scatter[oil][k]);
  errors_ = std::move(scatter);
}

ReadingCurve::Worn ReadingCurve::at(double reading, double log_viscosity) const {
  const auto worn = [&](std::size_t oil) {
    const std::vector<double>& read = readings_[oil];
    std::size_t k = 1;
    while (k + 1 < read.size() && (reading > read[k] || read[k] == read[k - 1])) ++k;
    Worn at;
    if (reading > read.front()) at.per_reading = (sizes_[k] - sizes_[k - 1]) / (read[k] - read[k - 1]);
    at.truth = reading > read.front() ? sizes_[k - 1] + at.per_reading * (reading - read[k - 1])
                                      : sizes_.front() + reading - read.front();
    if (!errors_.empty()) at.error = errors_[oil][nearest(sizes_, at.truth)];
    return at;
  };
  if (viscosities_.size() < 2) return worn(0);
  const double z = std::clamp(log_viscosity, viscosities_.front(), viscosities_.back());
  std::size_t k = 1;
  while (k + 1 < viscosities_.size() && z > viscosities_[k]) ++k;
  const double part = (z - viscosities_[k - 1]) / (viscosities_[k] - viscosities_[k - 1]);
  const Worn thin = worn(k - 1), thick = worn(k);
  const auto between = [&](double Worn::*of) { return (1 - part) * thin.*of + part * thick.*of; };
  return {between(&Worn::truth), between(&Worn::per_reading), between(&Worn::error)};
}

double ReadingCurve::spread(double truth) const { return spreads_[nearest(sizes_, truth)]; }

}  // namespace servodx
