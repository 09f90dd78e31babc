// What a log is watched by: the tuned valve, and how wrong its model is.
#pragma once
#include <map>
#include <vector>

#include "fit/error_model.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "signals/sample.h"
#include "simulate/scenario.h"

namespace servodx {

struct WatchedModel {
  Table table;
  Rig rig;
  ErrorModel error;
  ParameterVector base;                 // the tuned candidate
  double rated_current = 0.02;          // [A]
  std::map<Signal, double> noise = {};  // [SI] rms of the sensors, of healthy logs
};

WatchedModel watched_model(const Table& tuned, const Rig& rig);

// Samples [from, to) of a log, one by one.
std::vector<Sample> samples_of(const Log& log);
// The other way: a log of the signals that any sample has.
Log log_of(const std::string& name, const std::vector<Sample>& samples);

}  // namespace servodx
