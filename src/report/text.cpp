#include "report/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/trouble.h"
#include "diagnose/assessment.h"
#include "diagnose/baseline.h"
#include "diagnose/blame.h"
#include "diagnose/decide.h"
#include "diagnose/healthy_law.h"
#include "diagnose/judge.h"
#include "diagnose/judgeable.h"
#include "diagnose/moved.h"
#include "diagnose/record_law.h"
#include "fit/identifiability.h"
#include "parameters/list.h"
#include "report/columns.h"
#include "report/conditions.h"
#include "report/diagnosis_words.h"
#include "report/handy.h"
#include "report/row_verdict_word.h"
#include "servodx/actions.h"
#include "servodx/table.h"
#include "servodx/tune.h"

namespace servodx::report {
namespace {

// A held row has no error of its own; one on a bound was fitted and has none either.
bool was_fitted(const ParameterResult& p) { return std::isfinite(p.std_error) || p.verdict == RowVerdict::at_bound; }

std::string plural(long n, const std::string& thing) { return fmt::format("{} {}{}", n, thing, n == 1 ? "" : "s"); }

// "12 um +- 0.5" in the unit that suits the estimate.
struct InHandyUnit {
  explicit InHandyUnit(const ParameterResult& p)
      : unit(handy_unit(p.unit, std::max(std::abs(p.nominal), std::abs(p.estimate)))) {}
  std::string operator()(double value, int significant = 4) const { return digits(value * unit.factor, significant); }
  HandyUnit unit;
};

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

std::string channels_table(const std::vector<ChannelResult>& channels) {
  Columns table("lrrrl", 2);
  table.row({"channel", "rms error", "noise", "held out", "unit"});
  for (const ChannelResult& c : channels) {
    const ChannelFigures f = figures(c);
    table.row({std::string(info(c.signal).name), digits(f.rms), digits(f.noise_rms), digits(f.heldout_rms), f.unit});
  }
  return table.text();
}

std::string parameters_table(const std::vector<ParameterResult>& parameters) {
  Columns table("rlrrrll", 2);
  table.row({"id", "parameter", "nominal", "estimate", "+-", "unit", "verdict"});
  for (const ParameterResult& p : parameters) {
    if (!was_fitted(p)) continue;
    const InHandyUnit in(p);
    table.row({p.id > 0 ? std::to_string(p.id) : "", p.name, in(p.nominal), in(p.estimate), in(p.std_error, 2),
               in.unit.name.empty() ? "-" : in.unit.name, word_of(p.verdict)});
  }
  return table.text();
}

// Why a row that could be free was held: what the logs cannot tell.
std::string held_rows(const std::vector<ParameterResult>& parameters) {
  Columns table("ll", 2);
  for (const ParameterResult& p : parameters) {
    if (was_fitted(p)) continue;
    std::vector<std::string> others;
    for (const std::string& name : p.confounded_with)
      if (std::find(others.begin(), others.end(), name) == others.end()) others.push_back(name);
    const std::string reason = p.verdict == RowVerdict::flat ? "the logs do not show it"
                               : p.verdict == RowVerdict::confounded
                                   ? "the logs show it only together with " + join(others)
                                   : word_of(p.verdict);
    table.row({"held: " + p.name, reason});
  }
  return table.text();
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

std::string text_of(const TuneResult& result, const GoodEnough& good, const TextOptions& options) {
  const auto fitted = std::count_if(result.parameters.begin(), result.parameters.end(), was_fitted);
  std::string text = fmt::format("{}tuned {} from {}", result.interrupted ? "interrupted, the best so far: " : "",
                                 plural(fitted, "parameter"), plural(static_cast<long>(result.logs.size()), "log"));
  text += options.written_to.empty() ? "\n" : ": " + options.written_to + "\n";
  text += "  good enough?  " + line_of(good) + "\n";
  if (!good.errors.empty()) text += "  " + good.errors + "\n";
  text += "\n" + channels_table(result.channels) + "\n" + parameters_table(result.parameters);
  text += held_rows(result.parameters) + "\n";
  if (!result.starts.empty()) {
    auto costs = result.starts;
    std::sort(costs.begin(), costs.end());
    text += fmt::format("  {} of {} reached the best basin; final costs {}{}\n", result.reached_best(),
                        plural(static_cast<long>(costs.size()), "start"), digits(costs.front(), 4),
                        costs.size() > 1 ? " to " + digits(costs.back(), 4) : "");
  }
  if (const std::string gains = gains_in_words(result); !gains.empty()) text += "  " + gains + "\n";
  if (const std::string effects = effects_in_words(result.effects); !effects.empty()) text += "  " + effects + "\n";
  Columns nulls("lr", 2);
  for (const LogResult& log : result.logs) nulls.row({"null of " + log.path, percent(log.null) + " of rated"});
  return text + nulls.text();
}

std::string text_of(const DetectionBaseline& b, const TextOptions& options) {
  std::string text = fmt::format("threshold {} from {}", digits(b.threshold, 4), plural(b.logs, "fault-free log"));
  text += options.written_to.empty() ? "\n" : ": " + options.written_to + "\n";
  text += fmt::format("  {}\n", statement_of(b));
  Columns table("lrr", 2);
  table.row({"log", "score", "adequacy"});
  for (const DetectionBaseline::Score& s : b.scores) table.row({s.log, digits(s.score, 4), digits(s.adequacy)});
  text += table.text();
  for (const DetectionBaseline::Score& s : b.scores)
    if (!is_followed(s.adequacy))
      text += fmt::format(
          "  {}: the model does not follow it, its worst channel is {} times as wrong as on the tuning logs; it sets "
          "no "
          "limit but for tests like its own: tune with a log of its kind\n",
          s.log, digits(s.adequacy, 2));
  return text;
}

std::string text_of(const Diagnosis& d, const TextOptions& options) {
  std::string first = d.log + ": ";
  if (d.fault)
    first += in_colour("FAULT", d.verdict, options.colour) + " " + label_of(d.fault) + of_channel(d);
  else
    first += in_colour(d.verdict == VerdictKind::unknown ? "UNKNOWN" : word_of(d.verdict), d.verdict, options.colour);
  if (const std::string size = size_words(d); !size.empty()) first += ", " + size;
  if (d.suspicion) first += "; " + suspicion_in_words(*d.suspicion);
  Columns table("ll", 2);
  if (const std::string at = conditions_in_words(d.conditions); !at.empty()) table.row({"at", at});
  if (const std::string tuned = tuned_in_words(d.conditions); !tuned.empty()) table.row({"tuned at", tuned});
  if (const std::string far = beyond_in_words(d.conditions); !far.empty()) table.row({"BEYOND", far});
  if (const std::string kind = words_of(blame_of(d)); !kind.empty()) table.row({"kind", kind});
  if (d.assessment.unjudgeable != Unjudgeable::no) {
    table.row({"action", d.action.text});
    for (const std::string& call : next_calls(d, options.call)) table.row({"next", call});
    return first + ": " + words_of_doubt(d) + "\n" + table.text();
  }
  if (const std::string why = words_of_doubt(d); !why.empty()) first += ": " + why;

  const auto [word, hypotheses] = standing(d);
  if (d.doubt == Doubt::none || d.doubt == Doubt::no_fault) table.row({word, hypotheses});
  table.row({"error", fmt::format("{}, threshold {}; {}", digits(d.error), digits(d.threshold), chance_words(d))});
  if (d.beyond) table.row({"but", beyond_in_words(*d.beyond)});
  if (d.unlike) table.row({"beware", unlike_words(d) + mark_of(Trouble::unlike_test)});
  if (d.others > 0) table.row({"compared with", others_words(d)});
  for (const RecordFinding& f : d.records) table.row({"record", record_in_words(f)});
  for (std::size_t i = 1; i < d.faults.size(); ++i) table.row({"and", second_in_words(d.faults[i])});
  if (const std::string seen = words_of(d.assessment.gross); !seen.empty()) table.row({"seen at once", seen});
  if (d.onset) table.row({"since", digits(*d.onset, 4) + " s"});
  if (!d.ambiguous_with.empty()) table.row({"or else", join(ambiguous_labels(d))});
  if (const std::string test = separating_test_of(d, options.call); !test.empty()) table.row({"to separate", test});
  if (d.action.of != ActionClass::none) table.row({"action", d.action.text});
  for (const std::string& call : next_calls(d, options.call)) table.row({"next", call});
  table.row({"null", percent(d.null) + " of rated"});

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
  if (!in_health.empty()) text += "  let wander, as in health\n" + moves_table(in_health, most);
  return text;
}

}  // namespace servodx::report
