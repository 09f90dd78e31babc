// What a log says of each hypothesis, before any threshold.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "diagnose/broken_sensors.h"
#include "diagnose/hypotheses.h"
#include "diagnose/judgeable.h"
#include "diagnose/moved.h"
#include "diagnose/reading.h"
#include "diagnose/record_figures.h"
#include "diagnose/visible.h"
#include "evidence/conditions.h"
#include "faults/fault.h"
#include "faults/gross_finding.h"
#include "optimise/search_stop.h"
#include "servodx/note.h"
#include "servodx/operating_point.h"
#include "servodx/tune.h"
#include "simulate/scenario.h"
#include "tune/tune.h"

namespace servodx {

struct HypothesisResult {
  const Fault* fault = nullptr;                                 // null: healthy
  double misfit = 0;                                            // penalised -2 log likelihood
  double gain = 0;                                              // misfit of healthy less this one
  double probability = 0;                                       // by `judge`
  double severity = 0, severity_lower = 0, severity_upper = 0;  // [the fault's unit] 95 %
  double adequacy = 0;               // whitened rms of the worst channel, 1 when like the healthy logs
  std::vector<SearchStop> stops;     // how each start ended
  bool at_worst = false;             // at the far end of the range that was searched
  bool at_least = false;             // at the mildest that is called this fault: the fit has found none of it
  double null = 0;                   // [fraction of rated]
  std::vector<double> shapes = {};   // of the fault, in its order
  std::vector<MovedRow> moved = {};  // the fault's rows first
  double motion_left = 0;            // of the log's motion (diagnose/motion.h)
};

// A second fault beside a first.
struct PairResult {
  FaultSize first, second;
  double misfit = 0;
  double gain = 0;       // over the best single fault, less what the model's error may lend a second one
  double of_effect = 0;  // that gain before the allowance, of what both together gain over health
  double adequacy = 0;   // as a hypothesis'
};

// What a hypothesis says the log should be.
struct HypothesisPrediction {
  const Fault* fault = nullptr;  // null: healthy
  ParameterVector candidate = {};
  std::size_t from = 0;  // first sample it speaks of: a fault that steps in explains what follows
};

struct Assessment {
  std::string log, sha256, content;          // of several, joined; content_hash
  std::vector<std::string> logs;             // paths
  std::vector<HypothesisResult> hypotheses;  // healthy first; `judge` weighs and orders the faults
  double misfit_scale = 1;                   // tempers their probabilities (evidence/probabilities.h)
  std::vector<PairResult> pairs;             // the best first; empty where no fault gains beyond doubt
  std::vector<VisibleFault> visible;         // what each fault would have gained, as the gains of `hypotheses`
  std::vector<ChannelResult> channels;       // replay under health: rms beside noise
  GrossFinding gross = GrossFinding::none;
  Unjudgeable unjudgeable = Unjudgeable::no;       // of several logs, of the first that is
  std::optional<Reading> reading;                  // of one log: what would leave least of its motion, read so
  std::optional<double> onset;                     // [s] change point where one stands out
  std::vector<HypothesisPrediction> explanations;  // of each hypothesis that could be fitted
  std::vector<TestConditions> tests;   // of each log
  TestConditions test;                 // that judges: of several logs, by `judge`, the one least like the baseline's
  std::vector<OperatingPoint> points;  // where each log was recorded
  OperatingPoint sheet = {};           // what the rig file says of it
  std::vector<RecordFigure> figures;      // of the records alone
  std::vector<BrokenSensor> broken;
  double others_left = 0;  // of the motion of the sensors that are not broken, by the tuned valve
  bool current_recorded = false;
  std::vector<Note> notes;
  long simulations = 0, failed_simulations = 0;
};

}  // namespace servodx
