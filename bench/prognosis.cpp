// The prognosis study: figures 8 to 13 of Borello et al. 2009, lives of random valves to their end, progressive series
// of a rig, and the store at size.
//
//   servodx_prognosis figures TUNED RIG.toml RIG_MODEL.toml OUT_DIR
//   servodx_prognosis lives   TUNED RIG.toml RIG_MODEL.toml OUT_DIR [UNITS [CHECKS]]     units per degradation
//   servodx_prognosis series  TUNED RIG.toml SERIES_DIR...                               t01.csv, t02.csv, ...
//   servodx_prognosis store   FILE ROWS
//
// `lives`: every unit is a valve drawn from the rig's tolerances; its preflight checks come at random oil temperature
// (-30 to 70 degC) and free air, its degradation grows linearly or not to its end. Failure levels of all checks come
// from a seeded-fault test of the nominal valve, as ratios (or differences) to healthy. Does not show: other valve
// types, changing duty, more than one degradation at a time. End of life is the rig's true quantity crossing its level.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/random.h"
#include "faults/registry.h"
#include "prognose/history.h"
#include "prognose/metrics.h"
#include "prognose/trend.h"
#include "report/line_chart.h"
#include "rig/rig_run.h"

namespace servodx {
namespace {

namespace fs = std::filesystem;

struct Bench {
  Table tuned;
  RigFile rig;
  rig::RigModel model;
};

Log log_of(const rig::RigLog& made) {  // through the columns a file would hold
  Log log;
  log.path = "virtual rig";
  for (const OutputColumn& c : made.columns) {
    if (c.signal == Signal::time)
      log.time = c.value;
    else
      log.channels[static_cast<std::size_t>(index(c.signal))].value = c.value;
    log.channels[static_cast<std::size_t>(index(c.signal))].unit = c.unit;
  }
  return log;
}

struct Condition {
  double celsius = 40, air = 0.005;
};
Condition random_condition(Random& random) {
  return {random.uniform(-30, 70), std::exp(random.uniform(std::log(0.002), std::log(0.02)))};
}

CheckResult run_check(const Bench& b, const rig::RigModel& valve, const std::string& fault, double severity,
                      const Condition& at, std::uint64_t seed, const std::vector<double>& last = {},
                      const std::string& excitation = "preflight", double duration = 1.2, bool offset = false) {
  rig::RigRun run;
  run.excitation = excitation;
  run.duration = duration;
  run.temperature = at.celsius + 273.15;
  run.air = at.air;
  run.seed = seed;
  run.offset = offset;
  if (!fault.empty()) run.faults[fault] = severity;
  return check(log_of(rig::run_rig(valve, run)), b.tuned, b.rig, {.threads = 1, .last = last});
}

const Check* find(const std::vector<Check>& checks, const std::string& name) {
  for (const Check& c : checks)
    if (c.name == name) return &c;
  return nullptr;
}

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v.empty() ? std::nan("") : v[v.size() / 2];
}

// Severity at a part s of the life: the paper's degradations, linear in its quantity.
struct Degradation {
  const char* name;
  double healthy, failed;
  const char* figure;
};
constexpr Degradation degradations[] = {{"clogged_filter", 0, 0.75, "8"},
                                        {"torque_motor_loss", 1, 0.2, "9"},
                                        {"feedback_wire_backlash", 0, 20e-6, "10"},
                                        {"sticky_spool", 1, 20, "11"},
                                        {"radial_clearance_wear", 1, 10, "12"}};
double severity_at(const Degradation& d, double s) { return d.healthy + (d.failed - d.healthy) * s; }

void figures(const Bench& b, const std::string& out) {
  fs::create_directories(out);
  std::vector<report::ChartPanel> panels;
  std::string csv =
      "figure,degradation,severity,temperature [degC],mean_error [m],fidelity,fidelity_measured,"
      "correlation [m2],correlation_measured [m2],parameter\n";
  for (const Degradation& d : degradations) {
    const std::string shown = d.figure[0] == '8' || d.figure[0] == '9' ? "fidelity"
                              : std::string(d.figure) == "12"          ? "correlation@5Hz"
                                                                       : "mean_error";
    report::ChartPanel panel;
    panel.title = fmt::format("Borello 2009, fig. {}: {}", d.figure, d.name);
    panel.x_label = "severity";
    panel.y_label = shown;
    report::ChartLine warm{"40 degC", {}, {}, "", false}, any{"-30 to 70 degC, as measured", {}, {}, "", true},
        mended{"corrected to 40 degC", {}, {}, "", true};
    Random random(17, static_cast<std::uint32_t>(&d - degradations));
    constexpr int points = 11;
    for (int k = 0; k < points; ++k) {
      const double severity = severity_at(d, k / (points - 1.0));
      for (int cold = 0; cold < 2; ++cold) {
        const Condition at = cold ? random_condition(random) : Condition{};
        const bool service = shown == "mean_error" && !cold;
        const CheckResult r = service ? run_check(b, b.model, d.name, severity, at, 500 + k, {}, "flight", 20, true)
                                      : run_check(b, b.model, d.name, severity, at, 500 + k);
        const auto value = [&](const std::string& name, bool measured) {
          const Check* c = find(r.checks, name);
          return c ? (measured ? c->measured : c->value) : std::nan("");
        };
        std::string parameter;
        for (const Check& c : r.checks)
          if (c.cause == d.name) parameter = fmt::format("{}", c.value);
        csv += fmt::format("{},{},{},{:.1f},{},{},{},{},{},{}\n", d.figure, d.name, severity, at.celsius,
                           value("mean_error", true), value("fidelity", false), value("fidelity", true),
                           value("correlation@5Hz", false), value("correlation@5Hz", true), parameter);
        auto& line = cold ? any : warm;
        line.x.push_back(severity), line.y.push_back(value(shown, true));
        if (cold) mended.x.push_back(severity), mended.y.push_back(value(shown, false));
      }
      std::fprintf(stderr, "\rfigure %s: %d of %d ", d.figure, k + 1, points);
    }
    panel.lines = {warm, any};
    if (shown != "mean_error") panel.lines.push_back(mended);
    if (d.figure[0] == '9') {  // theory: 1 / gain left
      report::ChartLine theory{"theory 1/g", {}, {}, "", false};
      for (double x : warm.x) theory.x.push_back(x), theory.y.push_back(warm.y.front() / x);
      panel.lines.push_back(theory);
    }
    panels.push_back(panel);
  }
  // Fig. 13: a life of |e| with its levels, curve, tangent and the distribution of its end.
  ValveHistory h;
  h.valve = "backlash";
  std::vector<double> last;
  Random random(18);
  for (int k = 0; k < 26; ++k) {
    const CheckResult r =
        run_check(b, b.model, "feedback_wire_backlash", 20e-6 * k / 40.0, random_condition(random), 700 + k, last);
    last = r.tracked;
    Recording rec;
    rec.at = 2.5 * k, rec.temperature = r.temperature.value, rec.table_sha256 = "t", rec.checks = r.checks;
    h.recordings.push_back(rec);
  }
  const ValveTrend t = trend(h, {});
  report::ChartPanel panel;
  panel.title = "Borello 2009, fig. 13: life left, backlash";
  panel.x_label = "h", panel.y_label = "parameter:9 [m]";
  for (const CheckTrend& c : t.trends) {
    if (c.cause != "feedback_wire_backlash") continue;
    report::ChartLine seen{"checks", {}, {}, "", true};
    for (const auto& p : c.points) seen.x.push_back(p.at), seen.y.push_back(p.value);
    panel.lines.push_back(seen);
    const std::pair<const char*, std::optional<double>> levels[] = {
        {"threshold", c.threshold.upper}, {"warning", c.warning.upper}, {"failure", c.failure.upper}};
    for (const auto& [name, level] : levels)
      if (level) panel.lines.push_back({name, {0, 110}, {*level, *level}, "", false});
    if (c.tangent && c.warning.upper && c.failure.upper)
      panel.lines.push_back({"tangent rule",
                             {c.tangent->alert_at, c.tangent->alert_at + c.tangent->time_to_failure},
                             {*c.warning.upper, *c.failure.upper},
                             "",
                             false});
    if (c.remaining && c.failure.upper)
      panel.lines.push_back({"90 % of the predicted end",
                             {t.at + c.remaining->lower, t.at + c.remaining->upper},
                             {*c.failure.upper, *c.failure.upper},
                             "",
                             false});
  }
  panels.push_back(panel);
  write_file(out + "/figures.csv", csv);
  write_file(out + "/figures.svg", report::svg_of(panels, 2));
  std::printf("\n%s/figures.csv, %s/figures.svg\n", out.c_str(), out.c_str());
}

// Failure of every check that a degradation moves: nominal valve at its failed severity, over the same healthy.
struct FailureRule {
  bool ratio = false;
  double amount = 0;
};
std::map<std::string, FailureRule> seeded_fault(const Bench& b, const Degradation& d) {
  std::map<std::string, std::vector<double>> healthy, failed;
  std::vector<double> last;
  for (int k = 0; k < 5; ++k) {
    const Condition at{10.0 + 12 * k, 0.005};
    for (const Check& c : run_check(b, b.model, "", 0, at, 900 + k).checks) healthy[c.name].push_back(c.value);
    for (const Check& c : run_check(b, b.model, d.name, d.failed, at, 950 + k).checks)
      failed[c.name].push_back(c.value);
  }
  std::map<std::string, FailureRule> rules;
  for (const auto& [name, values] : healthy) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const double h = median(values), f = median(failed[name]);
    if (!(std::abs(f - h) > 3 * (*high - *low))) continue;  // the degradation does not move this check
    const bool ratio = !name.starts_with("parameter:1") && name != "parameter:9" && h > 0;
    rules[name] = {ratio || name == "parameter:14", ratio || name == "parameter:14" ? f / h : f - h};
  }
  return rules;
}

TrendOptions options_for(const ValveHistory& h, const std::map<std::string, FailureRule>& rules) {
  TrendOptions o;
  std::map<std::string, std::vector<double>> first;
  for (std::size_t k = 0; k < h.recordings.size() && k < static_cast<std::size_t>(o.healthy); ++k)
    for (const Check& c : h.recordings[k].checks) first[c.name].push_back(c.cause.empty() ? c.measured : c.value);
  for (const auto& [name, rule] : rules) {
    if (!first.contains(name)) continue;
    const double base = median(first[name]);
    const double level = rule.ratio ? base * rule.amount : base + rule.amount;
    if (level > base)
      o.failure[name] = {std::nullopt, level};
    else
      o.failure[name] = {level, std::nullopt};
  }
  return o;
}

ValveHistory until(const ValveHistory& h, double at) {
  ValveHistory cut = h;
  std::erase_if(cut.recordings, [&](const Recording& r) { return r.at > at; });
  return cut;
}

void lives(const Bench& b, const std::string& out, int units, int checks) {
  fs::create_directories(out);
  const double lambdas[] = {0.5, 0.7, 0.9};
  std::string csv =
      "degradation,unit,growth,life [h],lambda,alerted,named,remaining [h],median [h],lower [h],upper [h],"
      "alpha_lambda,crps [h],tangent [h],tangent_crps [h]\n";
  struct Tally {
    int n = 0, alerted = 0, met = 0, covered = 0, predicted = 0, early = 0, late = 0, named = 0, tangent = 0,
        tangent_met = 0;
    double crps = 0, tangent_crps = 0;
  };
  std::map<double, Tally> all;
  std::map<std::string, std::map<double, Tally>> each;
  for (const Degradation& d : degradations) {
    const auto rules = seeded_fault(b, d);
    for (int u = 0; u < units; ++u) {
      const auto id = static_cast<std::uint32_t>(&d - degradations);
      Random random(31, id, static_cast<std::uint32_t>(u));
      const rig::RigModel valve = rig::another_valve(b.model, 100 * (id + 1) + static_cast<std::uint64_t>(u) + 1);
      const double power = u % 2 ? std::exp(random.uniform(std::log(0.7), std::log(2.0))) : 1.0;
      const double life = random.uniform(80, 200);
      ValveHistory h;
      h.valve = fmt::format("{}-{}", d.name, u);
      std::vector<double> last;
      for (int k = 0; k < checks; ++k) {
        const double s = k / static_cast<double>(checks) * 0.95;  // the last check a little before the end
        const CheckResult r = run_check(b, valve, d.name, severity_at(d, std::pow(s, power)), random_condition(random),
                                        random.bits64(), last);
        last = r.tracked;
        Recording rec;
        rec.at = s * life, rec.temperature = r.temperature.value, rec.table_sha256 = "t", rec.checks = r.checks;
        h.recordings.push_back(rec);
      }
      for (double lambda : lambdas) {
        const ValveHistory seen = until(h, lambda * life);
        const ValveTrend t = trend(seen, options_for(seen, rules));
        const double now = seen.recordings.back().at, remaining = life - now, horizon = 5 * life;
        const CheckTrend* ruled = nullptr;
        for (const CheckTrend& c : t.trends)
          if (c.tangent && (!ruled || c.tangent->alert_at < ruled->tangent->alert_at)) ruled = &c;
        const double tangent =
            ruled ? std::max(0.0, ruled->tangent->alert_at + ruled->tangent->time_to_failure - now) : horizon;
        const bool alerted = t.alert_at.has_value() && t.remaining.has_value();
        const double score = alerted ? crps(t.life, remaining, horizon) : std::abs(horizon - remaining);
        const bool met = alerted && alpha_lambda(t.life, remaining, 0.2);
        const double tangent_score = std::abs(std::min(tangent, horizon) - remaining);
        for (Tally* y : {&all[lambda], &each[d.name][lambda]}) {
          ++y->n, y->alerted += alerted, y->met += met, y->crps += score, y->tangent_crps += tangent_score;
          y->tangent += ruled != nullptr, y->tangent_met += std::abs(tangent - remaining) <= 0.2 * remaining;
          y->named += t.cause == d.name;
          if (alerted) {
            ++y->predicted;
            y->covered += covers(t.life, remaining, 0.9);
            y->late += t.remaining->median > remaining;
            y->early += t.remaining->median <= remaining;
          }
        }
        csv += fmt::format("{},{},{:.2f},{:.1f},{},{},{},{:.1f},{:.1f},{:.1f},{:.1f},{},{:.2f},{:.1f},{:.2f}\n", d.name,
                           u, power, life, lambda, alerted ? 1 : 0, t.cause.value_or("-"), remaining,
                           alerted ? t.remaining->median : NAN, alerted ? t.remaining->lower : NAN,
                           alerted ? t.remaining->upper : NAN, met ? 1 : 0, score, tangent, tangent_score);
      }
      std::fprintf(stderr, "\r%s: %d of %d units ", d.name, u + 1, units);
      write_file(out + "/lives.csv", csv);
    }
  }
  // Healthy units, looked at after every check as a fleet would.
  int alarms = 0;
  for (int u = 0; u < units; ++u) {
    const rig::RigModel valve = rig::another_valve(b.model, 9000 + static_cast<std::uint64_t>(u));
    Random random(37, static_cast<std::uint32_t>(u));
    ValveHistory h;
    std::vector<double> last;
    for (int k = 0; k < checks; ++k) {
      const CheckResult r = run_check(b, valve, "", 0, random_condition(random), random.bits64(), last);
      last = r.tracked;
      Recording rec;
      rec.at = 3.0 * k, rec.temperature = r.temperature.value, rec.table_sha256 = "t", rec.checks = r.checks;
      h.recordings.push_back(rec);
    }
    alarms += trend(h, {}).alert_at.has_value();
    std::fprintf(stderr, "\rhealthy: %d of %d units ", u + 1, units);
  }
  std::printf("\n%d units a degradation, %d checks a life, alpha 0.2; no alert counts as a miss\n", units, checks);
  std::printf("%-24s %6s %5s %8s %6s %8s %6s %6s %6s %10s %12s %12s\n", "degradation", "lambda", "units", "alerted",
              "met", "covered", "early", "late", "named", "CRPS [h]", "tangent met", "tangent CRPS");
  const auto line = [](const std::string& name, double lambda, const Tally& y) {
    std::printf("%-24s %6.1f %5d %8d %6d %4d/%-3d %6d %6d %6d %10.1f %12d %12.1f\n", name.c_str(), lambda, y.n,
                y.alerted, y.met, y.covered, y.predicted, y.early, y.late, y.named, y.crps / y.n, y.tangent_met,
                y.tangent_crps / y.n);
  };
  for (const auto& [name, tallies] : each)
    for (const auto& [lambda, y] : tallies) line(name, lambda, y);
  for (const auto& [lambda, y] : all) line("all", lambda, y);
  std::printf("healthy units: %d alerts in %d, stated rate 1 %%\n", alarms, units);
}

void series(const Bench& b, const std::string& folder) {
  ValveHistory h;
  h.valve = fs::path(folder).filename();
  std::vector<double> last;
  for (int k = 1;; ++k) {
    const std::string path = fmt::format("{}/t{:02}.csv", folder, k);
    if (!fs::exists(path)) break;
    const Log log = read_log(path, b.rig);
    const CheckResult r = check(log, b.tuned, b.rig, {.threads = 1, .last = last});
    last = r.tracked;
    Recording rec;
    rec.at = k, rec.temperature = r.temperature.value, rec.table_sha256 = "t", rec.checks = r.checks;
    h.recordings.push_back(rec);
    std::fprintf(stderr, "\r%s: %d ", h.valve.c_str(), k);
  }
  const ValveTrend t = trend(h, {});
  const auto n = static_cast<double>(h.recordings.size());
  std::printf("%s: %zu checks, %s", h.valve.c_str(), h.recordings.size(), t.state.c_str());
  if (t.alert_at) std::printf(", alert at %g (lead %g checks to the last)", *t.alert_at, n - *t.alert_at);
  std::printf(", cause %s\n", t.cause.value_or("none").c_str());
  for (const CheckTrend& c : t.trends)
    std::printf("  %-18s %-8s ln BF %7.1f  %10.4g -> %10.4g  alert %s\n", c.name.c_str(), c.state.c_str(),
                c.log_bayes_factor, c.healthy, c.now, c.alert_at ? fmt::format("{}", *c.alert_at).c_str() : "-");
}

void store(const std::string& file, long rows) {
  fs::remove(file);
  const auto seconds = [from = std::chrono::steady_clock::now()] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
  };
  constexpr long per_valve = 200, figures_of_one = 8;
  History history(file, true);
  HistoryContent content;
  Random random(3);
  long written = 0;
  for (long v = 0; written < rows; ++v) {
    ValveHistory valve;
    valve.valve = fmt::format("v{}", v);
    for (long k = 0; k < per_valve && written < rows; ++k) {
      Recording r;
      r.at = static_cast<double>(k), r.log = "l", r.log_sha256 = fmt::format("{}-{}", v, k), r.table_sha256 = "t";
      r.version = "1", r.recorded_at = "2026-01-01T00:00:00Z", r.temperature = 313, r.temperature_source = "given";
      for (int c = 0; c < figures_of_one; ++c, ++written)
        r.checks.push_back({fmt::format("c{}", c), 1 + 0.01 * random.normal(), 0.01, "1", 1.0, 1.0, ""});
      valve.recordings.push_back(std::move(r));
    }
    content.valves.push_back(std::move(valve));
    if (content.valves.size() == 50 || written >= rows) history.restore(content), content.valves.clear();
  }
  std::printf("%ld rows in %.1f s\n", written, seconds());
  const double before = seconds();
  const ValveTrend t = trend(history.of("v7"), {});
  std::printf("trend of one valve of %zu checks: %.3f s\n", t.checks, seconds() - before);
}

int run(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  const auto bench = [&](bool with_model) {
    Bench b{read_table(argv[2]), read_rig_file(argv[3]), {}};
    if (with_model) b.model = rig::read_rig_model(argv[4]);
    return b;
  };
  if (what == "figures" && argc == 6) return figures(bench(true), argv[5]), 0;
  if (what == "lives" && argc >= 6)
    return lives(bench(true), argv[5], argc > 6 ? std::stoi(argv[6]) : 40, argc > 7 ? std::stoi(argv[7]) : 40), 0;
  if (what == "series" && argc >= 5) {
    const Bench b = bench(false);
    for (int k = 4; k < argc; ++k) series(b, argv[k]);
    return 0;
  }
  if (what == "store" && argc == 4) return store(argv[2], std::stol(argv[3])), 0;
  std::fprintf(stderr,
               "usage: servodx_prognosis figures|lives TUNED RIG.toml RIG_MODEL.toml OUT [UNITS [CHECKS]]\n"
               "       servodx_prognosis series TUNED RIG.toml SERIES_DIR...\n"
               "       servodx_prognosis store FILE ROWS\n");
  return 2;
}

}  // namespace
}  // namespace servodx

int main(int argc, char** argv) {
  try {
    return servodx::run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "servodx_prognosis: %s\n", e.what());
    return 1;
  }
}
