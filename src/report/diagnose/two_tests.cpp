#include "report/diagnose/two_tests.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/celsius.h"
#include "diagnose/test_change.h"
#include "fit/row_meaning.h"
#include "report/diagnose/verdict_words.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/replay_part.h"
#include "store/verdict_file.h"

namespace servodx::report {

using store::StoredVerdict;
using store::TestPlace;
using store::TestRow;
using store::TestSide;

namespace {

constexpr double certain_sigmas = 3.0;  // as `compare` has it

// A row that a side left alone is at its nominal value there, without an error.
std::vector<TwoTests::Row> rows_of(const TestSide& last, const TestSide& now, bool same_reference) {
  struct Pair {
    const TestRow *last = nullptr, *now = nullptr;
  };
  std::map<std::string, Pair> by_name;
  for (const TestRow& r : last.rows) by_name[r.name].last = &r;
  for (const TestRow& r : now.rows) by_name[r.name].now = &r;
  std::vector<TwoTests::Row> out;
  for (const auto& [name, pair] : by_name) {
    if (!same_reference && (!pair.last || !pair.now)) continue;
    const TestRow& known = pair.now ? *pair.now : *pair.last;
    TwoTests::Row row{name, known.unit, pair.last ? pair.last->estimate : known.nominal,
                      pair.now ? pair.now->estimate : known.nominal};
    row.std_error = std::hypot(pair.last ? pair.last->std_error : 0, pair.now ? pair.now->std_error : 0);
    if (row.std_error > 0) row.sigmas = (row.now - row.last) / row.std_error;
    row.matters = std::abs(row.sigmas) > certain_sigmas;
    if (row.now != row.last) out.push_back(row);
  }
  const auto far = [](const TwoTests::Row& r) { return std::isfinite(r.sigmas) ? std::abs(r.sigmas) : 0.0; };
  std::stable_sort(out.begin(), out.end(), [&](const auto& a, const auto& b) { return far(a) > far(b); });
  return out;
}

std::string verdict_word(const TestSide& side) { return side.verdict ? word_of(*side.verdict) : side.other_verdict; }

std::string name_of(const TestSide& side) { return side.fault.empty() ? verdict_word(side) : side.fault; }

std::string verdict_in_words(const TestSide& side) {
  if (side.fault.empty()) return verdict_word(side);
  return words(side.fault) +
         (side.size ? ", " + handy_interval(side.size->value, side.size->lower, side.size->upper, side.size->unit)
                    : "");
}

std::string error_in_words(const TestSide& side) { return digits(side.error) + " of " + digits(side.threshold); }

constexpr std::string_view of_oil = "oil_temperature";

std::string place_in_words(const TestSide& side, const std::string& condition) {
  for (const TestPlace& p : side.places)
    if (p.condition == condition)
      return condition == of_oil ? fmt::format("{} degC", std::lround(p.value - zero_celsius)) : handy(p.value, p.unit);
  return "-";
}

// What stands in text and page: name, last, now.
std::vector<std::array<std::string, 3>> figures_of(const TwoTests& t) {
  std::vector<std::array<std::string, 3>> out = {{"log", file_name(t.last.log), file_name(t.now.log)},
                                                 {"verdict", verdict_in_words(t.last), verdict_in_words(t.now)},
                                                 {"error of threshold", error_in_words(t.last), error_in_words(t.now)},
                                                 {"null, of rated", percent(t.last.null), percent(t.now.null)}};
  std::vector<std::string> conditions;
  for (const TestSide* side : {&t.last, &t.now})
    for (const TestPlace& p : side->places)
      if (std::find(conditions.begin(), conditions.end(), p.condition) == conditions.end())
        conditions.push_back(p.condition);
  for (const std::string& c : conditions)
    out.push_back({words(c), place_in_words(t.last, c), place_in_words(t.now, c)});
  return out;
}

constexpr const char* other_reference =
    "The last test was judged by another table or baseline: its figures differ by that too.";

std::string word_of(TestChange change) {
  switch (change) {
    case TestChange::alike:
      return "alike";
    case TestChange::failed:
      return "failed";
    case TestChange::mended:
      return "mended";
    case TestChange::grown:
      return "grown";
    case TestChange::lessened:
      return "lessened";
    case TestChange::another:
      return "another";
  }
  return "";
}

}  // namespace

TwoTests two_tests(const std::string& last_path, const StoredVerdict& last, const StoredVerdict& now) {
  TwoTests t;
  t.last_name = last_path;
  t.last = last.side, t.now = now.side;
  t.change = change_of(store::findings_of(t.last, t.now));
  t.same_reference = last.reference == now.reference;
  t.rows = rows_of(t.last, t.now, t.same_reference);
  return t;
}

std::string words_of(const TwoTests& t) {
  switch (t.change) {
    case TestChange::alike:
      return "as in the last test";
    case TestChange::failed:
      return "new: the last test was healthy";
    case TestChange::mended:
      return "gone: the last test showed " + words(name_of(t.last));
    case TestChange::grown:
      return "grown since the last test, from " +
             handy_interval(t.last.size->value, t.last.size->lower, t.last.size->upper, t.last.size->unit);
    case TestChange::lessened:
      return "less than in the last test, " +
             handy_interval(t.last.size->value, t.last.size->lower, t.last.size->upper, t.last.size->unit);
    case TestChange::another:
      return "another finding than in the last test, " + words(name_of(t.last));
  }
  return "";
}

std::string finding_of(const TwoTests& t) { return verdict_in_words(t.now) + "; " + words_of(t); }

Tone tone_of(const TwoTests& t) {
  switch (t.change) {
    case TestChange::alike:
      return t.now.healthy() ? Tone::good : Tone::plain;
    case TestChange::mended:
    case TestChange::lessened:
      return Tone::good;
    case TestChange::failed:
    case TestChange::grown:
    case TestChange::another:
      return Tone::bad;
  }
  return Tone::plain;
}

std::string text_of(const TwoTests& t) {
  std::string text = fmt::format("since the last test, {}: {}\n", t.last_name, words_of(t));
  Columns table("lrrr", 2);
  table.row({"", "last test", "this test", "sigmas"});
  for (const auto& [name, last, now] : figures_of(t)) table.row({name, last, now});
  for (const TwoTests::Row& r : t.rows)
    if (r.matters)
      table.row({r.name, handy(r.last, r.unit), handy(r.now, r.unit),
                 fmt::format("{}{}", r.sigmas > 0 ? "+" : "", digits(r.sigmas, 2))});
  text += table.text();
  return t.same_reference ? text : text + "  " + other_reference + "\n";
}

Json to_json(const TwoTests& t) {
  Json rows = Json::array();
  for (const TwoTests::Row& r : t.rows)
    rows.push_back({{"name", r.name},
                    {"unit", r.unit},
                    {"last", number(r.last)},
                    {"now", number(r.now)},
                    {"std_error", number(r.std_error)},
                    {"sigmas", number(r.sigmas)},
                    {"matters", r.matters}});
  return {{"result", t.last_name},
          {"log", t.last.log},
          {"verdict", verdict_word(t.last)},
          {"fault", t.last.fault.empty() ? Json(nullptr) : Json(t.last.fault)},
          {"error", number(t.last.error)},
          {"threshold", number(t.last.threshold)},
          {"change", word_of(t.change)},
          {"same_reference", t.same_reference},
          {"parameters", rows}};
}

void add_two_tests(Page& page, const TwoTests& t) {
  TablePart table{"Test beside test", "lll", {"", "last test", "this test"}, {}, 0};
  for (const auto& [name, last, now] : figures_of(t)) {
    Cell cell = now;
    if (name == "verdict") cell.tone = tone_of(t);
    table.rows.push_back({name, last, cell});
  }
  page.add(table);
  Moves moves{"What has moved from the last test to this one", {}, 0};
  for (const TwoTests::Row& r : t.rows) {
    const HandyUnit unit = handy_unit(r.unit, std::max(std::abs(r.last), std::abs(r.now)));
    Moves::Row row{.name = words(r.name),
                   .from = digits(r.last * unit.factor, 4),
                   .to = digits(r.now * unit.factor, 4),
                   .error = std::isfinite(r.std_error) ? digits(r.std_error * unit.factor, 2) : "",
                   .unit = unit.name,
                   .sigmas = r.sigmas,
                   .note = meaning_of_row(r.name),
                   .exact_from = r.last,
                   .exact_to = r.now,
                   .exact_error = r.std_error,
                   .exact_unit = r.unit == "-" ? "" : r.unit};
    moves.rows.push_back(std::move(row));
    moves.shown += r.matters ? 1 : 0;
  }
  moves.shown = std::max<std::size_t>(moves.shown, 4);  // where nothing moved for certain, what comes nearest
  if (!moves.rows.empty()) page.add(moves);
  if (!t.same_reference) page.text(other_reference);
}

}  // namespace servodx::report
