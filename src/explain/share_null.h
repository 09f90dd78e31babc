// How large a share of its held-out misfit a cause removes from a healthy log, cause by cause.
//
// Some causes gain a little on most healthy logs, as the gain of a sensor does; others on none. So a share is measured
// against the usual one of its own cause: -ln(1 - share), over its mean on the healthy logs. Few logs say little of a
// mean, so it begins from the cause's mean on healthy logs of other valves (usual_excess.h). The largest of these
// ratios over all causes is what a log is compared by, so the search over many causes is part of the null. A healthy
// log's own ratios stand beside the means of the others. Ratios follow the tail law of evidence/tail_law.h. Before all
// this a share stands over the scale of its oil (evidence/excess_trend.h).
#pragma once
#include <map>
#include <string>
#include <vector>

#include "evidence/excess_trend.h"
#include "evidence/tail_law.h"

namespace servodx {

// Of one healthy log.
struct SharesOfLog {
  std::map<std::string, double> of_effect;  // the larger of several places; a cause that is missing removed nothing
  double thickness;                         // ln of the viscosity of its oil; NaN: not known
};

using Excesses = std::map<std::string, double>;  // by effect; -ln(1 - share), over the scale of the log's oil [-]

// What is usual of each cause: its mean over the logs, and over a few of its mean on other valves (usual_excess.h).
class UsualExcesses {
 public:
  explicit UsualExcesses(const std::vector<Excesses>& healthy);
  double of(const std::string& effect) const;
  // Largest excess of one of these logs over what the others say is usual of its cause; 0: it has none.
  double largest_ratio(const Excesses& one_of_them) const;

 private:
  Excesses sum_;
  double logs_;
};

class ShareNull {
 public:
  // `thickness` of the suspects' oil; NaN: every healthy log speaks alike.
  ShareNull(const std::vector<SharesOfLog>& healthy, double thickness);
  int logs() const { return law_.logs(); }
  // Chance that some cause of one more healthy log is as far above what is usual of it.
  double chance(const std::string& effect, double share) const { return law_.chance(ratio(effect, share)); }
  // Healthy logs that it takes until that is at most the rate that they can promise (TailLaw::logs_needed).
  int logs_needed(const std::string& effect, double share, double asked) const;

 private:
  ShareNull(const std::vector<SharesOfLog>& healthy, double thickness, const ExcessTrend& trend);
  ShareNull(const std::vector<Excesses>& healthy, double scale);
  double ratio(const std::string& effect, double share) const;

  double scale_;  // mean excess in oil like the suspects' over that of all healthy logs
  UsualExcesses usual_;
  TailLaw law_;  // of the healthy logs' largest ratios
};

}  // namespace servodx
