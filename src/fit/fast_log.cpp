#include "fit/fast_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "fit/constants.h"
#include "fit/log_start.h"
#include "fit/ports_of.h"
#include "fit/recorder.h"
#include "fit/thin.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "signals/usual_step.h"
#include "simulate/fast_command.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

using namespace fit_constants::fast;

double step_of_fits() { return SimulateOptions{}.step; }

bool steps_span_samples(const std::vector<double>& time) {
  return time.size() > fewest && usual_step(time) * samples_a_step <= step_of_fits() * (1 + slack);
}

// The samples that are points: as far apart as a point may be, so on both sides of a gap.
std::vector<std::size_t> points_of(const std::vector<double>& t) {
  const double reach = steps_a_point * step_of_fits() * (1 + slack);
  std::vector<std::size_t> out = {0};
  for (std::size_t k = 0; k + 1 < t.size(); out.push_back(k)) {
    const std::size_t from = k++;
    while (k + 1 < t.size() && t[k + 1] - t[from] <= reach) ++k;
  }
  return out;
}

std::vector<double> at(const std::vector<double>& x, const std::vector<std::size_t>& points) {
  std::vector<double> out;
  for (const std::size_t p : points) out.push_back(x[p]);
  return out;
}

// Samples [from, to) around a point.
struct Around {
  std::size_t point, from, to;
};

// Half way to the points beside it.
std::vector<Around> around_points(const std::vector<double>& t, const std::vector<std::size_t>& points) {
  std::vector<Around> out;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t p = points[k];
    Around a{p, p, p + 1};
    const double before = k > 0 ? 0.5 * (t[points[k - 1]] + t[p]) : t[p];
    const double after = k + 1 < points.size() ? 0.5 * (t[p] + t[points[k + 1]]) : t[p];
    while (a.from > 0 && t[a.from - 1] >= before) --a.from;
    while (a.to < t.size() && t[a.to] <= after) ++a.to;
    out.push_back(a);
  }
  return out;
}

// Least squares of a parabola, at the point; NaN where most of the samples are missing. A signal that stands still
// passes bit for bit.
double parabola_at(const std::vector<double>& t, const std::vector<double>& x, const Around& a) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double s[5] = {}, y[3] = {}, about = none;
  std::size_t present = 0;
  const double width = t[a.to - 1] - t[a.from];
  for (std::size_t j = a.from; j < a.to; ++j) {
    if (std::isnan(x[j])) continue;
    if (present++ == 0) about = x[j];
    double power = 1;
    const double tau = (t[j] - t[a.point]) / width;
    for (int i = 0; i < 5; ++i, power *= tau) {
      s[i] += power;
      if (i < 3) y[i] += power * (x[j] - about);
    }
  }
  if (present < fewest || 2 * present < a.to - a.from) return none;
  // The first row of the normal matrix's inverse.
  const double c0 = s[2] * s[4] - s[3] * s[3], c1 = s[2] * s[3] - s[1] * s[4], c2 = s[1] * s[3] - s[2] * s[2];
  const double determinant = s[0] * c0 + s[1] * c1 + s[2] * c2;
  return determinant > 0 ? about + (c0 * y[0] + c1 * y[1] + c2 * y[2]) / determinant : none;
}

std::vector<double> smoothed(const std::vector<double>& t, const std::vector<double>& x,
                             const std::vector<Around>& around) {
  std::vector<double> out;
  for (const Around& a : around) out.push_back(parabola_at(t, x, a));
  return out;
}

// The most that the command moves within a usual step, from sample `from` to `to`.
double move_within_step(const CommandSamples& c, std::size_t from, std::size_t to) {
  double most = 0;
  for (std::size_t j = from + 1, behind = from; j <= to; ++j) {
    while (behind + 1 < j && c.time[j] - c.time[behind] > step_of_fits() * (1 + slack)) ++behind;
    most = std::max({most, std::abs(c.value[j] - c.value[behind]), std::abs(c.value[j] - c.value[j - 1])});
  }
  return most;
}

// Held between its samples, from each point to the next; at last the last sample.
std::vector<double> means_between(const CommandSamples& c, const std::vector<std::size_t>& points) {
  std::vector<double> out;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    double sum = 0;
    for (std::size_t j = points[k]; j < points[k + 1]; ++j)
      sum += (c.value[j] - c.value[points[k]]) * (c.time[j + 1] - c.time[j]);
    out.push_back(c.value[points[k]] + sum / (c.time[points[k + 1]] - c.time[points[k]]));
  }
  out.push_back(c.value[points.back()]);
  return out;
}

void take_command(Scenario& s, const std::vector<std::size_t>& points, const std::vector<double>& t) {
  auto samples = std::make_shared<CommandSamples>(CommandSamples{t, std::move(s.command)});
  s.command = means_between(*samples, points);
  s.fast.at = points;
  for (std::size_t k = 0; k + 1 < points.size(); ++k)
    s.fast.move.push_back(move_within_step(*samples, points[k], points[k + 1]));
  s.fast.move.push_back(0);
  s.fast.samples = std::move(samples);
}

// The same time, in points.
int window_of_points(int window, double step, double between) {
  return std::max(1, 2 * static_cast<int>(std::lround(0.5 * (window * step / between - 1))) + 1);
}

}  // namespace

bool is_fast(const Log& log) { return steps_span_samples(log.time); }

LogData at_points(const LogData& every_sample) {
  LogData out = every_sample;
  Scenario& s = out.scenario;
  const std::vector<double>& t = every_sample.scenario.time;
  const std::vector<std::size_t> points = points_of(t);
  const std::vector<Around> around = around_points(t, points);
  s.time = at(t, points);
  take_command(s, points, t);
  for (auto* series : {&s.supply_pressure, &s.return_pressure, &s.load_force})
    if (!series->empty()) *series = at(*series, points);
  for (FitChannel& c : out.channels) {
    c.measured = smoothed(t, c.measured, around);
    if (c.low_pass) c.low_pass = c.low_pass->at(s.time);
    const int window = window_of_points(c.filter.window, usual_step(t), usual_step(s.time));
    c.noise *= std::sqrt(static_cast<double>(c.filter.window) / window);
    c.filter.window = window;
  }
  take_start(out);
  out.notes.push_back(
      {Note::Kind::resampled,
       fmt::format(
           "{}: sampled at {:.4g} Hz: compared at {} points of {} rows; the command drives the model row by row",
           out.path, 1 / usual_step(t), points.size(), t.size())});
  return out;
}

LogData prepare_at_points(const Log& log, const RigFile& rig, const Recorder& recorder) {
  return is_fast(log) ? at_points(prepare(log, rig, recorder)) : prepare(log, rig, recorder);
}

LogData prepare_to_fit(const Log& log, const RigFile& rig, const Recorder& recorder) {
  const bool on_stand = ports_of(log, rig) != Ports::actuator;
  const bool creeps = on_stand && thinned(log, rig).samples() < log.samples();
  return creeps ? prepare_thinned(log, rig, recorder) : prepare_at_points(log, rig, recorder);
}

}  // namespace servodx
