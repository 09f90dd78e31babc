#include "diagnose/records.h"

#include <utility>

#include "diagnose/flow_into_chambers.h"
#include "diagnose/whitening.h"
#include "fit/log_data.h"
#include "signals/usual_step.h"

namespace servodx {

RecordsOfLogs look_at_records(const std::vector<Log>& logs, const ReadyLogs& ready, const ParameterVector& base,
                              const RigFile& rig, int threads) {
  RecordsOfLogs out;
  for (std::size_t l = 0; l < logs.size(); ++l) {
    const LogData& data = ready.every_sample(l);
    for (RecordFigure& f : record_figures(logs[l], data, base)) out.figures.push_back(std::move(f));
    std::vector<BrokenSensor> broken = broken_sensors(data, reference_of(data, base, threads));
    if (names_exchanged_ports(broken))
      broken = beside_flow(std::move(broken), chambers_by_flow(logs[l], rig, 1 / usual_step(logs[l].time)));
    out.broken.insert(out.broken.end(), broken.begin(), broken.end());
    out.current_recorded = out.current_recorded && data.scenario.current_measured;
  }
  return out;
}

std::vector<RecordFigure> driver_figures(const std::vector<Log>& logs, const ReadyLogs& ready) {
  std::vector<RecordFigure> out;
  for (std::size_t l = 0; l < logs.size(); ++l)
    for (RecordFigure& f : driver_figures(logs[l], ready.every_sample(l))) out.push_back(std::move(f));
  return out;
}

}  // namespace servodx
