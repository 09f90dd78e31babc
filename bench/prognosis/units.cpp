#include "prognosis/units.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <functional>

#include "base/atomic_file.h"
#include "base/celsius.h"
#include "base/csv.h"
#include "base/random.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "prognose/check.h"
#include "prognose/valve_history.h"
#include "rig/rig_model.h"
#include "rig/rig_run.h"
#include "servodx/tune.h"
#include "signals/log.h"
#include "store/history_csv.h"
#include "tune/tune.h"

namespace servodx::study {
namespace {

namespace fs = std::filesystem;

Log kept_log(const Bench& b, const std::string& file, const rig::RigModel& valve, const Condition& at,
             const rig::RigRun& run) {
  if (!fs::exists(file)) {
    rig::RigRun here = run;
    here.temperature = at.celsius + zero_celsius;
    here.air = at.air;
    rig::RigModel moved = valve;
    moved.armature_null += at.null;
    const rig::RigLog log = rig::run_rig(moved, here);
    write_log(file, log.columns, log.comments);
  }
  return read_log(file, b.rig);
}

}  // namespace

Degradation end_of(Degradation d, const rig::RigModel& type, const rig::RigModel& valve) {
  if (std::string_view(d.fault) == "radial_clearance_wear") d.failed *= type.edges_clearance / valve.edges_clearance;
  return d;
}

double truth_of(const Degradation& d, const rig::RigModel& valve, double severity) {
  const std::string_view fault = d.fault;
  if (fault == "sticky_spool") return severity * valve.spool_breakaway;  // what holds it in small strokes
  if (fault == "radial_clearance_wear") return severity * valve.edges_clearance;
  return severity;
}

Table own_table(const Bench& b, const std::string& name, const rig::RigModel& valve, std::uint32_t stream,
                const std::string& folder) {
  const std::string file = folder + "/valves/" + name + ".csv", tests = folder + "/tests/" + name;
  for (const std::string& made : {tests, folder + "/valves"}) fs::create_directories(made);
  if (!fs::exists(file)) {
    Random random(33, stream);
    rig::RigRun mixed;
    mixed.excitation = "mixed", mixed.duration = 4, mixed.seed = random.bits64();
    std::vector<Log> logs = {kept_log(b, tests + "/a1.csv", valve, {}, mixed)};
    for (const double celsius : {20.0, 40.0, 60.0, -10.0})
      logs.push_back(kept_log(b, fmt::format("{}/a{}.csv", tests, logs.size() + 1), valve, {.celsius = celsius},
                              preflight(b.test, random.bits64())));
    TuneOptions options;
    options.threads = 1;
    options.generations = 0;  // it begins near
    // What drawings say of all valves of the type holds: logs of a few seconds would trade it for something else.
    options.priors = {{"fixed_orifice_diameter", 0.02 * b.tuned[row::fixed_orifice_diameter].nominal},
                      {"orifice_slenderness", 0.3},
                      {"screen_viscous_drop", 0.5e5}};
    write_table(file, tune_table(logs, b.tuned, b.rig, options).table);
  }
  return read_table(file);
}

std::vector<Unit> plan(int first, int units) {
  std::vector<Unit> all;
  const auto add = [&](const Degradation* d, std::uint32_t group, int u) {
    Random random(31, group, static_cast<std::uint32_t>(u));
    Unit unit;
    unit.name = fmt::format("{}-{:02}", d ? d->name : "healthy", u);
    unit.degradation = d;
    unit.stream = 1000 * group + static_cast<std::uint32_t>(u);
    unit.valve = unit.stream + 1;
    const double power = std::exp(random.uniform(std::log(0.7), std::log(2.0))), onset = random.uniform(0.05, 0.3);
    unit.power = u % 2 ? power : 1.0;
    unit.onset = u / 2 % 2 ? onset : 0.0;
    unit.life = random.uniform(80, 200);
    all.push_back(unit);
  };
  constexpr std::uint32_t of_healthy = of_the_paper + 1;  // all valves stay those of older studies
  for (int u = first; u < first + units; ++u) {
    std::uint32_t group = 1;
    for (const Degradation& d : degradations) {
      add(&d, group, u);
      if (++group == of_healthy) ++group;
    }
    add(nullptr, of_healthy, u);
  }
  return all;
}

namespace {

// A history that is kept: read where it is there, else made by `add`, check by check.
ValveHistory kept_history(const std::string& name, const std::string& file, const Table& own,
                          const std::function<void(ValveHistory&)>& add) {
  ValveHistory h;
  if (fs::exists(file)) {
    h = read_history_csv(file).valves.front();
  } else {
    h.valve = name;
    add(h);
    for (Recording& r : h.recordings) r.table_sha256 = own.sha256;
    fs::create_directories(fs::path(file).parent_path());
    write_file(file, history_csv({{h}, {{own.sha256, read_file(own.path)}}}));
  }
  for (int i = 0; i < n_parameters; ++i) h.tuned.push_back(own[i].nominal);
  return h;
}

}  // namespace

rig::RigModel seeded_valve(const Bench& b, int v) {
  return rig::another_valve(b.model, static_cast<std::uint64_t>(9000 + v));
}

ValveHistory seeded_looks(const Bench& b, int v, const Degradation* fault, const std::string& folder) {
  const auto stream = static_cast<std::uint32_t>(9000 + v);
  const rig::RigModel valve = seeded_valve(b, v);
  const Table own = own_table(b, fmt::format("seeded-{}", v), valve, stream, folder);
  const std::string name = fmt::format("seeded-{}-{}", v, fault ? fault->name : "healthy");
  return kept_history(name, folder + "/seeded/" + name + ".csv", own, [&](ValveHistory& h) {
    int look = 0;
    for (const double part : fault ? std::vector(std::begin(seeded_parts), std::end(seeded_parts)) : std::vector{0.0})
      for (const double celsius : seeded_celsius) {
        const double severity = fault ? severity_at(end_of(*fault, b.model, valve), part) : 0.0;
        const Log log = test_log(valve, fault ? fault->name : "", severity, {celsius, 0.005, 0},
                                 preflight(b.test, 900 + static_cast<std::uint64_t>(look)));
        h.recordings.push_back(recording_of(look++, check(log, own, b.rig, {.threads = 1, .last = {}})));
      }
  });
}

ValveHistory history_of(const Bench& b, const Unit& unit, int checks, const std::string& folder) {
  const std::string tests = folder + "/tests/" + unit.name;
  const rig::RigModel valve = rig::another_valve(b.model, unit.valve);
  const Table own = own_table(b, unit.name, valve, unit.stream, folder);
  return kept_history(unit.name, folder + "/units/" + unit.name + ".csv", own, [&](ValveHistory& h) {
    Random random(32, unit.stream);
    std::vector<double> last;
    const Degradation end = unit.degradation ? end_of(*unit.degradation, b.model, valve) : degradations[0];
    for (int k = 0; k < checks; ++k) {
      const double s = 0.95 * k / (checks - 1.0);  // the last check a little before the end
      const Condition at = random_condition(random);
      rig::RigRun run = preflight(b.test, random.bits64());
      if (unit.degradation) run.faults[unit.degradation->name] = severity_at(end, unit.progress(s));
      const Log log = kept_log(b, fmt::format("{}/t{:02}.csv", tests, k + 1), valve, at, run);
      const CheckResult r = check(log, own, b.rig, {.threads = 1, .last = last});
      last = r.tracked;
      h.recordings.push_back(recording_of(s * unit.life, r));
      h.recordings.back().log = log.path;
      h.recordings.back().log_sha256 = r.sha256;
    }
  });
}

}  // namespace servodx::study
