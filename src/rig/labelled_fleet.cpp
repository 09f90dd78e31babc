#include "rig/labelled_fleet.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <mutex>

#include "base/celsius.h"
#include "base/error.h"
#include "base/random.h"
#include "rig/fluid.h"
#include "rig/passage.h"
#include "rig/rig_faults.h"
#include "rig/rig_model.h"
#include "servodx/rig.h"

namespace servodx::rig {
namespace {

constexpr int labels_of_the_contract = 11;  // the first of rig_faults()
constexpr int logs_per_valve = 30;
constexpr double coldest = -20.0, warmest = 65.0;  // [degC]

// Where faults are looked for, and where a valve is known to be well.
const std::vector<std::string> healthy_excitations{"steps_large", "mixed",     "steps_small", "flight",
                                                   "multisine",   "preflight", "sweep",       "triangle",
                                                   "prbs",        "sine",      "track"};
const std::vector<std::string> fault_excitations{"mixed", "flight"};

bool closed_loop(const std::string& excitation) { return excitation == "flight" || excitation == "track"; }

struct Size {
  Grade grade;
  double value;
};
// From mild to severe through medium, either sign where the fault has one.
Size size_of(const RigFault& fault, Random& random) {
  constexpr Grade grades[] = {Grade::mild, Grade::medium, Grade::severe};
  const double u = random.uniform(0.0, 2.0);
  const auto k = static_cast<std::size_t>(u);
  double value = fault.severity[k] + (u - static_cast<double>(k)) * (fault.severity[k + 1] - fault.severity[k]);
  if (fault.low < 0.0 && random.below(2)) value = -value;
  return {grades[static_cast<std::size_t>(std::lround(u))], value};
}

FleetLog planned(const FleetOptions& o, int valves, int i) {
  const int valve = i % valves, k = i / valves;  // the valve's k-th log
  Random random(o.seed, 91, static_cast<std::uint32_t>(i));
  FleetLog log;
  log.folder = fmt::format("valve_{:02}", valve + 1);
  log.valve = (o.seed << 16) + static_cast<std::uint64_t>(valve) + 1;
  log.set = k % 10 == 9 ? FleetSet::sudden : k % 2 == 1 ? FleetSet::fault : FleetSet::healthy;
  const bool healthy = log.set == FleetSet::healthy;
  const auto& excitations = healthy ? healthy_excitations : fault_excitations;
  const auto turn = static_cast<std::size_t>(k / 2);
  log.run.excitation = o.excitation.value_or(excitations[turn % excitations.size()]);
  log.run.duration = o.duration;
  log.run.rate = o.rate;
  log.run.seed = (o.seed << 20) + static_cast<std::uint64_t>(i) + 1;
  log.run.temperature = o.temperature.value_or(zero_celsius + random.uniform(coldest, warmest));
  log.run.air = random.uniform(0.002, 0.012);
  log.null = random.uniform(-0.005, 0.005);
  log.label = "healthy";
  log.severity = Grade::none;
  log.severity_value = 0.0;
  if (!healthy) {
    // Valves take up the list at different places, so that a small set of several valves covers it.
    const auto place = turn + 3 * static_cast<std::size_t>(valve);
    const RigFault& fault = rig_faults()[place % labels_of_the_contract];
    const Size size = size_of(fault, random);
    log.label = fault.name;
    log.severity = size.grade;
    log.severity_value = size.value;
    FaultCourse course(size.value);
    if (log.set == FleetSet::sudden) {
      course.start = o.duration * random.uniform(0.4, 0.6);
      if (random.below(2)) course.end = o.duration * random.uniform(0.8, 1.0);
    }
    log.run.faults = {{fault.name, course}};
  }
  const char* const set = name_of(log.set);
  log.path = fmt::format("{}/{}{:03}_{}.csv", set, set[0], k + 1, log.run.excitation);
  return log;
}

}  // namespace

const char* name_of(FleetSet set) {
  constexpr const char* names[] = {"healthy", "fault", "sudden"};
  return names[static_cast<std::size_t>(set)];
}

const char* name_of(Grade grade) {
  constexpr const char* names[] = {"none", "mild", "medium", "severe"};
  return names[static_cast<std::size_t>(grade)];
}

std::vector<FleetLog> plan_fleet(const FleetOptions& o) {
  if (o.logs < 1 || o.logs > 100000) {
    throw InputError({"", 0, "--fleet"}, fmt::format("{} logs are not 1 to 100000", o.logs), "give a number of logs");
  }
  const int valves = o.valves > 0 ? o.valves : (o.logs + logs_per_valve - 1) / logs_per_valve;
  if (o.valves < 0 || valves > o.logs) {
    throw InputError({"", 0, "--valves"}, fmt::format("{} valves are not 1 to {}", o.valves, o.logs),
                     "give no more valves than logs");
  }
  std::vector<FleetLog> plan;
  for (int i = 0; i < o.logs; ++i) plan.push_back(planned(o, valves, i));
  return plan;
}

RigModel model_of(const RigModel& type, const FleetLog& log) {
  RigModel model = another_valve(type, log.valve);
  model.armature_null += log.null;
  return model;
}

std::vector<bool> run_fleet(const RigModel& type, const std::vector<FleetLog>& plan, int threads,
                            const std::atomic<bool>& stop,
                            const std::function<void(const FleetLog&, const RigModel&, RigLog&&)>& write,
                            const std::function<void(double, long)>& progress) {
  const int n = static_cast<int>(plan.size());
  std::vector<char> written(plan.size(), 0);
  std::exception_ptr failure;
  std::mutex mutex;
  std::atomic<bool> failed{false};
  std::atomic<long> done{0};
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads > 0 ? threads : omp_get_max_threads())
  for (int i = 0; i < n; ++i) {
    if (stop || failed) continue;
    try {
      const RigModel model = model_of(type, plan[i]);
      RigRun run = plan[i].run;
      run.stop = &stop;
      RigLog log = run_rig(model, run);
      if (stop) continue;  // a piece of a log is no log
      write(plan[i], model, std::move(log));
      written[i] = 1;
      progress(static_cast<double>(++done) / n, done);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failed.exchange(true)) failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
  return {written.begin(), written.end()};
}

std::string data_sheet(const RigModel& m) {
  const Oil oil(m, 40.0 + zero_celsius, 0.0);
  // Both edges open by the stroke, half of the differential each.
  const double drop = 0.5 * (m.supply_pressure - m.supply_tank_pressure);
  const double flow = sum(flows_through(Edges(m).at(m.spool_stroke).law, oil, Four(m.supply_tank_pressure + drop),
                                        Four(m.supply_tank_pressure))
                              .volume *
                          four(0.5, 0.0, 0.0, 0.5));
  const double mount = 1.0 / (1.0 / m.actuator_surface_stiffness + 1.0 / m.actuator_earth_stiffness);
  std::string text = fmt::format(
      "# What a user would know of these valves: the data sheet of the type, rounded. The definition of each valve is "
      "the\n"
      "# virtual rig's own, and no fit may read it.\n"
      "name = \"{}\"\nports = \"{}\"\nmains_frequency = \"{:.3g} Hz\"\n[valve]\n",
      m.name,
      m.has_actuator()            ? "actuator"
      : m.ports == Ports::blocked ? "blocked"
                                  : "free",
      m.mains_frequency);
  const auto line = [&](const char* key, double value, const char* unit) {
    text += fmt::format("{} = \"{:.3g} {}\"\n", key, value, unit);
  };
  if (m.first_stage == FirstStage::jet_pipe) text += "first_stage = \"jet_pipe\"\n";
  line("rated_current", m.driver_rated_current * 1e3, "mA");
  line("spool_stroke", m.spool_stroke * 1e3, "mm");
  line("spool_stop", m.spool_stop * 1e3, "mm");
  line("spool_diameter", m.spool_diameter * 1e3, "mm");
  line("no_load_flow", flow * 6e4, "l/min");
  line("radial_clearance", m.edges_clearance * 1e6, "um");
  if (m.first_stage == FirstStage::flapper_nozzle) {
    line("nozzle_diameter", m.nozzles_diameter * 1e3, "mm");
    line("fixed_orifice_diameter", m.nozzles_orifice_diameter * 1e3, "mm");
    line("nozzle_gap", m.nozzles_gap * 1e6, "um");
  }
  if (m.has_actuator()) {
    text += "[actuator]\n";
    line("area_a", m.piston_area_a(), "m2");
    line("area_b", m.piston_area_b(), "m2");
    line("stroke", m.actuator_stroke * 1e3, "mm");
    line("moving_mass", m.actuator_piston_mass + m.actuator_surface_mass, "kg");
    line("dead_volume_a", m.actuator_dead_volume * 1e6, "cm3");
    line("dead_volume_b", m.actuator_dead_volume * 1e6, "cm3");
    line("mount_stiffness", mount, "N/m");
  }
  text += "[supply]\n";
  line("pressure", m.supply_pressure * 1e-5, "bar");
  line("return_pressure", m.supply_tank_pressure * 1e-5, "bar");
  text += "[fluid]\n";
  line("density", m.oil_density, "kg/m3");
  line("kinematic_viscosity", m.oil_viscosity_40 * 1e6, "mm2/s");
  return text;
}

std::string truth_table(const std::vector<FleetLog>& plan, const std::vector<bool>& written,
                        const std::string& folder) {
  std::string text =
      "path,set,class,severity,severity_value,excitation,closed_loop,hidden_effect,onset_s,test_index,"
      "oil_temperature_C,air_fraction,null_bias_pct,sample_hz,grown_s,valve\n";
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const FleetLog& log = plan[i];
    if (!written[i] || log.folder != folder) continue;
    const FaultCourse course = log.run.faults.empty() ? FaultCourse{} : log.run.faults.begin()->second;
    const auto time = [](double t) { return t >= 0.0 ? fmt::format("{:.3f}", t) : std::string(); };
    text += fmt::format("{},{},{},{},{:.6g},{},{},,{},,{:.1f},{:.4f},{:.3f},{},{},{}\n", log.path, name_of(log.set),
                        log.label, name_of(log.severity), log.severity_value, log.run.excitation,
                        closed_loop(log.run.excitation) ? 1 : 0, time(course.start), log.run.temperature - zero_celsius,
                        log.run.air, 100.0 * log.null, log.run.rate, time(course.end), log.valve);
  }
  return text;
}

}  // namespace servodx::rig
