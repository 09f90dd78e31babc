#include "plan/segments.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/two_pi.h"
#include "plan/constants.h"

namespace servodx {
namespace {

namespace k = plan_constants;

// Of the cycle's amplitude, at a phase in [0, 1).
double triangle(double phase) { return phase < 0.25 ? 4 * phase : phase < 0.75 ? 2 - 4 * phase : 4 * phase - 4; }
double square(double phase) { return phase < 0.25 || phase >= 0.75 ? 1.0 : -1.0; }
double eighths(double phase, const double (&level)[8]) { return level[std::min(7, static_cast<int>(8 * phase))]; }
constexpr double stair_levels[8] = {1.0 / 3, 1.0, 2.0 / 3, 0.0, -1.0 / 3, -1.0, -2.0 / 3, 0.0};
constexpr double pulse_levels[8] = {1.0, 0.0, 0.0, -1.0, -1.0, 0.0, 0.0, 1.0};

// `cycles` of a shape at a part of its time in [0, 1).
double level(Shape shape, double part, double cycles) {
  const double phase = part * cycles - std::floor(part * cycles);
  switch (shape) {
    case Shape::rest:
      return 0;
    case Shape::steps:
      return square(phase);
    case Shape::pulses:
      return eighths(phase, pulse_levels);
    case Shape::stairs:
      return eighths(phase, stair_levels);
    case Shape::triangle:
      return triangle(phase);
    case Shape::sine:
      return std::sin(two_pi * phase);
    case Shape::sweep:  // from a third of the rate to five thirds: as many cycles
      return std::sin(two_pi * cycles * part * (1.0 + 2.0 * part) / 3.0);
  }
  return 0;
}

double fastest(double seconds, double rate) {
  return std::max(1.0 / seconds, std::min(k::fastest, rate / k::samples_a_cycle));
}

}  // namespace

std::string name_of(Shape shape) {
  switch (shape) {
    case Shape::rest:
      return "rest";
    case Shape::steps:
      return "steps";
    case Shape::pulses:
      return "pulses";
    case Shape::stairs:
      return "stairs";
    case Shape::triangle:
      return "triangle";
    case Shape::sine:
      return "sine";
    case Shape::sweep:
      return "sweep";
  }
  return "";
}

Timing timing_of(double seconds, double rate) {
  Timing t;
  t.rate = rate;
  t.samples = static_cast<std::size_t>(std::floor(seconds * rate + 1e-9));
  const double played = seconds - k::lead - k::tail;
  const int pieces = std::clamp(static_cast<int>(std::lround(played / k::piece)), k::fewest_pieces, k::most_pieces);
  for (int i = 0; i <= pieces; ++i)
    t.first.push_back(static_cast<std::size_t>(std::lround((k::lead + played * i / pieces) * rate)));
  return t;
}

Timing single_piece(const Timing& of) {
  Timing t;
  t.rate = of.rate;
  const std::size_t tail = of.samples - of.first.back();
  t.first = {of.first[0], of.first[1]};
  t.samples = of.first[1] + tail;
  return t;
}

double played_rate(const Segment& s, double seconds) {
  return s.shape == Shape::rest ? 0.0 : std::max(1.0, std::round(s.rate * seconds)) / seconds;
}

std::vector<double> wave_of(const std::vector<Segment>& segments, const Timing& timing) {
  std::vector<double> wave(timing.samples, 0.0);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const double cycles = std::round(played_rate(segments[i], timing.seconds(i)) * timing.seconds(i));
    const std::size_t from = timing.first[i], to = timing.first[i + 1];
    for (std::size_t n = from; n < to; ++n)
      wave[n] = segments[i].amplitude *
                level(segments[i].shape, static_cast<double>(n - from) / static_cast<double>(to - from), cycles);
  }
  return wave;
}

std::vector<Segment> segment_library(double current, double seconds, double rate) {
  std::vector<Segment> out = {{}};
  for (int s = 1; s < n_shapes; ++s)
    for (const double a : k::amplitudes)
      for (const double r : k::rates)
        if (r <= fastest(seconds, rate)) out.push_back({static_cast<Shape>(s), a * current, r});
  return out;
}

Segment random_segment(Random& random, double current, double seconds, double rate) {
  Segment s;
  s.shape = static_cast<Shape>(1 + random.below(n_shapes - 1));
  const double least = std::log(k::amplitudes.front());
  s.amplitude = current * std::exp(least * random.uniform());
  const double slow = 1.0 / seconds;
  s.rate = slow * std::exp(std::log(fastest(seconds, rate) / slow) * random.uniform());
  return s;
}

}  // namespace servodx
