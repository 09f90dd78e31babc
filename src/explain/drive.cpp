#include "explain/drive.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/median.h"
#include "effects/effect.h"
#include "effects/transport_delay.h"
#include "explain/cause_score.h"
#include "explain/constants.h"
#include "explain/fit_causes.h"
#include "explain/score.h"
#include "explain/usual_error.h"
#include "fit/error_model.h"
#include "optimise/unit_cube.h"
#include "parameters/list.h"

namespace servodx {
namespace {

namespace k = explain_constants::drive;

// [s] of a corner frequency [Hz].
double lag_of(double bandwidth) { return 1 / (2 * M_PI * bandwidth); }

Cause delay_cause(double usual) {
  const EffectParameter& p = TransportDelay::parameters[0];
  Cause c;
  c.effect = TransportDelay::name, c.where = TransportDelay::place, c.test = TransportDelay::best_test;
  c.numbers = {Number{{p.name, p.unit, p.lower, usual + p.upper, false, usual}, usual}};
  for (const double part : k::tried_delays) c.probes.push_back({{usual + part * p.start}});
  return c;
}
Cause lag_cause() {
  const ParameterInfo& row = parameter_list[row::driver_bandwidth];
  Cause c;
  c.effect = std::string(row.name), c.where = TransportDelay::place, c.test = TransportDelay::best_test;
  c.numbers = {Number{{std::string(row.name), "Hz", k::slowest, k::at_once, true, k::at_once}, k::at_once}};
  for (const double bandwidth : k::tried_bandwidths) c.probes.push_back({{bandwidth}});
  return c;
}

}  // namespace

std::vector<double> through_driver(const std::vector<double>& time, const std::vector<double>& command, double delay,
                                   double lag) {
  std::vector<double> out;
  out.reserve(time.size());
  std::size_t at = 0;
  double before = command.front(), felt = before;
  for (std::size_t i = 0; i < time.size(); ++i) {
    const double t = time[i] - delay;
    while (at + 1 < time.size() && time[at + 1] <= t) ++at;
    double now = command[at];
    if (t <= time.front())
      now = command.front();
    else if (at + 1 < time.size())
      now += (command[at + 1] - command[at]) * (t - time[at]) / (time[at + 1] - time[at]);
    // Exact for a line from the last sample to this one.
    const double step = i > 0 ? time[i] - time[i - 1] : 0.0;
    if (step > 0 && lag > 0) {
      const double kept = std::exp(-step / lag), lags = lag * (now - before) / step;
      felt = kept * (felt - before + lags) + now - lags;
    } else {
      felt = now;
    }
    before = now;
    out.push_back(felt);
  }
  return out;
}

DriveSubject::DriveSubject(const std::vector<Log>& logs, const KnownRig& known)
    : usual_delay_(known.drive_delay.empty() ? 0.0 : median(known.drive_delay)), usual_(known.errors) {
  for (const Log& log : logs) {
    if (!log.has(Signal::command) || !log.has(Signal::coil_current)) return;
    Pair p;
    for (std::size_t i = 0; i < log.time.size(); ++i) {
      const double u = log[Signal::command][i], felt = log[Signal::coil_current][i];
      if (std::isfinite(u) && std::isfinite(felt))
        p.time.push_back(log.time[i]), p.command.push_back(u), p.current.push_back(felt);
    }
    if (p.time.size() < k::fewest) return;
    const auto [low, high] = std::minmax_element(p.command.begin(), p.command.end());
    p.span = *high - *low;
    if (!(p.span > 0)) return;
    p.sigma.assign(p.time.size(), k::first_error * p.span);
    pairs_.push_back(std::move(p));
  }
  long first = 0;
  for (std::size_t l = 0; l < pairs_.size(); ++l) {
    const auto n = static_cast<long>(pairs_[l].time.size());
    Series& series = series_.emplace_back();
    series.signal = info(Signal::coil_current).name, series.unit = "A";
    series.log = static_cast<int>(l), series.first = first, series.count = n;
    series.time = &pairs_[l].time, series.sigma = &pairs_[l].sigma;
    first += n;
  }
  causes_ = {delay_cause(usual_delay_), lag_cause()};
  for (Cause& c : causes_) c.family = "current";  // of the valve's own there is a cause of each name
}

Eigen::VectorXd DriveSubject::rows(const Point& x, const std::vector<int>& causes,
                                   const std::vector<Number>& numbers) const {
  Eigen::VectorXd out(series_.back().first + series_.back().count);
  double delay = usual_delay_, lag = 0;
  for (std::size_t c = 0; c < causes.size(); ++c) {
    const std::size_t j = 2 * pairs_.size() + c;
    (causes[c] == by_delay ? delay : lag) =
        causes[c] == by_delay ? numbers[j].from_unit(x[j]) : lag_of(numbers[j].from_unit(x[j]));
  }
  for (std::size_t l = 0; l < pairs_.size(); ++l) {
    const Pair& p = pairs_[l];
    const double gain = numbers[2 * l].from_unit(x[2 * l]), offset = numbers[2 * l + 1].from_unit(x[2 * l + 1]);
    const std::vector<double> sent = through_driver(p.time, p.command, delay, lag);
    for (std::size_t i = 0; i < sent.size(); ++i)
      out[series_[l].first + static_cast<long>(i)] = (p.current[i] - gain * sent[i] - offset) / p.sigma[i];
  }
  return out;
}

SubjectFit DriveSubject::fit(const std::vector<int>& causes, bool) const {
  SubjectFit out;
  for (const Pair& p : pairs_) {
    out.numbers.push_back({{"driver gain", "-", k::least_gain, k::most_gain, false, 1.0}, 1.0});
    out.numbers.push_back({{"driver offset", "A", -p.span, p.span, false, 0.0}, 0.0});
  }
  for (int c : causes) out.numbers.push_back(causes_[static_cast<std::size_t>(c)].numbers.front());
  for (const Number& n : out.numbers) out.start.push_back(n.to_unit(n.off));
  out.problem.n = static_cast<int>(out.numbers.size());
  out.problem.evaluate = [this, causes, numbers = out.numbers](std::span<const Point> points) {
    std::vector<Evaluation> e(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      e[i].residual = rows(points[i], causes, numbers);
      e[i].ok = e[i].residual.allFinite();
    }
    return e;
  };
  return out;
}

double DriveSubject::sample_period() const {
  const std::vector<double>& time = pairs_.front().time;
  return (time.back() - time.front()) / static_cast<double>(time.size() - 1);
}

double DriveSubject::time_beyond_usual(int cause, double value) const {
  return cause == by_delay ? value - usual_delay_ : lag_of(value);
}

double DriveSubject::time_error() const { return sample_period() / std::sqrt(12.0); }

double DriveSubject::error_beside(int cause, std::size_t k) const {
  const double probe = causes_[static_cast<std::size_t>(cause)].probes[k].front().front();
  return time_error() / std::abs(time_beyond_usual(cause, probe));
}

bool DriveSubject::rescale(const Eigen::VectorXd& residual) {
  const Eigen::VectorXd r = physical(residual);
  for (std::size_t l = 0; l < pairs_.size(); ++l) {
    Series& s = series_[l];
    weigh_by_usual(r.segment(s.first, s.count), usual_, k::least_error * pairs_[l].span, s, pairs_[l].sigma);
  }
  return true;
}

std::optional<UsualDrive> usual_drive(const Log& log) {
  const DriveSubject drive({log});
  if (drive.empty()) return {};
  const ExplainedFit base = fit_causes(drive, {}, nullptr, nullptr, explain_constants::base_iterations, false);
  if (!base.ok) return {};
  const CauseScore score = score_causes(drive, base)[DriveSubject::by_delay];
  const ExplainedFit fit =
      fit_causes(drive, {DriveSubject::by_delay}, &base, &score, explain_constants::base_iterations, false);
  if (!fit.ok) return {};
  const Eigen::VectorXd left = drive.physical(fit.residual);
  const double effective = effective_fraction({left.data(), left.data() + left.size()});
  return UsualDrive{numbers_of(drive, fit, DriveSubject::by_delay).value.front(),
                    {drive.series().front().signal, rms_of_rows(left), 0.0, effective, 1 / drive.sample_period()}};
}

}  // namespace servodx
