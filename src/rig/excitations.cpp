#include "rig/excitations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "base/two_pi.h"

namespace servodx::rig {
namespace {

constexpr double centring = 2.5;             // [1/m] of rated current: 0.05 mA/mm of 20 mA
using Wave = std::function<double(double)>;  // time [s] -> fraction of rated current

Stimulus open_loop(const RigModel& m, Wave wave) {
  const double rated = m.driver_rated_current;
  return {.command = [=](double t, double x) { return rated * (wave(t) - centring * x); }, .setpoint = {}, .load = {}};
}

double or_else(double value, double otherwise) { return value > 0.0 ? value : otherwise; }

// Steps held from `start` on. Signs are random, but turn back once the steps alone would have carried a piston of
// 0.3 m/s at full current further than 50 mm.
struct Steps {
  std::vector<double> end, level;
  double at(double t) const {
    const auto i = std::upper_bound(end.begin(), end.end(), t) - end.begin();
    return i < static_cast<long>(level.size()) ? level[i] : 0.0;
  }
};
Steps random_steps(Random random, double start, double stop, const std::vector<double>& sizes, double shortest,
                   double longest) {
  Steps steps{{start}, {0.0}};
  double t = start, travel = 0.0;
  while (t < stop) {
    const double dwell = random.uniform(shortest, longest);
    const double size = sizes[random.below(static_cast<std::uint32_t>(sizes.size()))];
    double sign = random.below(2) ? 1.0 : -1.0;
    if (std::fabs(travel) > 0.05) sign = travel > 0.0 ? -1.0 : 1.0;
    const double held = std::min(dwell, 0.08 / (0.3 * size));  // no single step longer than 80 mm
    t += held;
    travel += 0.3 * sign * size * held;
    steps.end.push_back(t);
    steps.level.push_back(sign * size);
  }
  return steps;
}

Wave steps_wave(const Shape& s, std::vector<double> sizes, double shortest, double longest) {
  if (s.amplitude > 0.0) {
    const double largest = *std::max_element(sizes.begin(), sizes.end());
    for (double& size : sizes) size *= s.amplitude / largest;
  }
  const Steps steps = random_steps(Random(s.seed, 11), 0.1, s.duration, sizes, shortest, longest);
  return [steps](double t) { return steps.at(t); };
}

// 40 lines, logarithmic from `low` to `high`, random phases, flat up to 10 Hz and then falling with the root of
// frequency; rms = amplitude.
Wave multisine_wave(Random random, double low, double high, double rms) {
  constexpr int lines = 40;
  std::vector<double> frequency(lines), gain(lines), phase(lines);
  double power = 0.0;
  for (int k = 0; k < lines; ++k) {
    frequency[k] = low * std::pow(high / low, k / (lines - 1.0));
    gain[k] = 1.0 / std::sqrt(std::max(1.0, frequency[k] / 10.0));
    phase[k] = two_pi * random.uniform();
    power += 0.5 * gain[k] * gain[k];
  }
  for (double& g : gain) g *= rms / std::sqrt(power);
  return [=](double t) {
    double sum = 0.0;
    for (int k = 0; k < lines; ++k) sum += gain[k] * std::sin(two_pi * frequency[k] * t + phase[k]);
    return sum;
  };
}

Stimulus steps_large(const RigModel& m, const Shape& s) {
  return open_loop(m, steps_wave(s, {0.10, 0.25, 0.50, 0.75, 1.0}, 0.12, 0.4));
}
Stimulus steps_small(const RigModel& m, const Shape& s) {
  return open_loop(m, steps_wave(s, {0.01, 0.02, 0.03, 0.05}, 0.08, 0.25));
}
Stimulus sine(const RigModel& m, const Shape& s) {
  const double a = or_else(s.amplitude, 0.3), f = or_else(s.frequency, 2.0);
  return open_loop(m, [=](double t) { return a * std::sin(two_pi * f * t); });
}
Stimulus multisine(const RigModel& m, const Shape& s) {
  return open_loop(m, multisine_wave(Random(s.seed, 12), 1.0, 100.0, or_else(s.amplitude, 0.12)));
}
Stimulus prbs(const RigModel& m, const Shape& s) {
  constexpr double bit = 6e-3;  // [s] flat to about 70 Hz
  const double a = or_else(s.amplitude, 0.15);
  Random random(s.seed, 13);
  std::vector<double> level(static_cast<std::size_t>(s.duration / bit) + 2);
  for (double& x : level) x = random.below(2) ? a : -a;
  return open_loop(
      m, [=](double t) { return level[std::min(static_cast<std::size_t>(t / bit + 1e-9), level.size() - 1)]; });
}
Stimulus sweep(const RigModel& m, const Shape& s) {
  const double a = or_else(s.amplitude, 0.15), low = 1.0, high = 150.0, rate = std::log(high / low) / s.duration;
  return open_loop(m, [=](double t) { return a * std::sin(two_pi * low * (std::exp(rate * t) - 1.0) / rate); });
}
double triangle_at(double turns) {
  const double turn = turns + 0.25;
  return 1.0 - 4.0 * std::fabs(turn - std::floor(turn) - 0.5);
}
Stimulus triangle(const RigModel& m, const Shape& s) {
  const double a = or_else(s.amplitude, 1.0), f = or_else(s.frequency, 0.5);
  return open_loop(m, [=](double t) { return a * triangle_at(f * t); });
}
// Borello's two preflight checks in one log: rest, small step out and back, rest, small slow sine.
Stimulus preflight(const RigModel& m, const Shape& s) {
  const double a = or_else(s.amplitude, 0.04), f = or_else(s.frequency, 5.0);
  return open_loop(m, [=](double t) {
    if (t < 0.1) return 0.0;
    if (t < 0.25) return 0.10;
    if (t < 0.4) return 0.0;
    return a * std::sin(two_pi * f * (t - 0.4));
  });
}
// The same with what it lacks to tell all wear apart. Reversals of rated current between step and sine: slewing draws
// all of the pilot flow through the filter, which a small step does not. After the sine a slow triangle, if any: the
// spool creeps through its laps, where these and the leakage part. A sine of 30 % after that, at which a spool still
// moves whose friction or weak motor holds it still in the small one. Whole cycles but for the last half: the piston
// comes back to within a few millimetres. The offset is compensated first.
Stimulus slews_and_sines(const RigModel& m, const Shape& s, int reversals, double triangles) {
  const double a = or_else(s.amplitude, 0.04), f = or_else(s.frequency, 5.0);
  constexpr double slews = 0.35, reversal = 0.03, rest = 0.08, triangle_frequency = 2.0, large_frequency = 10.0;
  const double slewed = slews + reversal * reversals, small = slewed + rest, slow = small + 2 / f,
               large = slow + triangles / triangle_frequency, end = large + 1.5 / large_frequency;
  Stimulus stimulus = open_loop(m, [=](double t) {
    if (t < 0.1) return 0.0;
    if (t < 0.25) return 0.10;
    if (t < slews) return 0.0;
    if (t < slewed - 1e-9) return static_cast<int>((t - slews) / reversal + 1e-9) % 2 == 0 ? 1.0 : -1.0;
    if (t < small) return 0.0;
    if (t < slow) return a * std::sin(two_pi * f * (t - small));
    if (t < large) return 1.5 * a * triangle_at(triangle_frequency * (t - slow));
    if (t < end) return 0.3 * std::sin(two_pi * large_frequency * (t - large));
    return 0.0;
  });
  stimulus.compensated = true;
  return stimulus;
}
Stimulus preflight_slew(const RigModel& m, const Shape& s) { return slews_and_sines(m, s, 16, 0); }
Stimulus preflight_wear(const RigModel& m, const Shape& s) { return slews_and_sines(m, s, 24, 2); }
// Both checks with the offset compensated: rest, small step out and back long enough to settle cold, rest, then whole
// cycles at several frequencies.
Stimulus preflight_full(const RigModel& m, const Shape& s) {
  struct Tone {
    double start, frequency;
  };
  static constexpr Tone tones[] = {{1.5, 2.0}, {3.5, 3.0}, {5.5, 5.0}, {7.5, 8.0}};  // 2 s each
  const double a = or_else(s.amplitude, 0.04);
  Stimulus stimulus = open_loop(m, [=](double t) {
    if (t < 0.5 || (t >= 0.8 && t < 1.5) || t >= 9.5) return 0.0;
    if (t < 0.8) return 0.10;
    const Tone& tone = tones[static_cast<std::size_t>((t - 1.5) / 2.0)];
    return a * std::sin(two_pi * tone.frequency * (t - tone.start));
  });
  stimulus.compensated = true;
  return stimulus;
}
Stimulus step(const RigModel& m, const Shape& s) {
  const double a = or_else(s.amplitude, 1.0), half = 0.45 * s.duration;
  return open_loop(m, [=](double t) {
    const double held = std::min(0.3, 0.5 * half);  // 90 mm of a piston of 0.3 m/s
    if (t >= 0.05 * s.duration && t < 0.05 * s.duration + held) return a;
    if (t >= 0.05 * s.duration + half && t < 0.05 * s.duration + half + held) return -a;
    return 0.0;
  });
}
Stimulus mixed(const RigModel& m, const Shape& s) {
  const double half = 0.25 + 0.5 * (s.duration - 0.25);
  const Steps steps = random_steps(Random(s.seed, 14), 0.4, half, {0.02, 0.05, 0.10, 0.25, 0.5}, 0.08, 0.3);
  const Wave lines = multisine_wave(Random(s.seed, 15), 1.0, 100.0, or_else(s.amplitude, 0.12));
  return open_loop(m, [=](double t) {
    if (t < 0.1) return 0.0;
    if (t < 0.25) return 0.10;
    return t < half ? steps.at(t) : lines(t - half);
  });
}

// Turbulence: white noise through a first-order filter (Dryden's longitudinal spectrum), 2 Hz corner.
Wave turbulence(Random random, double duration, double limit) {
  constexpr double tick = 5e-3, corner = 2.0;
  const double keep = std::exp(-two_pi * corner * tick);
  std::vector<double> value(static_cast<std::size_t>(duration / tick) + 3);
  double x = 0.0;
  for (double& v : value) {
    x = keep * x + std::sqrt(1.0 - keep * keep) * random.normal();
    v = std::clamp(x * limit / 2.5, -limit, limit);
  }
  return [=](double t) {
    const double at = std::clamp(t / tick, 0.0, static_cast<double>(value.size()) - 2.0);
    const auto k = static_cast<std::size_t>(at);
    return value[k] + (at - static_cast<double>(k)) * (value[k + 1] - value[k]);
  };
}

constexpr double loop_gain = 50.0;  // [1/m] rated current at 20 mm error: about 15 1/s

Stimulus closed_loop(const RigModel& m, Wave setpoint) {
  const double rated = m.driver_rated_current;
  return {
      .command = [=](double t, double x) { return std::clamp(loop_gain * rated * (setpoint(t) - x), -rated, rated); },
      .setpoint = setpoint,
      .load = {}};
}

// Slow sine without load: spool near null throughout.
Stimulus track(const RigModel& m, const Shape& s) {
  const double a = or_else(s.amplitude, 0.05) * 0.5 * m.actuator_stroke, f = or_else(s.frequency, 0.3);
  return closed_loop(m, [=](double t) { return a * std::sin(two_pi * f * t); });
}

Stimulus flight(const RigModel& m, const Shape& s) {
  Random random(s.seed, 16);
  const double half = 0.5 * m.actuator_stroke, largest = or_else(s.amplitude, 1.0) * half;
  const double interval = std::min(20.0, s.duration / 2.5);
  std::vector<double> end{0.1}, level{0.0};
  double t = 0.1;
  while (t < s.duration) {
    const double length = std::min(2.0, interval) * random.uniform(0.2, 1.0);
    const double rest = std::max(0.0, interval * random.uniform() - length);
    end.push_back(t + length);
    level.push_back(random.uniform(-largest, largest));
    end.push_back(t += length + rest);
    level.push_back(0.0);
  }
  const Steps steps{end, level};
  const double stall = std::min(m.piston_area_a(), m.piston_area_b()) * m.supply_pressure;
  const Wave gusts = turbulence(Random(s.seed, 17), s.duration, 0.2 * stall);
  Stimulus stimulus = closed_loop(m, [=](double now) { return steps.at(now); });
  stimulus.load = [=](double now) { return Load{gusts(now), 0.4 * stall / half}; };
  return stimulus;
}

}  // namespace

const std::vector<ExcitationInfo>& excitations() {
  static const std::vector<ExcitationInfo> list{
      {"steps_large", "open loop: random steps of 10 to 100 % of rated current", steps_large},
      {"steps_small", "open loop: random steps of 1 to 5 % of rated current", steps_small},
      {"sine", "open loop: one sine, 30 % of rated current at 2 Hz unless told", sine},
      {"multisine", "open loop: 40 sines from 1 to 100 Hz with random phases, 12 % of rated current rms", multisine},
      {"prbs", "open loop: random binary current of 15 % of rated, 6 ms a bit", prbs},
      {"sweep", "open loop: logarithmic sine sweep from 1 to 150 Hz, 15 % of rated current", sweep},
      {"triangle", "open loop: triangle to full rated current, 0.5 Hz", triangle},
      {"preflight", "open loop: small step out and back, then a sine of 4 % of rated current at 5 Hz", preflight},
      {"preflight_slew", "preflight with reversals of full current before the sine and a sine of 30 % after it; 1.51 s",
       preflight_slew},
      {"preflight_wear",
       "preflight_slew with 24 reversals in place of 16 and a slow triangle of 6 % across null; 2.75 s",
       preflight_wear},
      {"preflight_full",
       "open loop, null compensated: rest, step of 10 % out and back, sines of 4 % at 2, 3, 5 and 8 Hz, 2 s each; 9.5 "
       "s",
       preflight_full},
      {"step", "open loop: full step of rated current out and back, then the other way", step},
      {"track", "closed loop: slow sine of 5 % of the stroke at 0.3 Hz, no load", track},
      {"flight", "closed loop: random position steps against spring and turbulence loads", flight},
      {"mixed", "open loop: preflight step, steps of 2 to 50 %, then a multisine", mixed},
  };
  return list;
}

std::function<double(double)> borello_offset(std::uint64_t seed, double duration) {
  Random random(seed, 18);
  std::vector<double> end, level;  // short steps
  for (double t = 0.0; t < duration;) {
    const double interval = 10.0 * random.uniform(), length = 2.0 * random.uniform();
    end.insert(end.end(), {t + interval, t + interval + length});
    level.insert(level.end(), {0.0, random.uniform(-0.03, 0.03)});
    t += interval + length;
  }
  std::vector<double> knot{0.0}, value{random.uniform(-0.05, 0.05)};  // ramps, one after the other
  while (knot.back() < duration) {
    knot.push_back(knot.back() + random.uniform(1.0, 60.0));
    value.push_back(random.uniform(-0.05, 0.05));
  }
  const Steps steps{end, level};
  return [=](double t) {
    const auto k = static_cast<std::size_t>(std::upper_bound(knot.begin() + 1, knot.end() - 1, t) - knot.begin());
    const double part = std::clamp((t - knot[k - 1]) / (knot[k] - knot[k - 1]), 0.0, 1.0);
    return 0.02 + steps.at(t) + value[k - 1] + part * (value[k] - value[k - 1]);
  };
}

Stimulus make_stimulus(const std::string& name, const RigModel& model, const Shape& shape) {
  std::string names;
  for (const auto& e : excitations()) {
    if (e.name == name) return e.make(model, shape);
    names += (names.empty() ? "" : ", ") + e.name;
  }
  throw InputError({"", 0, "--excitation"}, fmt::format("unknown excitation '{}'", name), "known are " + names);
}

}  // namespace servodx::rig
