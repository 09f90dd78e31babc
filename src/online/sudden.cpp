#include "online/sudden.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>

#include "diagnose/gross.h"
#include "faults/fault.h"
#include "faults/record.h"
#include "faults/registry.h"
#include "faults/sizes.h"
#include "fit/error_model.h"
#include "fit/log_data.h"
#include "online/constants.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {
namespace {

namespace k = online_constants;

// What a sudden failure is: the far end of a fault and the places from which a search begins.
std::vector<double> severities_of(const Fault& fault, const ParameterVector& base) {
  const auto [least, worst, spread, starts] = sizes_of(fault, base.data());
  std::vector<double> out = starts;
  out.push_back(worst);
  // What breaks or seizes goes beyond what wears: on a log scale twice as far.
  if (fault.log_scale && fault.healthy > 0) out.push_back(worst * worst / fault.healthy);
  if (fault.healthy == 0 && !starts.empty() && starts.back() < 0) out.push_back(-worst);
  return out;
}

struct Try {
  const Fault* fault = nullptr;
  double severity = 0;
  ParameterVector candidate;
  Trajectory run;
};

double misfit_of(const Try& t, const LogData& data, const WatchedModel& model, const std::vector<Signal>& channels) {
  if (!t.run.ok) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (const FitChannel& c : data.channels) {
    if (std::find(channels.begin(), channels.end(), c.signal) == channels.end()) continue;
    const auto& shown = t.run.signals[static_cast<std::size_t>(c.simulated)];
    const auto noise = model.noise.find(c.signal);
    const std::vector<double> sigma =
        sigma_of(model.error.find(c.signal), noise == model.noise.end() ? c.noise : noise->second,
                 activity(data.scenario.time, shown));
    // A run that misses by far misses in every sample: beyond some deviates it counts by its size, not its square.
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const double z = std::abs(c.measured[i] - shown[i]) / sigma[i];
      if (!std::isnan(z)) sum += std::log1p(z * z);
    }
  }
  return sum;
}

}  // namespace

std::vector<NameScore> score_failures(const WatchedModel& model, std::span<const Sample> samples,
                                      const std::vector<Signal>& channels) {
  if (samples.size() < 3) return {};
  const LogData data = prepare(log_of("window", {samples.begin(), samples.end()}), model.rig);
  if (data.scenario.command.empty()) return {};
  std::vector<Try> tries;
  tries.push_back({nullptr, 0, model.base, {}});
  for (const Fault* fault : fault_list())
    for (double severity : severities_of(*fault, model.base)) {
      tries.push_back({fault, severity, model.base, {}});
      fault->apply(tries.back().candidate.data(), severity);
    }
  std::vector<Job> jobs;
  for (Try& t : tries) jobs.push_back({&data.scenario, &t.candidate, &t.run});
  SimulateOptions how;
  how.threads = 1;
  how.wanted.fill(false);
  for (const FitChannel& c : data.channels) how.wanted[static_cast<std::size_t>(c.simulated)] = true;
  simulate(jobs, how);
  std::map<std::string, NameScore> best;
  for (const Try& t : tries) {
    const std::string name = t.fault ? std::string(t.fault->name) : "";
    const NameScore score{name, misfit_of(t, data, model, channels), t.severity};
    const auto [at, is_new] = best.emplace(name, score);
    if (!is_new && score.misfit < at->second.misfit) at->second = score;
  }
  std::vector<NameScore> out;
  for (const auto& [name, score] : best) out.push_back(score);
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.misfit < b.misfit; });
  return out;
}

std::string name_of(const SuddenEvidence& e) {
  if (e.driver)
    if (const Fault* fault = fault_told_by(Record::driver)) return std::string(fault->name);
  if (e.supply)
    if (const Fault* fault = fault_told_by(Record::supply)) return std::string(fault->name);
  for (const Fault* fault : fault_list())
    if (fault->seen_outright && e.gross != GrossFinding::none && fault->seen_outright->finding == e.gross)
      return std::string(fault->name);
  if (e.scores.empty() || !std::isfinite(e.scores.front().misfit)) return "";
  return e.scores.front().name;
}

GrossFinding gross_finding_in(const WatchedModel& model, std::span<const Sample> samples) {
  if (samples.size() < 10) return GrossFinding::none;
  const bool current = !std::isnan(samples.front()[Signal::coil_current]);
  LogData data;
  data.scenario.rated_current = model.rated_current;
  FitChannel spool;
  spool.signal = Signal::spool_position;
  // What was asked in the last moments has not had its answer yet.
  const double answered = samples.back().time - k::command_to_spool;
  double command = 0;
  for (const Sample& s : samples) {
    const double u = s[current ? Signal::coil_current : Signal::command];
    if (s.time <= answered && !std::isnan(u)) command = u;
    data.scenario.time.push_back(s.time);
    data.scenario.command.push_back(command);
    spool.measured.push_back(s[Signal::spool_position]);
  }
  data.channels.push_back(std::move(spool));
  return gross_finding(data, model.base);
}

}  // namespace servodx
