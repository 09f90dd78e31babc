#include "excite.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace servodx::foreign {
namespace {
using std::numbers::pi;

constexpr double travel = 0.3;  // [1] of the stroke that one sweep of a test may take

class Maker {
 public:
  Maker(const Design& design, Random random) : d_(design), r_(random), full_(d_.actuator.stroke / d_.speed) {
    made_.duration = std::min(d_.rate < 1000   ? 8.0
                              : d_.rate < 1500 ? 5.0
                              : d_.rate < 3000 ? 4.0
                                               : 3.0,
                              19000 / d_.rate);
  }

  Excitation done(std::string name) {
    made_.name = std::move(name);
    return std::move(made_);
  }
  void seconds(double s) { made_.duration = std::min(s, made_.duration); }
  void flags(bool jittered, bool dropped) { made_.jittered = jittered, made_.dropped = dropped; }

  void fill(const std::function<double(double)>& of) {
    const auto ticks = static_cast<std::size_t>(std::ceil(made_.duration * d_.control_rate)) + 2;
    made_.demand.resize(ticks);
    for (std::size_t i = 0; i < ticks; ++i) made_.demand[i] = of(static_cast<double>(i) / d_.control_rate);
  }

  // Out, back, the other way, back; levels in turn.
  std::function<double(double)> steps(std::vector<double> levels) {
    struct Part {
      double until, level;
    };
    std::vector<Part> parts{{0.05, 0.0}};
    while (parts.back().until < made_.duration)
      for (const double level : levels)
        for (const double sign : {1.0, 0.0, -1.0, 0.0}) {
          const double hold = sign == 0.0 ? 0.08 : std::min(0.3, travel * full_ / level);
          parts.push_back({parts.back().until + hold, sign * level});
        }
    return [parts](double t) {
      for (const Part& p : parts)
        if (t < p.until) return p.level;
      return 0.0;
    };
  }

  std::function<double(double)> sine(double hertz, double amplitude) {
    const double held = std::min(amplitude, travel * pi * hertz * full_);
    return [=](double t) { return held * std::cos(2 * pi * hertz * t) * std::min(1.0, 10 * t); };
  }

  std::function<double(double)> multisine(double low, double high, double peak) {
    constexpr int lines = 24;
    std::vector<double> hertz, phase, size;
    double sum = 0.0;
    for (int i = 0; i < lines; ++i) {
      hertz.push_back(low * std::pow(high / low, i / (lines - 1.0)));
      phase.push_back(r_.uniform(0, 2 * pi));
      size.push_back(std::min(1.0, 0.3 * travel * pi * hertz[i] * full_ / peak));
      sum += size[i] * size[i];
    }
    const double scale = peak / (2.2 * std::sqrt(0.5 * sum));  // crest factor of random phases
    return [=](double t) {
      double u = 0.0;
      for (int i = 0; i < lines; ++i) u += size[i] * std::sin(2 * pi * hertz[i] * t + phase[i]);
      return scale * u;
    };
  }

  std::function<double(double)> prbs(double level, double bit) {
    std::vector<double> bits(static_cast<std::size_t>(made_.duration / bit) + 2);
    // A bit and later its opposite, in blocks of eight: the piston does not wander off.
    for (std::size_t i = 0; i < bits.size(); ++i)
      bits[i] = i % 16 < 8 ? (r_.uniform() < 0.5 ? -level : level) : -bits[i - 8];
    return [=](double t) { return bits[std::min(bits.size() - 1, static_cast<std::size_t>(t / bit))]; };
  }

  std::function<double(double)> sweep(double low, double high, double amplitude) {
    const double growth = std::log(high / low), whole = made_.duration, limit = travel * pi * full_;
    return [=](double t) {
      const double hertz = low * std::exp(growth * t / whole);
      const double phase = 2 * pi * low * whole / growth * std::expm1(growth * t / whole);
      return std::min(amplitude, limit * hertz) * std::cos(phase);
    };
  }

  std::function<double(double)> triangle(double peak, double most) {
    const double period = std::min(most, 4.0 * travel * full_ / peak);
    return [=](double t) {
      const double turn = t / period - std::floor(t / period);
      return peak * (turn < 0.25 ? 4 * turn : turn < 0.75 ? 2 - 4 * turn : 4 * turn - 4);
    };
  }

  // Position demand: noise through two lags, its speed within what the valve gives; load in proportion to stall.
  void flight() {
    made_.closed = true;
    const double dt = 1.0 / d_.control_rate, corner = std::min(r_.uniform(0.5, 2.0), 0.5 * d_.position_gain);
    const double part = dt * 2 * pi * corner, fastest = 0.4 * d_.speed * dt;
    const double half = 0.5 * d_.actuator.stroke;
    const double size = std::min(0.35 * half, 0.5 * d_.speed / (2 * pi * corner));
    double one = 0.0, target = 0.0, at = 0.0, wait = 0.0;
    fill([&](double) {
      if ((wait -= dt) <= 0.0) {
        target = r_.uniform(-1.0, 1.0) * size;
        wait = r_.uniform(0.15, 0.6) / corner;
      }
      one += part * (target - one);
      at += std::clamp(part * (one - at), -fastest, fastest);
      return at;
    });
    if (d_.loaded) load(half);
  }

  void load(double half) {
    const double stall = d_.actuator.area_b * d_.supply.pressure;
    made_.spring = r_.uniform(0.1, 0.3) * stall / (0.5 * half);
    if (r_.uniform() < 0.5) made_.drag = r_.uniform(0.0, 0.15) * stall / d_.speed;
    const double size = r_.uniform(0.02, 0.10) * stall, part = 2 * pi * 8.0 / d_.control_rate;
    double one = 0.0, two = 0.0;
    for (std::size_t i = 0; i < made_.demand.size(); ++i) {
      one += part * (r_.normal() / std::sqrt(part) - one);
      two += part * (one - two);
      made_.turbulence.push_back(size * 1.4 * two * std::min(1.0, static_cast<double>(i) * 4.0 / d_.control_rate));
    }
  }

  void slow_track() {
    made_.closed = true;
    const double hertz = 0.3, size = std::min(0.25 * d_.actuator.stroke, 0.15 * d_.speed / (2 * pi * hertz));
    fill([=](double t) { return size * std::sin(2 * pi * hertz * t); });
  }

  // One thing after the other, a third of the time each.
  void in_turn(const std::function<double(double)>& a, const std::function<double(double)>& b,
               const std::function<double(double)>& c) {
    const double third = made_.duration / 3;
    fill([&](double t) { return t < third ? a(t) : t < 2 * third ? b(t - third) : c(t - 2 * third); });
  }

  double full() const { return full_; }
  double highest() const { return std::min(0.3 * d_.rate, 2.0 * d_.valve_bandwidth); }  // [Hz] worth asking for
  Random& random() { return r_; }

 private:
  const Design& d_;
  Random r_;
  double full_;  // [s] the whole stroke at full speed
  Excitation made_;
};

}  // namespace

Excitation make_excitation(const Design& d, Trial test, Random random) {
  Maker m(d, test == Trial::acceptance ? Random(d.seed, 7) : random);
  Random& r = m.random();
  switch (test) {
    case Trial::steps_large:
      m.fill(m.steps({0.25, 1.0, 0.1, 0.5}));
      return m.done("steps_10_25_50_100pct");
    case Trial::steps_small:
      m.fill(m.steps({0.02, 0.05, 0.01}));
      return m.done("steps_1_2_5pct");
    case Trial::sine: {
      m.seconds(3.0);
      m.fill(m.sine(r.uniform(2.0, 10.0), r.uniform(0.05, 0.4)));
      return m.done("sine");
    }
    case Trial::multisine:
      m.fill(m.multisine(1.0, m.highest(), r.uniform(0.15, 0.4)));
      return m.done("multisine");
    case Trial::prbs:
    case Trial::prbs_jittered: {
      m.seconds(4.0);
      m.flags(test == Trial::prbs_jittered, false);
      const double ticks = std::ceil(std::max(0.25 / d.valve_bandwidth, 2.0 / d.rate) * d.control_rate);
      m.fill(m.prbs(r.uniform(0.08, 0.2), ticks / d.control_rate));
      return m.done(test == Trial::prbs ? "prbs" : "prbs_jittered_time");
    }
    case Trial::sweep:
      m.fill(m.sweep(0.5, m.highest(), r.uniform(0.1, 0.3)));
      return m.done("sweep");
    case Trial::triangle:
      m.fill(m.triangle(1.0, 2.0));
      return m.done("triangle_100pct");
    case Trial::flight:
    case Trial::flight_dropped:
      m.flags(false, test == Trial::flight_dropped);
      m.flight();
      return m.done(test == Trial::flight ? "closed_flight" : "closed_flight_dropped_samples");
    case Trial::slow_track:
      m.slow_track();
      return m.done("closed_sine_0.3Hz_noload");
    case Trial::acceptance:
      m.seconds(3.0);
      m.in_turn(m.steps({d.acceptance_amplitude, 0.4 * d.acceptance_amplitude}),
                m.triangle(d.acceptance_amplitude, 0.5), m.sine(d.acceptance_frequency, 0.5 * d.acceptance_amplitude));
      return m.done("acceptance_steps_triangle_sine");
    case Trial::mixed:
      m.in_turn(m.steps({0.6, 0.15, 0.3}), m.multisine(1.0, m.highest(), 0.25), m.triangle(0.4, 0.6));
      return m.done("open_steps_multisine_triangle");
  }
  return {};
}

}  // namespace servodx::foreign
