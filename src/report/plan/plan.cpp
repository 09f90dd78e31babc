#include "report/plan/plan.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "plan/goal.h"
#include "plan/plan.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/parts.h"

namespace servodx::report {
namespace {

// "from the mildest on": found as soon as it is called a fault.
std::string least_words(const PlannedTest::Fault& f) {
  if (!f.least) return "not found";
  return (f.from_mildest ? "the mildest, " : "") + handy(*f.least, f.unit);
}

std::string fault_headline(const PlannedTest::Fault& f) {
  return fmt::format("{} of {}: found {}, named {}", f.name, handy(f.severity, f.unit), chance(f.found),
                     chance(f.named));
}

std::string headline_of(const PlannedTest& test) {
  const PlannedTest::Figures& p = test.planned;
  const GoalKind kind = test.whole ? test.whole->kind : GoalKind::find;
  switch (kind) {
    case GoalKind::part:
      return p.pairs.empty() ? ""
                             : fmt::format("{} distinguished from {}: {}", p.pairs[0].first, p.pairs[0].second,
                                           chance(p.pairs[0].told));
    case GoalKind::estimate:
      return p.rows.empty() ? ""
                            : fmt::format("{}: {} of its error is left", p.rows[0].name,
                                          percent(p.rows[0].after / p.rows[0].before));
    case GoalKind::find: {
      const PlannedTest::Fault* worst = nullptr;
      for (const PlannedTest::Fault& f : p.faults)
        if (!worst || f.named < worst->named) worst = &f;
      return worst ? (p.faults.size() > 1 ? "least surely " : "") + fault_headline(*worst) : "";
    }
  }
  return "";
}

std::string pieces_text(const PlannedTest& test) {
  Columns table("rrlrr", 2);
  table.row({"from [s]", "for [s]", "shape", "of rated", "rate [Hz]"});
  for (const PlannedTest::Piece& p : test.pieces)
    table.row({digits(p.start), digits(p.seconds), p.shape, percent(p.amplitude), digits(p.rate)});
  return table.text();
}

const PlannedTest::Fault* random_of(const PlannedTest& test, std::size_t i) {
  return i < test.random.faults.size() ? &test.random.faults[i] : nullptr;
}

std::string shown_text(const PlannedTest& test) {
  std::string text;
  const PlannedTest::Figures& p = test.planned;
  if (!p.faults.empty()) {
    Columns table("llrrrl", 2);
    table.row({"fault", "least found in 19 of 20", "at", "found", "named", "nearest"});
    for (std::size_t i = 0; i < p.faults.size(); ++i) {
      const PlannedTest::Fault& f = p.faults[i];
      table.row({f.name, least_words(f), handy(f.severity, f.unit), chance(f.found), chance(f.named), f.nearest});
      if (const auto* r = random_of(test, i))
        table.row({"  by a random test", least_words(*r), "", chance(r->found), chance(r->named), r->nearest});
    }
    text += table.text();
  }
  constexpr std::size_t few = 3;  // of all faults there are too many pairs to read
  if (p.faults.size() <= few)
    for (std::size_t i = 0; i < p.pairs.size(); ++i)
      text += fmt::format("  {} distinguished from {}: {}; by a random test {}\n", p.pairs[i].first, p.pairs[i].second,
                          chance(p.pairs[i].told), chance(test.random.pairs[i].told));
  if (!p.rows.empty()) {
    Columns table("lrrr", 2);
    table.row({"row", "error before", "after", "random"});
    for (std::size_t i = 0; i < p.rows.size(); ++i)
      table.row({p.rows[i].name, handy(p.rows[i].before, p.rows[i].unit), handy(p.rows[i].after, p.rows[i].unit),
                 handy(test.random.rows[i].after, p.rows[i].unit)});
    text += table.text();
  }
  return text;
}

std::string extremes_words(const PlannedTest::Extremes& e) {
  std::string text = "current " + handy(e.current, "A");
  if (e.stroke > 0)
    text += fmt::format(", piston {} either way at {}, chambers {} to {}", handy(e.stroke, "m"), handy(e.speed, "m/s"),
                        handy(e.pressure_low, "Pa") + (e.cavitates ? " (oil cavitates)" : ""),
                        handy(e.pressure_high, "Pa"));
  return text;
}

Json fault_json(const PlannedTest::Fault& f) {
  return {{"name", f.name},
          {"unit", f.unit},
          {"least", f.least ? Json(*f.least) : Json(nullptr)},
          {"from_mildest", f.from_mildest},
          {"severity", f.severity},
          {"deviates", f.deviates},
          {"found", f.found},
          {"named", f.named},
          {"nearest", f.nearest}};
}

Json figures_json(const PlannedTest::Figures& f) {
  Json faults = Json::array(), pairs = Json::array(), rows = Json::array();
  for (const PlannedTest::Fault& one : f.faults) faults.push_back(fault_json(one));
  for (const PlannedTest::Pair& p : f.pairs) pairs.push_back({{"between", {p.first, p.second}}, {"told", p.told}});
  for (const PlannedTest::Row& r : f.rows)
    rows.push_back({{"name", r.name}, {"unit", r.unit}, {"before", r.before}, {"after", r.after}});
  const PlannedTest::Extremes& e = f.extremes;
  return {{"information", f.information},
          {"faults", faults},
          {"pairs", pairs},
          {"rows", rows},
          {"extremes",
           {{"current", e.current},
            {"stroke", e.stroke},
            {"speed", e.speed},
            {"pressure_low", e.pressure_low},
            {"pressure_high", e.pressure_high},
            {"cavitates", e.cavitates}}}};
}

std::vector<double> scaled(std::vector<double> x, double by) {
  for (double& v : x) v *= by;
  return x;
}

}  // namespace

std::string text_of(const PlannedTest& test, const std::string& written_to) {
  const double step = test.time.size() > 1 ? test.time[1] : 0;
  std::string text = fmt::format("{}: {} s, {} samples\n", written_to,
                                 digits(static_cast<double>(test.time.size()) * step), test.time.size());
  text += headline_of(test) + "\n" + pieces_text(test) + shown_text(test);
  return text + "  goes to: " + extremes_words(test.planned.extremes) + "\n";
}

Json plan_json(const PlannedTest& test) {
  Json pieces = Json::array();
  for (const PlannedTest::Piece& p : test.pieces)
    pieces.push_back(
        {{"shape", p.shape}, {"start", p.start}, {"seconds", p.seconds}, {"amplitude", p.amplitude}, {"rate", p.rate}});
  return {{"threshold", test.threshold},           {"closed_loop", !test.setpoint.empty()},
          {"interrupted", test.interrupted},       {"pieces", pieces},
          {"planned", figures_json(test.planned)}, {"random", figures_json(test.random)}};
}

Page plan_page(const Header& header, const PlannedTest& test) {
  Page page(header, "Planned test");
  Verdict verdict;
  verdict.tone = Tone::plain;
  verdict.word = "PLAN";
  verdict.headline = headline_of(test);
  verdict.facts = {{"goes to", extremes_words(test.planned.extremes)},
                   {"a finding needs", digits(test.threshold) + " deviates"}};
  page.verdict(verdict);
  page.section("The command", "Held from sample to sample. The random test is one of the same length and limits.");
  constexpr double milli = 1e3;
  page.add(Plot{.title = "command [mA]",
                .x_label = "time [s]",
                .x = test.time,
                .series = {{"planned", scaled(test.command, milli), Role::measured, false},
                           {"random", scaled(test.random_command, milli), Role::other, false}},
                .group = "time"});
  if (test.whole && !test.whole->piston.empty())
    page.add(Plot{.title = "piston position of a valve as tuned [mm]",
                  .x_label = "time [s]",
                  .x = test.time,
                  .series = {{"planned", scaled(test.whole->piston, milli), Role::named, false}},
                  .group = "time"});
  TablePart pieces{.title = "Pieces",
                   .alignment = "rrlrr",
                   .head = {"from [s]", "for [s]", "shape", "of rated", "rate [Hz]"},
                   .rows = {}};
  for (const PlannedTest::Piece& p : test.pieces)
    pieces.rows.push_back({{digits(p.start), p.start},
                           {digits(p.seconds), p.seconds},
                           p.shape,
                           {percent(p.amplitude), p.amplitude},
                           {digits(p.rate), p.rate}});
  page.add(pieces);
  page.section("What it would show",
               "Found: beyond the limit of healthy logs. Named: found, and likelier than any other fault.");
  TablePart faults{
      .title = "Faults",
      .alignment = "llrrrlrr",
      .head = {"fault", "least found in 19 of 20", "at", "found", "named", "nearest", "random: found", "named"},
      .rows = {}};
  for (std::size_t i = 0; i < test.planned.faults.size(); ++i) {
    const PlannedTest::Fault &f = test.planned.faults[i], &r = test.random.faults[i];
    faults.rows.push_back({f.name,
                           least_words(f),
                           handy(f.severity, f.unit),
                           {chance(f.found), f.found},
                           {chance(f.named), f.named},
                           f.nearest,
                           {chance(r.found), r.found},
                           {chance(r.named), r.named}});
  }
  if (!faults.rows.empty()) page.add(faults);
  TablePart pairs{
      .title = "Distinguished", .alignment = "llrr", .head = {"fault", "from", "planned", "random"}, .rows = {}};
  for (std::size_t i = 0; i < test.planned.pairs.size(); ++i) {
    const PlannedTest::Pair &p = test.planned.pairs[i], &r = test.random.pairs[i];
    pairs.rows.push_back({p.first, p.second, {chance(p.told), p.told}, {chance(r.told), r.told}});
  }
  if (!pairs.rows.empty()) page.add(pairs);
  TablePart rows{.title = "Rows", .alignment = "lrrr", .head = {"row", "error before", "after", "random"}, .rows = {}};
  for (std::size_t i = 0; i < test.planned.rows.size(); ++i) {
    const PlannedTest::Row &p = test.planned.rows[i], &r = test.random.rows[i];
    rows.rows.push_back({p.name,
                         {handy(p.before, p.unit), p.before},
                         {handy(p.after, p.unit), p.after},
                         {handy(r.after, r.unit), r.after}});
  }
  if (!rows.rows.empty()) page.add(rows);
  return page;
}

}  // namespace servodx::report
