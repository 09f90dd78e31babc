// Writes pages of made-up results for the browser test: `sample_pages FOLDER`. Figures mean nothing; shapes and names
// do.
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "base/atomic_file.h"
#include "base/random.h"
#include "diagnose/assessment.h"
#include "diagnose/baseline.h"
#include "diagnose/decide.h"
#include "diagnose/judge.h"
#include "diagnose/moved.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "fit/identifiability.h"
#include "fleet/fleet_verdict.h"
#include "fleet/gather.h"
#include "report/baseline/baseline_page.h"
#include "report/diagnose/diagnose_page.h"
#include "report/fleet/fleet.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "report/tune/tune_page.h"
#include "report/tune/tune_words.h"
#include "servodx/check_log.h"
#include "servodx/log.h"
#include "servodx/replay.h"
#include "servodx/table.h"
#include "servodx/tune.h"
#include "tune/tune.h"

namespace {

using namespace servodx;

const std::string hostile = "</script><script>alert('log')</script><img src=x onerror=alert(1)>.csv";

Replay some_replay(const std::string& log, std::size_t samples, const std::vector<std::string>& names) {
  Replay r;
  r.log = log;
  Random random(7);
  for (std::size_t k = 0; k < samples; ++k) {
    r.time.push_back(1e-3 * static_cast<double>(k));
    r.command.push_back(0.01 * std::sin(2 * std::numbers::pi * r.time[k]));
  }
  struct Sample {
    Signal signal;
    const char* unit;
    double size;
  };
  for (const Sample& s : {Sample{Signal::spool_position, "mm", 5e-4}, Sample{Signal::piston_position, "mm", 0.1},
                          Sample{Signal::pressure_a, "bar", 5e6}, Sample{Signal::pressure_b, "bar", 5e6}}) {
    ReplayedChannel c{s.signal, s.unit, {}, {}, {}};
    for (const std::string& name : names) c.simulated.push_back({name, {}, {}});
    for (std::size_t k = 0; k < samples; ++k) {
      const double y = s.size * std::sin(2 * std::numbers::pi * r.time[k] - 0.3);
      c.measured.push_back(k == samples / 3 ? 3 * s.size : y + 0.01 * s.size * random.normal());  // one lone peak
      c.sigma.push_back(0.015 * s.size);
      for (std::size_t i = 0; i < names.size(); ++i) {
        c.simulated[i].value.push_back(y * (i == 0 ? 1.1 : 1.0));
        c.simulated[i].residual.push_back(c.measured[k] - c.simulated[i].value[k]);
      }
    }
    r.channels.push_back(std::move(c));
  }
  return r;
}

report::Header some_header(const std::string& command, const std::string& log) {
  report::Header header;
  header.version = "0.0.0";
  header.command = command;
  header.inputs = {{log, std::string(64, 'a')}};
  header.notes = {log + ": 3 gaps in time"};
  *header.settings = {{"name", log}};
  header.simulations = 1234;
  return header;
}

std::vector<ParameterResult> some_parameters() {
  return {{4, "flapper_stiffness", "N/m", 5000, 6200, 55, RowVerdict::bounded, {}, 0, 0},
          {9, "valve_glitch", "m", 0, 2.07e-5, 1.6e-6, RowVerdict::bounded, {}, 0, 0},
          {22, "radial_clearance", "m", 3e-6, 2.9e-6, 4e-7, RowVerdict::bounded, {}, 0, 0},
          {30,
           "cross_piston_leakage",
           "m3/s/Pa",
           1e-13,
           1e-13,
           std::nan(""),
           RowVerdict::confounded,
           {"spool_friction"},
           0,
           0}};
}

Diagnosis some_diagnosis(const std::string& log, VerdictKind verdict) {
  Diagnosis d;
  d.log = log;
  d.verdict = verdict;
  d.error = verdict == VerdictKind::healthy ? 4 : 37;
  d.threshold = 9.45;
  d.p_value = 0.2;
  d.assessment.log = log;
  d.null = -0.0026;
  const Fault* backlash = find_fault("feedback_wire_backlash");
  const Fault* sticky = find_fault("sticky_spool");
  d.nearest = backlash;
  for (const ParameterResult& p : some_parameters())
    d.moved.push_back({p, p.name == "valve_glitch" ? MovedRow::By::fault : MovedRow::By::tolerance});
  d.baseline_logs = 4;
  d.assessment.test = {0.043, 5.6, 314.0};
  d.unlike = {hostile, {0.040, 2.0, 333.0}};
  d.assessment.hypotheses = {{nullptr, 900, 0, 1e-6, 0, 0, 0, 8.1, {}},
                             {backlash, 80, 820, 0.93, 2.07e-5, 1.76e-5, 2.39e-5, 1.3, {}},
                             {sticky, 90, 810, 0.07, 4.1, 3.0, 5.2, 1.6, {}}};
  d.assessment.hypotheses.back().at_least = true;
  for (const HypothesisResult& h : d.assessment.hypotheses) d.probabilities.push_back({h.fault, h.probability});
  if (verdict == VerdictKind::fault) {
    d.fault = backlash;
    d.severity = {2.07e-5, 1.76e-5, 2.39e-5};
    d.ambiguous_with = {sticky};
    d.onset = 1.5;
  }
  return d;
}

Promise some_promise() {
  Promise p;
  p.faults = {{"sticky_spool", "times the tuned friction", 2.5, 20, 4, 30},
              {"clogged_filter", "blocked fraction of the filter area", 0.15, 0.8, 0.5, 1}};
  return p;
}

DetectionBaseline some_baseline() {
  DetectionBaseline b;
  b.threshold = 9.45;
  b.asked = 0.01;
  b.promised = 1.0 / 5;
  b.promised_95 = 0.5;
  b.logs = 4;
  b.logs_needed = 99;
  for (int i = 0; i < 4; ++i)
    b.scores.push_back(
        {i == 0 ? hostile : "h" + std::to_string(i) + ".csv", std::string(64, 'b'), 2.0 + 2.48 * i, 1.0 + i, {}});
  b.adequacy_limit = 4;
  return b;
}

TuneResult some_tuning() {
  TuneResult t;
  t.parameters = some_parameters();
  t.channels = {{Signal::spool_position, "mm", 1e-6, 4e-7, 1.1e-6}, {Signal::pressure_a, "bar", 1e5, 2e4, 1.3e5}};
  t.logs = {{hostile, t.channels, -0.004, 0.0, {}}, {"h2.csv", t.channels, 0.002, 1.0, {}}};
  using From = StartEnd::From;
  t.starts = {{From::table, 120}, {From::rig_size, 80, true}, {From::genetic, 81, true}, {From::genetic, 300}};
  for (int k = 0; k < 30; ++k) t.convergence.push_back({{Stage::Kind::genetic}, 50 * k, 1000.0 / (1 + k)});
  t.stages = {{{Stage::Kind::genetic}, StageMethod::genetic, 1000, 33, 1500, 0},
              {{Stage::Kind::start, 1}, StageMethod::least_squares, 100, 17, 100, 6},
              {{Stage::Kind::start, 1}, StageMethod::ceres, 17, 16.7, 12, 1}};
  for (int k = 0; k < 6; ++k) t.convergence.push_back({{Stage::Kind::start, 1}, 1500 + 20 * k, 100.0 / (1 + k)});
  return t;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  using namespace servodx::report;
  const auto write = [&](const std::string& name, Page page) {
    write_file(std::string(argv[1]) + "/" + name + ".html", page.html());
  };
  const std::vector<std::string> both = {"healthy", "feedback_wire_backlash"};
  const std::string log = "bench/valve 3.csv";
  write("diagnose", diagnose_page(some_header("diagnose", log), {some_diagnosis(log, VerdictKind::fault)},
                                  some_baseline(), {some_replay(log, 3000, both)}));
  write("many",
        diagnose_page(some_header("diagnose", hostile),
                      {some_diagnosis(hostile, VerdictKind::fault), some_diagnosis("u.csv", VerdictKind::unknown),
                       some_diagnosis("h.csv", VerdictKind::healthy)},
                      some_baseline(), {some_replay(hostile, 1500, both), some_replay("u.csv", 1500, both)},
                      {"feedback_wire_backlash", "sticky_spool", "healthy"}));
  write("long", diagnose_page(some_header("diagnose", log), {some_diagnosis(log, VerdictKind::fault)}, some_baseline(),
                              {some_replay(log, 1'000'000, both)}));
  write("baseline",
        baseline_page(some_header("baseline", hostile), some_baseline(), {some_replay(hostile, 1500, {"healthy"})}));
  write("tune", tune_page(some_header("tune", hostile), some_tuning(), good_enough(some_tuning(), {some_promise()}),
                          {some_replay(hostile, 1500, {"tuned"})}));
  FleetTable fleet;
  FleetRow fault, unknown, healthy;
  fault.log = hostile, fault.verdict = FleetVerdict::fault, fault.fault = "sticky_spool", fault.probability = 0.87;
  unknown.log = "u.csv", unknown.verdict = FleetVerdict::unknown;
  healthy.log = "h.csv", healthy.verdict = FleetVerdict::healthy;
  fleet.rows = {fault, unknown, healthy};
  write("gather", fleet_page(some_header("gather", hostile), fleet, {}));
  return 0;
}
