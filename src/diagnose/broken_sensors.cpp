#include "diagnose/broken_sensors.h"

#include <algorithm>
#include <cmath>

#include "diagnose/constants.h"
#include "diagnose/motion.h"
#include "servodx/log.h"
#include "signals/noise.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

double range_of(const std::vector<double>& x, std::size_t from, std::size_t to) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (std::size_t i = from; i < to; ++i)
    if (std::isfinite(x[i])) low = std::min(low, x[i]), high = std::max(high, x[i]);
  return high > low ? high - low : 0.0;
}

struct Run {
  std::size_t from = 0, to = 0;
};
Run longest_still(const std::vector<double>& x) {
  Run best;
  for (std::size_t from = 0; from < x.size();) {
    std::size_t to = from + 1;
    while (to < x.size() && x[to] == x[from]) ++to;
    if (to - from > best.to - best.from) best = {from, to};
    from = to;
  }
  return best;
}

double least_step(const std::vector<double>& x) {
  double least = HUGE_VAL;
  for (std::size_t i = 1; i < x.size(); ++i)
    if (const double step = std::abs(x[i] - x[i - 1]); step > 0) least = std::min(least, step);
  return least;
}

// How often it goes up, down and up again from sample to sample, or the other way: by noise, not by the staircase that
// a slow motion makes of a recorder's steps.
std::size_t zigzags(const std::vector<double>& x) {
  std::size_t count = 0;
  for (std::size_t k = 3; k < x.size(); ++k) {
    const double first = x[k - 2] - x[k - 3], next = x[k - 1] - x[k - 2], last = x[k] - x[k - 1];
    count += first * next < 0 && next * last < 0;
  }
  return count;
}

// Alive, it repeats no value for as long, however still what it measures: elsewhere its noise is as large as its steps.
// Half as large is enough where the noise is seen to zigzag: a staircase alone reads as half a step of noise too.
bool has_lost_its_noise(const std::vector<double>& x, Run still) {
  std::vector<double> elsewhere = x;
  elsewhere.erase(elsewhere.begin() + static_cast<long>(still.from), elsewhere.begin() + static_cast<long>(still.to));
  const double noise = noise_of(elsewhere, 0) / least_step(elsewhere);
  if (noise >= 1) return true;
  return noise >= k::noise_in_steps &&
         zigzags(elsewhere) * (still.to - still.from) >= k::zigzags_due * elsewhere.size();
}

// One value for a good part of the log, while the command moves as it does elsewhere and the simulation's sensor would;
// less of the latter does where its noise is gone.
bool is_frozen(const FitChannel& c, const LogData& data, const std::vector<double>& simulated) {
  const Run still = longest_still(c.measured);
  const std::size_t n = c.measured.size();
  if (still.to - still.from < std::max<std::size_t>(k::fewest_still, n / k::still_one_in)) return false;
  const double asked = range_of(data.scenario.command, still.from, still.to);
  const double would = range_of(simulated, still.from, still.to);
  return asked > k::moves_as_elsewhere * range_of(data.scenario.command, 0, n) && would > k::beyond_noise * c.noise &&
         (would > k::moves_as_elsewhere * range_of(simulated, 0, n) || has_lost_its_noise(c.measured, still));
}

// At its lowest or highest value, again and again, where the simulation goes far beyond. A spool at its stop is where
// the simulation's stops as well; a piston drifts, and says nothing here.
bool is_clipped(const FitChannel& c, const std::vector<double>& simulated) {
  if (c.signal == Signal::piston_position) return false;
  const auto [low, high] = std::minmax_element(c.measured.begin(), c.measured.end(), [](double a, double b) {
    return std::isfinite(a) && (!std::isfinite(b) || a < b);
  });
  const double least = k::clipped_beyond * range_of(c.measured, 0, c.measured.size());
  std::size_t beyond = 0, at_limit = 0;
  for (std::size_t from = 0; from < c.measured.size();) {
    std::size_t to = from + 1;
    while (to < c.measured.size() && c.measured[to] == c.measured[from]) ++to;
    const double at = c.measured[from];
    for (std::size_t i = from; i < to && to - from >= k::survey_of_log::clipped_run; ++i) {
      at_limit += at == *low || at == *high;
      beyond += (at == *high && simulated[i] > at + least) || (at == *low && simulated[i] < at - least);
    }
    from = to;
  }
  const auto part = [](std::size_t n, std::size_t of) { return static_cast<double>(n) / static_cast<double>(of); };
  return part(at_limit, c.measured.size()) > k::clipped_part && part(beyond, at_limit) > k::clipped_while_beyond;
}

struct Followed {
  const FitChannel* channel;
  const std::vector<double>* simulated;
  std::vector<double> moves, would_move;
  double own;  // correlation of the two
};

// The channels that the simulation moves beyond their noise.
std::vector<Followed> followed(const LogData& data, const Trajectory& healthy) {
  std::vector<Followed> out;
  for (const FitChannel& c : data.channels) {
    const std::vector<double>& y = healthy.signals[static_cast<std::size_t>(c.simulated)];
    if (y.empty() || range_of(y, 0, y.size()) < k::beyond_noise * c.noise) continue;
    Followed f{&c, &y, moves(data.scenario.time, c.measured), moves(data.scenario.time, y), 0};
    f.own = correlation(f.moves, f.would_move);
    out.push_back(std::move(f));
  }
  return out;
}

bool is_port(const Followed& f) {
  return f.channel->signal == Signal::pressure_a || f.channel->signal == Signal::pressure_b;
}

double square_between(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (std::isfinite(a[i]) && std::isfinite(b[i])) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

// Each chamber's sensor moves as the other chamber would.
bool are_swapped(const std::vector<Followed>& moving) {
  std::vector<const Followed*> ports;
  for (const Followed& f : moving)
    if (is_port(f)) ports.push_back(&f);
  if (ports.size() != 2) return false;
  const Followed &a = *ports[0], &b = *ports[1];
  const double own = square_between(a.moves, a.would_move) + square_between(b.moves, b.would_move);
  return square_between(a.moves, b.would_move) + square_between(b.moves, a.would_move) < k::swapped_leaves * own;
}

bool is_exchange(const BrokenSensor& b) { return b.finding == SensorFinding::swapped_ports; }

}  // namespace

std::vector<BrokenSensor> broken_sensors(const LogData& data, const Trajectory& healthy) {
  if (!healthy.ok) return {};
  const std::vector<Followed> moving = followed(data, healthy);
  const auto follows = [](const Followed& f) { return f.own > k::follows; };
  if (std::none_of(moving.begin(), moving.end(), follows)) return {};  // then it is no one sensor
  const bool swapped = are_swapped(moving);
  std::vector<BrokenSensor> out;
  std::size_t against = 0;
  for (const Followed& f : moving) {
    if (is_frozen(*f.channel, data, *f.simulated))
      out.push_back({SensorFinding::frozen, f.channel->signal});
    else if (swapped && is_port(f))
      out.push_back({SensorFinding::swapped_ports, f.channel->signal});
    else if (f.own > k::follows && is_clipped(*f.channel, *f.simulated))
      out.push_back({SensorFinding::clipped, f.channel->signal});
    else if (f.own < -k::follows)
      out.push_back({SensorFinding::turned, f.channel->signal}), ++against;
  }
  // Two that move against the simulation at once: the command's sign, or the rig file's, and no sensor.
  if (against + swapped > 1)
    std::erase_if(out, [](const BrokenSensor& b) {
      return b.finding == SensorFinding::turned || b.finding == SensorFinding::swapped_ports;
    });
  return out;
}

bool names_exchanged_ports(const std::vector<BrokenSensor>& found) {
  return std::any_of(found.begin(), found.end(), &is_exchange);
}

std::vector<BrokenSensor> beside_flow(std::vector<BrokenSensor> found, Chambers by_flow) {
  if (by_flow == Chambers::as_they_stand) std::erase_if(found, &is_exchange);
  return found;
}

}  // namespace servodx
