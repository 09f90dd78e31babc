#include "explain/block_replay.h"

#include <algorithm>
#include <cmath>

#include "base/tiny.h"
#include "explain/constants.h"
#include "explain/ties.h"
#include "explain/usual_error.h"
#include "fit/chart.h"
#include "fit/error_model.h"
#include "fit/log_data.h"
#include "optimise/unit_cube.h"
#include "servodx/log.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

namespace k = explain_constants;

struct Kind {
  const char *name, *unit;
  std::vector<double> Balance::*missing;
  bool sliding;
};
constexpr Kind kinds[] = {{"missing flow A", "m3/s", &Balance::flow_a, false},
                          {"missing flow B", "m3/s", &Balance::flow_b, false},
                          {"missing force", "N", &Balance::force, true},
                          {"supply pressure", "Pa", &Balance::supply, false}};

}  // namespace

ReplaySubject::ReplaySubject(const ValveSubject& valve, const Point& at, const KnownRig& known)
    : valve_(valve), usual_(known.errors) {
  for (const Cause& c : valve.causes()) {
    causes_.push_back(c);
    causes_.back().family = c.family.empty() ? "replay" : "replay/" + c.family;
    causes_.back().atop.clear();
    if (c.simulated) causes_.back().probes.clear();  // not looked at
  }
  long first = 0;
  for (std::size_t l = 0; l < valve.logs().size(); ++l) {
    base_.push_back(valve.candidate({}, at, static_cast<int>(l)));
    Quiet& q = quiet_.emplace_back();
    for (const FitChannel& c : valve.logs()[l].channels) {
      if (c.signal == Signal::spool_position) q.spool = quiet(valve.logs()[l].scenario.time, c.measured);
      if (c.signal == Signal::piston_position) q.piston = quiet(valve.logs()[l].scenario.time, c.measured);
    }
    const Balance b = balance_of(l, base_.back());
    for (const Kind& kind : kinds) {
      const std::vector<double>& missing = b.*kind.missing;
      Part part{l, kind.missing, {}};
      for (std::size_t i = 0; i < missing.size(); ++i)
        if (!kind.sliding || b.slides[i]) part.windows.push_back(i);
      if (part.windows.size() < k::fewest_windows) continue;
      std::vector<double> time;
      for (std::size_t i : part.windows) time.push_back(b.time[i]);
      const auto n = static_cast<long>(part.windows.size());
      Eigen::VectorXd here(n);
      for (long i = 0; i < n; ++i) here[i] = missing[part.windows[static_cast<std::size_t>(i)]];
      sigma_.emplace_back(part.windows.size(), std::max(tiny, rms_of_rows(here)));
      time_.push_back(std::move(time));
      series_.push_back({kind.name, kind.unit, static_cast<int>(l), first, n, nullptr, nullptr});
      parts_.push_back(std::move(part));
      first += n;
    }
  }
  for (std::size_t i = 0; i < series_.size(); ++i) series_[i].time = &time_[i], series_[i].sigma = &sigma_[i];
}

Balance ReplaySubject::balance_of(std::size_t log, const ParameterVector& candidate) const {
  const LogData& data = valve_.logs()[log];
  const Quiet& q = quiet_[log];
  Measured measured;
  measured.quiet = true;
  if (!q.spool.empty()) measured.spool = &q.spool;
  if (!q.piston.empty()) measured.piston = &q.piston;
  for (const FitChannel& c : data.channels) {
    if (c.signal == Signal::pressure_a) measured.pressure_a = &c.measured;
    if (c.signal == Signal::pressure_b) measured.pressure_b = &c.measured;
  }
  return balance(data.scenario, measured, candidate, k::window);
}

Eigen::VectorXd ReplaySubject::rows(const std::vector<int>& causes, std::span<const double> of_causes) const {
  Eigen::VectorXd out(series_.empty() ? 0 : series_.back().first + series_.back().count);
  std::size_t i = 0;
  for (std::size_t l = 0; l < base_.size(); ++l) {
    ParameterVector v = base_[l];
    std::size_t at = 0;
    for (int c : causes)
      for (const FreeValue& f : valve_.values(c)) {
        const double value = f.from_unit(of_causes[at++]);
        if (f.log >= 0 && f.log != static_cast<int>(l)) continue;
        if (f.apply)
          f.apply(v.data(), value);
        else
          v[static_cast<std::size_t>(f.at)] = value;
      }
    const Balance b = balance_of(l, v);
    for (; i < parts_.size() && parts_[i].log == l; ++i) {
      const std::vector<double>& missing = b.*parts_[i].missing;
      for (std::size_t k = 0; k < parts_[i].windows.size(); ++k)
        out[series_[i].first + static_cast<long>(k)] = missing[parts_[i].windows[k]] / sigma_[i][k];
    }
  }
  return out;
}

SubjectFit ReplaySubject::fit(const std::vector<int>& causes, bool) const {
  SubjectFit out;
  for (const Series& s : series_) {
    out.numbers.push_back({{s.signal, "sigma", -k::offset_range, k::offset_range}});
    out.start.push_back(0.5);
  }
  for (int c : causes)
    for (const Number& n : causes_[static_cast<std::size_t>(c)].numbers) {
      out.numbers.push_back(n);
      out.start.push_back(n.to_unit(n.off));
    }
  out.problem.n = static_cast<int>(out.numbers.size());
  out.problem.evaluate = [this, causes](std::span<const Point> points) {
    std::vector<Evaluation> e(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Point& x = points[k];
      e[k].residual = rows(causes, std::span(x).subspan(series_.size()));
      for (std::size_t i = 0; i < series_.size(); ++i)
        e[k].residual.segment(series_[i].first, series_[i].count).array() -= k::offset_range * (2 * x[i] - 1);
      e[k].ok = e[k].residual.allFinite();
    }
    return e;
  };
  tie(out, causes_, causes);
  return out;
}

std::vector<UsualError> ReplaySubject::errors(const Eigen::VectorXd& rows) const {
  const Eigen::VectorXd r = physical(rows);
  std::vector<UsualError> out;
  for (const Series& s : series_)
    out.push_back({s.signal, rms_of_rows(r.segment(s.first, s.count)), 0.0, s.effective, 2 / k::window});
  return out;
}

std::vector<Miss> ReplaySubject::misses(const Eigen::VectorXd& rows) const {
  const Eigen::VectorXd r = physical(rows);
  std::vector<Miss> out;
  for (const Kind& kind : kinds) {
    double square = 0, n = 0;
    for (std::size_t i = 0; i < series_.size(); ++i) {
      const Series& s = series_[i];
      if (parts_[i].missing != kind.missing) continue;
      square += r.segment(s.first, s.count).squaredNorm(), n += static_cast<double>(s.count);
    }
    if (n > 0) out.push_back({kind.name, std::sqrt(square / n)});
  }
  return out;
}

// Weighed by what is left, or by what is usual where that is less; windows overlap, and count for what is news in them.
bool ReplaySubject::rescale(const Eigen::VectorXd& rows) {
  const Eigen::VectorXd r = physical(rows);
  for (std::size_t i = 0; i < series_.size(); ++i) {
    Series& s = series_[i];
    weigh_by_usual(r.segment(s.first, s.count), usual_, tiny, s, sigma_[i]);
  }
  return !series_.empty();
}

}  // namespace servodx
