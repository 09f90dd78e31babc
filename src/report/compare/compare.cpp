#include "report/compare/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_text.h"
#include "base/result_schema.h"
#include "report/diagnose/two_tests.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/parts.h"
#include "report/shared/replay_part.h"
#include "store/verdict_file.h"

namespace servodx::report {
namespace {

constexpr double certain_sigmas = 3.0;
constexpr double rounding = 1e-9;      // relative: sums in another order
constexpr std::size_t longest = 40;    // characters of a text in a terminal's column
constexpr std::size_t most_named = 3;  // in the headline

std::string shown(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) return digits(value.get<double>(), 4);
  return value.is_null() ? "-" : value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string relative_change(double a, double b) {
  if (!std::isfinite(a) || !std::isfinite(b) || a == 0) return "";
  return fmt::format("{}{} %", b > a ? "+" : "", digits(100 * (b - a) / std::abs(a), 2));
}

bool is_rounding(double a, double b) { return a == b || std::abs(a - b) <= rounding * std::abs(a); }

// Elements of an array of objects by the text under a key.
std::map<std::string, const Json*> by(const Json& array, const char* key) {
  std::map<std::string, const Json*> found;
  if (array.is_array())
    for (const Json& item : array)
      if (item.is_object() && item.contains(key)) found.emplace(shown(item[key]), &item);
  return found;
}

class Comparing {
 public:
  explicit Comparing(Comparison& to) : to_(to) {}

  void value(const std::string& what, const Json& a, const Json& b, bool matters = false) {
    const bool numbers = a.is_number() && b.is_number();
    if (a == b || (numbers && is_rounding(a.get<double>(), b.get<double>()))) {
      ++to_.same;
      return;
    }
    to_.differences.push_back({what, shown(a), shown(b),
                               numbers ? relative_change(a.get<double>(), b.get<double>()) : "", std::nan(""),
                               matters});
  }

  void parameter(const std::string& name, const Json& a, const Json& b) {
    const double from = number_or_nan(a, "estimate"), to = number_or_nan(b, "estimate");
    if (is_rounding(from, to)) {
      ++to_.same;
      return;
    }
    const double error = std::hypot(number_or_nan(a, "std_error"), number_or_nan(b, "std_error"));
    const double sigmas = error > 0 ? (to - from) / error : std::nan("");
    const std::string unit = text_or_empty(a, "unit");
    to_.differences.push_back({name, handy(from, unit), handy(to, unit), relative_change(from, to), sigmas,
                               std::abs(sigmas) > certain_sigmas});
  }

  // Every scalar under both, by its path; arrays of objects by their name, log or signal where they have one.
  void tree(const std::string& path, const Json& a, const Json& b) {
    if (a.is_object() && b.is_object()) {
      if (a.contains("estimate") && a.contains("std_error")) return parameter(path, a, b);
      for (const auto& [key, item] : a.items())
        if (b.contains(key)) tree(path.empty() ? key : path + "." + key, item, b[key]);
      return;
    }
    if (a.is_array() && b.is_array()) {
      for (const char* key : {"log", "name", "signal", "effect", "path", "fault"}) {
        const auto left = by(a, key), right = by(b, key);
        if (left.empty() || right.empty()) continue;
        for (const auto& [name, item] : left) {
          const auto other = right.find(name);
          if (other != right.end())
            tree(name_path(path, name), *item, *other->second);
          else
            to_.differences.push_back({name_path(path, name), "there", "not there", "", std::nan(""), false});
        }
        for (const auto& [name, item] : right)
          if (!left.contains(name))
            to_.differences.push_back({name_path(path, name), "not there", "there", "", std::nan(""), false});
        return;
      }
      return value(path, a, b);
    }
    const std::string last = path.substr(path.find_last_of('.') + 1);
    value(path, a, b, last == "verdict" || last == "fault" || last == "state" || last == "where");
  }

 private:
  // A parameter and a channel are known by their name.
  static std::string name_path(const std::string& path, const std::string& name) {
    return path == "parameters" || path == "channels" ? name : path + " " + name;
  }
  Comparison& to_;
};

void compare_conditions(const Json& a, const Json& b, Comparison& to) {
  const auto ask = [&](const char* key) {
    const Json of_a = a.value(key, Json()), of_b = b.value(key, Json());
    if (of_a != of_b) to.conditions.push_back(fmt::format("{}: {} and {}", key, shown(of_a), shown(of_b)));
  };
  ask("version");
  if (a.contains("commit") && b.contains("commit")) ask("commit");  // results of lists alone state it
  ask("seed");
  const Json sa = a.value("settings", Json::object()), sb = b.value("settings", Json::object());
  for (const auto& [key, item] : sa.items())
    if (!sb.contains(key) || sb[key] != item)
      to.conditions.push_back(
          fmt::format("setting {}: {} and {}", key, shown(item), sb.contains(key) ? shown(sb[key]) : "not there"));
  const Json files_a = a.value("inputs", Json::array()), files_b = b.value("inputs", Json::array());
  const auto ia = by(files_a, "sha256"), ib = by(files_b, "sha256");
  for (const auto& [hash, file] : ia)
    if (!ib.contains(hash)) to.conditions.push_back("input only of A: " + text_or_empty(*file, "path"));
  for (const auto& [hash, file] : ib)
    if (!ia.contains(hash)) to.conditions.push_back("input only of B: " + text_or_empty(*file, "path"));
}

}  // namespace

Comparison compare(const std::string& path_a, Json a, const std::string& path_b, Json b) {
  Comparison c;
  for (const auto& [json, path] : {std::pair(&a, &path_a), std::pair(&b, &path_b)})
    if (auto notice = schema_notice(*json, *path)) c.notes.push_back(std::move(*notice));
  c.command = a["command"].get<std::string>();
  c.a = path_a, c.b = path_b;
  if (b["command"].get<std::string>() != c.command)
    throw InputError({path_b, 0, "command"},
                     fmt::format("is a result of '{}', the other of '{}'", shown(b["command"]), c.command),
                     "compare results of one command");
  compare_conditions(a, b, c);
  if (store::holds_one_verdict(a) && store::holds_one_verdict(b))
    c.tests = two_tests(path_a, store::verdict_of(a), store::verdict_of(b));
  for (Json* json : {&a, &b})
    for (const char* key : {"tool", "version", "commit", "schema", "command", "seed", "settings", "inputs", "seconds",
                            "notes", "simulations", "failed_simulations", "output"})
      json->erase(key);
  // One log against another: diagnoses of one log each compare though the logs differ.
  if (c.tests) a = a["results"][0], b = b["results"][0];
  Comparing(c).tree("", a, b);
  std::stable_sort(c.differences.begin(), c.differences.end(), [](const auto& x, const auto& y) {
    const auto rank = [](const Comparison::Difference& d) {
      return std::pair(d.matters ? 1 : 0, std::isfinite(d.sigmas) ? std::abs(d.sigmas) : 0.0);
    };
    return rank(x) > rank(y);
  });
  return c;
}

namespace {

std::string headline(const Comparison& c) {
  if (c.tests) return finding_of(*c.tests);
  if (c.differences.empty()) return fmt::format("The two results of '{}' are the same", c.command);
  std::vector<std::string> matter;
  for (const Comparison::Difference& d : c.differences)
    if (d.matters) matter.push_back(d.what);
  if (matter.empty())
    return fmt::format("{} figures differ, none beyond {} sigmas, and no verdict", c.differences.size(),
                       digits(certain_sigmas));
  const std::size_t all = matter.size();
  if (all > most_named) matter.resize(most_named);
  return fmt::format("{} of {} differences matter (a verdict, or beyond {} sigmas): {}{}", all, c.differences.size(),
                     digits(certain_sigmas), join(matter),
                     all > most_named ? fmt::format(" and {} more", all - most_named) : "");
}

// Cut, where a whole sentence stands in a cell.
std::string shortened(const std::string& text) {
  if (text.size() <= longest) return text;
  std::size_t end = longest;
  while ((text[end] & 0xC0) == 0x80) --end;  // not within a character
  return text.substr(0, end) + "...";
}

std::string in_sigmas(double s) { return std::isfinite(s) ? fmt::format("{}{}", s > 0 ? "+" : "", digits(s, 2)) : ""; }

}  // namespace

std::string text_of(const Comparison& c) {
  std::string text = headline(c) + fmt::format("\n  A {}\n  B {}\n", c.a, c.b);
  for (const std::string& condition : c.conditions) text += "  differs in " + condition + "\n";
  constexpr std::size_t most = 40;
  Columns table("llrrrr", 2);
  if (!c.differences.empty()) table.row({"", "", "A", "B", "change", "sigmas"});
  for (std::size_t i = 0; i < std::min(most, c.differences.size()); ++i) {
    const auto& d = c.differences[i];
    table.row({d.matters ? "*" : "", d.what, shortened(d.a), shortened(d.b), d.change, in_sigmas(d.sigmas)});
  }
  text += table.text();
  if (c.differences.size() > most) text += fmt::format("  and {} more: --json has all\n", c.differences.size() - most);
  return text + fmt::format("  {} figures are equal\n", c.same);
}

Json compare_json(const Comparison& c) {
  Json differences = Json::array();
  for (const auto& d : c.differences)
    differences.push_back({{"what", d.what},
                           {"a", d.a},
                           {"b", d.b},
                           {"change", d.change},
                           {"sigmas", std::isfinite(d.sigmas) ? Json(d.sigmas) : Json(nullptr)},
                           {"matters", d.matters}});
  return {{"a", c.a},
          {"b", c.b},
          {"of", c.command},
          {"conditions", c.conditions},
          {"differences", differences},
          {"equal", c.same},
          {"tests", c.tests ? to_json(*c.tests) : Json(nullptr)}};
}

Page compare_page(const Header& header, const Comparison& c) {
  Page page(header, "Comparison of two results of " + c.command);
  Verdict v;
  v.headline = words(headline(c));
  v.detail = c.a + "  (A) and  " + c.b + "  (B)";
  const bool any = std::any_of(c.differences.begin(), c.differences.end(), [](const auto& d) { return d.matters; });
  v.tone = c.tests ? tone_of(*c.tests) : any ? Tone::doubt : Tone::good;
  v.facts = {{"Differ", std::to_string(c.differences.size())}, {"Equal", std::to_string(c.same)}};
  for (const std::string& condition : c.conditions) v.reasons.push_back("Conditions differ: " + condition);
  page.verdict(v);
  if (c.tests) {
    page.section("Since the last test", "A is taken for the last test of the valve, B for this one.");
    add_two_tests(page, *c.tests);
  }
  if (c.differences.empty()) return page;
  page.section("Differences", "", c.tests.has_value());
  TablePart table{"From A to B", "lrrrr", {"", "A", "B", "change", "sigmas"}, {}, 40};
  for (const auto& d : c.differences) {
    Cell name = words(d.what);
    if (d.matters) name.tone = Tone::bad;
    table.rows.push_back({name, shortened(d.a), shortened(d.b), d.change,
                          std::isfinite(d.sigmas) ? Cell(in_sigmas(d.sigmas), d.sigmas) : Cell("")});
  }
  page.add(table);
  return page;
}

}  // namespace servodx::report
