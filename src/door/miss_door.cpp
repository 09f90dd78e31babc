// The front door of what a tune does not follow.
#include <cstddef>

#include "door/stands_first.h"
#include "explain/explain.h"
#include "fit/tuned_state.h"
#include "servodx/diagnose.h"
#include "servodx/explain.h"
#include "servodx/log.h"
#include "servodx/miss.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "tune/tune.h"

namespace servodx {
namespace {

// The log that the tune follows worst, of the channels that it does not follow.
const Log& worst_of(const std::vector<Log>& logs, const TuneResult& result) {
  std::size_t worst = 0;
  double most = 0;
  for (std::size_t l = 0; l < logs.size(); ++l)
    for (const ChannelResult& c : result.logs[l].channels)
      for (const Unfollowed& u : result.unfollowed)
        if (c.signal == u.signal && c.rms / c.noise_rms > most) most = c.rms / c.noise_rms, worst = l;
  return logs[worst];
}

}  // namespace

std::optional<Verdict::Beyond> likeliest_miss(const std::vector<Log>& logs, const Tuned& tuned, const Rig& rig,
                                              const ExplainOptions& options) {
  options.validate();
  if (!tuned.whole || tuned.whole->unfollowed.empty() || options.watch.stopped()) return {};
  const Explanation e = explain({worst_of(logs, *tuned.whole)}, tuned, rig, options);
  if (e.interrupted) return {};
  return stands_first(*e.whole);
}

}  // namespace servodx
