#include "report/diagnose/diagnosis_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/celsius.h"
#include "base/trouble.h"
#include "diagnose/assessment.h"
#include "diagnose/baseline.h"
#include "diagnose/blame.h"
#include "diagnose/decide.h"
#include "diagnose/judge.h"
#include "diagnose/moved.h"
#include "diagnose/naming.h"
#include "diagnose/reading.h"
#include "diagnose/record_law.h"
#include "diagnose/records.h"
#include "evidence/conditions.h"
#include "faults/fault.h"
#include "faults/gross_finding.h"
#include "faults/record.h"
#include "parameters/list.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/replay_part.h"
#include "servodx/actions.h"
#include "servodx/log.h"
#include "servodx/note.h"

namespace servodx::report {
namespace {

// By its error where that is known, else by its size.
double moved(const MovedRow& row) {
  const double change = std::abs(row.estimate - row.nominal);
  if (row.std_error > 0) return change / row.std_error;
  return change > 0 ? change / std::max(std::abs(row.nominal), std::abs(row.estimate)) : 0.0;
}

}  // namespace

std::string word_of(VerdictKind verdict) {
  switch (verdict) {
    case VerdictKind::healthy:
      return "healthy";
    case VerdictKind::fault:
      return "fault";
    case VerdictKind::unknown:
      return "unknown";
  }
  return "";
}

bool of_log(const Diagnosis& d) { return blame_of(d) == Blame::log; }

std::string headword(const Diagnosis& d) {
  switch (d.verdict) {
    case VerdictKind::healthy:
      return "HEALTHY";
    case VerdictKind::fault:
      return of_log(d) ? "MISREAD" : "FAULT";
    case VerdictKind::unknown:
      return "UNKNOWN";
  }
  return "";
}

std::vector<std::string> doubts_beside_baseline(const Diagnosis& d) {
  std::vector<std::string> out;
  for (const Note& note : d.assessment.notes)
    if (note.kind == Note::Kind::other_rig || note.kind == Note::Kind::own_log ||
        note.kind == Note::Kind::lacking_channels)
      out.push_back(note.text);
  return out;
}

std::string word_of(Blame blame) {
  switch (blame) {
    case Blame::none:
      return "none";
    case Blame::component:
      return "component";
    case Blame::physics:
      return "physics";
    case Blame::surroundings:
      return "surroundings";
    case Blame::log:
      return "log";
    case Blame::test:
      return "test";
  }
  return "";
}

std::string words_of(Blame blame) {
  switch (blame) {
    case Blame::none:
      return "";
    case Blame::component:
      return "a component failed";
    case Blame::physics:
      return "physics is missing in the model";
    case Blame::surroundings:
      return "a sensor, the supply or the driver is at fault";
    case Blame::log:
      return "the log or the rig file is to be mended: of the valve it says nothing until then";
    case Blame::test:
      return "this log does not tell: run another test";
  }
  return "";
}

std::string word_of(GrossFinding finding) {
  switch (finding) {
    case GrossFinding::spool_on_both_stops:
      return "spool_on_both_stops";
    case GrossFinding::spool_on_one_stop:
      return "spool_on_one_stop";
    case GrossFinding::no_response:
      return "no_response";
    case GrossFinding::none:
      break;
  }
  return "";
}

std::string words_of(GrossFinding finding) {
  switch (finding) {
    case GrossFinding::none:
      return "";
    case GrossFinding::spool_on_both_stops:
      return "spool on both stops at small current";
    case GrossFinding::spool_on_one_stop:
      return "spool on one stop at small current";
    case GrossFinding::no_response:
      return "the spool does not respond";
  }
  return "";
}

std::string word_of(Misreading kind) {
  switch (kind) {
    case Misreading::time_scale:
      return "time_scale";
    case Misreading::reversed:
      return "reversed";
    case Misreading::late:
      return "late";
    case Misreading::turned:
      return "turned";
    case Misreading::unit:
      return "unit";
    case Misreading::exchanged:
      return "exchanged";
  }
  return "";
}

std::string word_of(Unjudgeable reason) {
  switch (reason) {
    case Unjudgeable::no:
      return "";
    case Unjudgeable::nothing_asked:
      return "nothing_asked";
    case Unjudgeable::sensors_still:
      return "sensors_still";
    case Unjudgeable::command_missing:
      return "command_missing";
    case Unjudgeable::noise_alone:
      return "noise_alone";
    case Unjudgeable::command_too_large:
      return "command_too_large";
    case Unjudgeable::pressure_beyond_supply:
      return "pressure_beyond_supply";
    case Unjudgeable::position_beyond_travel:
      return "position_beyond_travel";
    case Unjudgeable::too_short:
      return "too_short";
    case Unjudgeable::pressures_out_of_order:
      return "pressures_out_of_order";
    case Unjudgeable::rows_jump:
      return "rows_jump";
    case Unjudgeable::copied:
      return "copied";
    case Unjudgeable::coarse:
      return "coarse";
    case Unjudgeable::oil_beyond:
      return "oil_beyond";
  }
  return "";
}

std::string reason_of(const Diagnosis& d) {
  switch (d.doubt) {
    case Doubt::none:
      return "";
    case Doubt::unjudgeable:
      return word_of(d.assessment.unjudgeable);
    case Doubt::misread:
      return d.assessment.reading ? word_of(d.assessment.reading->kind) : "";
    case Doubt::unrelated:
      return "unrelated";
    case Doubt::no_fault:
      return "no_fault_explains";
  }
  return "";
}

std::string words_of(const Reading& r) {
  std::vector<std::string> of;
  for (const Signal s : r.of) of.push_back("'" + std::string(name_of(s)) + "'");
  const std::string names = join(of), by = digits(r.factor, 4);
  switch (r.kind) {
    case Misreading::time_scale:
      return "with its time times " + by + ": look at the unit of time and the rate";
    case Misreading::reversed:
      return "with its rows the other way round, the last first";
    case Misreading::late:
      return fmt::format("with its sensors {} s {}: look at the recorders' clocks and triggers",
                         digits(std::abs(r.factor), 3), r.factor > 0 ? "earlier" : "later");
    case Misreading::turned:
      return "with the sign of " + names + " turned: look at the wiring and at the gain in the rig file";
    case Misreading::unit:
      return "with " + names + " times " + by + ": look at the unit and at the gain in the rig file";
    case Misreading::exchanged:
      return "with the columns of " + names + " exchanged: look at the plugs and at the names of the columns";
  }
  return "";
}

std::string words_of_doubt(const Diagnosis& d) {
  switch (d.doubt) {
    case Doubt::none:
      return "";
    case Doubt::unjudgeable:
      return words_of(d.assessment.unjudgeable);
    case Doubt::misread:
      return "it would be a healthy valve's " + (d.assessment.reading ? words_of(*d.assessment.reading) : "");
    case Doubt::unrelated:
      return "nothing that the valve could do moves as this log does: another test's, another valve's, or columns of "
             "something else";
    case Doubt::no_fault:
      return "not like the fault-free logs, and no known fault explains it";
  }
  return "";
}

std::string words_of(Unjudgeable reason) {
  switch (reason) {
    case Unjudgeable::no:
      return "";
    case Unjudgeable::nothing_asked:
      return "the command stands still: nothing is asked of the valve. Record a test that moves it";
    case Unjudgeable::sensors_still:
      return "every sensor shows one value while the command moves: no recording, no sensors, or another log's columns";
    case Unjudgeable::noise_alone:
      return "no channel knows its own last sample: noise, rows out of order, or columns of something else";
    case Unjudgeable::command_too_large:
      return "the command is a multiple of rated current: look at its unit and at valve.rated_current";
    case Unjudgeable::pressure_beyond_supply:
      return "the chambers are far above the supply: look at the pressures' units";
    case Unjudgeable::position_beyond_travel:
      return "spool or piston is far beyond its stops: look at the column's signal, unit and gain";
    case Unjudgeable::command_missing:
      return "the spool moves while the command stands still: look at the command's column and unit";
    case Unjudgeable::pressures_out_of_order:
      return "the pressures are not in the order return, chambers, supply: look at their columns, units and signs";
    case Unjudgeable::rows_jump:
      return "the piston is elsewhere from one row to the next: two records in one file, or rows out of order";
    case Unjudgeable::copied:
      return "two channels show the same values: one signal was recorded twice";
    case Unjudgeable::coarse:
      return "every channel that moves shows only a handful of values: look at the recorder's range and bits";
    case Unjudgeable::oil_beyond:
      return "no oil bears the temperature: look at its column and unit";
    case Unjudgeable::too_short:
      return "the log is shorter, or sampled more slowly, than a valve answers: look at the unit of time";
  }
  return "";
}

std::string label_of(const Fault* hypothesis) {
  return hypothesis ? std::string(hypothesis->name) : word_of(VerdictKind::healthy);
}

std::string name_of(const Diagnosis& d) { return d.fault ? label_of(d.fault) : word_of(d.verdict); }

std::string action_label_of(const Diagnosis& d) { return of_log(d) ? misread_label : name_of(d); }

std::string mistake_in_words(const Diagnosis& d) {
  const std::optional<SensorFinding> finding = sensor_finding_of(d);
  if (finding == SensorFinding::swapped_ports) return "the columns 'pressure_a' and 'pressure_b' are exchanged";
  if (finding != SensorFinding::turned) return "";
  return "the sign of '" + channel_of(d.faults.front()) + "' is turned: its column wants gain = \"-1\" in the rig file";
}

std::string meaning_of(const Fault* hypothesis) {
  return hypothesis ? std::string(hypothesis->meaning) : "as the fault-free logs, within every fault's tolerance";
}

std::string unit_of(const Fault* hypothesis) { return hypothesis ? std::string(hypothesis->unit) : ""; }

std::optional<double> error_of_null(const Diagnosis& d) {
  for (const MovedRow& p : d.moved)
    if (p.name == parameter_list[row::servovalve_null].name && std::isfinite(p.std_error)) return p.std_error;
  return std::nullopt;
}

std::string null_in_words(const Diagnosis& d) {
  const std::optional<double> error = error_of_null(d);
  return digits(100 * d.null, 2) + (error ? " +- " + digits(100 * *error, 1) : "") + " % of rated";
}

const HypothesisResult* result_of(const Diagnosis& d, const Fault* hypothesis) {
  for (const HypothesisResult& h : d.assessment.hypotheses)
    if (h.fault == hypothesis) return &h;
  return nullptr;
}

double probability_of(const Diagnosis& d, const Fault* hypothesis) {
  for (const FaultProbability& p : d.probabilities)
    if (p.of == hypothesis) return p.value;
  return 0;
}

std::map<std::string, double> labelled_probabilities(const Diagnosis& d) {
  std::map<std::string, double> out;
  for (const FaultProbability& p : d.probabilities) out[label_of(p.of)] = p.value;
  if (d.verdict == VerdictKind::unknown) out[word_of(d.verdict)] = 1.0;
  return out;
}

std::vector<const Fault*> ambiguous_by_label(const Diagnosis& d) {
  std::vector<const Fault*> out = d.ambiguous_with;
  std::sort(out.begin(), out.end(), [](const Fault* a, const Fault* b) { return label_of(a) < label_of(b); });
  return out;
}

std::vector<std::string> ambiguous_labels(const Diagnosis& d) {
  std::vector<std::string> out;
  for (const Fault* other : ambiguous_by_label(d)) out.push_back(label_of(other));
  return out;
}

namespace {

// The likeliest of what cannot be ruled out.
const Fault* rival_of(const Diagnosis& d) {
  return *std::max_element(d.ambiguous_with.begin(), d.ambiguous_with.end(),
                           [&](const Fault* a, const Fault* b) { return probability_of(d, a) < probability_of(d, b); });
}

// As `servodx plan` takes it: a fault that was fitted, at the size that was found.
std::string planned_fault(const Diagnosis& d, const Fault* fault) {
  const HypothesisResult* fitted = result_of(d, fault);
  if (!fitted || fitted->at_least || !std::isfinite(fitted->severity)) return label_of(fault);
  return fmt::format("{}={}", label_of(fault), digits(fitted->severity));
}

// Log, rig and table, as the calls that follow a verdict take them.
std::string given(const CallNames& names) {
  return "--params " + shell_word(names.table) + (names.rig.empty() ? "" : " --rig " + shell_word(names.rig));
}

std::string logs_of(const Diagnosis& d) {
  if (d.assessment.logs.empty()) return d.log.empty() ? "LOG" : shell_word(d.log);
  std::vector<std::string> words;
  for (const std::string& log : d.assessment.logs) words.push_back(shell_word(log));
  return join(words, " ");
}

}  // namespace

std::string separating_test_of(const Diagnosis& d, const CallNames& names) {
  if (!d.fault || d.ambiguous_with.empty()) return "";
  const Fault* rival = rival_of(d);
  // Only what a fit shows can be planned for. No test parts twins but a record that tells one of them.
  const bool twins = rival && (rival->twin == d.fault || d.fault->twin == rival);
  if (twins && rival->told_by) return std::string(rival->test);
  if (!result_of(d, d.fault) || (rival && !result_of(d, rival)) || twins) return std::string(d.fault->test);
  const std::string wish = rival ? "--between " + planned_fault(d, d.fault) + "," + planned_fault(d, rival)
                                 : "--faults " + planned_fault(d, d.fault);
  const std::string like = d.assessment.logs.empty() ? logs_of(d) : shell_word(d.assessment.logs.front());
  return "servodx plan " + wish + " " + given(names) + " --like " + like + " --seconds 2 -o command.csv";
}

std::vector<Candidate> candidates_of(const std::vector<HypothesisPrediction>& explanations) {
  std::vector<Candidate> out;
  for (const HypothesisPrediction& e : explanations) out.push_back({label_of(e.fault), e.candidate, e.from});
  return out;
}

std::string statement_of(const DetectionBaseline& b) {
  if (b.logs == 0) return "";
  std::string text = fmt::format(
      "{} fault-free logs promise a false-alarm rate of {:.1f} % on average over baselines (below {:.0f} % with 95 % "
      "confidence)",
      b.logs, 100 * b.promised, 100 * b.promised_95);
  if (!keeps_rate(b))
    text += fmt::format("; {:.3g} % takes {} logs, {} more", 100 * b.asked, b.logs_needed, b.logs_needed - b.logs) +
            mark_of(Trouble::few_logs);
  return text;
}

std::string chance_words(const Diagnosis& d) {
  std::string text = "p = " + digits(d.p_value, 2);
  if (d.baseline_logs > 0 && d.p_value * (d.baseline_logs + 1) < 1.5)
    text += fmt::format(", the least that {} log{} can show", d.baseline_logs, d.baseline_logs == 1 ? "" : "s");
  return text;
}

std::string size_words(const HypothesisResult& h) {
  return h.at_least ? "none of it seen"
                    : handy_interval(h.severity, h.severity_lower, h.severity_upper, unit_of(h.fault));
}

std::string size_words(const Diagnosis& d) {
  if (!d.fault || !std::isfinite(d.severity.value)) return "";
  const HypothesisResult* h = result_of(d, d.fault);
  if (h && h->at_least && h->severity == d.severity.value)
    return "at its least, " + handy(d.severity.value, unit_of(d.fault));
  return handy_interval(d.severity.value, d.severity.lower, d.severity.upper, unit_of(d.fault));
}

std::string record_in_words(const RecordFinding& f) {
  if (f.broken) {
    const std::string sensor = words(std::string(name_of(f.signal)));
    switch (*f.broken) {
      case SensorFinding::frozen:
        return sensor + " shows one value while the command moves: its sensor or its cable";
      case SensorFinding::turned:
        return sensor + " moves against the simulation: its sign";
      case SensorFinding::clipped:
        return sensor + " stays at one limit while the simulation goes beyond: its range, or the recorder's";
      case SensorFinding::swapped_ports:
        return sensor + " follows the other port's simulation: the two are swapped";
    }
  }
  const std::string unit(info(f.signal).si_unit);
  const auto beside = [&](double value, double usual) {
    return fmt::format("{}, on healthy logs {}", handy(value, unit), handy(usual, unit));
  };
  switch (*f.figure) {
    case FigureKind::supply_level:
      return "supply pressure at no flow " + beside(f.value, f.usual);
    case FigureKind::supply_step:
      return fmt::format("the supply pressure steps to {} of itself", digits(f.value));
    case FigureKind::supply_left:
      return fmt::format("at its largest flow the supply is left with {} of its pressure, on healthy logs with {}",
                         digits(f.value), digits(f.usual));
    case FigureKind::driver_gain:
      return fmt::format("the current that flows is {} of the command, on healthy logs {}", digits(f.value),
                         digits(f.usual));
    case FigureKind::driver_offset:
      return fmt::format("the current has an offset of {} of rated, on healthy logs of {}", percent(f.value - 1),
                         percent(f.usual - 1));
    case FigureKind::driver_left:
      return fmt::format("{} of the current does not follow the command, on healthy logs {}", percent(f.value),
                         percent(f.usual));
    case FigureKind::sensor_noise:
      return fmt::format("{} scatters by {}", words(std::string(name_of(f.signal))), beside(f.value, f.usual));
  }
  return "";
}

std::string channel_of(const NamedFault& fault) {
  return fault.fault && fault.fault->told_by == Record::sensor && fault.record
             ? std::string(name_of(fault.record->signal))
             : "";
}

std::string of_channel(const Diagnosis& d) {
  const std::string channel = d.faults.empty() ? "" : channel_of(d.faults.front());
  return channel.empty() ? "" : " of " + channel;
}

std::string second_in_words(const NamedFault& f) {
  return fmt::format("{}, {}, {}", label_of(f.fault), handy_interval(f.severity, f.lower, f.upper, unit_of(f.fault)),
                     chance(f.probability));
}

std::string suspicion_in_words(const Suspicion& s) {
  const std::string more = s.logs_needed > 0 ? fmt::format("{} healthy logs like these would tell", s.logs_needed)
                                             : "more healthy logs like these would not tell";
  return fmt::format(
      "first stands {}, {}, not beyond what {} fault-free logs can exclude: it would be said at a rate of {} false "
      "alarms; {}",
      words(label_of(s.fault)), handy_interval(s.severity, s.lower, s.upper, unit_of(s.fault)), s.logs, percent(s.rate),
      more);
}

std::string beyond_in_words(const BeyondFaults& b) {
  if (b.first.empty() && b.where.empty()) return "explain finds no cause either";
  if (b.first.empty()) return fmt::format("explain finds no name; most is missing at {}", words(b.where));
  const std::string what = b.depends_on.empty()
                               ? fmt::format("{} at {}", words(b.first), words(b.where))
                               : fmt::format("something at {} that follows {}", words(b.where), words(b.depends_on));
  const std::string removes =
      fmt::format("explain puts first {}: it removes {} of what is left", what, percent(b.share));
  return b.taken ? removes : removes + ", which healthy logs show too";
}

DetectableWords detectable_words(const Diagnosis& d) {
  DetectableWords out;
  for (const Detectable& f : d.detectable)
    if (f.severity)
      out.shown.push_back(fmt::format("{} from {}", words(label_of(f.fault)), handy(*f.severity, unit_of(f.fault))));
    else
      out.hidden.push_back(words(label_of(f.fault)));
  return out;
}

std::string test_words(const TestConditions& test) {
  std::string text =
      fmt::format("drive spans {} at about {} Hz", handy(test.drive_span, "A"), digits(test.drive_band, 2));
  if (test.temperature) text += fmt::format(", oil {} degC", std::lround(*test.temperature - zero_celsius));
  return text;
}

std::string unlike_words(const Diagnosis& d) {
  if (!d.unlike) return "";
  const Apart a = apart(d.assessment.test, d.unlike->test);
  std::vector<std::string> in;
  if (a.span) in.push_back("span");
  if (a.band) in.push_back("pace");
  if (a.oil > 0) in.push_back(fmt::format("oil by {:.1f} K", a.oil));
  return fmt::format("no log of the baseline is of a test like this ({}); the nearest, {}: {}{}",
                     test_words(d.assessment.test), file_name(d.unlike->log), test_words(d.unlike->test),
                     in.empty() ? "" : "; too far apart in " + join(in));
}

std::string compared_words(const Diagnosis& d) {
  if (d.repeats > 0) return fmt::format("{} fault-free repeats of its own test", d.repeats);
  if (d.others == 0) return "";
  return fmt::format(
      "{} fault-free log{} of other tests, as the baseline's own do not hold this one; they promise no rate", d.others,
      d.others == 1 ? "" : "s");
}

std::string shell_word(const std::string& text) {
  constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-+=,:@%";
  if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::vector<std::string> next_calls(const Diagnosis& d, const CallNames& names) {
  if (d.verdict != VerdictKind::unknown) return {};
  const std::string logs = logs_of(d) + " " + given(names);
  const std::string look = "servodx check-log " + logs;
  if (d.assessment.unjudgeable != Unjudgeable::no || blame_of(d) == Blame::log) return {look};
  return {look, "servodx explain " + logs + " --baseline " + shell_word(names.baseline) +
                    " -o extended.csv --report explain.html"};
}

MovedParts moved_parts(const Diagnosis& d) {
  MovedParts parts;
  for (const MovedRow& row : d.moved) (row.by == MovedRow::By::fault ? parts.fault : parts.health).push_back(row);
  for (auto* rows : {&parts.fault, &parts.health})
    std::stable_sort(rows->begin(), rows->end(), [](const auto& a, const auto& b) { return moved(a) > moved(b); });
  return parts;
}

}  // namespace servodx::report
