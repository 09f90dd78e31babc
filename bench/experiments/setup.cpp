#include <chrono>
#include <filesystem>

#include "base/random.h"
#include "diagnose/decide.h"
#include "diagnose/diagnose.h"
#include "diagnose/judge.h"
#include "experiments/studies.h"
#include "fit/log_data.h"
#include "servodx/data_sheet.h"
#include "servodx/diagnose.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/tune.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"
#include "tune/tune.h"

namespace servodx::experiments {
namespace {

// By which scripts/digest tunes the shipped rig, and its baseline's.
const std::vector<std::string> tuning = {"h08_preflight_cold", "h09_preflight_hot", "h01_steps_large", "h05_prbs"};
const std::vector<std::string> healthy = {"h02_steps_small", "h04_multisine", "h07_triangle", "h12_mixed"};

std::vector<Log> logs_of(const Setup& setup, const std::vector<std::string>& names) {
  std::vector<Log> out;
  for (const std::string& name : names) out.push_back(shipped(setup, "healthy/" + name));
  return out;
}

}  // namespace

Log shipped(const Setup& setup, const std::string& name) {
  return read_log(std::string(SERVODX_SOURCE_DIR) + "/data/" + name + ".csv", setup.rig);
}

Setup make_setup(const std::string& dir) {
  Setup setup;
  setup.dir = dir;
  std::filesystem::create_directories(dir);
  setup.rig = read_rig_file(std::string(SERVODX_SOURCE_DIR) + "/data/rig.toml");
  setup.textbook = read_table(std::string(SERVODX_SOURCE_DIR) + "/params/borello2009.csv");
  const std::string kept = dir + "/tuned.csv";
  if (!std::filesystem::exists(kept)) {
    TuneOptions o;
    o.generations = 3;
    o.rounds = 2;
    write_table(kept, tune_table(logs_of(setup, tuning), setup.textbook, setup.rig, o).table);
  }
  setup.tuned = read_table(kept);
  setup.baseline = make_baseline(logs_of(setup, healthy), setup.tuned, setup.rig, 0.2, {});
  return setup;
}

Log written_by_model(const Setup& setup, const Log& like, const ParameterVector& truth, unsigned seed) {
  const LogData data = prepare(like, setup.rig);
  SimulateOptions how;
  how.wanted.fill(true);
  const Trajectory run = simulate(data.scenario, truth, how);
  Log log = like;
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    const FitChannel& channel = data.channels[c];
    Random random(seed, static_cast<std::uint32_t>(c));
    std::vector<double>& value = log.channels[static_cast<std::size_t>(index(channel.signal))].value;
    value = run.signals[static_cast<std::size_t>(channel.simulated)];
    for (double& v : value) v += random.normal(0.0, channel.noise);
  }
  log.path = "written by the model";
  log.sha256 = std::to_string(seed);
  return log;
}

Judged judge(const Setup& setup, const Log& log, FaultSearch search, int population, unsigned seed) {
  DiagnoseOptions options;
  options.search = search;
  options.population = population;
  options.seed = seed;
  options.explain_unknown = false;
  const auto start = std::chrono::steady_clock::now();
  const Diagnosis d = diagnose(log, setup.tuned, setup.rig, setup.baseline, options);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string name(d.fault ? d.fault->name : d.verdict == VerdictKind::healthy ? "healthy" : "unknown");
  return {name, d.severity.value, d.error, d.assessment.simulations, seconds};
}

}  // namespace servodx::experiments
