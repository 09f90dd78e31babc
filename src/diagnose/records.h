// What the records of a valve's logs say by themselves, all logs together: the figures of each (record_figures.h), and
// the sensors that no healthy valve can explain (broken_sensors.h).
#pragma once
#include <vector>

#include "diagnose/broken_sensors.h"
#include "diagnose/ready_logs.h"
#include "diagnose/record_figures.h"
#include "parameters/table.h"
#include "servodx/rig.h"
#include "signals/log.h"
#include "simulate/scenario.h"

namespace servodx {

// Of several logs each log's; the worst stands out among all.
struct RecordsOfLogs {
  std::vector<RecordFigure> figures;
  std::vector<BrokenSensor> broken;
  bool current_recorded = true;  // in every log
};
// `logs` and `ready` are the same logs in the same order.
RecordsOfLogs look_at_records(const std::vector<Log>& logs, const ReadyLogs& ready, const ParameterVector& base,
                              const RigFile& rig, int threads);
// The figures of the driver alone, of logs in which nothing else can be judged.
std::vector<RecordFigure> driver_figures(const std::vector<Log>& logs, const ReadyLogs& ready);

}  // namespace servodx
