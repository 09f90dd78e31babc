// The studies of the GA paper, "Analysis of diagnosis algorithm performance": what each repeats, and what it counts.
#pragma once
#include <string>

#include "diagnose/baseline.h"
#include "fit/error_model.h"
#include "parameters/table.h"
#include "servodx/diagnose.h"
#include "servodx/rig.h"
#include "signals/log.h"
#include "simulate/scenario.h"

namespace servodx::experiments {

// The shipped rig, a table tuned to four of its healthy logs, and a baseline of the others; made once, kept in `dir`.
struct Setup {
  std::string dir;
  RigFile rig;
  Table textbook, tuned;
  DetectionBaseline baseline;
  long most = 0;  // trials that a run may add; 0: all

  // Whether one more trial may begin.
  bool may() { return most == 0 || used++ < most; }
  long used = 0;
};
Setup make_setup(const std::string& dir);

Log shipped(const Setup& setup, const std::string& name);
// The log as the model would have written it, with the log's own noise on top.
Log written_by_model(const Setup& setup, const Log& like, const ParameterVector& truth, unsigned seed);

struct Judged {
  std::string name;     // the fault named, else the verdict
  double severity = 0;  // as found
  double score = 0;     // [deviates] from health
  long simulations = 0;
  double seconds = 0;
};
Judged judge(const Setup& setup, const Log& log, FaultSearch search, int population, unsigned seed);

void searches(Setup& setup);        // both searches on the shipped logs
void tune_up(Setup& setup);         // type 1: does a tune find a healthy valve's error floor?
void selection(Setup& setup);       // type 1: are the rows set aside those that are redundant?
void self_diagnosis(Setup& setup);  // type 1: faults that the model wrote itself
void recorded(Setup& setup);        // type 2: the virtual rig in the rig's place
void populations(Setup& setup);     // 50 individuals against 100
void rows_at_once(Setup& setup);    // rows freed at once against success
void large_faults(Setup& setup);    // how far apart parameter sets of one large fault lie

}  // namespace servodx::experiments
