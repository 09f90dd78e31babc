#include "report/diagnose/diagnosis_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/trouble.h"
#include "diagnose/assessment.h"
#include "diagnose/blame.h"
#include "diagnose/decide.h"
#include "diagnose/judge.h"
#include "diagnose/judgeable.h"
#include "diagnose/moved.h"
#include "diagnose/record_law.h"
#include "parameters/list.h"
#include "report/diagnose/diagnosis_words.h"
#include "report/diagnose/next_calls.h"
#include "report/diagnose/verdict_words.h"
#include "report/shared/columns.h"
#include "report/shared/conditions.h"
#include "report/shared/handy.h"
#include "report/shared/text_options.h"
#include "servodx/actions.h"
#include "servodx/tune.h"

namespace servodx::report {
namespace {

template <class Rows>
std::string moves_table(const Rows& rows, std::size_t most) {
  Columns table("lrlrrrl", 4);
  for (std::size_t i = 0; i < std::min(rows.size(), most); ++i) {
    const ParameterResult& p = rows[i];
    const InHandyUnit in(p);
    const bool known = std::isfinite(p.std_error);
    table.row({p.name, in(p.nominal), "->", in(p.estimate), known ? "+-" : "", known ? in(p.std_error, 2) : "",
               in.unit.name});
  }
  return table.text();
}

std::string in_colour(const std::string& word, VerdictKind verdict, bool colour) {
  if (!colour) return word;
  const char* code = verdict == VerdictKind::healthy ? "32" : verdict == VerdictKind::fault ? "31" : "33";
  return fmt::format("\033[1;{}m{}\033[0m", code, word);
}

// How the hypotheses stand: a named fault with its two runners-up, or the three that come nearest.
std::pair<std::string, std::string> standing(const Diagnosis& d) {
  std::vector<std::pair<double, std::string>> order;
  if (d.verdict == VerdictKind::unknown)  // its probabilities say only that
    for (const HypothesisResult& h : d.assessment.hypotheses) order.emplace_back(h.probability, label_of(h.fault));
  else
    for (const auto& [label, p] : labelled_probabilities(d)) order.emplace_back(p, label);
  const auto named = [&](const std::string& label) { return d.fault && label == label_of(d.fault); };
  std::stable_sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
    return std::pair(named(a.second), a.first) > std::pair(named(b.second), b.first);
  });
  if (order.size() > 3) order.resize(3);
  std::vector<std::string> words;
  for (const auto& [p, label] : order) words.push_back(label + " " + chance(p));
  if (!d.fault || words.empty()) return {"nearest", join(words)};
  words.erase(words.begin());
  return {"probability", chance(order.front().first) + (words.empty() ? "" : "; then " + join(words))};
}

}  // namespace

std::string text_of(const Diagnosis& d, const TextOptions& options) {
  std::string first = d.log + ": ";
  first += in_colour(d.verdict == VerdictKind::healthy ? word_of(d.verdict) : headword(d), d.verdict, options.colour);
  if (d.fault && !of_log(d)) first += " " + label_of(d.fault) + of_channel(d);
  if (const std::string mistake = mistake_in_words(d); !mistake.empty()) first += ": " + mistake;
  if (const std::string size = size_words(d); !size.empty()) first += ", " + size;
  if (d.suspicion) first += "; " + suspicion_in_words(*d.suspicion);
  Columns table("ll", 2);
  if (const std::string at = conditions_in_words(d.conditions); !at.empty()) table.row({"at", at});
  if (const std::string tuned = tuned_in_words(d.conditions); !tuned.empty()) table.row({"tuned at", tuned});
  if (const std::string far = beyond_in_words(d.conditions); !far.empty()) table.row({"BEYOND", far});
  for (const std::string& doubt : doubts_beside_baseline(d)) table.row({"BEWARE", doubt});
  if (const std::string kind = words_of(blame_of(d)); !kind.empty()) table.row({"kind", kind});
  if (const std::string why = words_of_doubt(d); !why.empty()) first += ": " + why;
  if (d.assessment.unjudgeable != Unjudgeable::no) {
    for (const RecordFinding& f : d.records) table.row({"record", record_in_words(f)});
    table.row({"action", d.action.text});
    for (const std::string& call : next_calls(d, options.call)) table.row({"next", call});
    return first + "\n" + table.text();
  }

  const auto [word, hypotheses] = standing(d);
  if ((d.doubt == Doubt::none || d.doubt == Doubt::no_fault) && !of_log(d)) table.row({word, hypotheses});
  table.row({"error", fmt::format("{}, threshold {}; {}", digits(d.error), digits(d.threshold), chance_words(d))});
  if (d.beyond) table.row({"but", beyond_in_words(*d.beyond)});
  if (d.unlike) table.row({"beware", unlike_words(d) + mark_of(Trouble::unlike_test)});
  if (const std::string with = compared_words(d); !with.empty()) table.row({"compared with", with});
  for (const RecordFinding& f : d.records) table.row({"record", record_in_words(f)});
  for (std::size_t i = 1; i < d.faults.size(); ++i) table.row({"and", second_in_words(d.faults[i])});
  if (const std::string seen = words_of(d.assessment.gross); !seen.empty()) table.row({"seen at once", seen});
  if (d.onset) table.row({"since", digits(*d.onset, 4) + " s"});
  if (!d.ambiguous_with.empty()) table.row({"or else", join(ambiguous_labels(d))});
  if (const std::string test = separating_test_of(d, options.call); !test.empty()) table.row({"to separate", test});
  if (d.action.of != ActionClass::none) table.row({"action", d.action.text});
  for (const std::string& call : next_calls(d, options.call)) table.row({"next", call});
  if (!of_log(d)) table.row({"null", null_in_words(d)});

  if (!d.fault) {
    const auto [shown, hidden] = detectable_words(d);
    if (!shown.empty()) table.row({"would show", join(shown)});
    if (!hidden.empty()) table.row({"cannot show", join(hidden)});
  }

  auto [by_fault, in_health] = moved_parts(d);
  std::erase_if(in_health, [](const MovedRow& p) {
    return p.name == parameter_list[row::servovalve_null].name;  // it has a line of its own
  });
  constexpr std::size_t most = 4;
  std::string text = first + "\n" + table.text();
  if (!by_fault.empty())
    text += fmt::format("  {}\n", d.fault ? "moved by the fault" : "moved by the nearest, " + label_of(d.nearest)) +
            moves_table(by_fault, most);
  if (!in_health.empty()) text += "  moved in every hypothesis, healthy included\n" + moves_table(in_health, most);
  return text;
}

}  // namespace servodx::report
