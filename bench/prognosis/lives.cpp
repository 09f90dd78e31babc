// Random valves followed to their end, and healthy ones: how good the predictions were.
//
// A unit is a valve drawn from the rig's tolerances and checked with its own table (units.h). Its checks come at even
// parts of the life, each at random oil temperature, free air and null. End of life is the rig's true quantity at the
// failed level. Failure levels, and how parameters read wear of known size, come from a seeded-fault test of twelve
// valves of the type.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>

#include "base/atomic_file.h"
#include "base/celsius.h"
#include "base/median.h"
#include "prognose/check.h"
#include "prognose/check_name.h"
#include "prognose/check_series.h"
#include "prognose/track.h"
#include "prognose/trend.h"
#include "prognose/trend_options.h"
#include "prognose/valve_history.h"
#include "prognosis/metrics.h"
#include "prognosis/study.h"
#include "prognosis/units.h"
#include "rig/rig_model.h"
#include "store/history.h"
#include "store/seeded_csv.h"

namespace servodx::study {
namespace {

// Label of the fault that a tracked parameter stands for; empty for the paper's checks.
std::string caused_by(const CheckName& check) {
  for (const Progressive& p : progressive_faults())
    if (check.row() == p.row) return std::string(p.fault->name);
  return {};
}

std::size_t row_of(const CheckName& check) { return static_cast<std::size_t>(check.row().value()); }

double mean_of(const std::vector<double>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
}

// How far another valve's level may lie from the mean of these valves': what their means scatter by, that mean's own
// error, and Student's factor for so few at 90 %.
double spread_of(const std::vector<double>& looks) {
  const std::size_t each = looks.size() / seeded_valves;
  double square = 0;
  for (std::size_t v = 0; v < seeded_valves; ++v) {
    const auto first = looks.begin() + static_cast<long>(v * each);
    square += std::pow(mean_of({first, first + static_cast<long>(each)}) - mean_of(looks), 2);
  }
  constexpr double n = seeded_valves, student = 1.796 / 1.645;  // n - 1 degrees of freedom
  return student * std::sqrt(square / (n - 1) * (1 + 1 / n));
}

// To a check some degradations are one fault, and wear of either reads its own way.
bool is_a_fault(const Degradation& d) { return std::string_view(d.name) == d.fault; }

std::string seeded_file(const Degradation& d, const std::string& folder) {
  return folder + (is_a_fault(d) ? "/seeded.csv" : fmt::format("/seeded-{}.csv", d.name));
}

// What the seeded-fault test read of the degradations whose parameter is stated as it is, as `servodx trend --seeded`
// takes it: of those that are one fault, valves that wear as the one that is asked for.
std::string seeded_csv(const Bench& b, const Degradation& asked, const std::string& folder) {
  std::string csv = "valve,name,truth,value,oil_temperature [degC]\n";
  for (const Degradation& d : degradations) {
    const bool one_fault = std::string_view(d.fault) == asked.fault;
    if (d.stated != Stated::value || (one_fault ? &d != &asked : !is_a_fault(d))) continue;
    for (int v = 0; v < seeded_valves; ++v)
      for (const Degradation* fault : {static_cast<const Degradation*>(nullptr), &d}) {
        const rig::RigModel valve = seeded_valve(b, v);
        for (const Recording& r : seeded_looks(b, v, fault, folder).recordings)
          for (const Check& c : r.checks)
            if (caused_by(c.name) == d.fault)
              csv += fmt::format("{},{},{:.6g},{:.6g},{:.1f}\n", v, c.name.text(),
                                 truth_of(d, valve, severity_at(end_of(d, b.model, valve), fault ? seeded_part(r) : 0)),
                                 c.value, r.temperature - zero_celsius);
      }
  }
  return csv;
}

// Failure levels of every check that a degradation moves, by a seeded-fault test of valves of the type in warm oil, as
// a user would set them: of the paper's checks a multiple of healthy; of the parameters as the degradation is stated.
TrendSettings seeded_fault(const Bench& b, const Degradation& d, const std::string& folder) {
  constexpr double warm = 283;  // [K]
  std::map<CheckName, std::vector<double>> healthy, failed;
  const auto add = [&](const ValveHistory& h, bool whole_way, std::map<CheckName, std::vector<double>>& to) {
    for (const Recording& r : h.recordings)
      for (const Check& c : r.checks) {
        if ((whole_way && seeded_part(r) < 1) || r.temperature < warm) continue;
        double value = c.value;
        if (caused_by(c.name) == d.fault && d.stated == Stated::current) value *= friction_current(h.tuned);
        if (caused_by(c.name) == d.fault && d.stated == Stated::multiple) value /= h.tuned[row_of(c.name)];
        to[c.name].push_back(value);
      }
  };
  for (int v = 0; v < seeded_valves; ++v)
    add(seeded_looks(b, v, nullptr, folder), false, healthy), add(seeded_looks(b, v, &d, folder), true, failed);
  TrendSettings options;
  options.seeded = read_seeded_csv(seeded_file(d, folder));
  for (const auto& [name, values] : healthy) {
    if (failed[name].empty()) continue;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const double h = median(values), f = median(failed[name]);
    const std::string cause = caused_by(name);
    if (cause == d.fault && d.stated == Stated::value) {
      const rig::RigModel& type = b.model;
      const double end = truth_of(d, type, d.failed);
      (end > truth_of(d, type, d.healthy) ? options.failure[name].second : options.failure[name].first) = end;
    } else if (cause == d.fault) {
      const double level = mean_of(failed[name]);
      options.failure_spread[name] = spread_of(failed[name]);
      (d.stated == Stated::multiple ? options.failure_ratio : options.failure_current)[name] = level;
    } else if (cause.empty() && std::abs(f - h) > 3 * (*high - *low)) {
      options.failure_ratio[name] = f / h;
    }
  }
  return options;
}

// Every reading of the row that wears beside the truth.
std::string readings_csv(const Bench& b, const std::vector<Unit>& all, const std::vector<ValveHistory>& histories) {
  std::string csv = "degradation,unit,part of the life,oil_temperature [degC],truth,reading,std_error,tuned\n";
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i].degradation) continue;
    const rig::RigModel valve = rig::another_valve(b.model, all[i].valve);
    const Degradation end = end_of(*all[i].degradation, b.model, valve);
    for (const Recording& r : histories[i].recordings)
      for (const Check& c : r.checks) {
        if (caused_by(c.name) != end.fault) continue;
        const double s = r.at / all[i].life;
        csv += fmt::format("{},{},{:.4f},{:.1f},{:.5g},{:.5g},{:.3g},{:.5g}\n", end.name, all[i].name, s,
                           r.temperature - zero_celsius, truth_of(end, valve, severity_at(end, all[i].progress(s))),
                           c.value, c.std_error, histories[i].tuned[row_of(c.name)]);
      }
  }
  return csv;
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

Judged judge(const Unit& unit, const ValveHistory& h, double lambda, const TrendSettings& options) {
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
  j.named = t.cause == unit.degradation->fault;
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

void lives(const Bench& b, const std::string& out, int units, int checks, int first,
           const std::vector<std::string>& only) {
  std::vector<Unit> all = plan(first, units);
  if (!only.empty())
    std::erase_if(all, [&](const Unit& u) {
      return std::find(only.begin(), only.end(), u.degradation ? u.degradation->name : "healthy") == only.end();
    });
  const int n = static_cast<int>(all.size());
  std::vector<ValveHistory> histories(all.size());
  for_each(n, "lives", [&](int i) { histories[i] = history_of(b, all[i], checks, out); });
  write_file(out + "/readings.csv", readings_csv(b, all, histories));
  std::map<std::string, TrendSettings> seeded;
  for (const Degradation& d : degradations) seeded[d.name];
  for_each(seeded_valves, "seeded valves", [&](int v) { seeded_looks(b, v, nullptr, out); });
  for_each(std::size(degradations), "seeded faults", [&](int i) {
    for (int v = 0; v < seeded_valves; ++v) seeded_looks(b, v, &degradations[i], out);
  });
  for (const Degradation& d : degradations) {
    write_file(seeded_file(d, out), seeded_csv(b, d, out));
    seeded.at(d.name) = seeded_fault(b, d, out);
  }
  for (const auto& [name, o] : seeded) {
    std::fprintf(stderr, "\n%s fails at", name.c_str());
    for (const auto& [check, ratio] : o.failure_ratio) std::fprintf(stderr, " %s x %.3g", check.text().c_str(), ratio);
    for (const auto& [check, current] : o.failure_current)
      std::fprintf(stderr, " %s %.3gA", check.text().c_str(), current);
    for (const auto& [check, l] : o.failure)
      std::fprintf(stderr, " %s %.3g", check.text().c_str(), l.second.value_or(l.first.value_or(0)));
    for (const auto& [check, spread] : o.failure_spread)
      std::fprintf(stderr, " (%s ~%.2g)", check.text().c_str(), spread);
  }

  std::vector<std::optional<double>> alarm(all.size());
  std::vector<std::string> alarmed(all.size());
  for_each(n, "false alarms", [&](int i) {
    if (all[i].degradation) return;
    for (std::size_t k = 12; k <= histories[i].recordings.size() && !alarm[i]; k += 2) {  // on every other occasion
      const ValveTrend t = trend(until(histories[i], histories[i].recordings[k - 1].at), {});
      alarm[i] = t.alert_at;
      for (const CheckTrend& c : t.trends)
        if (c.alert_at) alarmed[i] += " " + c.name.text();
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
            judge(all[i], histories[i], lambdas[l], own ? TrendSettings{} : seeded.at(all[i].degradation->name));
    });
    std::map<double, Tally> of_all;
    std::map<std::string, std::map<double, Tally>> of_each;
    for (int i = 0; i < n; ++i)
      for (std::size_t l = 0; l < std::size(lambdas) && all[i].degradation; ++l) {
        csv += (own ? "own," : "seeded,") + judged[i][l].row;
        for (Tally* t : {&of_all[lambdas[l]], &of_each[all[i].degradation->name][lambdas[l]]}) t->add(judged[i][l]);
      }
    std::printf("\nfailure levels: %s\n",
                own ? "the tool's own" : fmt::format("a seeded-fault test of {} valves", seeded_valves).c_str());
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
