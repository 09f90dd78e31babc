#include "tune/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>

#include "base/celsius.h"
#include "base/median.h"
#include "effects/registry.h"
#include "effects/viscosity_change.h"
#include "fit/log_data.h"
#include "fit/oil_of.h"
#include "optimise/unit_cube.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "servodx/note.h"
#include "servodx/tune.h"
#include "simulate/scenario.h"
#include "tune/constants.h"
#include "tune/weights.h"

namespace servodx {
namespace {

// "a.csv 0.12, b.csv 0.98"
std::string by_log(const std::vector<LogResult>& logs, const std::function<bool(std::size_t)>& among,
                   const std::function<double(const LogResult&)>& value) {
  std::string text;
  for (std::size_t l = 0; l < logs.size(); ++l)
    if (among(l))
      text += fmt::format("{}{} {:.2f}", text.empty() ? "" : ", ",
                          std::filesystem::path(logs[l].path).filename().string(), value(logs[l]));
  return text;
}

}  // namespace

std::vector<LogResult> results_by_log(const std::vector<Log>& logs, const TuneScope& scope, const FitProblem& problem,
                                      const Point& point, const std::vector<Trajectory>& settled,
                                      const std::vector<Trajectory>& heldout, double heldout_part) {
  std::vector<LogResult> out;
  for (std::size_t l = 0; l < scope.data.size(); ++l) {
    const LogData& data = scope.data[l];
    const ParameterVector v = problem.candidate(point, static_cast<int>(l));
    LogResult result{
        data.path, {}, v[row::servovalve_null], data.scenario.command_slope.value_or(v[nuisance::command_slope]), v};
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
      const FitChannel& channel = data.channels[c];
      const auto n = channel.measured.size();
      const auto from = seen_samples(n, heldout_part);
      ChannelResult r{channel.signal, logs[l].channels[index(channel.signal)].unit, 0, channel.noise, 0};
      const int li = static_cast<int>(l), ci = static_cast<int>(c);
      if (settled[l].ok) r.rms = rms_of(problem.raw_residual(li, ci, settled[l]), 0, n);
      if (heldout[l].ok) r.heldout_rms = rms_of(problem.raw_residual(li, ci, heldout[l]), from, n);
      result.channels.push_back(r);
    }
    out.push_back(std::move(result));
  }
  return out;
}

double heldout_over_noise(const FitProblem& problem, const std::vector<Trajectory>& runs, double heldout_part) {
  if (!(heldout_part > 0)) return std::nan("");
  std::array<double, n_signals> left{}, noise{};  // squares, over the logs
  for (std::size_t l = 0; l < runs.size(); ++l)
    for (std::size_t c = 0; c < problem.logs()[l]->channels.size() && runs[l].ok; ++c) {
      const FitChannel& channel = problem.logs()[l]->channels[c];
      const auto n = channel.measured.size();
      const double rms = rms_of(problem.raw_residual(static_cast<int>(l), static_cast<int>(c), runs[l]),
                                seen_samples(n, heldout_part), n);
      left[index(channel.signal)] += rms * rms;
      noise[index(channel.signal)] += channel.noise * channel.noise;
    }
  double sum = 0;
  int channels = 0;
  for (std::size_t s = 0; s < left.size(); ++s)
    if (left[s] > 0 && noise[s] > 0) sum += 0.5 * std::log(left[s] / noise[s]), ++channels;
  return channels > 0 ? std::exp(sum / channels) : std::nan("");
}

std::vector<ChannelResult> pooled_channels(const std::vector<LogResult>& logs) {
  std::vector<ChannelResult> pooled;
  for (const LogResult& log : logs)
    for (const ChannelResult& r : log.channels) {
      auto it =
          std::find_if(pooled.begin(), pooled.end(), [&](const ChannelResult& p) { return p.signal == r.signal; });
      if (it == pooled.end()) it = pooled.insert(pooled.end(), {r.signal, r.unit, 0, 0, 0});
      it->rms += r.rms * r.rms;
      it->noise_rms += r.noise_rms * r.noise_rms;
      it->heldout_rms += r.heldout_rms * r.heldout_rms;
    }
  for (ChannelResult& p : pooled) {
    long n = 0;
    for (const LogResult& log : logs)
      for (const ChannelResult& c : log.channels) n += c.signal == p.signal;
    for (double* v : {&p.rms, &p.noise_rms, &p.heldout_rms}) *v = std::sqrt(*v / static_cast<double>(n));
  }
  return pooled;
}

namespace {

using namespace tune_constants;

// [SI] 0: not asked.
double reach_of(Signal signal, const ParameterVector& v) {
  switch (signal) {
    case Signal::spool_position:
      return v[row::spool_stop];
    case Signal::piston_position:
      return v[row::piston_stroke];
    case Signal::pressure_a:
    case Signal::pressure_b:
    case Signal::load_pressure:
      return v[row::supply_pressure];
    default:
      return 0;
  }
}

}  // namespace

std::vector<Unfollowed> unfollowed_channels(const std::vector<ChannelResult>& pooled, const ParameterVector& tuned) {
  std::vector<Unfollowed> out;
  for (const ChannelResult& c : pooled) {
    const double reach = reach_of(c.signal, tuned);
    if (reach > 0 && c.noise_rms > 0 && c.rms > unfollowed_over_noise * c.noise_rms && c.rms > unfollowed_part * reach)
      out.push_back({c.signal, c.rms / c.noise_rms});
  }
  return out;
}

void take_medians(Table& table, const std::vector<LogResult>& logs) {
  std::vector<double> nulls, airs;
  for (const LogResult& log : logs) {
    nulls.push_back(log.candidate[row::servovalve_null]);
    airs.push_back(log.candidate[row::air_fraction]);
  }
  table[row::servovalve_null].nominal = median(nulls);
  Row& air = table[row::air_fraction];
  air.nominal = std::clamp(median(airs), air.lower, air.upper);
}

std::vector<Note> notes_of_logs(const std::vector<LogResult>& logs, const std::optional<CommandSlope>& usual,
                                const TuneScope& scope, const RigFile& rig) {
  std::vector<Note> notes;
  notes.push_back({Note::Kind::command_slope,
                   "command between samples, 0 held to 1 in a line" +
                       std::string(rig.command_hold ? ", from the rig file: " : ", estimated log by log: ") +
                       by_log(
                           logs, [](std::size_t) { return true; }, [](const LogResult& l) { return l.command_slope; }) +
                       (usual ? fmt::format("; of one more log {:.2f} +- {:.2f}", usual->usual, usual->spread) : "")});
  const std::string temperatures = by_log(
      logs, [&](std::size_t l) { return !scope.data[l].scenario.oil_known; },
      [&](const LogResult& l) {
        return kelvin_where(rig.fluid, l.candidate[effect_row<ViscosityChange>(0)]) - zero_celsius;
      });
  if (!temperatures.empty())
    notes.push_back({Note::Kind::oil, "oil by the fit, where no temperature was logged, degC: " + temperatures});
  return notes;
}

}  // namespace servodx
