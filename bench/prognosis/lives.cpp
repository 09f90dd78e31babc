// Random valves followed to their end, and healthy ones. What is made (a history of checks a unit) is kept in
// OUT/units/*.csv and taken up again by the next run, so that judging them anew costs no simulation; each can be
// imported into a history and looked at with `servodx trend`.
//
// A unit is a valve drawn from the rig's tolerances and checked with the table tuned on the nominal valve. Its checks
// come at even parts of the life, each at random oil temperature, free air and null. Its degradation grows from its
// first hour (every other pair of units) or from a later one, by s^p: linear in every other unit. End of life is the
// rig's true severity at its failed level. Failure levels of the paper's checks come from a seeded-fault test of the
// nominal valve.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "prognose/history_csv.h"
#include "prognose/metrics.h"
#include "prognose/trend.h"
#include "prognosis/study.h"

namespace servodx::study {
namespace {

namespace fs = std::filesystem;

struct Unit {
  std::string name;
  const Degradation* degradation = nullptr;  // none: healthy
  std::uint64_t valve = 0;
  double power = 1, onset = 0, life = 0;  // onset as a part of the life [h]
  std::uint32_t stream = 0;

  double progress(double s) const { return s <= onset ? 0.0 : std::pow((s - onset) / (1 - onset), power); }
};

std::vector<Unit> plan(int units) {
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
  for (int u = 0; u < units; ++u) {
    std::uint32_t group = 1;
    for (const Degradation& d : degradations) add(&d, group++, u);
    add(nullptr, group, u);
  }
  return all;
}

ValveHistory live(const Bench& b, const Unit& unit, int checks) {
  const rig::RigModel valve = rig::another_valve(b.model, unit.valve);
  Random random(32, unit.stream);
  ValveHistory h;
  h.valve = unit.name;
  std::vector<double> last;
  for (int k = 0; k < checks; ++k) {
    const double s = 0.95 * k / (checks - 1.0);  // the last check a little before the end
    const double severity = unit.degradation ? severity_at(*unit.degradation, unit.progress(s)) : 0;
    const Condition at = random_condition(random);
    const Log log =
        test_log(valve, unit.degradation ? unit.degradation->name : "", severity, at, preflight(random.bits64()));
    const CheckResult r = check(log, b.tuned, b.rig, {.threads = 1, .last = last});
    last = r.tracked;
    h.recordings.push_back(recording_of(s * unit.life, r));
    h.recordings.back().log = h.recordings.back().log_sha256 = fmt::format("{}-{}", unit.name, k);
    h.recordings.back().table_sha256 = b.tuned.sha256;
  }
  return h;
}

ValveHistory kept(const Bench& b, const Unit& unit, int checks, const std::string& folder) {
  const std::string file = folder + "/" + unit.name + ".csv";
  ValveHistory h;
  if (fs::exists(file)) {
    h = read_history_csv(file).valves.front();
  } else {
    h = live(b, unit, checks);
    write_file(file, history_csv({{h}, {{b.tuned.sha256, read_file(b.tuned.path)}}}));
  }
  for (int i = 0; i < n_parameters; ++i) h.tuned.push_back(b.tuned[i].nominal);
  return h;
}

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v.empty() ? std::nan("") : v[v.size() / 2];
}

// Label of the fault that a tracked parameter stands for.
std::string find_parameter(const std::string& name) {
  for (const Progressive& p : progressive_faults())
    if (name == fmt::format("parameter:{}", p.row + 1)) return std::string(p.fault->name);
  return {};
}

// Failure levels of every check that a degradation moves, by a seeded-fault test of the nominal valve, as a user would
// set them: of the paper's checks a multiple of healthy, of the parameters what they read at the failed severity.
TrendOptions seeded_fault(const Bench& b, const Degradation& d) {
  std::map<std::string, std::vector<double>> healthy, failed;
  std::map<std::string, bool> parameter;
  for (int k = 0; k < 5; ++k) {
    const Condition at{10.0 + 12 * k, 0.005, 0};
    const auto add = [&](const std::string& fault, double severity, std::map<std::string, std::vector<double>>& to) {
      const Log log = test_log(b.model, fault, severity, at, preflight(900 + static_cast<std::uint64_t>(k)));
      for (const Check& c : check(log, b.tuned, b.rig, {.threads = 1, .last = {}}).checks)
        to[c.name].push_back(c.value), parameter[c.name] = !c.cause.empty();
    };
    add("", 0, healthy), add(d.name, d.failed, failed);
  }
  TrendOptions options;
  for (const auto& [name, values] : healthy) {
    if (failed[name].empty()) continue;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const double h = median(values), f = median(failed[name]);
    if (!(std::abs(f - h) > 3 * (*high - *low))) continue;
    if (!parameter[name])
      options.failure_ratio[name] = f / h;
    else if (find_parameter(name) == d.name)
      (f > h ? options.failure[name].second : options.failure[name].first) = f;
  }
  return options;
}

ValveHistory until(const ValveHistory& h, double at) {
  ValveHistory cut = h;
  std::erase_if(cut.recordings, [&](const Recording& r) { return r.at > at; });
  return cut;
}

struct Judged {
  bool alerted = false, met = false, covered = false, late = false, named = false, ruled = false, rule_met = false;
  double crps = 0, rule_crps = 0;
  std::string row;
};

constexpr double lambdas[] = {0.5, 0.7, 0.9};

Judged judge(const Unit& unit, const ValveHistory& h, double lambda, const TrendOptions& options) {
  const ValveHistory seen = until(h, lambda * unit.life);
  const ValveTrend t = trend(seen, options);
  const double now = seen.recordings.back().at, remaining = unit.life - now, horizon = 5 * unit.life;
  const CheckTrend* ruled = nullptr;
  for (const CheckTrend& c : t.trends)
    if (c.tangent && (!ruled || c.tangent->alert_at < ruled->tangent->alert_at)) ruled = &c;
  const double rule = ruled ? std::max(0.0, ruled->tangent->alert_at + ruled->tangent->time_to_failure - now) : horizon;
  Judged j;
  j.alerted = t.alert_at && t.remaining;
  j.crps = j.alerted ? crps(t.life, remaining, horizon) : horizon - remaining;
  j.met = j.alerted && alpha_lambda(t.life, remaining, 0.2);
  j.covered = j.alerted && covers(t.life, remaining, 0.9);
  j.late = j.alerted && t.remaining->median > remaining;
  j.named = t.cause == unit.degradation->name;
  j.ruled = ruled;
  j.rule_met = std::abs(rule - remaining) <= 0.2 * remaining;
  j.rule_crps = std::abs(std::min(rule, horizon) - remaining);
  j.row = fmt::format("{},{},{:.2f},{:.2f},{:.1f},{},{},{},{:.1f},{:.1f},{:.1f},{:.1f},{},{},{:.2f},{:.1f},{:.2f}\n",
                      unit.degradation->name, unit.name, unit.power, unit.onset, unit.life, lambda, j.alerted,
                      t.cause.value_or("-"), remaining, j.alerted ? t.remaining->median : NAN,
                      j.alerted ? t.remaining->lower : NAN, j.alerted ? t.remaining->upper : NAN, j.met, j.covered,
                      j.crps, rule, j.rule_crps);
  return j;
}

struct Tally {
  int n = 0, alerted = 0, met = 0, covered = 0, late = 0, named = 0, ruled = 0, rule_met = 0;
  double crps = 0, rule_crps = 0;
  void add(const Judged& j) {
    ++n, alerted += j.alerted, met += j.met, covered += j.covered, late += j.late, named += j.named;
    ruled += j.ruled, rule_met += j.rule_met, crps += j.crps, rule_crps += j.rule_crps;
  }
  void print(const std::string& name, double lambda) const {
    std::printf("%-24s %6.1f %5d %8d %5d (%3.0f %%) %4d/%-3d (%3.0f %%) %6d %6d %6d %9.1f %12d %12d %12.1f\n",
                name.c_str(), lambda, n, alerted, met, 100.0 * met / n, covered, alerted,
                100.0 * covered / std::max(1, alerted), alerted - late, late, named, crps / n, ruled, rule_met,
                rule_crps / n);
  }
};

}  // namespace

void lives(const Bench& b, const std::string& out, int units, int checks) {
  const std::string folder = out + "/units";
  fs::create_directories(folder);
  const std::vector<Unit> all = plan(units);
  const int n = static_cast<int>(all.size());
  std::vector<ValveHistory> histories(all.size());
  for_each(n, "lives", [&](int i) { histories[i] = kept(b, all[i], checks, folder); });
  std::map<std::string, TrendOptions> seeded;
  for (const Degradation& d : degradations) seeded[d.name];
  for_each(std::size(degradations), "seeded faults",
           [&](int i) { seeded.at(degradations[i].name) = seeded_fault(b, degradations[i]); });
  for (const auto& [name, o] : seeded) {
    std::fprintf(stderr, "\n%s fails at", name.c_str());
    for (const auto& [check, ratio] : o.failure_ratio) std::fprintf(stderr, " %s x %.3g", check.c_str(), ratio);
    for (const auto& [check, l] : o.failure)
      std::fprintf(stderr, " %s %.3g", check.c_str(), l.second.value_or(l.first.value_or(0)));
  }

  std::vector<std::optional<double>> alarm(all.size());
  std::vector<std::string> alarmed(all.size());
  for_each(n, "healthy", [&](int i) {
    if (all[i].degradation) return;
    for (std::size_t k = 12; k <= histories[i].recordings.size() && !alarm[i]; k += 2) {  // on every other occasion
      const ValveTrend t = trend(until(histories[i], histories[i].recordings[k - 1].at), {});
      alarm[i] = t.alert_at;
      for (const CheckTrend& c : t.trends)
        if (c.alert_at) alarmed[i] += " " + c.name;
    }
  });
  int healthy = 0, alarms = 0;
  for (int i = 0; i < n; ++i)
    if (!all[i].degradation) {
      ++healthy, alarms += alarm[i].has_value();
      if (alarm[i]) std::fprintf(stderr, "\n%s: alert at %g h:%s", all[i].name.c_str(), *alarm[i], alarmed[i].c_str());
    }
  std::printf("%d units a degradation, %d checks a life, alpha 0.2; no alert counts as a miss\n", units, checks);
  std::printf("healthy units: %d alerts in %d, stated rate 1 %% over 100 checks\n", alarms, healthy);

  std::string csv =
      "levels,degradation,unit,power,onset,life [h],lambda,alerted,named,remaining [h],median [h],lower [h],upper [h],"
      "alpha_lambda,covered,crps [h],tangent [h],tangent_crps [h]\n";
  for (const bool own : {false, true}) {
    std::vector<std::array<Judged, std::size(lambdas)>> judged(all.size());
    for_each(n, own ? "judged by own levels" : "judged", [&](int i) {
      if (!all[i].degradation) return;
      for (std::size_t l = 0; l < std::size(lambdas); ++l)
        judged[i][l] =
            judge(all[i], histories[i], lambdas[l], own ? TrendOptions{} : seeded.at(all[i].degradation->name));
    });
    std::map<double, Tally> of_all;
    std::map<std::string, std::map<double, Tally>> of_each;
    for (int i = 0; i < n; ++i)
      for (std::size_t l = 0; l < std::size(lambdas) && all[i].degradation; ++l) {
        csv += (own ? "own," : "seeded,") + judged[i][l].row;
        for (Tally* t : {&of_all[lambdas[l]], &of_each[all[i].degradation->name][lambdas[l]]}) t->add(judged[i][l]);
      }
    std::printf("\nfailure levels: %s\n", own ? "the tool's own" : "a seeded-fault test of the nominal valve");
    std::printf("%-24s %6s %5s %8s %13s %16s %6s %6s %6s %9s %12s %12s %12s\n", "degradation", "lambda", "units",
                "alerted", "met", "covered", "early", "late", "named", "CRPS [h]", "tangent", "tangent met",
                "its CRPS");
    for (const auto& [name, tallies] : of_each)
      for (const auto& [lambda, t] : tallies) t.print(name, lambda);
    for (const auto& [lambda, t] : of_all) t.print("all", lambda);
  }
  write_file(out + "/lives.csv", csv);
}

}  // namespace servodx::study
