#include "report/diagnose/diagnose_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/trouble.h"
#include "curves/curves.h"
#include "diagnose/assessment.h"
#include "diagnose/baseline.h"
#include "diagnose/blame.h"
#include "diagnose/decide.h"
#include "diagnose/judge.h"
#include "diagnose/judgeable.h"
#include "diagnose/moved.h"
#include "diagnose/naming.h"
#include "diagnose/record_law.h"
#include "faults/fault.h"
#include "faults/gross_finding.h"
#include "report/curves/curves.h"
#include "report/diagnose/bode_part.h"
#include "report/diagnose/diagnosis_words.h"
#include "report/diagnose/friction_words.h"
#include "report/diagnose/next_calls.h"
#include "report/diagnose/two_tests.h"
#include "report/diagnose/verdict_words.h"
#include "report/shared/call_names.h"
#include "report/shared/certificate_part.h"
#include "report/shared/columns.h"
#include "report/shared/conditions.h"
#include "report/shared/handy.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "report/shared/parameter_part.h"
#include "report/shared/parts.h"
#include "report/shared/replay_part.h"
#include "servodx/actions.h"
#include "servodx/certificate.h"
#include "store/baseline_parts.h"

namespace servodx::report {
namespace {

Tone tone_of(const Diagnosis& d) {
  if (of_log(d)) return Tone::doubt;
  if (d.verdict == VerdictKind::fault) return Tone::bad;
  return d.verdict == VerdictKind::healthy && !d.unlike ? Tone::good : Tone::doubt;
}

// The hypothesis that comes nearest beside health.
const HypothesisResult* nearest_fault(const Diagnosis& d) {
  const HypothesisResult* best = nullptr;
  for (const HypothesisResult& h : d.assessment.hypotheses)
    if (h.fault && (!best || h.probability > best->probability)) best = &h;
  return best;
}

std::string headline(const Diagnosis& d) {
  if (d.verdict == VerdictKind::healthy)
    return file_name(d.log) + (d.suspicion ? " cannot be distinguished from the fault-free logs"
                               : d.unlike  ? " is like the fault-free logs, though of another test"
                                           : " is like the fault-free logs");
  if (d.doubt == Doubt::unjudgeable || d.doubt == Doubt::misread || d.doubt == Doubt::unrelated)
    return file_name(d.log) + " cannot be judged: " + words_of_doubt(d);
  if (d.verdict == VerdictKind::unknown) return file_name(d.log) + " is not healthy, and no known fault explains it";
  if (const std::string mistake = mistake_in_words(d); !mistake.empty())
    return file_name(d.log) + " cannot be judged: " + mistake;
  const std::string size = size_words(d);
  return words(label_of(d.fault) + of_channel(d)) + (size.empty() ? "" : ", " + size);
}

std::vector<std::string> reasons(const Diagnosis& d, const DetectionBaseline& baseline, const CallNames& call) {
  std::vector<std::string> why;
  const bool above = d.error > d.threshold;
  const bool seen_outright = d.assessment.gross != GrossFinding::none;
  if (seen_outright) why.push_back("Seen without a fit: " + words_of(d.assessment.gross) + ".");
  for (const RecordFinding& f : d.records) why.push_back(sentence(record_in_words(f)));
  for (std::size_t i = 1; i < d.faults.size(); ++i)
    why.push_back("Beside it stands " + second_in_words(d.faults[i]) + ".");
  why.push_back(fmt::format(
      "Its error is {}; the threshold, set by {} fault-free log{}, is {}. A fault-free log is as "
      "far off with {}.",
      digits(d.error), d.baseline_logs, d.baseline_logs == 1 ? "" : "s", digits(d.threshold), chance_words(d)));
  if (const std::string far = beyond_in_words(d.conditions); !far.empty())
    why.push_back("Beware: recorded beyond what is known: " + far + ".");
  if (d.unlike)
    why.push_back("Beware: " + unlike_words(d) + ". The threshold may not hold for it." +
                  mark_of(Trouble::unlike_test));
  if (const std::string with = compared_words(d); !with.empty()) why.push_back("Compared with " + with + ".");
  if (of_log(d)) return why;  // what a valve would have to be, to make such a log, says nothing of this one
  const HypothesisResult* healthy = result_of(d, nullptr);
  const HypothesisResult* best = d.fault ? result_of(d, d.fault) : nearest_fault(d);
  if (above && healthy && best)
    why.push_back(
        fmt::format("As healthy, the worst channel is {} times as wrong as on the tuning logs; with {} it is {}{}.",
                    digits(healthy->adequacy, 2), words(label_of(best->fault)), digits(best->adequacy, 2),
                    d.verdict == VerdictKind::unknown
                        ? fmt::format(" (fault-free logs reach {})", digits(baseline.adequacy_limit, 2))
                        : ""));
  if (d.fault && !d.ambiguous_with.empty()) {
    std::vector<std::string> others;
    for (const Fault* other : ambiguous_by_label(d))  // a twin is not fitted, and has no probability of its own
      others.push_back(words(label_of(other)) + (result_of(d, other) ? " " + chance(probability_of(d, other)) : ""));
    why.push_back(fmt::format("It cannot be distinguished for certain from {}. To separate them: {}.", join(others),
                              separating_test_of(d, call)));
  } else if (d.fault && !seen_outright) {
    const HypothesisResult* next = nullptr;
    for (const HypothesisResult& h : d.assessment.hypotheses)
      if (h.fault != d.fault && (!next || probability_of(d, h.fault) > probability_of(d, next->fault))) next = &h;
    if (next)
      why.push_back(fmt::format("The next best explanation, {}, has {}.", words(label_of(next->fault)),
                                chance(probability_of(d, next->fault))));
  }
  if (d.suspicion) why.push_back(sentence(suspicion_in_words(*d.suspicion)));
  if (d.onset)
    why.push_back(fmt::format("Until {} s the log is healthy; the fault explains what follows.", digits(*d.onset, 4)));
  return why;
}

Verdict verdict_of(const Diagnosis& d, const DetectionBaseline& baseline, const CallNames& call) {
  Verdict v;
  v.tone = tone_of(d);
  v.word = headword(d);
  v.headline = headline(d);
  const std::string kind = words_of(blame_of(d));
  if (d.assessment.unjudgeable != Unjudgeable::no) {
    v.facts = {{"Kind", kind}, {"Action", d.action.text}};
    for (const RecordFinding& f : d.records) v.reasons.push_back(sentence(record_in_words(f)));
    for (const std::string& next : next_calls(d, call)) v.reasons.push_back("Run next: " + next);
    return v;
  }
  // Of a broken sensor the fault's meaning is not what was found; the record says it.
  if (d.fault && !sensor_finding_of(d)) v.detail = meaning_of(d.fault) + ", in " + d.log;
  if (d.beyond) v.detail = sentence(beyond_in_words(*d.beyond));
  if (d.fault && !of_log(d)) v.facts.push_back({"Probability", chance(probability_of(d, d.fault))});
  if (d.onset) v.facts.push_back({"Since", digits(*d.onset, 4) + " s"});
  v.facts.push_back({"Error / threshold", digits(d.error) + " / " + digits(d.threshold)});
  if (!of_log(d)) v.facts.push_back({"Null", null_in_words(d)});
  if (const auto hidden = detectable_words(d).hidden; d.verdict == VerdictKind::healthy && !hidden.empty())
    v.facts.push_back({"Blind to", join(hidden)});
  if (!kind.empty()) v.facts.push_back({"Kind", kind});
  if (d.action.of != ActionClass::none) v.facts.push_back({"Action", d.action.text});
  for (const std::string& doubt : doubts_beside_baseline(d)) v.reasons.push_back("Beware: " + doubt + ".");
  for (const std::string& next : next_calls(d, call)) v.reasons.push_back("Run next: " + next);
  for (std::string& reason : reasons(d, baseline, call)) v.reasons.push_back(std::move(reason));
  return v;
}

// Of a healthy log: what was tried beside health, and that it gained nothing. A bar of its probability would promise
// more than the rate of false alarms that the baseline can. A size is said of what stands first alone, as the verdict
// does: of the others it is where the fit of a fault that is not there came to rest.
void add_tried(Page& page, const Diagnosis& d) {
  TablePart table{"Faults that were tried: none gains more than on fault-free logs",
                  "lll",
                  {"fault", "size that fits best", "what it leaves"},
                  {},
                  4};
  for (const HypothesisResult& h : d.assessment.hypotheses)
    if (h.fault)
      table.rows.push_back({words(label_of(h.fault)),
                            d.suspicion && d.suspicion->fault == h.fault ? size_words(h) : "-",
                            fmt::format("worst channel {} times its usual error", digits(h.adequacy, 2))});
  if (!table.rows.empty()) page.add(table);
}

void add_ranking(Page& page, const Diagnosis& d) {
  if (d.verdict == VerdictKind::healthy) return add_tried(page, d);
  Bars bars;
  bars.title = "Hypotheses, each fitted to this log";
  bars.label = "hypothesis";
  bars.unit = "probability";
  bars.full = 1.0;
  bars.shown = 4;
  auto order = d.assessment.hypotheses;
  const bool unknown = d.verdict == VerdictKind::unknown;
  const auto p_of = [&](const HypothesisResult& h) {    // of an unknown the verdict's probabilities say only that
    if (unknown) return h.fault ? h.probability : 0.0;  // it is not healthy: that is no matter of rank
    return probability_of(d, h.fault);
  };
  std::stable_sort(order.begin(), order.end(), [&](const auto& a, const auto& b) { return p_of(a) > p_of(b); });
  for (const HypothesisResult& h : order) {
    std::string note = h.fault ? size_words(h) + "; " : "";
    note += fmt::format("worst channel {} times its usual error", digits(h.adequacy, 2));
    bars.rows.push_back({words(label_of(h.fault)), p_of(h), unknown && !h.fault ? "-" : chance(p_of(h)), note,
                         !h.fault && !unknown ? Tone::good
                         : d.fault == h.fault ? Tone::bad
                                              : Tone::plain,
                         ""});
  }
  page.add(bars);
  if (unknown) page.text("None of them fits well enough to be named: the bars only rank them among each other.");
}

void add_detectable(Page& page, const Diagnosis& d) {
  if (d.detectable.empty()) return;
  TablePart table{"What this log could have shown: the least of each fault that 95 of 100 such logs would not pass",
                  "ll",
                  {"fault", "seen from"},
                  {},
                  d.verdict == VerdictKind::healthy ? 0u : 4u};  // a verdict that names something has more to show
  for (const Detectable& f : d.detectable)
    table.rows.push_back(
        {words(label_of(f.fault)), f.severity ? handy(*f.severity, unit_of(f.fault)) : "not even its worst"});
  page.add(table);
}

// Beside health: what is named and what cannot be distinguished from it, or what comes nearest. Of a misread log health
// alone.
std::vector<std::string> drawn_hypotheses(const Diagnosis& d) {
  std::vector<std::string> out = {label_of(nullptr)};
  if (of_log(d)) return out;
  const HypothesisResult* nearest = nearest_fault(d);
  if (d.fault)
    out.push_back(label_of(d.fault));
  else if (d.verdict == VerdictKind::unknown && nearest)
    out.push_back(label_of(nearest->fault));
  for (const Fault* other : ambiguous_by_label(d))
    if (out.size() < 3 && other) out.push_back(label_of(other));
  return out;
}

void add_traces(Page& page, const Diagnosis& d, const Replay& replay, std::size_t drawn) {
  ReplayView view;
  view.shown = drawn_hypotheses(d);
  view.onset = d.onset;
  view.logs = drawn;
  page.text(view.shown.size() == 1
                ? "Below, the tuned model, with null and air fitted to this log, against the measurement; the channel "
                  "it misses most first."
            : d.fault
                ? "Below, dashed: the valve as healthy; full colour: with the fault. The channel that health misses "
                  "most comes first. Where the dashed residual leaves the band and the coloured one stays in it, the "
                  "fault explains what health cannot."
                : "Below, dashed: the valve as healthy; full colour: with the hypothesis that comes nearest, which "
                  "does not explain the log either. The channel that health misses most comes first.");
  add_replay(page, replay, view);
}

void add_details(Page& page, const Diagnosis& d, const std::vector<Replay>& replays, std::size_t drawn) {
  if (d.assessment.unjudgeable != Unjudgeable::no) return add_conditions(page, d.conditions);  // nothing was fitted
  if (!of_log(d)) add_ranking(page, d);
  add_conditions(page, d.conditions);
  if (!of_log(d)) add_detectable(page, d);
  const auto [by_fault, in_health] = moved_parts(d);
  if (!by_fault.empty())
    page.add(moves_of(
        {by_fault.begin(), by_fault.end()},
        d.fault ? "What the fault moves, against the tuned table"
                : "What the nearest hypothesis, " + words(label_of(d.nearest)) + ", moves against the tuned table"));
  const auto r = std::find_if(replays.begin(), replays.end(), [&](const Replay& x) { return x.log == d.log; });
  if (r != replays.end()) add_traces(page, d, *r, drawn);
  if (!in_health.empty()) {
    Moves wander = moves_of({in_health.begin(), in_health.end()},
                            "Moved in every hypothesis, healthy included: tolerances, and this log's own null and air");
    wander.shown = 4;
    page.add(wander);
  }
}

// Where the log was recorded, each with the uncertainty of the instrument that the sheet names for it.
void certify_conditions(std::vector<CertifiedFigure>& figures, const Diagnosis& d, const Certificate& sheet) {
  for (const ConditionFigure& c : condition_figures(d.conditions)) {
    const Instrument* instrument = c.signal ? sheet.of(*c.signal) : nullptr;
    figures.push_back({c.name, c.value, instrument ? instrument->uncertainty : "", "", "", Tone::plain});
  }
}

void certify(Page& page, const Diagnosis& d, const DetectionBaseline& baseline, const Header& header,
             const CertificateOf& certificate) {
  const Certificate& sheet = *certificate.sheet;
  std::vector<CertifiedFigure> figures = {
      {"error", digits(d.error) + " deviates", "", "below " + digits(d.threshold), word_of(d.verdict), tone_of(d)}};
  for (const NamedFault& f : of_log(d) ? std::vector<NamedFault>{} : d.faults)
    figures.push_back(
        {words(label_of(f.fault)), handy(f.severity, unit_of(f.fault)),
         std::isfinite(f.lower) && std::isfinite(f.upper) ? handy(0.5 * (f.upper - f.lower), unit_of(f.fault)) : "", "",
         chance(f.probability), Tone::plain});
  CertifiedFigure null{"null",     percent(d.null) + " of rated", "", "below " + percent(baseline.null_limit), "",
                       Tone::plain};
  constexpr double k = 2;  // of an expanded uncertainty
  if (const std::optional<double> error = error_of_null(d)) {
    const double size = std::abs(d.null), band = sheet.guard * k * *error;
    const bool inside = size < baseline.null_limit, clear = size + band < baseline.null_limit;
    null.uncertainty = percent(k * *error);
    null.judgement = word_of(clear    ? curves::Judgement::pass
                             : inside ? curves::Judgement::too_near
                                      : curves::Judgement::fail);
    null.tone = clear ? Tone::good : inside ? Tone::doubt : Tone::bad;
  }
  figures.push_back(null);
  certify_conditions(figures, d, sheet);
  add_certificate(page, certificate, header, figures,
                  "healthy is said where the error is below the threshold, unless the records show a fault by "
                  "themselves. " +
                      sentence(statement_of(baseline)) + " Of a figure with a limit: " + guard_words(sheet.guard) +
                      ".");
}

bool all_known(const std::vector<Diagnosis>& results, const std::vector<std::string>& truths) {
  return truths.size() == results.size() &&
         std::none_of(truths.begin(), truths.end(), [](const auto& t) { return t.empty(); });
}

// Where the truth is known: how many are right, and which are not.
void say_truth(Verdict& v, const std::vector<Diagnosis>& results, const std::vector<std::string>& truths) {
  if (!all_known(results, truths)) return;
  std::vector<std::string> wrong;
  for (std::size_t i = 0; i < results.size(); ++i)
    if (name_of(results[i]) != truths[i])
      wrong.push_back(fmt::format("{}: the verdict is {}, the truth {}.", file_name(results[i].log),
                                  words(name_of(results[i])), words(truths[i])));
  v.detail = fmt::format("{} of {} verdicts are what the truth files beside the logs say.",
                         results.size() - wrong.size(), results.size());
  constexpr std::size_t most = 8;
  if (wrong.size() <= most) v.reasons = wrong;
}

// What was named against what was made, where the truth is known of every log.
void add_confusion(Page& page, const std::vector<Diagnosis>& results, const std::vector<std::string>& truths) {
  if (!all_known(results, truths)) return;
  Matrix m{"Confusion: the truth is known from the files beside the logs", "truth", "verdict", {}, {}, {}, "", true};
  // Rows and columns in one order, so that what is right lies on the diagonal: health, the faults, last what is no
  // truth (unknown).
  std::map<std::pair<std::string, std::string>, double> counts;
  for (std::size_t i = 0; i < results.size(); ++i) ++counts[{words(truths[i]), words(name_of(results[i]))}];
  const auto add = [](std::vector<std::string>& names, const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const bool health : {true, false})
    for (const auto& [at, n] : counts)
      if ((at.first == label_of(nullptr)) == health) add(m.rows, at.first);
  m.columns = m.rows;
  for (const auto& [at, n] : counts)
    if (at.second != word_of(VerdictKind::unknown)) add(m.columns, at.second);
  for (const auto& [at, n] : counts) add(m.columns, at.second);
  for (const std::string& row : m.rows) {
    m.value.emplace_back();
    for (const std::string& column : m.columns) m.value.back().push_back(counts[{row, column}]);
  }
  page.add(m);
}

}  // namespace

Page diagnose_page(const Header& header, const std::vector<Diagnosis>& results, const DetectionBaseline& baseline,
                   const std::vector<Replay>& replays, const std::vector<std::string>& truths,
                   const CertificateOf& certificate, const BesideVerdict& beside) {
  if (results.size() == 1) {
    const Diagnosis& d = results.front();
    Page page(header, "Diagnosis of " + file_name(d.log));
    add_to_head(page, d.conditions);
    Verdict verdict = verdict_of(d, baseline, header.call);
    if (beside.last) verdict.facts.push_back({"Since the last test", words_of(*beside.last)});
    if (d.friction) verdict.reasons.push_back(sentence(friction_in_words(*d.friction)));
    page.verdict(verdict);
    if (certificate.sheet) certify(page, d, baseline, header, certificate);
    if (beside.last) {
      page.section("Since the last test",
                   "Both verdicts and what moved between them; " + beside.last->last_name + " has the last one.");
      add_two_tests(page, *beside.last);
    }
    page.section(d.assessment.unjudgeable == Unjudgeable::no ? "Why" : "This log");
    add_details(page, d, replays, 1);
    if (!beside.bodes.empty()) {
      page.section("Frequency response",
                   "By simulation on a test stand with free ports and oil at 40 degC: the valve as tuned, and as this "
                   "log has it. Both are set over the tuned valve at its lowest frequency.");
      add_bode(page, beside.bodes);
    }
    return page;
  }
  long faults = 0, unknown = 0;
  for (const Diagnosis& d : results)
    faults += d.verdict == VerdictKind::fault, unknown += d.verdict == VerdictKind::unknown;
  const auto total = static_cast<long>(results.size());
  Page page(header, fmt::format("Diagnosis of {} logs", total));
  Verdict all;
  all.tone = faults > 0 ? Tone::bad : unknown > 0 ? Tone::doubt : Tone::good;
  all.headline = fmt::format("{} of {} logs show a fault, {} unknown, {} healthy", faults, total, unknown,
                             total - faults - unknown);
  say_truth(all, results, truths);
  page.verdict(all);
  page.section("All logs");
  Bars scores{"Error of each log", "log", "error", {}, Mark{baseline.threshold, "threshold"}, {}};
  for (std::size_t i = 0; i < results.size(); ++i)
    scores.rows.push_back({results[i].log, std::min(results[i].error, 10 * baseline.threshold),
                           digits(results[i].error),
                           results[i].fault ? headline(results[i]) : word_of(results[i].verdict), tone_of(results[i]),
                           fmt::format("#log{}", i + 1)});
  page.add(scores);
  add_confusion(page, results, truths);
  for (std::size_t i = 0; i < results.size(); ++i) {
    page.verdict(verdict_of(results[i], baseline, header.call), fmt::format("log{}", i + 1));
    page.section("Traces, hypotheses and parameters of " + file_name(results[i].log), "",
                 results[i].verdict == VerdictKind::healthy);
    add_details(page, results[i], replays, std::max<std::size_t>(1, replays.size()));
  }
  return page;
}

Page diagnose_page(const Header& header, const std::vector<servodx::Verdict>& verdicts, const Baseline& baseline,
                   const std::vector<Replay>& replays, const std::vector<std::string>& truths,
                   const CertificateOf& certificate, const BesideVerdict& beside) {
  std::vector<Diagnosis> results;
  for (const servodx::Verdict& v : verdicts) results.push_back(*v.whole);
  return diagnose_page(header, results, parts_of(baseline).detection, replays, truths, certificate, beside);
}

}  // namespace servodx::report
