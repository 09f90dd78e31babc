// Whether a log would be the tuned valve's, were it read otherwise: its time in another unit, its rows backwards, its
// sensors late, a sign turned, a unit mistaken, columns exchanged.
//
// Each mistake is a hypothesis without a free number: the log is read as it would have to be, the tuned valve is run on
// it, and what it leaves of the motion (diagnose/motion.h) is set beside what it and every fault leave of the log as it
// was read. A fault that explains the log as read leaves less than a mistaken healthy log may.
//
// Limits: one mistake at a time, of a healthy valve; units that are in use.
#pragma once
#include <optional>
#include <vector>

#include "diagnose/judgeable.h"
#include "fit/error_model.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "simulate/scenario.h"

namespace servodx {

enum class Misreading {
  time_scale,  // of the unit of time, or of the rate
  reversed,    // the last row first
  late,        // the sensors beside the command
  turned,      // a sign
  unit,
  exchanged,  // columns
};

struct Reading {
  Misreading kind = Misreading::unit;
  double factor = 1;              // that the numbers are to be multiplied by; of sensors that are late their lag [s]
  std::vector<Signal> of = {};    // the signals meant; all sensors that are late
  std::vector<Signal> from = {};  // of exchanged columns: where the signals of `of` stand
  double left = 1;                // of the motion, once it is read so
};

// The log as that reading has it.
Log read_as(const Log& log, const Reading& reading);

struct ReadingTrial {
  const Table& tuned;
  const RigFile& rig;
  const ErrorModel& error;
  int threads = 0;
};
// What the tuned valve leaves of the log as it was read.
double left_as_read(const Log& log, const ReadingTrial& trial);
// The reading that leaves least. Of a log that cannot be judged, only readings that would mend that.
std::optional<Reading> best_reading(const Log& log, Unjudgeable unjudgeable, const ReadingTrial& trial);

}  // namespace servodx
