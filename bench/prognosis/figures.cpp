// Figures 8 to 13 of Borello et al. 2009, as curves and numbers, with what theory says of each.
//
// r and E come from preflight tests of 0.9 s and 1.6 s (rest, step, whole cycles of the sine are all they look at), |e|
// from 20 s of flight (by then its running mean has settled; where not, the table says so). The sine of fig. 12 has the
// paper's 0.5 mA at 5 Hz.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>

#include "base/atomic_file.h"
#include "base/celsius.h"
#include "base/random.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "prognose/check.h"
#include "prognose/monitor.h"
#include "prognose/performance_limits.h"
#include "prognose/trend.h"
#include "prognose/valve_history.h"
#include "prognosis/study.h"
#include "report/shared/line_chart.h"
#include "rig/rig_run.h"
#include "servodx/monitor.h"
#include "store/history.h"

namespace servodx::study {
namespace {

using report::ChartLine;
using report::ChartPanel;

constexpr int points = 11;

struct Point {
  double severity = 0;
  Condition at;
  Check shown;
  bool settled = true;
};

// Theory: what the figure would be, from health, by linear hydraulics and statics.
struct Theory {
  std::string label;
  double (*value)(const MonitorParameters& healthy, const MonitorParameters& worn, double severity, double first);
};

// |e| at most: half of the play, by which the ball lags on either side.
double of_backlash(const MonitorParameters&, const MonitorParameters&, double play, double first) {
  return first + 0.5 * play;
}
// |e| at most: the spool stops short by what moves the flapper to the pilot pressure that its friction holds.
double of_friction(const MonitorParameters& m, const MonitorParameters&, double times, double first) {
  constexpr double sliding = 1.5;  // [N] params/rigs/borello2009.toml
  return first + (times - 1) * sliding * m.spool_force_gain / m.wire_stiffness;
}
double of_torque(const MonitorParameters&, const MonitorParameters&, double left, double first) { return first / left; }
// A filter slows the first stage as the root of the pilot pressure.
double of_filter(const MonitorParameters& m, const MonitorParameters& worn, double, double first) {
  return first * fidelity_of_slower(m.first_stage_gain / worn.first_stage_gain);
}
// The lap gone: the whole sine opens the edges. E = X Y / 2 with Y = GQ X / (A w).
double of_clearance(const MonitorParameters& m, const MonitorParameters&, double, double) {
  const double x = 0.025 * 0.5e-3, w = 2 * std::numbers::pi * 5;
  return 0.5 * x * x * m.flow_gain / (m.piston_area * w);
}
const std::array<Theory, std::size(degradations)> theories = {{{"theory: pilot pressure", of_filter},
                                                               {"theory: 1/g", of_torque},
                                                               {"theory: at most", of_backlash},
                                                               {"theory: at most", of_friction},
                                                               {"theory: no lap left", of_clearance},
                                                               {"theory: no lap left", of_clearance}}};

rig::RigRun test_of(const Degradation& d, std::uint64_t seed) {
  rig::RigRun run = preflight("preflight_slew", seed);
  const std::string shown = d.check;
  if (shown == "mean_error") run.excitation = "flight", run.duration = 20, run.offset = true;
  if (shown == "correlation@5Hz") run.amplitude = 0.025, run.duration = 1.6;
  return run;
}

// Fig. 13: a life of backlash with its levels, curve, tangent and the distribution of its end.
ChartPanel figure_13(const Bench& b, std::string& csv) {
  constexpr int checks = 26;
  constexpr double life = 100;
  ValveHistory h;
  h.valve = "backlash";
  for (int i = 0; i < n_parameters; ++i) h.tuned.push_back(b.tuned[i].nominal);
  std::vector<double> last;
  Random random(18);
  for (int k = 0; k < checks; ++k) {
    const double at = 2.5 * k;
    const Condition condition = random_condition(random);
    const CheckResult r = check(test_log(b.model, "feedback_wire_backlash", 20e-6 * at / life, condition,
                                         preflight(b.test, 700 + static_cast<std::uint64_t>(k))),
                                b.tuned, b.rig, {.threads = 1, .last = last});
    last = r.tracked;
    h.recordings.push_back(recording_of(at, r));
    std::fprintf(stderr, "\rfigure 13: %d of %d ", k + 1, checks);
  }
  const ValveTrend t = trend(h, {});
  ChartPanel panel;
  panel.title = "Fig. 13: life left, backlash; it ends at 100 h";
  panel.x_label = "h", panel.y_label = "parameter:9 [um]";
  for (const CheckTrend& c : t.trends) {
    if (c.cause != "feedback_wire_backlash") continue;
    constexpr double um = 1e6;
    ChartLine seen{"checks, corrected", {}, {}, "", true};
    for (const auto& p : c.points) {
      seen.x.push_back(p.at), seen.y.push_back(um * p.value);
      csv += fmt::format("13,feedback_wire_backlash,{},{},{},,,,,{}\n", p.at, p.temperature - zero_celsius, p.value,
                         p.healthy ? 1 : 0);
    }
    panel.lines.push_back(seen);
    const std::pair<const char*, std::optional<double>> levels[] = {
        {"threshold", c.threshold.upper}, {"warning", c.warning.upper}, {"failure", c.failure.upper}};
    for (const auto& [name, level] : levels)
      if (level) panel.lines.push_back({name, {0, 120}, {um * *level, um * *level}, "", false});
    if (c.tangent && c.warning.upper && c.failure.upper) {
      panel.lines.push_back({"the paper's rule",
                             {c.tangent->alert_at, c.tangent->alert_at + c.tangent->time_to_failure},
                             {um * *c.warning.upper, um * *c.failure.upper},
                             "",
                             false});
      std::printf("fig. 13: the paper's rule alerts at %.1f h and puts the end at %.1f h\n", c.tangent->alert_at,
                  c.tangent->alert_at + c.tangent->time_to_failure);
    }
    if (c.remaining && c.failure.upper)
      panel.lines.push_back({"90 % of the end, ours",
                             {t.at + c.remaining->lower, t.at + c.remaining->upper},
                             {um * *c.failure.upper, um * *c.failure.upper},
                             "",
                             false});
  }
  if (t.remaining)
    std::printf("fig. 13: alert at %.1f h; at %.1f h the end is put at %.1f h (%.1f to %.1f, 90 %%); true 100 h\n",
                t.alert_at.value_or(NAN), t.at, t.at + t.remaining->median, t.at + t.remaining->lower,
                t.at + t.remaining->upper);
  return panel;
}

}  // namespace

void figures(const Bench& b, const std::string& out) {
  std::filesystem::create_directories(out);
  constexpr int n_fig = std::size(degradations);
  std::vector<Point> all(n_fig * points * 2);
  for_each(static_cast<int>(all.size()), "tests", [&](int i) {
    const Degradation& d = degradations[i / (2 * points)];
    const int k = i / 2 % points;
    Point& p = all[static_cast<std::size_t>(i)];
    p.severity = severity_at(d, k / (points - 1.0));
    Random random(17, static_cast<std::uint32_t>(i));
    const bool service = std::string(d.check) == "mean_error";  // in service the oil is warm
    if (i % 2 && service) return;
    if (i % 2) p.at = random_condition(random);
    const rig::RigRun run = test_of(d, service ? 500 : 500 + static_cast<std::uint64_t>(i / 2));  // one flight for all
    const CheckResult r = check(test_log(b.model, d.name, p.severity, p.at, run), b.tuned, b.rig,
                                {.threads = 1, .track = false, .correct = !service, .last = {}});
    p.settled = !service || r.mean_error.settled;
    if (const Check* c = find(r.checks, d.check))
      p.shown = *c;
    else
      p.shown.measured = p.shown.value = NAN;
  });

  std::string csv =
      "figure,degradation,severity,temperature [degC],measured,corrected,std_error,theory,unit,settled or healthy\n";
  std::vector<ChartPanel> panels;
  const Supply standard{b.tuned[row::supply_pressure].nominal, b.tuned[row::return_pressure].nominal, {}, 0.02};
  const MonitorParameters healthy = monitor_parameters(b.tuned, standard);
  for (int f = 0; f < n_fig; ++f) {
    const Degradation& d = degradations[f];
    const Point* of = &all[static_cast<std::size_t>(f * points * 2)];
    const std::string shown = d.check;
    const auto [scale, unit] = shown == "fidelity"     ? std::pair(1.0, "1")
                               : shown == "mean_error" ? std::pair(1e6, "um")
                                                       : std::pair(1e9, "1e-9 m2");
    ChartPanel panel;
    panel.title = fmt::format("Fig. {}: {}", d.figure, d.name);
    panel.x_label = "severity", panel.y_label = fmt::format("{} [{}]", shown, unit);
    ChartLine warm{"40 degC", {}, {}, "", false}, any{"-30 to 70 degC", {}, {}, "", true},
        mended{"corrected", {}, {}, "", true}, theory{theories[f].label, {}, {}, "", false};
    for (int k = 0; k < 2 * points; ++k) {
      const Point& p = of[k];
      if (k % 2 && shown == "mean_error") continue;
      Table worn = b.tuned;
      if (std::string(d.name) == "clogged_filter")
        worn[row::filter_blockage_positive].nominal = worn[row::filter_blockage_negative].nominal = p.severity;
      const double expected =
          theories[f].value(healthy, monitor_parameters(worn, standard), p.severity, of[0].shown.measured);
      ChartLine& line = k % 2 ? any : warm;
      line.x.push_back(p.severity), line.y.push_back(scale * p.shown.measured);
      if (k % 2)
        mended.x.push_back(p.severity), mended.y.push_back(scale * p.shown.value);
      else
        theory.x.push_back(p.severity), theory.y.push_back(scale * expected);
      csv += fmt::format("{},{},{},{:.1f},{},{},{},{},{},{}\n", d.figure, d.name, p.severity, p.at.celsius,
                         p.shown.measured, p.shown.value, p.shown.std_error, expected, p.shown.unit, p.settled ? 1 : 0);
    }
    std::printf("fig. %-2s %-24s %-16s %8.4g -> %8.4g %-8s (40 degC; theory -> %.4g)\n", d.figure, d.name, d.check,
                warm.y.front(), warm.y.back(), unit, theory.y.back());
    panel.lines = {warm, theory};
    if (shown != "mean_error") panel.lines.push_back(any), panel.lines.push_back(mended);
    panels.push_back(panel);
  }
  panels.push_back(figure_13(b, csv));
  write_file(out + "/figures.csv", csv);
  write_file(out + "/figures.svg", report::svg_of(panels, 2));
  std::printf("%s/figures.csv, %s/figures.svg\n", out.c_str(), out.c_str());
}

}  // namespace servodx::study
