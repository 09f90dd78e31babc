// What might be missing of a valve's model: every effect of the registry, the effects that are rows, sensors and mains
// pick-up channel by channel, and every row that was held.
//
// Which of them are sought, over which range and from which sizes on, follows from the facts below; no fit is asked.
#pragma once
#include <cstddef>
#include <optional>
#include <set>
#include <vector>

#include "effects/effect.h"
#include "effects/registry.h"
#include "explain/sought_cause.h"
#include "fit/log_data.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "simulate/scenario.h"

namespace servodx {

// What decides of the causes. Refers to the tuned table and its candidate.
struct CauseFacts {
  const Table& table;
  const ParameterVector& tuned;                // the table's values
  bool rig_known = false;                      // healthy logs say what is usual of this rig
  std::optional<double> mains_frequency = {};  // [Hz] none: not stated
  // Of the logs.
  std::size_t logs = 1;
  std::set<Signal> compared = {};                         // by one log at least
  bool on_stand = false;                                  // one at least is of a valve on a test stand
  bool oil_known = true;                                  // in all of them
  bool supply_measured = false, return_measured = false;  // in all of them
};
CauseFacts cause_facts(const std::vector<LogData>& logs, const Table& table, const ParameterVector& tuned,
                       const RigFile& rig, bool rig_known);

// `nothing` where these logs could not tell the effect.
SoughtAs sought_as(const EffectInfo& effect, const CauseFacts& facts);
// What is of the construction is there from the first day or never: in a rig's healthy logs as well, and no likely
// news.
double prior_of_effect(const EffectInfo& effect, bool rig_known);
// By itself: no row effect has it, it has a range, and it is neither measured nor a log's own.
bool is_sought_alone(int at, const CauseFacts& facts);

std::vector<SoughtCause> valve_causes(const CauseFacts& facts);

}  // namespace servodx
