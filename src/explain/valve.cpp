#include "explain/valve.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/student.h"
#include "explain/constants.h"
#include "explain/sought_cause.h"
#include "explain/ties.h"
#include "explain/valve_causes.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/fast_log.h"
#include "fit/free_values.h"
#include "fit/log_data.h"
#include "fit/thin.h"
#include "fit/tuned_state.h"
#include "optimise/unit_cube.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

namespace k = explain_constants;

// What healthy logs have had of a nuisance, by Student's 99 %, is where it goes; beyond is a cause, and no log's own
// affair. A log's air is a number of its oil, and counts by how soft it makes it: little air and none are alike. The
// command between samples is the logger's, and a delay in its place.
void limit(FreeValue& own, const std::vector<double>& healthy) {
  if (healthy.size() < k::enough_healthy) return;
  double mean = 0, square = 0;
  const auto n = static_cast<double>(healthy.size());
  for (double v : healthy) mean += v / n;
  for (double v : healthy) square += std::pow(v - mean, 2) / (n - 1);
  const double reach = student_quantile(k::beyond_healthy, n - 1) * std::sqrt(square * (1 + 1 / n)),
               least = k::least_own_range * (own.upper - own.lower);
  own.lower = std::max(own.lower, mean - reach);
  own.upper = std::max(std::min(own.upper, mean + reach), own.lower + least);
  own.start = std::clamp(own.start, own.lower, own.upper);
}

}  // namespace

ValveSubject::ValveSubject(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig, int threads,
                           std::optional<KnownRig> known)
    : table_(tuned), base_(candidate_of(tuned)), error_(required_error_model(tuned)), known_(std::move(known)) {
  options_.threads = threads;
  options_.creep_step = creep_step_of(logs, rig);
  prepare_logs(logs, rig);
  for (SoughtCause& c : valve_causes(cause_facts(logs_, table_, base_, rig, known_.has_value())))
    add(std::move(c.cause), std::move(c.values));
  free_own(rig.null_limit);
  free_rows();
  weigh_as_tuned();
}

void ValveSubject::prepare_logs(const std::vector<Log>& logs, const RigFile& rig) {
  RigFile without_notch = rig;
  without_notch.mains_frequency.reset();
  for (const Log& log : logs) {
    logs_.push_back(prepare_to_fit(log, without_notch, recorder_of(table_)));
    for (Note& note : leave_out_unknown_channels(logs_.back(), error_)) logs_.back().notes.push_back(std::move(note));
    require_channels(logs_.back());
  }
}

void ValveSubject::free_own(double null_limit) {
  for (std::size_t l = 0; l < logs_.size(); ++l)
    for (FreeValue& f : nuisance_values(logs_[l], static_cast<int>(l), base_, null_limit)) {
      if (known_ && f.at == row::air_fraction) limit(f, known_->air);
      if (known_ && f.at == nuisance::command_slope) limit(f, known_->command_slope);
      free_.push_back(std::move(f));
    }
  own_ = free_.size();
}

void ValveSubject::free_rows() {
  for (FreeValue& f : shared_values(table_)) {
    if (f.at >= n_parameters) continue;  // effects of the table are causes
    const Row& row = table_[f.at];
    const double slope = coordinate(row).slope(row.nominal);
    f.prior_sd = std::max(k::least_sd, row.std_error.value_or(0.0) / slope);
    free_.push_back(std::move(f));
  }
}

int ValveSubject::add(Cause cause, std::vector<FreeValue> values) {
  causes_.push_back(std::move(cause));
  values_.push_back(std::move(values));
  return static_cast<int>(causes_.size()) - 1;
}

std::vector<FreeValue> ValveSubject::free_for(const std::vector<int>& causes, bool wide) const {
  std::vector<FreeValue> free(free_.begin(), free_.begin() + static_cast<long>(base_count(wide)));
  for (FreeValue& f : free)
    if (wide && f.log < 0) f.prior_sd = k::wide_sd;
  for (int c : causes)
    for (const FreeValue& f : values_[static_cast<std::size_t>(c)]) free.push_back(f);
  return free;
}

std::shared_ptr<FitProblem> ValveSubject::problem(const std::vector<int>& causes, bool wide) const {
  std::vector<const LogData*> data;
  for (const LogData& l : logs_) data.push_back(&l);
  const auto p = std::make_shared<FitProblem>(data, base_, free_for(causes, wide), options_);
  p->difference_step = step_through_contacts;
  for (std::size_t l = 0; l < sigma_.size(); ++l)
    for (std::size_t c = 0; c < sigma_[l].size(); ++c)
      p->set_sigma(static_cast<int>(l), static_cast<int>(c), sigma_[l][c]);
  const std::lock_guard lock(making_);
  made_.push_back(p);
  return p;
}

SubjectFit ValveSubject::fit(const std::vector<int>& causes, bool wide) const {
  const std::shared_ptr<FitProblem> p = problem(causes, wide);
  SubjectFit out;
  for (std::size_t j = 0; j < base_count(wide); ++j) {
    const FreeValue& f = free_[j];
    const bool of_row = f.at < n_parameters;
    const std::string unit(of_row ? parameter_list[static_cast<std::size_t>(f.at)].unit : "");
    out.numbers.push_back(number_of({f, unit}));
  }
  for (int c : causes)
    for (const Number& n : causes_[static_cast<std::size_t>(c)].numbers) out.numbers.push_back(n);
  out.start = p->start();
  out.work = {p, &p->work()};
  out.problem.n = p->n();
  out.problem.evaluate = [this, p](std::span<const Point> points) {
    std::vector<Evaluation> e = p->evaluate(points);
    for (Evaluation& one : e)
      if (one.ok) remember(one.residual);
    return e;
  };
  out.problem.jacobian = [this, p](const Point& x, const Eigen::VectorXd& r, Eigen::MatrixXd& j) {
    Eigen::VectorXd plain = r;
    forget(plain);
    if (!p->jacobian(x, plain, j)) return false;
    for (long c = 0; c < j.cols(); ++c) remember(j.col(c));
    return true;
  };
  tie(out, causes_, causes);
  return out;
}

double ValveSubject::own(int log, int at, const Point& point) const {
  const bool stated = at == nuisance::command_slope && logs_[static_cast<std::size_t>(log)].scenario.command_slope;
  return stated ? std::nan("") : candidate({}, point, log)[static_cast<std::size_t>(at)];
}

bool ValveSubject::own_at_end(int at, const Point& point) const {
  for (std::size_t j = 0; j < own_; ++j)
    if (free_[j].at == at && point[j] >= 1 - k::at_end) return true;
  return false;
}

double ValveSubject::thickness() const {
  double sum = 0;
  for (const LogData& l : logs_) {
    if (!l.scenario.oil_known) return std::nan("");
    sum += std::log(l.scenario.oil.viscosity_ratio);
  }
  return sum / static_cast<double>(logs_.size());
}

long ValveSubject::simulations() const {
  long n = 0;
  for (const auto& p : made_) n += p->simulations();
  return n;
}
long ValveSubject::failed_simulations() const {
  long n = 0;
  for (const auto& p : made_) n += p->failed_simulations();
  return n;
}

}  // namespace servodx
