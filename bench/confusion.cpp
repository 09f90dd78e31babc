// The main job on a labelled rig: fault-free logs rotated through tuning, baseline and held out; every fault log and
// every held-out healthy one diagnosed; confusion matrix with counts.
//
//   servodx_confusion RIG_DIR [--params P] [--rotations 5] [--only R] [--cache DIR] [--generations G]
//
// RIG_DIR holds rig.toml, healthy/*.csv and truth.csv (path,set,class,severity,severity_value,...). Does not prove
// anything about other rigs; the thresholds come from 8 logs, so the promised rate is 1/9.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "diagnose/assessment.h"
#include "diagnose/baseline.h"
#include "diagnose/decide.h"
#include "diagnose/diagnose.h"
#include "diagnose/judge.h"
#include "faults/gross_finding.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "fit/replay.h"
#include "fit/tuned_state.h"
#include "parameters/table.h"
#include "report/diagnose/diagnosis_words.h"
#include "report/diagnose/verdict_words.h"
#include "servodx/diagnose.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "signals/log.h"
#include "simulate/scenario.h"
#include "tune/tune.h"

using namespace servodx;
namespace fs = std::filesystem;

namespace {

struct Truth {
  std::string path, set, label, severity, excitation;
  double value = 0, onset = NAN;
};

std::vector<Truth> read_truth(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  std::vector<Truth> out;
  while (std::getline(in, line)) {
    std::stringstream cells(line);
    std::vector<std::string> c;
    for (std::string cell; std::getline(cells, cell, ',');) c.push_back(cell);
    if (c.size() < 9) continue;
    out.push_back(
        {c[0], c[1], c[2], c[3], c[5], c[4].empty() ? 0 : std::stod(c[4]), c[8].empty() ? NAN : std::stod(c[8])});
  }
  return out;
}

struct Replayed {
  Signal signal;
  double rms, noise;  // [SI]
};

// What health leaves of a log, the piston above 0.3 Hz: below what fits look at, so that drift counts here.
std::vector<Replayed> replayed(const Assessment& a, const Log& log, const Table& tuned, const RigFile& rig) {
  constexpr double piston_drift = 0.3;  // [Hz]
  LogData data = prepare(log, rig, recorder_of(tuned));
  for (FitChannel& c : data.channels)
    if (c.signal == Signal::piston_position) c.filter.drift = piston_drift;
  const auto healthy = std::find_if(a.explanations.begin(), a.explanations.end(),
                                    [](const HypothesisPrediction& e) { return !e.fault; });
  std::vector<Replayed> out;
  if (healthy == a.explanations.end()) return out;
  const FitProblem problem({&data}, healthy->candidate, {});
  const Trajectory t = problem.trajectories({}).front();
  if (!t.ok) return out;
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    double sum = 0, n = 0;
    for (double r : problem.raw_residual(0, static_cast<int>(c), t))
      if (!std::isnan(r)) sum += r * r, ++n;
    out.push_back({data.channels[c].signal, std::sqrt(sum / n), data.channels[c].noise});
  }
  return out;
}

// Words of the rig's truth for labels of ours.
std::string label_of(const std::string& word) {
  if (word == "sensor_gain_drift_position") return "sensor_fault";
  if (word == "cylinder_internal_leakage") return "cylinder_leakage";
  if (word == "edge_wear") return "radial_clearance_wear";
  return word;
}

bool listed(const std::string& label) {
  static const std::vector<std::string> seven = {"clogged_filter",     "torque_motor_loss", "feedback_wire_backlash",
                                                 "feedback_wire_lost", "sticky_spool",      "radial_clearance_wear",
                                                 "null_shift"};
  return std::find(seven.begin(), seven.end(), label) != seven.end();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("confusion matrix of a labelled rig");
  std::string dir, params = "params/borello2009.csv", cache;
  int rotations = 5, only = -1, generations = 30;
  app.add_option("rig_dir", dir)->required();
  app.add_option("--params", params);
  app.add_option("--rotations", rotations);
  app.add_option("--only", only);
  app.add_option("--cache", cache, "folder that keeps tuned tables between runs");
  app.add_option("--generations", generations);
  CLI11_PARSE(app, argc, argv);

  const RigFile rig = read_rig_file(dir + "/rig.toml");
  const Table nominal = read_table(params);
  const std::vector<Truth> truth = read_truth(fs::path(dir) / "truth.csv");
  std::vector<std::string> healthy;
  for (const Truth& t : truth)
    if (t.set == "healthy") healthy.push_back(t.path);
  std::map<std::pair<std::string, std::string>, std::map<std::string, int>>
      confusion;  // (truth, severity) -> verdict -> count
  int false_alarms = 0, healthy_judged = 0;
  double promised = 0;
  const auto start = std::chrono::steady_clock::now();
  std::map<std::string, std::vector<double>> replay;  // signal -> rms over noise, rms
  for (int r = 0; r < rotations; ++r) {
    if (only >= 0 && r != only) continue;
    std::vector<Log> tune_logs, base_logs, held;
    int turn = 0;
    for (std::size_t i = 0; i < healthy.size(); ++i) {
      Log log = read_log(dir + "/" + healthy[i], rig);
      if (static_cast<int>(i) % rotations == r)
        held.push_back(std::move(log));
      else
        (turn++ % 2 == 0 ? tune_logs : base_logs).push_back(std::move(log));
    }
    Table tuned;
    const std::string kept = cache.empty() ? "" : fmt::format("{}/rot{}.csv", cache, r);
    if (!kept.empty() && fs::exists(kept)) {
      tuned = read_table(kept);
    } else {
      TuneOptions o;
      o.generations = generations;
      const TuneResult t = tune_table(tune_logs, nominal, rig, o);
      tuned = t.table;
      if (!kept.empty()) write_table(kept, tuned);
    }
    const DiagnoseOptions options;
    const DetectionBaseline baseline = make_baseline(base_logs, tuned, rig, 0.01, options);
    promised = baseline.promised;
    fmt::print("rotation {}: {} tune, {} baseline, {} held out; threshold {:.2f}, adequacy limit {:.2f}\n", r,
               tune_logs.size(), base_logs.size(), held.size(), baseline.threshold, baseline.adequacy_limit);
    for (const DetectionBaseline::Score& s : baseline.scores) {
      fmt::print("    baseline {:26s} score {:6.2f} adequacy {:.2f} gains", fs::path(s.log).filename().string(),
                 s.score, s.adequacy);
      for (const auto& [fault, gain] : s.gains)
        if (gain > 1) fmt::print(" {} {:.1f}", report::label_of(fault), gain);
      fmt::print("\n");
    }
    const auto show = [&](const Log& log, const Truth& t) {
      const Diagnosis d = diagnose(log, tuned, rig, baseline, options);
      const std::string verdict = report::name_of(d);
      ++confusion[{label_of(t.label), t.severity}][verdict];
      if (t.label == "healthy") {
        ++healthy_judged;
        false_alarms += d.verdict != VerdictKind::healthy;
      }
      std::string ambiguous;
      for (const std::string& a : report::ambiguous_labels(d)) ambiguous += " " + a;
      fmt::print(
          "  {:28s} {:26s} {:7s} {:8.3g} -> {:22s} score {:8.2f} severity {:.3g} [{:.3g}, {:.3g}] adequacy "
          "{:.1f}{}{}{}\n",
          t.path, label_of(t.label), t.severity, t.value, verdict, d.error, d.severity.value, d.severity.lower,
          d.severity.upper,
          std::min_element(d.assessment.hypotheses.begin(), d.assessment.hypotheses.end(),
                           [](auto& x, auto& y) { return x.probability > y.probability; })
              ->adequacy,
          ambiguous.empty() ? "" : " ambiguous with" + ambiguous,
          d.onset ? fmt::format(" onset {:.3f} (true {:.3f})", *d.onset, t.onset) : "",
          d.assessment.gross == GrossFinding::none ? "" : " [" + report::words_of(d.assessment.gross) + "]");
      if (t.set == "healthy") {
        fmt::print("    replay");
        for (const auto& [signal, rms, noise] : replayed(d.assessment, log, tuned, rig)) {
          fmt::print("  {} {:.4g} ({:.1f} noise)", info(signal).name, rms, rms / noise);
          replay[std::string(info(signal).name)].push_back(
              signal == Signal::pressure_a || signal == Signal::pressure_b ? rms / 1e5 : rms / noise);
        }
        fmt::print("\n");
      }
      fmt::print("    gains");
      for (const HypothesisResult& h : d.assessment.hypotheses)
        if (h.gain > 1) fmt::print(" {} {:.1f}", report::label_of(h.fault), h.gain);
      fmt::print("\n");
      std::fflush(stdout);
    };
    for (const Log& log : held)
      for (const Truth& t : truth)
        if (dir + "/" + t.path == log.path) show(log, t);
    for (const Truth& t : truth)
      if (t.set == "fault" || t.set == "sudden") show(read_log(dir + "/" + t.path, rig), t);
  }

  fmt::print("\nconfusion (rows truth, counts over rotations)\n");
  std::map<std::string, std::array<int, 3>> by_severity;  // severity -> logs, detected, named
  for (const auto& [key, row] : confusion) {
    std::string cells;
    int n = 0, detected = 0, named = 0;
    for (const auto& [verdict, count] : row) {
      cells += fmt::format("  {} {}", verdict, count);
      n += count;
      if (verdict != "healthy") detected += count;
      if (verdict == key.first) named += count;
    }
    fmt::print("{:26s} {:8s} n {:3d} |{}\n", key.first, key.second, n, cells);
    if (listed(key.first)) {
      by_severity[key.second][0] += n;
      by_severity[key.second][1] += detected;
      by_severity[key.second][2] += named;
    }
  }
  for (const auto& [severity, c] : by_severity)
    fmt::print("listed faults, {}: {} of {} detected, {} of {} named rightly\n", severity, c[1], c[0], c[2], c[0]);
  fmt::print("false alarms: {} of {} healthy logs ({:.1f} %); promised {:.1f} %\n", false_alarms, healthy_judged,
             100.0 * false_alarms / std::max(1, healthy_judged), 100 * promised);
  fmt::print("held-out healthy replay, median and worst (pressures in bar, others over noise):");
  for (auto& [signal, v] : replay) {
    std::sort(v.begin(), v.end());
    fmt::print("  {} {:.2f} / {:.2f}", signal, v[v.size() / 2], v.back());
  }
  fmt::print("\n{:.0f} s\n", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return 0;
}
