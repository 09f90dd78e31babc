// Is a tune good enough to diagnose with? Decided from what the tune and its logs know.
//
// Five questions. Does the model follow the logs: where a channel is left far beyond its noise (tune/summary.h) the
// answer is no, and where it is left yet further the data sheet is another rig's. Does it predict what
// it was not fitted to: of the median log the error on the held-out part against the fitted error, at most twice, as a
// diagnosis lets a hypothesis leave twice the usual error and no more (judge); single logs that are predicted worse are
// named, for they have no like among the others. Does it keep to the data sheet: a stated size at the end of its range
// does duty for something else. Did the search arrive: its end, and a second start in the same valley.
// And would a fault be seen: each at its typical size on the log of these that shows it best, against the errors that
// the table now says its model makes (check-log's deviates; below 3 it stays hidden).
#pragma once
#include <cstddef>
#include <vector>

#include "optimise/box_least_squares.h"
#include "servodx/log.h"
#include "tune/tune.h"

namespace servodx {

enum class Trust { yes, with_care, no };

// Why not, or not quite; in the order in which they are told.
enum class TrustDoubt {
  interrupted,     // the tune
  unfollowed,      // a channel is left far beyond its noise: alone a no
  another_sheet,   // one is left so far that the data sheet is another rig's
  off_drawing,     // a size that the data sheet states stands at the end of its range
  predicts_worse,  // than it fits
  not_arrived,     // the search
  lone_valley,     // no second start reached the best one
  hidden_faults    // even at typical size
};

struct TrustEvidence {
  struct Prediction {
    std::size_t log = 0;
    double over_fitted = 0;  // error on the held-out part over the fitted one
  };
  struct Channel {
    Signal signal = Signal::time;
    double error = 0, noise = 0;  // [SI] fitted, of all logs; of the sensor, 0 where it is not known
    std::vector<Prediction> logs = {};
  };
  // Deviates on the log that shows the fault best.
  struct Fault {
    double at_least = 0, at_typical = 0;
  };
  bool interrupted = false;
  bool unfollowed = false, off_drawing = false;  // anything is
  std::vector<Channel> channels = {};
  StopReason stop = StopReason::converged;  // of the last fit
  double cost = 0, still_promised = 0;      // of it; infinite where it had no derivatives
  std::size_t starts = 0;
  int in_best_valley = 0;          // of the starts
  std::vector<Fault> faults = {};  // empty: nothing is said of faults
};

// `faults`: on logs like these, with the tuned table.
TrustEvidence evidence_of(const TuneResult& result, std::vector<TrustEvidence::Fault> faults);

struct TrustVerdict {
  struct Times {
    Signal signal = Signal::time;
    double times = 0;
  };
  struct Exception {
    Signal signal = Signal::time;
    std::size_t log = 0;
    double times = 0;
  };
  Trust trust = Trust::yes;
  std::vector<TrustDoubt> doubts;
  std::vector<Times> beyond_noise;    // fitted error over noise, where the sheet is another rig's
  std::vector<Times> worse;           // held-out over fitted error of the median log, where it predicts worse
  std::vector<Exception> exceptions;  // single logs that are predicted worse than fitted
  std::vector<std::size_t> hidden;    // faults that stay hidden at typical size on every log
  std::vector<std::size_t> faint;     // that show then, and hide at the mildest that is called the fault
};

TrustVerdict trust_in(const TrustEvidence& evidence);

}  // namespace servodx
