#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "curves/curves.h"
#include "servodx/log.h"
#include "servodx/rig.h"

namespace servodx::curves {
namespace {

constexpr std::uint32_t draws = 40;   // the standard deviation is known to 11 %
constexpr std::uint32_t fewest = 20;  // draws that show the figure
constexpr double coverage = 2.0;      // k of an expanded uncertainty
constexpr std::uint64_t seed = 1;     // fixed: a figure's uncertainty is a property of the log

// [SI] of white noise, from second differences of the samples; 0 where the resolution hides it.
double noise_of(const std::vector<double>& y) {
  std::vector<double> d;
  for (std::size_t k = 1; k + 1 < y.size(); ++k)
    if (const double v = y[k - 1] - 2 * y[k] + y[k + 1]; !std::isnan(v)) d.push_back(std::fabs(v));
  if (d.empty()) return 0;
  const auto middle = d.begin() + static_cast<std::ptrdiff_t>(d.size() / 2);
  std::nth_element(d.begin(), middle, d.end());
  return *middle / (0.6745 * std::sqrt(6.0));
}

// Readings of one signal as they might have been. What was rounded to one value was rounded by one error.
void draw(std::vector<double>& y, double noise, double resolution, const InstrumentError& instrument, Random& random) {
  const double gain = 1 + random.normal(0, instrument.relative / coverage);
  const double offset = random.normal(0, instrument.absolute / coverage);
  double last = std::nan(""), rounding = 0;
  for (double& value : y) {
    if (value != last) rounding = random.uniform(-0.5, 0.5) * resolution;
    last = value;
    value = value * gain + offset + rounding + (noise > 0 ? random.normal(0, noise) : 0.0);
  }
}

InstrumentError of_signal(const std::vector<InstrumentError>& instruments, Signal signal) {
  for (const InstrumentError& i : instruments)
    if (i.signal == signal) return i;
  return {signal, 0, 0};
}

}  // namespace

void add_uncertainty(Sheet& sheet, const Log& log, const RigFile& rig,
                     const std::vector<InstrumentError>& instruments) {
  std::vector<double> noise(n_signals, 0.0);
  for (int s = 0; s < n_signals; ++s)
    if (const auto signal = static_cast<Signal>(s); log.has(signal)) noise[s] = noise_of(log[signal]);
  std::vector<std::vector<double>> drawn(sheet.figures.size());
  for (std::uint32_t n = 0; n < draws; ++n) {
    Log one = log;
    for (int s = 0; s < n_signals; ++s) {
      const auto signal = static_cast<Signal>(s);
      if (signal == Signal::time || !log.has(signal)) continue;
      Random random(seed, n, static_cast<std::uint32_t>(s));
      Channel& channel = one.channels[index(signal)];
      draw(channel.value, noise[s], channel.resolution, of_signal(instruments, signal), random);
    }
    Sheet read;
    try {
      read = read_figures(one, rig);
    } catch (const InputError&) {
      continue;  // this draw shows no figure
    }
    for (std::size_t i = 0; i < sheet.figures.size(); ++i)
      for (const Figure& f : read.figures)
        if (f.name == sheet.figures[i].name && f.signal == sheet.figures[i].signal && std::isfinite(f.value))
          drawn[i].push_back(f.value);
  }
  for (std::size_t i = 0; i < sheet.figures.size(); ++i) {
    if (!std::isfinite(sheet.figures[i].value) || drawn[i].size() < fewest) continue;
    double mean = 0, square = 0;
    for (double v : drawn[i]) mean += v / static_cast<double>(drawn[i].size());
    for (double v : drawn[i]) square += (v - mean) * (v - mean);
    sheet.figures[i].uncertainty = coverage * std::sqrt(square / static_cast<double>(drawn[i].size() - 1));
  }
}

}  // namespace servodx::curves
