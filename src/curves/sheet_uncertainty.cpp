#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "curves/constants.h"
#include "curves/curves.h"
#include "servodx/curves.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "signals/noise.h"

namespace servodx::curves {
namespace {

using namespace curves_constants;

// Readings of one signal as they might have been. What was rounded to one value was rounded by one error.
void draw(std::vector<double>& y, double noise, double resolution, Random& random) {
  double last = std::nan(""), rounding = 0;
  for (double& value : y) {
    if (value != last) rounding = random.uniform(-0.5, 0.5) * resolution;
    last = value;
    value = value + rounding + (noise > 0 ? random.normal(0, noise) : 0.0);
  }
}

// Of a log that might have been: nothing where it shows no figure.
Sheet figures_or_none(const Log& log, const RigFile& rig) {
  try {
    return read_figures(log, rig);
  } catch (const InputError&) {
    return {};
  }
}

const Figure* same_figure(const Sheet& sheet, const Figure& as) {
  for (const Figure& f : sheet.figures)
    if (f.name == as.name && f.signal == as.signal && std::isfinite(f.value)) return &f;
  return nullptr;
}

Log drawn_log(const Log& log, const std::vector<double>& noise, std::uint32_t number) {
  Log one = log;
  for (int s = 0; s < n_signals; ++s) {
    const auto signal = static_cast<Signal>(s);
    if (signal == Signal::time || !log.has(signal)) continue;
    Random random(seed, number, static_cast<std::uint32_t>(s));
    Channel& channel = one.channels[index(signal)];
    draw(channel.value, noise[index(signal)], channel.resolution, random);
  }
  return one;
}

// Squares of what noise and resolution do to each figure, expanded; NaN where too few draws show it.
std::vector<double> by_draws(const Sheet& sheet, const Log& log, const RigFile& rig) {
  std::vector<double> noise(n_signals, 0.0);
  for (int s = 0; s < n_signals; ++s)
    if (const auto signal = static_cast<Signal>(s); log.has(signal)) noise[index(signal)] = noise_of(log[signal], 0);
  std::vector<std::vector<double>> drawn(sheet.figures.size());
  for (std::uint32_t n = 0; n < draws; ++n) {
    const Sheet read = figures_or_none(drawn_log(log, noise, n), rig);
    for (std::size_t i = 0; i < drawn.size(); ++i)
      if (const Figure* f = same_figure(read, sheet.figures[i])) drawn[i].push_back(f->value);
  }
  std::vector<double> squares;
  for (const std::vector<double>& values : drawn) {
    double mean = 0, square = 0;
    for (double v : values) mean += v / static_cast<double>(values.size());
    for (double v : values) square += (v - mean) * (v - mean);
    squares.push_back(values.size() < fewest_draws
                          ? std::nan("")
                          : coverage * coverage * square / static_cast<double>(values.size() - 1));
  }
  return squares;
}

// The same of one error of an instrument, by what the figures do between its two ends.
void add_error(std::vector<double>& squares, const Sheet& sheet, const Log& log, const RigFile& rig, Signal signal,
               double gain, double offset) {
  if ((gain == 0 && offset == 0) || !log.has(signal)) return;
  const auto read_with = [&](double way) {
    Log one = log;
    for (double& v : one.channels[index(signal)].value) v += way * (gain * v + offset);
    return figures_or_none(one, rig);
  };
  const Sheet high = read_with(1), low = read_with(-1);
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const Figure *a = same_figure(high, sheet.figures[i]), *b = same_figure(low, sheet.figures[i]);
    const double half = a && b ? 0.5 * (a->value - b->value) : std::nan("");
    squares[i] += half * half;
  }
}

}  // namespace

void add_uncertainty(Sheet& sheet, const Log& log, const RigFile& rig,
                     const std::vector<InstrumentError>& instruments) {
  std::vector<double> squares = by_draws(sheet, log, rig);
  for (const InstrumentError& e : instruments) {
    add_error(squares, sheet, log, rig, e.signal, e.relative, 0);
    add_error(squares, sheet, log, rig, e.signal, 0, e.absolute);
  }
  for (std::size_t i = 0; i < squares.size(); ++i)
    if (std::isfinite(sheet.figures[i].value)) sheet.figures[i].uncertainty = std::sqrt(squares[i]);
}

}  // namespace servodx::curves
