#include "online/watched_model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "fit/tuned_state.h"
#include "servodx/data_sheet.h"
#include "signals/signal.h"

namespace servodx {

WatchedModel watched_model(const Table& tuned, const Rig& rig) {
  WatchedModel out;
  out.table = tuned;
  out.rig = rig;
  out.error = error_model_of(tuned);
  out.base = candidate_of(apply_rig_facts(tuned, rig));
  out.rated_current = rig.fact("valve.rated_current").value_or(out.rated_current);
  return out;
}

std::vector<Sample> samples_of(const Log& log) {
  std::vector<Sample> out(log.samples());
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].time = log.time[k];
    for (const SignalInfo& s : signal_list)
      if (s.signal != Signal::time && log.has(s.signal)) out[k][s.signal] = log[s.signal][k];
  }
  return out;
}

Log log_of(const std::string& name, const std::vector<Sample>& samples) {
  Log log;
  log.path = name;
  for (const Sample& s : samples) log.time.push_back(s.time);
  log.channels[static_cast<std::size_t>(index(Signal::time))].unit = std::string(1, 's');
  for (const SignalInfo& s : signal_list) {
    if (s.signal == Signal::time) continue;
    const auto present =
        std::count_if(samples.begin(), samples.end(), [&](const Sample& x) { return !std::isnan(x[s.signal]); });
    if (static_cast<double>(present) < (1 - missing_limit) * static_cast<double>(samples.size()) || present == 0)
      continue;
    Channel& c = log.channels[static_cast<std::size_t>(index(s.signal))];
    for (const Sample& x : samples) c.value.push_back(x[s.signal]);
    c.unit = std::string(s.si_unit);
    c.missing = samples.size() - static_cast<std::size_t>(present);
    c.column = std::string(s.name);
  }
  log.sha256 = content_hash(log);
  return log;
}

}  // namespace servodx
