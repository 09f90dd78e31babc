#include "fit/bode.h"

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>

#include "base/two_pi.h"
#include "fit/constants.h"
#include "fit/stand.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

using namespace fit_constants;

double frequency_at(int k) { return bode_lowest * std::pow(bode_highest / bode_lowest, k / (bode_frequencies - 1.0)); }

// A valve's line: gain over `reference`, and the phase nearest to the last.
BodeLine line_of(const std::string& name, const std::vector<std::complex<double>>& values, double reference) {
  BodeLine line{name, {}, {}};
  double last = 0;
  for (const std::complex<double>& g : values) {
    line.gain.push_back(20 * std::log10(std::abs(g) / reference));
    const double phase = std::arg(g);
    line.phase.push_back(phase + two_pi * std::round((last - phase) / two_pi));
    if (std::isfinite(line.phase.back())) last = line.phase.back();
  }
  return line;
}

// Where `y` first falls below `level`, on a line over the logarithm of the frequency.
std::optional<double> first_below(const std::vector<double>& frequency, const std::vector<double>& y, double level) {
  for (std::size_t k = 1; k < y.size(); ++k)
    if (y[k] < level && y[k - 1] >= level)
      return frequency[k - 1] * std::pow(frequency[k] / frequency[k - 1], (y[k - 1] - level) / (y[k - 1] - y[k]));
  return {};
}

}  // namespace

std::vector<Bode> bode_of(const std::vector<Candidate>& valves, const RigFile& rig) {
  std::vector<Bode> out;
  if (valves.empty()) return out;
  std::vector<ParameterVector> candidates;
  for (const Candidate& v : valves) candidates.push_back(v.candidate);
  const double rated = rated_current(rig, candidates.front());
  std::vector<StandTest> tests;
  for (const double amplitude : bode_amplitudes) {
    out.push_back({amplitude, {}, {}});
    for (int k = 0; k < bode_frequencies; ++k) {
      const double f = frequency_at(k);
      out.back().frequency.push_back(f);
      tests.push_back(sine_test(rig, rated, amplitude, f, settling_cycles(f)));
    }
  }
  const auto runs = spools(tests, candidates);
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::size_t test = 0;
  for (Bode& bode : out) {
    std::vector<std::vector<std::complex<double>>> values(valves.size());
    for (std::size_t k = 0; k < bode.frequency.size(); ++k, ++test)
      for (std::size_t v = 0; v < valves.size(); ++v)
        values[v].push_back(runs[test][v].empty() ? std::complex<double>(none, none)
                                                  : response(tests[test], runs[test][v]));
    const double reference = std::abs(values.front().front());
    for (std::size_t v = 0; v < valves.size(); ++v) bode.lines.push_back(line_of(valves[v].name, values[v], reference));
  }
  return out;
}

Bandwidth bandwidth_of(const Bode& bode, const BodeLine& line) {
  return {first_below(bode.frequency, line.gain, line.gain.front() - bandwidth_fall),
          first_below(bode.frequency, line.phase, -two_pi / 4)};
}

}  // namespace servodx
