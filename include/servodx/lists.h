// What there is: faults, effects, rows, models and signals, from the registries that own them.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "servodx/log.h"

namespace servodx {

struct ListedFault {
  std::string name, unit, meaning;           // name: label of the verdict; unit: of its severities
  double healthy = 0, least = 0, worst = 0;  // [unit] nothing moves; the mildest that is called a fault; the worst
  std::string separating_test, action;
};
std::vector<ListedFault> listed_faults();

struct ListedEffect {
  struct Parameter {
    std::string name, unit, meaning;
    int id = 0;                                 // of a row among the 41; 0: a row that the effect adds
    double off = 0;                             // [unit] where the effect does nothing
    std::optional<double> lower, upper, start;  // [unit] of an effect with physics of its own
  };
  std::string name, where, meaning;
  bool of_table = false;  // acts by rows among the 41; else it has physics of its own
  std::vector<Parameter> parameters;
};
std::vector<ListedEffect> listed_effects();

struct ListedRow {
  int id = 0;  // 1 to 41
  std::string name, group, unit, meaning;
};
std::vector<ListedRow> listed_rows();

// The model that logs are fitted with.
struct ListedModel {
  std::string name, meaning;
  int states = 0, rows = 0;
};
ListedModel identification_model();
// Load pressure from spool position and load flow (servodx/map.h).
struct ListedMap {
  std::string name, meaning;
};
std::vector<ListedMap> listed_maps();

struct ListedSignal {
  Signal signal = Signal::time;
  std::string name, si_unit, accepted_units, meaning;
  bool simulated = false;  // the model reports it
};
std::vector<ListedSignal> listed_signals();

}  // namespace servodx
