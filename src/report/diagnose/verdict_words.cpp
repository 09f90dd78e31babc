#include "report/diagnose/verdict_words.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "servodx/actions.h"
#include "servodx/log.h"

namespace servodx::report {

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
      return "this log does not decide it: run another test";
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

std::string meaning_of(const Fault* hypothesis) {
  return hypothesis ? std::string(hypothesis->meaning) : "as the fault-free logs, within every fault's tolerance";
}

std::string unit_of(const Fault* hypothesis) { return hypothesis ? std::string(hypothesis->unit) : ""; }

}  // namespace servodx::report
