// What a person reads and what a program reads say the same as the result struct.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "diagnose/assessment.h"
#include "diagnose/baseline.h"
#include "diagnose/broken_sensors.h"
#include "diagnose/decide.h"
#include "diagnose/judge.h"
#include "diagnose/judgeable.h"
#include "diagnose/moved.h"
#include "diagnose/record_law.h"
#include "explain/cause_score.h"
#include "explain/explain.h"
#include "explain/healthy.h"
#include "explain/missing.h"
#include "explain/outcome.h"
#include "faults/registry.h"
#include "fit/identifiability.h"
#include "fleet/fleet_verdict.h"
#include "fleet/gather.h"
#include "optimise/box_least_squares.h"
#include "optimise/ceres_refinement.h"
#include "parameters/list.h"
#include "prognose/check.h"
#include "prognose/life.h"
#include "prognose/track.h"
#include "prognose/trend.h"
#include "prognose/trend_state.h"
#include "report/baseline/baseline_json.h"
#include "report/baseline/baseline_text.h"
#include "report/check/check_report.h"
#include "report/check_log/check_log.h"
#include "report/diagnose/diagnose_page.h"
#include "report/diagnose/diagnosis_json.h"
#include "report/diagnose/diagnosis_text.h"
#include "report/diagnose/diagnosis_words.h"
#include "report/diagnose/next_calls.h"
#include "report/diagnose/verdict_words.h"
#include "report/explain/explain_report.h"
#include "report/fleet/fleet.h"
#include "report/selftest/selftest.h"
#include "report/shared/call_names.h"
#include "report/shared/certificate_part.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/html.h"
#include "report/shared/json.h"
#include "report/shared/replay_part.h"
#include "report/shared/text_options.h"
#include "report/trend/trend_report.h"
#include "report/tune/tune_json.h"
#include "report/tune/tune_page.h"
#include "report/tune/tune_text.h"
#include "report/tune/tune_words.h"
#include "servodx/actions.h"
#include "servodx/certificate.h"
#include "servodx/check_log.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/selftest.h"
#include "servodx/table.h"
#include "servodx/tune.h"
#include "store/baseline_file.h"
#include "store/baseline_parts.h"
#include "store/healthy_file.h"
#include "store/truth_file.h"
#include "temporary_folder.h"
#include "tune/trust.h"
#include "tune/tune.h"

namespace servodx::report {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

DetectionBaseline some_baseline() {
  DetectionBaseline b;
  b.threshold = 3.1000000000000001;
  b.asked = 0.01;
  b.promised = 1.0 / 9.0;
  b.promised_95 = 0.3123456789012345;
  b.logs = 8;
  b.logs_needed = 99;
  for (int i = 0; i < 8; ++i)
    b.scores.push_back({fmt::format("h{}.csv", i),
                        std::string(64, 'a'),
                        0.1 * i,
                        1.0 / (1 + i),
                        {{find_fault("sticky_spool"), 0.3 * i}}});
  for (DetectionBaseline::Score& s : b.scores) s.content = "of " + s.log;
  b.adequacy_limit = 1.2345678901234567;
  b.null_limit = 0.05;
  b.tuned_sha256 = std::string(64, 'b');
  return b;
}

Diagnosis some_diagnosis() {
  Diagnosis d;
  d.log = "suspect.csv";
  d.verdict = VerdictKind::fault;
  d.error = 12.3;
  d.threshold = 3.1;
  d.p_value = 4e-4;
  d.fault = find_fault("feedback_wire_backlash");
  d.probabilities = {
      {d.fault, 0.9}, {find_fault("sticky_spool"), 0.06}, {find_fault("null_shift"), 0.03}, {nullptr, 0.01}};
  d.ambiguous_with = {find_fault("sticky_spool")};
  d.severity = {12e-6, 9e-6, 15e-6};
  d.onset = 2.3125;
  MovedRow moved;
  moved.by = MovedRow::By::fault;
  moved.id = 9;
  moved.name = "valve_glitch";
  moved.unit = "m";
  moved.estimate = 12e-6;
  moved.std_error = 1.5e-6;
  moved.verdict = RowVerdict::bounded;
  d.moved = {moved};
  return d;
}

TEST(Handy, UnitsBringNumbersNearOne) {
  EXPECT_EQ(handy(12e-6, "m"), "12 um");
  EXPECT_EQ(handy(0.4, "m"), "400 mm");
  EXPECT_EQ(handy(207e5, "Pa"), "207 bar");
  EXPECT_EQ(handy(0.02, "A"), "20 mA");
  EXPECT_EQ(handy(14.0 / 6e4, "m3/s"), "14 l/min");
  EXPECT_EQ(handy(0.52, "blocked fraction of the filter area"), "52 % of the filter area blocked");
  EXPECT_EQ(handy(-0.5, "blocked fraction of one nozzle, negative for nozzle 2"),
            "-50 % of one nozzle blocked, negative for nozzle 2");
  EXPECT_EQ(handy(0.2, "fraction of the torque gain left"), "20 % of the torque gain left");
  EXPECT_EQ(handy(6.03, "times the tuned clearance"), "6.03 times the tuned clearance");
  EXPECT_EQ(handy(0.5, "-"), "0.5");
  EXPECT_EQ(handy_interval(12e-6, 9e-6, 15.4e-6, "m"), "12 um (9 to 15.4, 95 %)");
  EXPECT_EQ(handy_interval(12e-6, nan, nan, "m"), "12 um");
}

TEST(Handy, DigitsAreFewAndHonest) {
  EXPECT_EQ(digits(0), "0");
  EXPECT_EQ(digits(-0.012345), "-0.0123");
  EXPECT_EQ(digits(1234.5), "1234");
  EXPECT_EQ(digits(9.999), "10");
  EXPECT_EQ(digits(nan), "-");
  EXPECT_EQ(duration(192), "3 min 12 s");
}

TEST(Handy, ChannelFiguresAreInTheLogsUnitOrSi) {
  ChannelResult c{Signal::pressure_a, "bar", 1e5, 2e4, nan};
  EXPECT_EQ(figures(c).unit, "bar");
  EXPECT_DOUBLE_EQ(figures(c).rms, 1.0);
  c = {Signal::oil_temperature, "degC", 1.5, 0, 0};  // a difference: no offset
  EXPECT_DOUBLE_EQ(figures(c).rms, 1.5);
  c = {Signal::spool_position, "% of stroke", 2e-6, 0, 0};  // says nothing without the stroke
  EXPECT_EQ(figures(c).unit, "m");
  EXPECT_DOUBLE_EQ(figures(c).rms, 2e-6);
}

TEST(Columns, AlignWhateverTheWidths) {
  Columns table("lr", 1);
  table.row({"a", "1000"});
  table.row({"b\u00b5b", "1"});
  table.row({"", ""});
  EXPECT_EQ(table.text(), " a    1000\n b\u00b5b     1\n\n");
}

TEST(CheckPage, CallsChecksByTheirSymbolsAndParametersByTheirRows) {
  CheckResult r;
  r.log = "preflight.csv";
  for (const char* name : {"mean_error", "fidelity", "correlation@5Hz"})
    r.checks.push_back({name, 1, 0, "-", 1, 1, ""});
  r.checks.push_back({"parameter:9", 2e-6, 1e-7, "m", 2e-6, 1, "feedback_wire_backlash"});
  const std::string html = check_page({}, r, {}).html();
  for (const char* shown : {"mean error |e|", "fidelity r", "correlation E(tau) at 5Hz", "backlash (row 9)"})
    EXPECT_NE(html.find(shown), std::string::npos) << shown;
  EXPECT_EQ(html.find("parameter:9"), std::string::npos);
}

// The tuned value and the fault's own level of failure make a size a way; an error as long as the way is no news.
TEST(CheckPage, OpensWithTheWearThatSurelyReadsAQuarterOfTheWay) {
  CheckResult r;
  r.log = "preflight.csv";
  r.checks.push_back({"parameter:1", 0.6, 0.5, "-", 0.6, 1, "clogged_filter", 0.0, 0.75});
  r.checks.push_back({"parameter:9", 2e-6, 1e-7, "m", 2e-6, 1, "feedback_wire_backlash", 0.0, 20e-6});
  EXPECT_NE(check_page({}, r, {}).html().find("No wear reads a quarter of the way"), std::string::npos);
  r.checks.back() = {"parameter:9", 12e-6, 1e-7, "m", 12e-6, 1, "feedback_wire_backlash", 0.0, 20e-6};
  const std::string html = check_page({}, r, {}).html();
  EXPECT_NE(html.find("Feedback wire backlash reads 60 % of the way to failure: 12 um"), std::string::npos);
}

ExplainResult some_explanation() {
  ExplainResult r;
  r.verdict = ExplainVerdict::extended;
  r.where = "first_stage";
  r.channels = {{"pressure_a", "bar", 3e5, 2e5, 1e5, 3e5, 2e5}, {"spool_position", "um", 9e-6, 1e-6, 5e-7, 9e-6, 1e-6}};
  r.causes = {{"valve_glitch",
               "first_stage",
               "small sines",
               {{"valve_glitch", "m", 20.3e-6, 0.2e-6, 0, 19.97e-6, 20.63e-6}},
               {0.98, 0.97, 0.99},
               {},
               0,
               {"asymmetric_lap"}}};
  r.causes.front().meaning = "backlash between feedback wire and spool, full width";
  r.heldout_gain = {0.98, 0.97, 0.99};
  r.adequacy_before = 346, r.adequacy_after = 1.2;
  r.p_adequacy = 0.4;
  return r;
}

// What was found and how large, and the channel that shows it most, before any table.
TEST(ExplainPage, OpensWithTheCauseItsSizeAndTheChannelThatShowsIt) {
  const std::string html = explain_page({}, some_explanation(), {}).html();
  const std::string opening = html.substr(0, html.find("<section class=\"part\""));
  for (const char* shown :
       {"FOUND", "Mending valve glitch at first stage removes ", "20.3 um (20 to 20.6, 90 %), tuned 0 um",
        "It shows most in the spool position: off by 9 um rms as tuned, by 1 um with what was found", "(346 before)",
        "valve glitch (backlash between feedback wire and spool, full width)",
        "In place of valve glitch it may be asymmetric lap", "Valve glitch shows best in small sines."})
    EXPECT_NE(opening.find(shown), std::string::npos)
        << shown << " is not in " << opening.substr(opening.find("<main>"));
  EXPECT_NE(html.find("What was found"), std::string::npos);

  ExplainResult nothing;
  nothing.verdict = ExplainVerdict::sufficient;
  EXPECT_NE(explain_page({}, nothing, {}).html().find("NOTHING NEW"), std::string::npos);
  nothing.verdict = ExplainVerdict::unexplained;
  EXPECT_NE(explain_page({}, nothing, {}).html().find("UNEXPLAINED"), std::string::npos);
}

// The head is read in ten seconds: one size, in the units of the log, and no gain below nothing.
TEST(ExplainPage, TheHeadIsShortAndInTheLogsUnits) {
  ExplainResult r = some_explanation();
  r.channels.front() = {"pressure_a", "psi", 272e3, 145e3, 1e3, 3e5, 2e5};
  r.causes.push_back(r.causes.front());
  r.causes.push_back(r.causes.front());
  r.retuned = {-0.2, -0.3, -0.1};
  const std::string html = explain_page({}, r, {}).html();
  const std::string opening = html.substr(0, html.find("<section class=\"part\""));
  EXPECT_NE(opening.find("valve glitch at first stage and 2 more removes"), std::string::npos) << opening;
  EXPECT_NE(opening.find("It shows most in the pressure A: off by 39.5 psi rms as tuned, by 21 psi"), std::string::npos)
      << opening;
  EXPECT_EQ(opening.find("-20 %"), std::string::npos) << opening;
  EXPECT_NE(html.find(">or else<"), std::string::npos);
  for (ExplainedCause& c : r.causes) c.confusable_with.clear();
  EXPECT_EQ(explain_page({}, r, {}).html().find(">or else<"), std::string::npos) << "an empty column";
}

// A mass that may be anything from nothing to the most that it could be, and one that a bound holds.
TEST(ExplainPage, ASizeThatTheLogsDoNotTellHasNoInterval) {
  ExplainResult r = some_explanation();
  r.verdict = ExplainVerdict::sufficient;
  r.causes.front().parameters = {
      {"mount_mass", "kg", 148, 65169, 0, 0, 200, SizeTold::not_told},
      {"mount_compliance", "m/N", 1e-6, std::nan(""), 0, std::nan(""), std::nan(""), SizeTold::at_bound}};
  r.standing = std::move(r.causes);
  r.suspicion.emplace().size = r.standing.front().parameters.front();
  const std::string text = text_of(r, {}), html = explain_page({}, r, {}).html();
  EXPECT_NE(text.find("    mount_mass 148 kg, not determined by these logs, before 0 kg\n"), std::string::npos) << text;
  EXPECT_NE(text.find(", mount_mass 148 kg, not determined by these logs: it removes"), std::string::npos) << text;
  EXPECT_NE(text.find("1000 um/kN, at a bound, before 0"), std::string::npos) << text;
  for (const char* shown : {">not determined by these logs<", ">at a bound<"})
    EXPECT_NE(html.find(shown), std::string::npos) << shown;
  const Json json = explain_json(r), mass = json["standing"][0]["parameters"]["mount_mass"];
  EXPECT_EQ(mass["told"], "not_told");
  EXPECT_EQ(mass["lower"], 0);
  EXPECT_EQ(mass["upper"], 200);
  EXPECT_EQ(json["suspicion"]["severity"]["told"], "not_told");
  EXPECT_TRUE(json["standing"][0]["parameters"]["mount_compliance"]["upper"].is_null());
}

ExplainedCandidate candidate(const char* effect, Fate fate) {
  ExplainedCandidate c;
  c.effect = effect, c.where = "spool", c.fate = fate, c.predicted_gain = 40;
  return c;
}

// A cause is taken by the free run or by the replay of the blocks; either way no reason why not stands beside it.
TEST(ExplainText, ListsUnderWhyNotOnlyWhatWasNotTaken) {
  ExplainResult r = some_explanation();
  for (const Fate fate : {Fate::taken, Fate::taken_by_blocks}) {
    r.candidates = {candidate("valve_glitch", fate), candidate("flow_force", Fate::not_worth_its_numbers)};
    const std::string text = text_of(r, {}), tried = text.substr(text.find("why not"));
    EXPECT_EQ(tried.find("valve_glitch"), std::string::npos) << tried;
    EXPECT_NE(tried.find("its gain is not worth its added parameters"), std::string::npos) << tried;
  }
}

// The page draws every candidate, and marks what was taken.
TEST(ExplainPage, MarksACauseToldByTheBlocksAsTaken) {
  const auto page_with = [](Fate fate) {
    ExplainResult r = some_explanation();
    r.candidates = {candidate("valve_glitch", fate)};
    const std::string html = explain_page({}, r, {}).html();
    return html.substr(html.find("What was tried"));
  };
  const auto marked = [&](Fate fate) { return page_with(fate).find("<tr data-tone=\"bad\"") != std::string::npos; };
  EXPECT_TRUE(marked(Fate::taken));
  EXPECT_TRUE(marked(Fate::taken_by_blocks));
  EXPECT_FALSE(marked(Fate::others_fit_better));
}

// Ten logs cannot promise the one per cent asked for: a reader learns what they can, wherever he looks.
TEST(ExplainText, SaysTheRateOfFalseAlarmsThatItsHealthyLogsCanPromise) {
  ExplainResult r = some_explanation();
  EXPECT_TRUE(explain_json(r)["false_alarm"].is_null());
  r.false_alarm = {0.01, 1.0 / 11, 10};
  const std::string said =
      "healthy log is called wrong at a rate of 9.1 %, that 10 healthy logs can promise; asked was 1 %";
  EXPECT_NE(text_of(r, {}).find(said), std::string::npos) << text_of(r, {});
  EXPECT_NE(explain_page({}, r, {}).html().find(said), std::string::npos);
  EXPECT_DOUBLE_EQ(explain_json(r)["false_alarm"]["promised"], 1.0 / 11);
}

// The likeliest place by name, size and what it follows, and what the channels do not tell it from; in health, nothing.
TEST(ExplainPage, SaysWhatIsMissingAndDrawsItWithItsBand) {
  ExplainResult r = some_explanation();
  MissingInput force{"piston_force", "force", "N"}, flow{"flow_b", "flow", "m3/s"};
  force.rms = 310, force.std_error = 20, force.gain = 500, force.likely = true;
  force.variable = "direction of the piston", force.share = 0.88;
  force.value = {{300, -320}}, force.error = {{20, 20}};
  flow.rms = 2e-6, flow.gain = 498, flow.likely = true;
  flow.value = {{1e-6, 2e-6}}, flow.error = {{1e-7, 1e-7}};
  r.missing = {{force, flow}, {{0, 0.001}}};
  const std::string text = text_of(r, {});
  EXPECT_NE(text.find("missing at piston_force: 310 N rms +- 20 N, 88 % of its square in line with direction of "
                      "the piston; these channels do not distinguish it from"),
            std::string::npos)
      << text;
  EXPECT_NE(explain_page({}, r, {}).html().find("force missing at piston force [N]"), std::string::npos);
  const Json json = explain_json(r)["missing_input"];
  EXPECT_EQ(json["places"].size(), 2u);
  EXPECT_EQ(json["logs"][0]["value"][1], -320);
  r.verdict = ExplainVerdict::sufficient;
  EXPECT_EQ(text_of(r, {}).find("missing at"), std::string::npos);
  EXPECT_EQ(explain_page({}, r, {}).html().find("force missing at"), std::string::npos);
}

TEST(TrendPage, AFigureThatFallsIsNotSaidToRise) {
  ValveTrend v;
  v.valve = "V7", v.state = TrendState::warning;
  CheckTrend t;
  t.name = "fidelity", t.unit = "1", t.state = TrendState::warning;
  t.healthy = 1.34, t.now = 1.15, t.trend = true, t.log_bayes_factor = 20;
  v.trends = {t};
  EXPECT_NE(trend_page({}, {v}, false).html().find("falls, over 1000 to 1"), std::string::npos);
  v.trends.front().now = 1.5;
  EXPECT_NE(trend_page({}, {v}, false).html().find("rises, over 1000 to 1"), std::string::npos);
}

// What was read last stands beside what the fitted law says of that hour.
TEST(TrendPage, TheLastReadingStandsBesideTheLaw) {
  ValveTrend v;
  v.valve = "V7", v.state = TrendState::warning;
  CheckTrend t;
  t.name = "fidelity", t.unit = "1", t.now = 1.5;
  t.points = {{0, 1.0, 300, true}, {10, 1.44, 300, false}};
  v.trends = {t};
  const std::string html = trend_page({}, {v}, false).html();
  EXPECT_LT(html.find(">last reading<"), html.find(">by its law<"));
  EXPECT_NE(html.find("data-value=\"1.44\">1.44<"), std::string::npos);
  EXPECT_NE(html.find("data-value=\"1.5\">1.5<"), std::string::npos);
  EXPECT_NE(text_of(v).find("1.44"), std::string::npos) << text_of(v);
}

// Few checks are no sign of health, and a legend names nothing that is not drawn.
TEST(TrendPage, FewChecksSayNothingOfWear) {
  ValveTrend v;
  v.valve = "V7", v.state = TrendState::unknown, v.checks = 2;
  v.notes = {{Note::Kind::few_checks, "fewer than 6 checks: no word on a trend"}};
  CheckTrend t;
  t.name = "fidelity", t.unit = "1";
  t.points.resize(2);
  for (CheckTrend::Point& p : t.points) p.healthy = true;
  t.points[1].at = 10;
  v.trends = {t};
  const std::string html = trend_page({}, {v}, false).html();
  EXPECT_NE(html.find("Nothing is known yet of how V7 wears, after 2 checks"), std::string::npos);
  EXPECT_NE(html.find("Fewer than 6 checks: no word on a trend."), std::string::npos);
  EXPECT_EQ(html.find("shows no growth"), std::string::npos);
  EXPECT_EQ(html.find("\"watched\""), std::string::npos);
}

// A filter may read far from the tuned value and not be told from it: what is compared is the drop over it.
TEST(CheckText, SaysByWhatAFilterIsNotTold) {
  CheckResult r;
  r.checks.push_back({"parameter:1", 0.85, 0.005, "-", 0.85, 1, "clogged_filter", 0.0, 0.75, 0.05, false});
  EXPECT_NE(text_of(r).find(": by the drop over it not distinguished from the tuned 0"), std::string::npos)
      << text_of(r);
  r.checks.front().value = 0.06;
  EXPECT_NE(text_of(r).find(": not distinguished from the tuned 0"), std::string::npos) << text_of(r);
}

// Nor may a backlash within what the model's form leaves open; and what wears along is said where the wear is.
TEST(CheckText, SaysWhatTheModelsFormLeavesOpenAndWhatWearsAlong) {
  CheckResult r;
  r.checks.push_back({"parameter:9", 1e-6, 5e-8, "m", 1e-6, 1, "feedback_wire_backlash", 0.0, 2e-5, 1e-7, false});
  EXPECT_NE(text_of(r).find(": by the model's form not distinguished from the tuned 0"), std::string::npos)
      << text_of(r);
  r.checks.front() = {"parameter:22", 1.8e-5, 1e-7, "m", 1.8e-5, 1, "radial_clearance_wear", 3e-6, 3e-5, 5e-7, true};
  r.checks.front().along = TrackedAlong{1.57, 0.004, 0.02};
  EXPECT_NE(text_of(r).find("; rounding of the edges, of what the clearance has grown: 1.6 +- 0.02"), std::string::npos)
      << text_of(r);
  const nlohmann::json along = to_json(r.checks.front(), 313.15)["along"];
  EXPECT_EQ(along["value"], 1.57);
  EXPECT_EQ(along["whole_error"], 0.02);
}

// The hour behind the state is that of the last check, not of the warning.
TEST(TrendText, TheHourIsThatOfTheLastCheck) {
  ValveTrend v;
  v.valve = "V7", v.state = TrendState::warning, v.at = 700, v.checks = 36, v.alert_at = 340;
  EXPECT_TRUE(text_of(v).starts_with("V7: warning; last check at 700 h, 36 checks\n")) << text_of(v);
}

// A history may come from anywhere: a filter that gets cleaner has no life towards a blocked one.
TEST(TrendPage, WhatMovesAwayFromFailureIsSaidToAndGetsNoLife) {
  ValveTrend v;
  v.valve = "V7", v.state = TrendState::watch;
  CheckTrend t;
  t.name = "parameter:1", t.unit = "-", t.cause = "clogged_filter", t.state = TrendState::watch;
  t.healthy = 0.46, t.now = 0.10, t.trend = true, t.log_bayes_factor = 20;
  t.failure.upper = 0.87;
  t.remaining = Remaining{346, 65, 14074};
  v.trends = {t};
  const std::string away = trend_page({}, {v}, false).html();
  EXPECT_NE(away.find("away from failure"), std::string::npos);
  EXPECT_NE(away.find("46 %"), std::string::npos);  // of the filter
  EXPECT_EQ(away.find("346 h"), std::string::npos);
  std::swap(v.trends.front().healthy, v.trends.front().now);
  const std::string towards = trend_page({}, {v}, false).html();
  EXPECT_EQ(towards.find("away from failure"), std::string::npos);
  EXPECT_NE(towards.find("346 h"), std::string::npos);
}

// The heads of a page's first matrix: its columns, then its rows.
std::pair<std::vector<std::string>, std::vector<std::string>> heads_of_matrix(const std::string& html) {
  std::pair<std::vector<std::string>, std::vector<std::string>> heads;
  const std::size_t from = html.find("<figure class=\"matrix\">"), body = html.find("<tbody>", from);
  for (std::size_t at = html.find("<th", html.find("</th>", from)); at < html.find("</figure>", from);
       at = html.find("<th", at + 1)) {
    const std::size_t word = html.find('>', at) + 1;
    (at < body ? heads.first : heads.second).push_back(html.substr(word, html.find('<', word) - word));
  }
  return heads;
}

TEST(DiagnosePage, TheTruthLiesOnTheDiagonalAndWhatIsWrongIsNamed) {
  std::vector<Diagnosis> results;
  for (const VerdictKind verdict :
       {VerdictKind::fault, VerdictKind::unknown, VerdictKind::healthy, VerdictKind::healthy}) {
    results.push_back(some_diagnosis());
    results.back().verdict = verdict;
    if (verdict != VerdictKind::fault) results.back().fault = nullptr;
  }
  results[1].log = "stuck.csv";
  const std::string html = diagnose_page({}, results, some_baseline(), {},
                                         {"feedback_wire_backlash", "sticky_spool", "clogged_filter", "healthy"})
                               .html();
  const auto [columns, rows] = heads_of_matrix(html);
  EXPECT_EQ(rows, (std::vector<std::string>{"healthy", "clogged filter", "feedback wire backlash", "sticky spool"}));
  std::vector<std::string> all = rows;
  all.push_back("unknown");
  EXPECT_EQ(columns, all);
  const std::string opening = html.substr(0, html.find("<section class=\"part\""));
  EXPECT_NE(opening.find("2 of 4 verdicts are what the truth files"), std::string::npos);
  EXPECT_NE(opening.find("stuck.csv: the verdict is unknown, the truth sticky spool."), std::string::npos);
}

TEST(TunePage, NamesTheParametersAtAnEndOfTheirRange) {
  TuneResult result;
  result.logs = {{"h.csv", {}, 0.01, 0.0, {}}};
  ParameterResult p;
  p.name = "torque_motor_frequency", p.unit = "Hz", p.nominal = 700, p.estimate = 350, p.std_error = nan;
  p.verdict = RowVerdict::at_bound;
  result.parameters = {p};
  const std::string html = tune_page({}, result, good_enough(result, {}), {}).html();
  EXPECT_NE(html.find("At an end of its range: torque motor frequency."), std::string::npos);
}

TEST(TunePage, SaysOnceThatItIsGoodEnoughAndCallsFaultsByTheirWords) {
  TuneResult result;
  result.channels = {{Signal::spool_position, "um", 1e-6, 5e-7, 1.5e-6}};
  result.starts = {{StartEnd::From::table, 1.0, true}, {StartEnd::From::genetic, 1.01, true}};
  Promise log;
  log.faults = {{"clogged_filter", "-", 0.15, 0.8, 0.5, 12}};
  const std::string html = tune_page({}, result, good_enough(result, {log}), {}).html();
  const std::string opening = html.substr(0, html.find("<section class=\"part\""));
  EXPECT_EQ(opening.find("Good enough"), std::string::npos) << opening;
  EXPECT_NE(opening.find("may miss at their mildest clogged filter."), std::string::npos) << opening;
}

TEST(TunePage, NamesEachStartByWhereItBeganInBarsAndStagesAlike) {
  using From = StartEnd::From;
  TuneResult result;
  result.starts = {{From::table, 3.0}, {From::rig_size, 1.0, true}, {From::genetic, 2.0}, {From::genetic, 4.0}};
  for (int start = 1; start <= 4; ++start)
    result.stages.push_back({{Stage::Kind::start, start}, StageMethod::least_squares, 9.0, 1.0, 10, 1});
  result.convergence = {{{Stage::Kind::start, 1}, 10, 9.0}};
  const std::string html = tune_page({}, result, good_enough(result, {}), {}).html();
  for (const char* began : {"table's values", "effects by the rig's size", "genetic 1", "genetic 2"}) {
    const std::string name = escape_html(began);
    EXPECT_NE(html.find(name), html.rfind(name)) << began << ": once a bar, once a stage";
    EXPECT_NE(html.find("from " + name), std::string::npos) << began;
  }
  EXPECT_EQ(html.find("genetic 3"), std::string::npos);
}

TEST(CheckLogText, ANoticeIsToldAndIsNotSuspicious) {
  LogCheck check;
  check.survey.findings = {{FindingKind::values, "columns ignored: 'shift'", {}, false, true}};
  const std::string text = text_of({check});
  EXPECT_NE(text.find("  note: columns ignored: 'shift'\n"), std::string::npos) << text;
  EXPECT_NE(text.find("  nothing suspicious\n"), std::string::npos) << text;
  const Json log = check_log_json({check})["logs"][0];
  EXPECT_TRUE(log["suspicious"].empty());
  EXPECT_EQ(log["notices"].size(), 1u);
}

TEST(CheckLogText, EndsWithHowManyOfManyLogsAreSuspicious) {
  LogCheck cold, fine;
  cold.survey.path = "cold.csv", fine.survey.path = "fine.csv";
  cold.survey.findings = {
      {FindingKind::temperature, "cold oil"}, {FindingKind::gaps, "one"}, {FindingKind::gaps, "two"}};
  EXPECT_TRUE(text_of({cold, fine}).ends_with("\n1 of 2 logs have something suspicious: temperature in 1, gaps in 1\n"))
      << text_of({cold, fine});
  EXPECT_TRUE(text_of({fine, fine}).ends_with("\nnothing suspicious in 2 logs\n"));
  EXPECT_EQ(text_of({cold}).find("of 1 log"), std::string::npos) << "one log has said it";
}

// Of health a probability would promise more than a baseline can; of an unknown state it says nothing.
TEST(FleetPage, OnlyAFaultHasAProbability) {
  FleetTable table;
  FleetRow healthy, unknown, fault;
  healthy.log = "a.csv", healthy.verdict = FleetVerdict::healthy, healthy.probability = 0.9999;
  unknown.log = "b.csv", unknown.verdict = FleetVerdict::unknown, unknown.probability = 1;
  fault.log = "c.csv", fault.verdict = FleetVerdict::fault, fault.fault = "sticky_spool", fault.probability = 0.87;
  table.rows = {fault, unknown, healthy};
  for (const std::string& said : {text_of(table, {}), fleet_page({}, table, {}).html()}) {
    EXPECT_NE(said.find("87 %"), std::string::npos) << said;
    EXPECT_EQ(said.find("99.9 %"), std::string::npos) << said;
  }
}

// The folder may be called anything: an address is no markup and no scheme.
TEST(FleetPage, ARowLeadsToItsLogsPageWhereOneStands) {
  FleetTable table;
  FleetRow with, without;
  with.log = "a.csv", with.page = "a.12.html", without.log = "b.csv";
  table.rows = {with, without};
  const std::string page = fleet_page({}, table, {}, "../r s:\"#").html();
  EXPECT_NE(page.find("<a href=\"../r%20s%3A%22%23/a.12.html\">a.csv</a>"), std::string::npos);
  EXPECT_EQ(page.find(">b.csv</a>"), std::string::npos);
  EXPECT_EQ(fleet_page({}, table, {}).html().find(">a.csv</a>"), std::string::npos) << "no folder is known";
}

TEST(Words, APortsLetterIsACapital) {
  EXPECT_EQ(words("pressure_a"), "pressure A");
  EXPECT_EQ(words("lap_pb"), "lap pb");
  EXPECT_EQ(words("a"), "a");
}

TEST(BaselineFile, ReadsBackToTheSameBits) {
  const TemporaryFolder folder;
  const DetectionBaseline b = some_baseline();
  Header header;
  header.command = "baseline";
  const DetectionBaseline back =
      store::read_baseline(folder.write("base.json", dump(header, baseline_json(b)))).baseline;
  EXPECT_EQ(back.threshold, b.threshold);
  EXPECT_EQ(back.asked, b.asked);
  EXPECT_EQ(back.promised, b.promised);
  EXPECT_EQ(back.promised_95, b.promised_95);
  EXPECT_EQ(back.logs, b.logs);
  EXPECT_EQ(back.logs_needed, b.logs_needed);
  EXPECT_EQ(statement_of(back), statement_of(b));
  EXPECT_EQ(back.adequacy_limit, b.adequacy_limit);
  EXPECT_EQ(back.null_limit, b.null_limit);
  EXPECT_EQ(back.tuned_sha256, b.tuned_sha256);
  ASSERT_EQ(back.scores.size(), b.scores.size());
  for (std::size_t i = 0; i < b.scores.size(); ++i) {
    EXPECT_EQ(back.scores[i].log, b.scores[i].log);
    EXPECT_EQ(back.scores[i].sha256, b.scores[i].sha256);
    EXPECT_EQ(back.scores[i].content, b.scores[i].content);
    EXPECT_EQ(back.scores[i].score, b.scores[i].score);
    EXPECT_EQ(back.scores[i].adequacy, b.scores[i].adequacy);
    EXPECT_EQ(back.scores[i].gains, b.scores[i].gains);
  }
}

TEST(Truth, OfOtherTypesIsRefusedByKey) {
  const TemporaryFolder folder;
  const auto told = [&](const std::string& text) -> std::string {
    folder.write("log.truth.json", text);
    try {
      return store::truth_beside(folder / "log.csv", "1");
    } catch (const InputError& error) {
      return error.rule;
    }
  };
  EXPECT_EQ(told(R"({"sha256": "1", "label": "healthy"})"), "healthy");
  EXPECT_EQ(told(R"({"sha256": "2", "label": "healthy"})"), "");
  EXPECT_EQ(told(R"({"sha256": 1, "label": "healthy"})"), "key 'sha256': is not a text");
  EXPECT_EQ(told(R"({"sha256": "1", "label": ["healthy"]})"), "key 'label': is not a text");
  EXPECT_EQ(told("[1]"), "");
}

TEST(BaselineFile, RefusalsNameFileKeyAndMend) {
  const TemporaryFolder folder;
  Header header;
  header.command = "baseline";
  const Json good = Json::parse(dump(header, baseline_json(some_baseline())));
  const auto refusal = [&](const std::string& text) -> std::string {
    try {
      store::read_baseline(folder.write("base.json", text));
    } catch (const InputError& error) {
      return std::string(error.what()).substr((folder / "").size());
    }
    return "accepted";
  };
  const auto edited = [&](auto&& edit) {
    Json json = good;
    edit(json);
    return refusal(json.dump());
  };
  const std::string mend = "; make it again with 'servodx baseline'";
  EXPECT_EQ(refusal(good.dump()), "accepted");
  EXPECT_EQ(refusal("{\n\"threshold\": oops"), "base.json:2: is not JSON" + mend);
  EXPECT_EQ(refusal("[1]"), "base.json: is no object" + mend);
  EXPECT_EQ(refusal("{\"threshold\": 1e999}"), "base.json: holds a number beyond 1.8e308" + mend);
  EXPECT_EQ(refusal(std::string(100000, '[')), "base.json: nests deeper than 100 levels" + mend);
  EXPECT_EQ(refusal("{}"), "base.json: key 'command': is missing" + mend);
  EXPECT_EQ(edited([](Json& j) { j.erase("threshold"); }), "base.json: key 'threshold': is missing" + mend);
  EXPECT_EQ(edited([](Json& j) { j["threshold"] = nullptr; }), "base.json: key 'threshold': is not a number" + mend);
  EXPECT_EQ(edited([](Json& j) { j["false_alarm"]["promised"] = 2; }),
            "base.json: key 'false_alarm.promised': is out of range: 2" + mend);
  EXPECT_EQ(edited([](Json& j) { j["false_alarm"] = 3; }),
            "base.json: key 'false_alarm.asked': is not in an object" + mend);
  EXPECT_EQ(edited([](Json& j) { j["scores"] = Json::array(); }), "base.json: key 'scores': holds no scores" + mend);
  EXPECT_EQ(edited([](Json& j) { j["scores"][0].erase("score"); }), "base.json: key 'scores.score': is missing" + mend);
  EXPECT_EQ(edited([](Json& j) { j["scores"][0].erase("content"); }), "accepted") << "of an earlier version";
  EXPECT_EQ(edited([](Json& j) { j["scores"][0]["content"] = 1; }),
            "base.json: key 'scores.content': is not a text" + mend);
  EXPECT_EQ(
      edited([](Json& j) { j["command"] = "tune"; }),
      "base.json: key 'command': is the result of 'tune', not of 'baseline'; name the file that 'servodx baseline "
      "-o' wrote");
}

// Each log with as many figures as a bench's has.
BaselineParts baseline_of_logs(std::size_t logs) {
  BaselineParts parts;
  parts.detection = some_baseline();
  const DetectionBaseline::Score score = parts.detection.scores.front();
  parts.detection.scores.assign(logs, score);
  HealthyLog log;
  log.log = "bench/healthy.csv", log.sha256 = std::string(64, 'a'), log.has_shares = true;
  const std::vector<ProbeScore> sizes(4, ProbeScore{1.0 / 3.0, 1.0 / 7.0});
  for (int k = 0; k < 150; ++k) log.scores.push_back({"effect_of_a_valve", fmt::format("row_{}", k), sizes, 1.0 / 3.0});
  for (int k = 0; k < 15; ++k) log.misses.push_back({fmt::format("part {}", k), 1.0 / 3.0});
  for (int k = 0; k < 8; ++k) {
    log.shares.push_back({"effect_of_a_valve", fmt::format("row_{}", k), 1.0 / 3.0, 1.0 / 7.0});
    log.errors.push_back({"spool_position", 1.0 / 3.0});
  }
  parts.causes.emplace().logs.assign(logs, log);
  return parts;
}

TEST(BaselineFile, OfAHundredLogsIsWithinTheLimits) {
  const TemporaryFolder folder;
  Header header;
  header.command = "baseline";
  const std::string text = dump(header, baseline_json(baseline_of_logs(100)));
  EXPECT_GT(text.size(), 9'000'000u);  // 90 kB a log
  const std::string path = folder.write("base.json", text);
  EXPECT_EQ(store::read_baseline(path).baseline.scores.size(), 100u);
  EXPECT_EQ(store::read_healthy(path).logs.size(), 100u);
}

TEST(DiagnoseJson, HasTheContractsKeys) {
  const Json json = diagnose_json({some_diagnosis()});
  const Json& r = json.at("results").at(0);
  for (const char* key : {"log", "verdict", "error", "threshold", "p_value", "fault", "probabilities", "ambiguous_with",
                          "separating_test", "severity", "onset_time", "parameters"})
    EXPECT_TRUE(r.contains(key)) << key;
  for (const char* key : {"value", "lower", "upper", "unit"}) EXPECT_TRUE(r["severity"].contains(key)) << key;
  for (const char* key : {"id", "name", "nominal", "estimate", "std_error", "verdict", "confounded_with"})
    EXPECT_TRUE(r["parameters"][0].contains(key)) << key;
  EXPECT_EQ(r["severity"]["value"], 12e-6);
  EXPECT_EQ(r["onset_time"], 2.3125);
}

TEST(DiagnoseJson, WhatIsAbsentOrNotFiniteIsNull) {
  Diagnosis d = some_diagnosis();
  d.verdict = VerdictKind::unknown;
  d.fault = nullptr;
  d.onset.reset();
  d.error = INFINITY;
  d.moved[0].std_error = nan;
  const Json r = Json::parse(dump({}, diagnose_json({d}))).at("results").at(0);
  EXPECT_TRUE(r["fault"].is_null());
  EXPECT_TRUE(r["onset_time"].is_null());
  EXPECT_TRUE(r["error"].is_null());
  EXPECT_TRUE(r["severity"]["value"].is_null());
  EXPECT_TRUE(r["parameters"][0]["std_error"].is_null());
}

TEST(DiagnoseText, TheNullHasItsErrorWhereOneIsKnown) {
  Diagnosis d = some_diagnosis();
  d.null = -0.0072;
  EXPECT_EQ(null_in_words(d), "-0.72 % of rated");
  MovedRow null;
  null.name = parameter_list[row::servovalve_null].name;
  null.std_error = 0.0013;
  d.moved.push_back(null);
  EXPECT_EQ(null_in_words(d), "-0.72 +- 0.1 % of rated");
}

TEST(DiagnoseText, TheFirstLineIsTheVerdictWithItsSize) {
  Diagnosis of_fault = some_diagnosis();
  of_fault.action = default_actions().at("feedback_wire_backlash");
  const std::string text = text_of(of_fault, {});
  EXPECT_EQ(text.substr(0, text.find('\n')), "suspect.csv: FAULT feedback_wire_backlash, 12 um (9 to 15, 95 %)");
  EXPECT_NE(text.find("90 %; then sticky_spool 6 %, null_shift 3 %\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("healthy"), std::string::npos) << "two runners-up only: " << text;
  for (const char* words : {"2.312 s", "to separate", "action", "valve_glitch", "p = 0.0004"})
    EXPECT_NE(text.find(words), std::string::npos) << words << " is not in:\n" << text;
  EXPECT_EQ(text.find('\033'), std::string::npos);
  EXPECT_NE(text_of(some_diagnosis(), {.colour = true, .written_to = ""}).find('\033'), std::string::npos);
}

// The test is planned for the two that are hard to tell, at the sizes that were found; where no fit tells them, the
// fault's own words stand.
TEST(SeparatingTest, NamesTheOptionsOfAPlan) {
  Diagnosis d = some_diagnosis();
  EXPECT_EQ(separating_test_of(d), d.fault->test) << "nothing was fitted";
  HypothesisResult backlash, sticky;
  backlash.fault = d.fault, backlash.severity = 12e-6;
  sticky.fault = find_fault("sticky_spool"), sticky.severity = 2.5, sticky.at_least = true;
  d.assessment.hypotheses = {HypothesisResult{}, backlash, sticky};
  EXPECT_NE(separating_test_of(d).find("servodx plan --between feedback_wire_backlash=1.2e-05,sticky_spool --params"),
            std::string::npos)
      << separating_test_of(d);
  d.ambiguous_with = {nullptr};
  EXPECT_NE(separating_test_of(d).find("--faults feedback_wire_backlash=1.2e-05 "), std::string::npos);
  d.ambiguous_with.clear();
  EXPECT_EQ(separating_test_of(d), "");
}

TEST(MovedRows, HaveALineOfMeaningOnThePage) {
  Diagnosis d = some_diagnosis();
  d.moved.front().verdict = RowVerdict::at_bound;
  EXPECT_NE(diagnose_page({}, {d}, some_baseline(), {})
                .html()
                .find("backlash between feedback wire and spool, full width; at the end of its range"),
            std::string::npos);
  d.moved.front().name = "of a table of one's own";
  EXPECT_NE(diagnose_page({}, {d}, some_baseline(), {}).html().find("<td class=\"note\">at the end of its range"),
            std::string::npos);
}

TEST(KindOfVerdict, ExchangedColumnsLeadAndAskForTheRigFile) {
  Diagnosis d = some_diagnosis();
  d.fault = find_fault("sensor_fault");
  d.ambiguous_with.clear(), d.moved.clear(), d.onset.reset();
  d.severity = {nan, nan, nan};
  RecordFinding record;
  record.fault = d.fault, record.broken = SensorFinding::swapped_ports, record.signal = Signal::pressure_a;
  d.faults = {{d.fault, 1, nan, nan, nan, record}};
  const std::string text = text_of(d, {}), head = text.substr(0, text.find('\n'));
  EXPECT_NE(head.find("the columns 'pressure_a' and 'pressure_b' are exchanged"), std::string::npos) << head;
  EXPECT_NE(text.find("the log or the rig file is to be mended"), std::string::npos) << text;
  EXPECT_EQ(text.find("null "), std::string::npos) << text;
  EXPECT_EQ(diagnose_json({d})["results"][0]["kind"], "log");
  EXPECT_EQ(default_actions().at(action_label_of(d)).text,
            "abnormal: mend the rig file or the wiring, then diagnose again");
  const std::string html = diagnose_page({}, {d}, some_baseline(), {}).html();
  EXPECT_NE(html.find("suspect.csv cannot be judged: the columns"), std::string::npos);
  EXPECT_EQ(html.find("gain has drifted, in "), std::string::npos) << "what was found is not that";
}

// Sizes and chances of faults are of no valve there: neither text nor page may show one.
TEST(KindOfVerdict, OfTheLogShowsNoHypothesis) {
  Diagnosis d = some_diagnosis();
  HypothesisResult sensor;
  sensor.fault = find_fault("sensor_fault"), sensor.severity = 0.57, sensor.probability = 0.9;
  d.assessment.hypotheses = {HypothesisResult{}, sensor};
  d.fault = sensor.fault, d.probabilities = {{d.fault, 0.9}, {nullptr, 0.1}};
  d.ambiguous_with.clear(), d.moved.clear(), d.onset.reset();
  RecordFinding record;
  record.fault = d.fault, record.broken = SensorFinding::swapped_ports, record.signal = Signal::pressure_a;
  d.faults = {{d.fault, 1, nan, nan, nan, record}};
  const auto page_of = [&] { return diagnose_page({}, {d}, some_baseline(), {}).html(); };
  EXPECT_TRUE(text_of(d, {}).starts_with("suspect.csv: MISREAD: the columns")) << text_of(d, {});
  for (const char* word : {"FAULT", "90 %", "0.57"}) {
    EXPECT_EQ(text_of(d, {}).find(word), std::string::npos) << word << " in\n" << text_of(d, {});
    EXPECT_EQ(page_of().find(word), std::string::npos) << word;
  }
  EXPECT_EQ(diagnose_json({d})["results"][0]["verdict"], "fault") << "the contract's outcomes are three";
  d.faults.front().record->broken.reset();  // a sensor that is itself at fault
  EXPECT_TRUE(text_of(d, {}).starts_with("suspect.csv: FAULT sensor_fault")) << text_of(d, {});
  for (const char* word : {"90 %", "0.57"}) EXPECT_NE(page_of().find(word), std::string::npos) << word;
}

TEST(DiagnosePage, AHealthyHeadSaysWhatTheLogCannotShow) {
  Diagnosis d = some_diagnosis();
  d.verdict = VerdictKind::healthy, d.fault = nullptr, d.ambiguous_with.clear(), d.moved.clear();
  d.detectable = {{find_fault("sticky_spool"), {}}, {find_fault("clogged_filter"), 0.8}};
  const auto head = [&] {
    const std::string html = diagnose_page({}, {d}, some_baseline(), {}).html();
    return html.substr(0, html.find("<section class=\"part\""));
  };
  EXPECT_NE(head().find("Blind to"), std::string::npos) << head();
  EXPECT_NE(head().find("sticky spool"), std::string::npos) << head();
  EXPECT_EQ(head().find("clogged filter"), std::string::npos) << head();
  d.detectable.erase(d.detectable.begin());
  EXPECT_EQ(head().find("Blind to"), std::string::npos) << head();
}

// Health has 20.7 % among hypotheses of which none holds: no bar of it beside "is not healthy".
TEST(DiagnosePage, AnUnknownStateHasNoShareForHealth) {
  Diagnosis d = some_diagnosis();
  d.verdict = VerdictKind::unknown, d.fault = nullptr, d.onset.reset(), d.ambiguous_with.clear();
  d.assessment.hypotheses = {{nullptr, 900, 0, 0.207, 0, 0, 0, 8.1, {}},
                             {find_fault("sticky_spool"), 880, 10, 0.793, 4, 3, 5, 7.9, {}}};
  const std::string html = diagnose_page({}, {d}, some_baseline(), {}).html();
  EXPECT_EQ(html.find(">20.7 %<"), std::string::npos);
  EXPECT_EQ(html.find("<tr data-tone=\"good\""), std::string::npos);
  EXPECT_NE(html.find(">79.3 %<"), std::string::npos);
}

TEST(DiagnosePage, OfAHealthyLogWhatStandsFirstAloneHasASize) {
  Diagnosis d = some_diagnosis();
  d.verdict = VerdictKind::healthy, d.fault = nullptr, d.onset.reset(), d.ambiguous_with.clear();
  const Fault* filter = find_fault("clogged_filter");
  d.assessment.hypotheses = {{nullptr, 90, 0, 0.9, 0, 0, 0, 1.1, {}},
                             {filter, 90, 0, 0.1, 0.606, 0.199, 0.98, 1.1, {}}};
  const auto page_of = [&] { return diagnose_page({}, {d}, some_baseline(), {}).html(); };
  EXPECT_EQ(page_of().find("60.6 "), std::string::npos);
  d.suspicion = Suspicion{.fault = filter, .severity = 0.606, .lower = 0.199, .upper = 0.98};
  EXPECT_NE(page_of().find("60.6 "), std::string::npos);
}

TEST(DiagnosePage, ACertificateStatesVerdictNullRuleInstrumentsAndWhoAnswersForIt) {
  Certificate sheet;
  sheet.number = "2026-114", sheet.date = "2026-11-25", sheet.issued = "2026-11-27";
  sheet.laboratory = "Weser Test Lab", sheet.method = "WI-114", sheet.authorised_by = "M. Ahlers";
  Instrument gauge;
  gauge.name = "pressure sensor A", gauge.calibrated = "2026-05-02", gauge.due = "2026-11-01";
  sheet.instruments = {gauge};
  Header header;
  header.inputs = {{"suspect.csv", std::string(64, 'c')}};
  add_to_head(header.head, sheet);
  const std::string html =
      diagnose_page(header, {some_diagnosis()}, some_baseline(), {}, {}, {&sheet, "out.manifest.json"}).html();
  for (const std::string& words :
       {std::string("2026-114"), std::string("<dt>Issued</dt><dd>2026-11-27</dd>"), std::string("Weser Test Lab"),
        std::string("WI-114"), std::string("<dt>Authorised by</dt><dd>M. Ahlers</dd>"),
        std::string("pressure sensor A"), std::string("2026-11-01, overdue"), std::string("Decision rule"),
        std::string(64, 'c'), std::string("servodx rerun out.manifest.json")})
    EXPECT_NE(html.find(words), std::string::npos) << words;
}

TEST(KindOfVerdict, IsSaidInTextJsonAndPage) {
  Diagnosis d = some_diagnosis();
  const auto page_of = [](const Diagnosis& of) { return diagnose_page({}, {of}, some_baseline(), {}).html(); };
  EXPECT_NE(text_of(d, {}).find("a component failed"), std::string::npos) << text_of(d, {});
  EXPECT_NE(page_of(d).find("a component failed"), std::string::npos);
  EXPECT_EQ(diagnose_json({d})["results"][0]["kind"], "component");
  d.fault = find_fault("supply_fault");
  EXPECT_EQ(diagnose_json({d})["results"][0]["kind"], "surroundings");
  EXPECT_NE(text_of(d, {}).find("a sensor, the supply or the driver is at fault"), std::string::npos);
  d.verdict = VerdictKind::unknown, d.fault = nullptr;
  d.assessment.unjudgeable = Unjudgeable::too_short;
  EXPECT_NE(text_of(d, {}).find("run another test"), std::string::npos) << text_of(d, {});
  EXPECT_NE(page_of(d).find("run another test"), std::string::npos);
  d.verdict = VerdictKind::healthy, d.assessment.unjudgeable = Unjudgeable::no;
  EXPECT_EQ(diagnose_json({d})["results"][0]["kind"], "none");
  EXPECT_EQ(text_of(d, {}).find("kind "), std::string::npos) << text_of(d, {});
}

TEST(SeparatingTest, TwinsKeepTheirWords) {
  Diagnosis d = some_diagnosis();
  d.fault = find_fault("torque_motor_loss");
  d.ambiguous_with = {d.fault->twin};
  HypothesisResult motor, driver;
  motor.fault = d.fault, driver.fault = d.fault->twin;
  d.assessment.hypotheses = {HypothesisResult{}, motor, driver};
  EXPECT_EQ(separating_test_of(d), d.fault->twin->test) << "the coil current alone tells the driver";
  d.fault = find_fault("corner_wear"), d.ambiguous_with = {d.fault->twin};
  motor.fault = d.fault, driver.fault = d.fault->twin;
  d.assessment.hypotheses = {HypothesisResult{}, motor, driver};
  EXPECT_EQ(separating_test_of(d), d.fault->test);
}

// A twin is not fitted: "under 0.1 %" would say that it is ruled out.
TEST(DiagnosePage, ATwinHasNoProbabilityAndALogIsNotLikeTestsThatAreMissing) {
  Diagnosis d = some_diagnosis();
  d.fault = find_fault("torque_motor_loss");
  d.ambiguous_with = {d.fault->twin};
  d.baseline_logs = 1, d.p_value = 0.5;
  std::string html = diagnose_page({}, {d}, some_baseline(), {}).html();
  EXPECT_NE(html.find("It cannot be distinguished for certain from driver fault. "), std::string::npos) << html;
  EXPECT_NE(html.find("set by 1 fault-free log, is"), std::string::npos);
  EXPECT_NE(html.find("the least that 1 log can show"), std::string::npos);
  d.verdict = VerdictKind::healthy, d.fault = nullptr, d.ambiguous_with.clear();
  d.unlike = {"logs/h11.csv", {0.04, 1.96, 333.0}};
  html = diagnose_page({}, {d}, some_baseline(), {}).html();
  EXPECT_NE(html.find("is like the fault-free logs, though of another test"), std::string::npos);
}

// A rank among n logs ends at 1 / (n + 1): a small p is not to be read off few logs.
TEST(DiagnoseText, ThePValueSaysWhereTheLogsCanShowNoLess) {
  Diagnosis d = some_diagnosis();
  d.baseline_logs = 9;
  d.p_value = 0.1;
  EXPECT_NE(text_of(d, {}).find("p = 0.1, the least that 9 logs can show"), std::string::npos) << text_of(d, {});
  d.p_value = 0.2;
  EXPECT_EQ(text_of(d, {}).find("the least"), std::string::npos) << text_of(d, {});
}

TEST(DiagnoseText, TheFaultsRowsComeBeforeWhatHealthyValvesVaryBy) {
  Diagnosis d = some_diagnosis();
  MovedRow tolerance = d.moved.front(), air = d.moved.front();
  tolerance.name = "torque_motor_gain", tolerance.by = MovedRow::By::tolerance, tolerance.estimate = 1;
  air.name = "air_fraction", air.by = MovedRow::By::nuisance, air.estimate = 2;
  d.moved = {tolerance, air, d.moved.front()};
  const std::string text = text_of(d, {});
  const auto at = [&](const char* word) { return text.find(word); };
  EXPECT_LT(at("moved by the fault"), at("valve_glitch")) << text;
  EXPECT_LT(at("valve_glitch"), at("moved in every hypothesis")) << text;
  EXPECT_LT(at("moved in every hypothesis"), at("torque_motor_gain")) << text;
  EXPECT_LT(at("moved in every hypothesis"), at("air_fraction")) << text;
}

TEST(DiagnoseText, ATestThatTheBaselineHasNoneOfIsSaid) {
  Diagnosis d = some_diagnosis();
  EXPECT_EQ(text_of(d, {}).find("beware"), std::string::npos);
  d.assessment.test = {0.0431, 5.56, 314.0};
  d.unlike = {"logs/h11.csv", {0.04, 1.96, 333.0}};
  EXPECT_NE(
      text_of(d, {}).find("no log of the baseline is of a test like this (drive spans 43.1 mA at about 5.6 Hz, oil "
                          "41 degC); the nearest, h11.csv: drive spans 40 mA at about 2 Hz, oil 60 degC; too far "
                          "apart in oil by 19.0 K"),
      std::string::npos)
      << text_of(d, {});
}

// At the mild end of its range a hypothesis has found nothing: the end's value is the search's, not the log's.
TEST(DiagnosisWords, AHypothesisAtItsLeastHasNoSize) {
  HypothesisResult h;
  h.severity = 0.15, h.severity_lower = 0.15, h.severity_upper = 0.3, h.fault = find_fault("clogged_filter");
  EXPECT_EQ(size_words(h), "15 % of the filter area blocked (15 to 30, 95 %)");
  h.at_least = true;
  EXPECT_EQ(size_words(h), "none of it seen");
}

TEST(DiagnoseText, AHealthyLogSaysSoFirst) {
  Diagnosis d;
  d.log = "good.csv";
  d.verdict = VerdictKind::healthy;
  d.probabilities = {{nullptr, 0.97}, {find_fault("null_shift"), 0.02}, {find_fault("sticky_spool"), 0.01}};
  const std::string text = text_of(d, {});
  EXPECT_TRUE(text.starts_with("good.csv: healthy\n")) << text;
  EXPECT_NE(text.find("healthy 97 %, null_shift 2 %, sticky_spool 1 %"), std::string::npos) << text;
}

TEST(DiagnoseText, AnUnknownStateNamesWhatComesNearest) {
  Diagnosis d;
  d.log = "odd.csv";
  d.verdict = VerdictKind::unknown, d.doubt = Doubt::no_fault;
  d.probabilities = {{nullptr, 0.0}, {find_fault("sticky_spool"), 0.0}};
  d.assessment.hypotheses.resize(2);
  d.assessment.hypotheses[0].probability = 1e-200;
  d.assessment.hypotheses[1].fault = find_fault("sticky_spool");
  d.assessment.hypotheses[1].probability = 0.9999;
  const std::string text = text_of(d, {});
  EXPECT_TRUE(text.starts_with("odd.csv: UNKNOWN: ")) << text;
  EXPECT_NE(text.find("sticky_spool over 99.9 %, healthy under 0.1 %"), std::string::npos) << text;
}

// What is advised is run as it stands.
TEST(DiagnoseText, WhatToRunNextNamesTheFilesOfTheCall) {
  Diagnosis d;
  d.log = "logs/odd one.csv";
  d.verdict = VerdictKind::unknown;
  const CallNames call{"bench.toml", "tuned.csv", "base.json"};
  const std::vector<std::string> calls = next_calls(d, call);
  ASSERT_EQ(calls.size(), 2u);
  EXPECT_EQ(calls[0], "servodx check-log 'logs/odd one.csv' --params tuned.csv --rig bench.toml");
  EXPECT_EQ(calls[1],
            "servodx explain 'logs/odd one.csv' --params tuned.csv --rig bench.toml --baseline base.json "
            "-o extended.csv --report explain.html");
  EXPECT_NE(text_of(d, {.colour = false, .written_to = {}, .call = call}).find(calls[1]), std::string::npos)
      << text_of(d, {.colour = false, .written_to = {}, .call = call});
  Header header;
  header.call = call;
  EXPECT_NE(diagnose_page(header, {d}, some_baseline(), {}).html().find("--baseline base.json"), std::string::npos);
  EXPECT_EQ(next_calls(d, {"", "t.csv", "b.json"})[0], "servodx check-log 'logs/odd one.csv' --params t.csv");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
}

TEST(BaselineText, SaysWhatIsPromised) {
  const std::string text = text_of(some_baseline(), {.colour = false, .written_to = "base.json"});
  EXPECT_TRUE(text.starts_with("threshold 3.1 from 8 fault-free logs: base.json\n")) << text;
  EXPECT_NE(
      text.find(
          "8 fault-free logs promise a false-alarm rate of 11.1 % on average over baselines (below 31 % with 95 % "
          "confidence); 1 % takes 99 logs, 91 more [W02]\n"),
      std::string::npos)
      << text;
}

TEST(TuneReport, HeldRowsSayWhyAndFittedOnesHaveErrors) {
  TuneResult result;
  result.channels = {{Signal::spool_position, "um", 1e-6, 5e-7, 2e-6}};
  ParameterResult fitted, held;
  fitted.id = 3;
  fitted.name = "torque_motor_gain";
  fitted.unit = "N/A";
  fitted.nominal = 100;
  fitted.estimate = 104.25;
  fitted.std_error = 0.5;
  fitted.verdict = RowVerdict::bounded;
  held.id = 7;
  held.name = "nozzle_gap";
  held.unit = "m";
  held.std_error = nan;
  held.verdict = RowVerdict::confounded;
  held.confounded_with = {"flapper_stiffness", "spool_offset", "spool_offset"};
  result.parameters = {fitted, held};
  result.logs = {{"h.csv", result.channels, 0.01}};
  result.starts = {{StartEnd::From::table, 2.0}, {StartEnd::From::genetic, 1.0, true}};
  const std::string text = text_of(result, good_enough(result, {}), {});
  for (const char* words : {"tuned 1 parameter from 1 log\n", "104.2", "held: nozzle_gap",
                            "together with flapper_stiffness, spool_offset\n", "1 of 2 starts", "1 to 2"})
    EXPECT_NE(text.find(words), std::string::npos) << words << " is not in:\n" << text;
  const Json json = tune_json(result);
  for (const char* key : {"channels", "parameters", "starts"}) EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["channels"][0]["unit"], "um");
  EXPECT_DOUBLE_EQ(json["channels"][0]["heldout_rms"].get<double>(), 2.0);
  EXPECT_EQ(json["starts"].size(), 2u);
}

TEST(TuneReport, SaysWhatEachMethodGained) {
  TuneResult result;
  result.stages = {{{Stage::Kind::genetic}, StageMethod::genetic, 900, 200, 1500, 0},
                   {{Stage::Kind::start, 1}, StageMethod::least_squares, 200, 50, 300, 6},
                   {{Stage::Kind::everything}, StageMethod::least_squares, 60, 20, 400, 11},
                   {{Stage::Kind::everything}, StageMethod::ceres, 20, 19, 40, 1}};
  result.ceres.end = CeresEnd::converged;
  result.ceres.steps = 2;
  const std::string text = text_of(result, good_enough(result, {}), {});
  for (const char* words :
       {"genetic search: 900 to 200 (1500 simulations, 0 Jacobians)",
        "bounded search: 60 to 20 (400 simulations, 11 Jacobians)", "Ceres: 20 to 19 (40 simulations, 1 Jacobians)"})
    EXPECT_NE(text.find(words), std::string::npos) << words << " is not in:\n" << text;
  EXPECT_EQ(text.find("300 simulations"), std::string::npos) << "an earlier fit's";
  const Json local = tune_json(result)["local"];
  ASSERT_EQ(local["stages"].size(), 4u);
  EXPECT_EQ(local["stages"][3]["by"], "ceres");
  EXPECT_EQ(local["stages"][3]["cost_after"], 19.0);
  EXPECT_EQ(local["ceres"]["end"], "converged");
  EXPECT_EQ(local["ceres"]["steps"], 2);
}

TEST(TuneReport, GoodEnoughIsWhatPredictsHasArrivedAndWouldSeeTheFaults) {
  TuneResult result;
  result.channels = {{Signal::spool_position, "um", 1e-6, 5e-7, 1.5e-6}};
  result.starts = {{StartEnd::From::table, 1.0, true}, {StartEnd::From::genetic, 1.01, true}};
  Promise log;
  log.faults = {{"sticky_spool", "-", 2.5, 20, 4, 30}, {"clogged_filter", "-", 0.15, 0.8, 0.5, 1}};
  Promise other = log;  // the fault that one log hides another may show
  other.faults[1].deviates_at_typical = 12;
  GoodEnough good = good_enough(result, {log, other});
  EXPECT_EQ(good.trust, Trust::yes);
  EXPECT_EQ(good.errors, "error over noise on the held-out part: spool position 3");
  EXPECT_EQ(good.faint, std::vector<std::string>{"clogged_filter"});
  EXPECT_TRUE(line_of(good).starts_with("yes: it predicts logs as well as it fits")) << line_of(good);

  good = good_enough(result, {log});
  EXPECT_EQ(good.trust, Trust::with_care);
  EXPECT_EQ(good.hidden, std::vector<std::string>{"clogged_filter"});
  const auto reason = [&](const char* words) {
    const GoodEnough g = good_enough(result, {other});
    EXPECT_EQ(g.trust, Trust::with_care) << words;
    EXPECT_NE(line_of(g).find(words), std::string::npos) << line_of(g);
  };
  result.unfollowed = {{Signal::pressure_a, 11.3}};
  const BeyondFaults likeliest{"hose_compliance", "flow_a", "", 0.6, true};
  good = good_enough(result, {other}, &likeliest);
  EXPECT_EQ(good.trust, Trust::no);
  EXPECT_TRUE(line_of(good).starts_with("no: ")) << line_of(good);
  for (const char* words : {"pressure A is left with 11 times its noise", "hose compliance at flow A"})
    EXPECT_NE(line_of(good).find(words), std::string::npos) << line_of(good);
  result.unfollowed.clear();
  result.off_drawing = {{"radial_clearance", 0.333}};
  reason("(radial clearance 0.33 times the sheet's)");
  result.off_drawing.clear();
  result.stop = StopReason::iteration_limit, result.still_promised = 7;
  reason("has not arrived (iteration limit, 7 of its cost still promised)");
  result.still_promised = 0.3;
  EXPECT_EQ(good_enough(result, {other}).trust, Trust::yes) << "no more than chance lends";
  result.stop = StopReason::stalled, result.still_promised = 0.6, result.cost = 780;
  EXPECT_EQ(good_enough(result, {other}).trust, Trust::yes) << "a thousandth of the cost is no other valley";
  result.cost = 0;
  reason("has not arrived (stalled, 0.6 of its cost still promised)");
  result.stop = StopReason::start_failed, result.still_promised = 0;
  reason("has not arrived (start failed");
  result.stop = StopReason::stalled, result.still_promised = std::numeric_limits<double>::infinity();
  reason("has not arrived (stalled, without derivatives nothing says how much is left)");
  result.stop = StopReason::converged;
  result.starts[1].in_best_valley = false;
  reason("no second start");
  result.starts[1].in_best_valley = true;
  const auto log_with = [&](const char* path, double heldout) {
    return LogResult{path, {{Signal::spool_position, "um", 1e-6, 5e-7, heldout}}, 0, 0, {}};
  };
  result.logs = {log_with("a.csv", 1e-6), log_with("b.csv", 1.1e-6), log_with("c.csv", 31e-6)};
  good = good_enough(result, {other});  // one log without its like is said, and judges nothing
  EXPECT_TRUE(line_of(good).starts_with("yes: it predicts most logs as well as it fits")) << line_of(good);
  EXPECT_NE(line_of(good).find("spool position of c.csv (31 times)"), std::string::npos) << line_of(good);
  result.logs[1] = log_with("b.csv", 2.1e-6);
  reason("predicts worse than it fits (spool position 2.1 times)");
  result.channels[0].rms = 60 * result.channels[0].noise_rms;
  reason("does not follow these logs (error over noise: spool position 60 times): check the rig file's data sheet");
}

// Two repeats have a scatter of one degree of freedom: six of its sigmas are chance, of twenty repeats' they are not.
TEST(Selftest, ABiasIsNoNewsBeforeThereAreRepeatsEnough) {
  SelftestResult r;
  r.rows.push_back({.name = "port_width", .bias = 1, .bias_sigmas = 6});
  r.repeats = 2;
  EXPECT_EQ(selftest_json(r)["biased"], 0);
  r.repeats = 20;
  EXPECT_EQ(selftest_json(r)["biased"], 1);
}

TEST(HandyUnits, ARatioHasNoUnit) { EXPECT_EQ(handy(1.5, "1"), "1.5"); }

}  // namespace
}  // namespace servodx::report
