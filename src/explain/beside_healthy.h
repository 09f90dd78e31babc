// Whether what a log shows is news beside healthy logs: the tests that a reference answers.
//
// Over the healthy logs a cause's sizes scatter beyond their standard errors (size_scatter.h). A new log's size is news
// where it lies outside what that predicts, by Student's t. With n logs no distribution-free test can promise less than
// 1/(n + 1); the tail beyond is an assumption, and the result says so.
//
// Sizes scatter widely where a test hardly shows a cause, and then no size is news. So a log is also looked at whole:
// if a block of the model or a channel misses more than healthy logs do, something is new whatever its name.
#pragma once
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "explain/blocks.h"
#include "explain/healthy.h"
#include "explain/share_null.h"
#include "explain/subject.h"

namespace servodx {

class HealthyTest {
 public:
  // `thickness` of the suspects (Subject::thickness): shares that follow the oil are judged at theirs. Not
  // known: every healthy log speaks alike.
  explicit HealthyTest(const HealthyReference& reference, double thickness = std::nan(""));
  // Chance that healthy logs show sizes like these of this cause, a score each log; 1 where fewer than three healthy
  // logs speak of it. Logs of one state share its oil and its day: over them only the noise averages out, and not what
  // else scatters from one healthy log to another. Tails that are longer than Student's are learnt: a cause's own
  // chances on the healthy logs, each beside the others, say how far its chances can be believed. A rare cause has its
  // share of the false alarms and no more: its chance counts over its prior (Genovese et al. 2006).
  double alone(const std::vector<HealthyScore>& logs) const;
  // The same with all causes counted together: how small the smallest of a healthy log's chances is, is learnt from the
  // healthy logs themselves, each against the others: -ln(1 - p) is taken as exponential, its predictive is Lomax's. A
  // cause that held-out data of that log refuse is not counted, as no suspect is accused by such a one.
  double together(double alone) const;
  // How far a size of this cause lies from none on healthy logs, and what a log with this standard error scatters
  // beyond it: root of the sum of squares; 0 where fewer than three speak of it. [of the probe]
  double spread(const HealthyScore& of, std::size_t probe) const;
  // Chance that a part misses as much in a healthy log; 1 where fewer than three speak of it.
  double miss(const Miss& part) const;
  // Of shares of the held-out misfit.
  const ShareNull& shares() const { return shares_; }
  // That any of these parts does, by Bonferroni.
  double any(const std::vector<Miss>& parts) const;

 private:
  struct OfCause {
    std::vector<const HealthyScore*> score;  // [healthy log] null: it does not speak of the cause
    std::vector<double> surprise;            // [healthy log] -ln of its chance by Student's law beside the others
  };
  const OfCause* of(const HealthyScore& cause) const;
  double by_law(const OfCause& cause, const std::vector<HealthyScore>& logs, int left_out) const;
  double believed(const OfCause& cause, double surprise, int left_out, double prior) const;
  const HealthyReference& reference_;
  std::map<std::pair<std::string, std::string>, OfCause> causes_;
  ShareNull shares_;
  std::vector<double> smallest_;  // [healthy log] of its chances beside the others
};

}  // namespace servodx
