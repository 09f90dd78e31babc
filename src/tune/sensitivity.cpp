#include "servodx/sensitivity.h"

#include <Eigen/Dense>
#include <algorithm>
#include <span>

#include "base/error.h"
#include "base/require_setting.h"
#include "effects/registry.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/fast_log.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "fit/thin.h"
#include "fit/tuned_state.h"
#include "optimise/unit_cube.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/watch.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"
#include "tune/constants.h"

namespace servodx {
namespace {

using tune_constants::most_at_once;

struct Sum {
  double squares = 0, samples = 0;
  double rms() const { return samples > 0 ? std::sqrt(squares / samples) : NAN; }
};
// Of each row and end, channel by channel.
using Sums = std::vector<std::array<std::vector<Sum>, 2>>;

// Every row, free in a tune or not, on its own scale.
std::vector<FreeValue> every_row(const Table& table) {
  std::vector<FreeValue> free;
  const auto add = [&](const Row& r, int at) {
    free.emplace_back(r.name, at, r.lower, r.upper, r.log_scale, r.nominal);
  };
  for (int i = 0; i < n_parameters; ++i) add(table[i], i);
  for (const EffectInfo& e : effect_list())
    for (std::size_t j = 0; j < e.parameters.size(); ++j)
      if (const int row = table.find(e.parameters[j].name); row >= 0) add(table[row], e.first + static_cast<int>(j));
  return free;
}

// All rows at nominal but one, which is at an end.
std::vector<Point> extremes(const FitProblem& problem) {
  const Point x = problem.start();
  std::vector<Point> points;
  for (std::size_t j = 0; j < x.size(); ++j)
    for (const double end : {0.0, 1.0}) {
      points.push_back(x);
      points.back()[j] = end;
    }
  return points;
}

class Driving {
 public:
  Driving(Sensitivity& out, Sums& sums) : out_(out), sums_(sums) {}

  void log(const LogData& data, const FitProblem& problem, const Watch& watch, double from, double to) {
    const Point start = problem.start();
    const Evaluation base = problem.evaluate(std::span(&start, 1)).front();
    if (!base.ok)
      throw InputError({.file = data.path}, "the simulation fails at the table's own values",
                       "check the table against the rig's data sheet");
    const std::vector<Point> points = extremes(problem);
    for (std::size_t first = 0; first < points.size(); first += most_at_once) {
      const std::size_t n = std::min(most_at_once, points.size() - first);
      const std::vector<Evaluation> ran = problem.evaluate(std::span(&points[first], n));
      for (std::size_t i = 0; i < n; ++i) take(data, problem, base, ran[i], (first + i) / 2, (first + i) % 2);
      watch.tell("rows driven",
                 from + (to - from) * static_cast<double>(first + n) / static_cast<double>(points.size()),
                 problem.simulations());
    }
    out_.simulations += problem.simulations();
    out_.failed_simulations += problem.failed_simulations();
  }

 private:
  void take(const LogData& data, const FitProblem& problem, const Evaluation& base, const Evaluation& driven,
            std::size_t row, std::size_t end) {
    if (!driven.ok) return out_.rows[row].ends[end].failed.push_back(data.path);
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
      const auto [first, count] = problem.rows(0, static_cast<int>(c));
      const auto at = std::find(out_.channels.begin(), out_.channels.end(), data.channels[c].signal);
      Sum& sum = sums_[row][end][static_cast<std::size_t>(at - out_.channels.begin())];
      sum.squares += (driven.residual - base.residual).segment(first, count).squaredNorm();
      sum.samples += static_cast<double>(present_samples(data.channels[c]));
    }
  }

  Sensitivity& out_;
  Sums& sums_;
};

void rank(Sensitivity& out, const Sums& sums) {
  for (std::size_t j = 0; j < out.rows.size(); ++j)
    for (std::size_t e = 0; e < 2; ++e) {
      Sum all;
      DrivenEnd& end = out.rows[j].ends[e];
      for (const Sum& s : sums[j][e]) {
        end.by_channel.push_back(s.rms());
        all.squares += s.squares, all.samples += s.samples;
      }
      end.effect = all.rms();
    }
  const auto place = [](const DrivenRow& r) { return std::isnan(r.largest()) ? -1.0 : r.largest(); };
  std::stable_sort(out.rows.begin(), out.rows.end(),
                   [&](const DrivenRow& a, const DrivenRow& b) { return place(a) > place(b); });
}

}  // namespace

double DrivenRow::largest() const { return std::fmax(ends[0].effect, ends[1].effect); }

Sensitivity drive_rows(const std::vector<Log>& logs, const Table& table, const RigFile& rig, int threads,
                       const Watch& watch) {
  require_threads(threads);
  Sensitivity out;
  const std::vector<FreeValue> free = every_row(table);
  for (const FreeValue& f : free) {
    const Row& r = table[table.find(f.name)];
    out.rows.push_back({r.id, r.name, r.unit, r.estimate, r.nominal, {}});
    out.rows.back().ends[0].value = r.lower, out.rows.back().ends[1].value = r.upper;
  }
  std::vector<LogData> data;
  for (const Log& log : logs) {
    data.push_back(prepare_at_points(log, rig, recorder_of(table)));
    require_channels(data.back());
    for (const FitChannel& c : data.back().channels)
      if (std::find(out.channels.begin(), out.channels.end(), c.signal) == out.channels.end())
        out.channels.push_back(c.signal);
  }
  Sums sums(free.size());
  for (auto& row : sums)
    for (auto& end : row) end.resize(out.channels.size());
  SimulateOptions simulate;
  simulate.threads = threads;
  simulate.creep_step = creep_step_of(logs, rig);
  Driving driving(out, sums);
  const double n = static_cast<double>(data.size());
  for (std::size_t l = 0; l < data.size() && !(out.interrupted = watch.stopped()); ++l) {
    FitProblem problem({&data[l]}, candidate_of(table), free, simulate);
    for (std::size_t c = 0; c < data[l].channels.size(); ++c)
      problem.set_sigma(0, static_cast<int>(c), data[l].channels[c].noise);
    driving.log(data[l], problem, watch, static_cast<double>(l) / n, static_cast<double>(l + 1) / n);
  }
  rank(out, sums);
  return out;
}

}  // namespace servodx
