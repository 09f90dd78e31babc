#include "report/diagnose/diagnosis_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/celsius.h"
#include "base/trouble.h"
#include "diagnose/assessment.h"
#include "diagnose/baseline.h"
#include "diagnose/blame.h"
#include "diagnose/broken_sensors.h"
#include "diagnose/decide.h"
#include "diagnose/judge.h"
#include "diagnose/moved.h"
#include "diagnose/naming.h"
#include "diagnose/record_figures.h"
#include "diagnose/record_law.h"
#include "evidence/conditions.h"
#include "faults/fault.h"
#include "faults/record.h"
#include "parameters/list.h"
#include "report/diagnose/verdict_words.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/replay_part.h"
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

std::vector<std::string> doubts_beside_baseline(const Diagnosis& d) {
  std::vector<std::string> out;
  for (const Note& note : d.assessment.notes)
    if (note.kind == Note::Kind::other_rig || note.kind == Note::Kind::own_log ||
        note.kind == Note::Kind::lacking_channels)
      out.push_back(note.text);
  return out;
}

std::string mistake_in_words(const Diagnosis& d) {
  const std::optional<SensorFinding> finding = sensor_finding_of(d);
  if (finding == SensorFinding::swapped_ports) return "the columns 'pressure_a' and 'pressure_b' are exchanged";
  if (finding != SensorFinding::turned) return "";
  return "the sign of '" + channel_of(d.faults.front()) + "' is turned: its column wants gain = \"-1\" in the rig file";
}

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
  const std::string more = s.logs_needed > 0 ? fmt::format("{} healthy logs like these would decide it", s.logs_needed)
                                             : "more healthy logs like these would not decide it";
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

MovedParts moved_parts(const Diagnosis& d) {
  MovedParts parts;
  for (const MovedRow& row : d.moved) (row.by == MovedRow::By::fault ? parts.fault : parts.health).push_back(row);
  for (auto* rows : {&parts.fault, &parts.health})
    std::stable_sort(rows->begin(), rows->end(), [](const auto& a, const auto& b) { return moved(a) > moved(b); });
  return parts;
}

}  // namespace servodx::report
