#include "plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "base/error.h"
#include "diagnose/hypotheses.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "faults/sizes.h"
#include "fit/candidate_of.h"
#include "parameters/list.h"
#include "plan/constants.h"
#include "plan/information.h"
#include "plan/lanes.h"
#include "plan/piece_search.h"
#include "plan/segments.h"
#include "plan/test_bench.h"
#include "servodx/data_sheet.h"
#include "servodx/note.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

namespace k = plan_constants;

std::string listed(const std::vector<const Fault*>& faults) {
  std::string text;
  for (const Fault* f : faults) text += (text.empty() ? "" : ", ") + std::string(f->name);
  return text;
}

TargetLane target_of(const PlanFault& wished, const std::string& option, const std::vector<const Fault*>& shown,
                     const ParameterVector& base) {
  const auto at = std::find_if(shown.begin(), shown.end(), [&](const Fault* f) { return f->name == wished.name; });
  if (at == shown.end())
    throw InputError({option, 0, ""}, "'" + wished.name + "' is no fault that a log of this rig can show by a fit",
                     "name one of: " + listed(shown));
  TargetLane out;
  out.fault = *at;
  const FaultSizes sizes = sizes_of(*out.fault, base.data());
  out.severity = std::isfinite(wished.severity) ? wished.severity : sizes.starts.front();
  const double size = out.fault->healthy == 0 ? std::abs(out.severity) : out.severity;
  const auto [low, high] = std::minmax(out.fault->healthy, sizes.worst);
  if (!(size >= low && size <= high) || size == out.fault->healthy)
    throw InputError({option, 0, ""},
                     fmt::format("{} of {} is not between healthy, {}, and the worst, {}", out.severity, wished.name,
                                 out.fault->healthy, sizes.worst),
                     fmt::format("give a severity in its unit ({})", out.fault->unit));
  return out;
}

std::vector<TargetLane> targets_of(const PlanOptions& options, const std::vector<const Fault*>& shown,
                                   const ParameterVector& base) {
  std::vector<TargetLane> out;
  const bool part = !options.between.empty();
  std::vector<PlanFault> wished = part ? options.between : options.faults;
  if (wished.empty() && options.rows.empty())
    for (const Fault* f : shown) wished.push_back({std::string(f->name)});
  std::set<std::string> seen;
  for (const PlanFault& w : wished) {
    const std::string option = part ? "--between" : "--faults";
    out.push_back(target_of(w, option, shown, base));
    if (!seen.insert(w.name).second)
      throw InputError({option, 0, ""}, "'" + w.name + "' is named twice", "name each fault once");
  }
  return out;
}

GoalKind kind_of(const PlanOptions& options) {
  if (!options.between.empty()) return GoalKind::part;
  return options.rows.empty() ? GoalKind::find : GoalKind::estimate;
}

PlanLimits limits_in_effect(PlanLimits limits, const Table& table, Ports ports) {
  if (ports == Ports::actuator) {
    if (!limits.stroke) limits.stroke = k::usual_stroke * table[row::piston_stroke].nominal / 2;
  } else if (limits.stroke || limits.speed || limits.pressure) {
    throw InputError({limits.stroke  ? "--max-stroke"
                      : limits.speed ? "--max-speed"
                                     : "--max-pressure",
                      0, ""},
                     "a valve on a test stand moves no piston", "leave it out");
  }
  return limits;
}

FindingLaw law_of(const DetectionBaseline* baseline, double degrees) {
  constexpr double false_alarm = 0.01;
  FindingLaw law = usual_law(baseline ? baseline->asked : false_alarm);
  law.degrees = std::max(1.0, degrees);
  if (!baseline) return law;
  law.threshold = baseline->threshold;
  for (const auto& [fault, gain] : usual_gains(*baseline)) law.usual_gain[std::string(fault->name)] = gain;
  return law;
}

// The test once more, with rivals and faults at as many severities as the least one needs.
PlannedTest::Figures figures(TestBench& bench, const LaneSet& fine, const std::vector<double>& wave, GoalKind kind,
                             const FindingLaw& law) {
  const TestRun run = std::move(bench.play({&wave, 1}, fine).front());
  PlannedTest::Figures out = figures_of(Information(run.gram, fine), fine, kind, law);
  out.extremes = run.extremes;
  return out;
}

// The loop then asks for the planned current where the valve is as tuned, and brings it back where it is not.
std::vector<double> setpoint_of(const std::vector<double>& command, const std::vector<double>& piston, double gain,
                                const PlanLimits& limits) {
  std::vector<double> out(command.size());
  double most = 0;
  for (std::size_t n = 0; n < out.size(); ++n) {
    out[n] = piston[n] + command[n] / gain;
    most = std::max(most, std::abs(out[n]));
  }
  if (limits.stroke && most > *limits.stroke)
    throw InputError(
        {"--closed-loop", 0, ""},
        fmt::format("the setpoint would go to {:.4g} mm, beyond the stroke limit of {:.4g} mm: a loop of this "
                    "gain asks for that much to send the current",
                    most * 1e3, *limits.stroke * 1e3),
        "lower --max-current, widen --max-stroke or plan in open loop");
  return out;
}

std::vector<PlannedTest::Piece> pieces_of(const std::vector<Segment>& segments, const Timing& timing) {
  std::vector<PlannedTest::Piece> out;
  for (std::size_t i = 0; i < segments.size(); ++i)
    out.push_back({name_of(segments[i].shape), static_cast<double>(timing.first[i]) / timing.rate, timing.seconds(i),
                   segments[i].shape == Shape::rest ? 0 : segments[i].amplitude,
                   played_rate(segments[i], timing.seconds(i))});
  return out;
}

std::vector<double> times(double factor, std::vector<double> x) {
  for (double& v : x) v *= factor;
  return x;
}

}  // namespace

PlannedTest plan_of(const Table& tuned, const RigFile& rig, const PlanOptions& options,
                    const DetectionBaseline* baseline, const Log* like) {
  const Table table = apply_rig_facts(tuned, rig);
  TestBench bench(table, rig, like, options.rate, options.threads);
  const std::vector<const Fault*> shown = fitted_faults({&bench.pattern()});
  const LaneWishes wishes{targets_of(options, shown, candidate_of(table)), options.rows, k::grid};
  const LaneSet set = lanes_of(bench.pattern(), table, rig.null_limit, wishes);
  const Ports ports = bench.pattern().scenario.ports;
  if (options.loop_gain && ports != Ports::actuator)
    throw InputError({"--closed-loop", 0, ""}, "a valve on a test stand closes no position loop", "leave it out");
  const Timing timing = timing_of(options.seconds, options.rate);
  const SearchWishes how{kind_of(options), limits_in_effect(options.limits, table, ports),
                         options.rounds,   options.seed,
                         options.threads,  options.watch};
  FoundTest found = search(bench, set, timing, how);
  const FoundTest blind = random_test(bench, set, timing, how);

  PlannedTest out;
  const std::vector<double> wave = wave_of(found.segments, timing), random = wave_of(blind.segments, timing);
  const FindingLaw law = law_of(baseline, bench.degrees(options.seconds));
  const LaneSet fine = lanes_of(bench.pattern(), table, rig.null_limit, {wishes.targets, options.rows, k::fine_grid});
  out.planned = figures(bench, fine, wave, how.kind, law);
  out.random = figures(bench, fine, random, how.kind, law);
  for (std::size_t n = 0; n < wave.size(); ++n) out.time.push_back(static_cast<double>(n) / options.rate);
  out.command = times(bench.rated_current(), wave);
  out.random_command = times(bench.rated_current(), random);
  if (options.loop_gain) out.setpoint = setpoint_of(out.command, found.run.piston, *options.loop_gain, how.limits);
  out.pieces = pieces_of(found.segments, timing);
  out.threshold = law.threshold;
  out.notes = bench.notes();
  if (out.planned.extremes.cavitates)
    out.notes.push_back(
        {Note::Kind::cavitation,
         "the chambers of a healthy valve within its tolerances may fall to -1 bar, where oil cavitates: the test is "
         "harder on the actuator, and less like the model, than its figures say; lower --max-current or --max-speed"});
  if (!baseline)
    out.notes.push_back(
        {Note::Kind::no_baseline,
         "no baseline is given: a finding has to pass what noise alone needs, not what healthy logs show"});
  out.simulations = bench.simulations(), out.failed_simulations = bench.failed_simulations();
  out.interrupted = found.interrupted;
  out.whole =
      std::make_shared<TestPlan>(TestPlan{how.kind, how.limits, bench.rated_current(), std::move(found.run.piston)});
  return out;
}

}  // namespace servodx
