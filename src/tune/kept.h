// What a checkpoint keeps of a tune's stages, field by field (base/bytes.h), and the stages' inputs.
#pragma once
#include <string>
#include <tuple>
#include <vector>

#include "base/bytes.h"
#include "base/stages.h"
#include "fit/fit_work.h"
#include "fit/identifiability.h"
#include "optimise/box_least_squares.h"
#include "optimise/ceres_refinement.h"
#include "optimise/local.h"
#include "optimise/search_stop.h"
#include "optimise/unit_cube.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "tune/screen.h"
#include "tune/tune.h"

namespace servodx {

inline auto fields(Stage& s) {
  auto& [kind, start] = s;
  return std::tie(kind, start);
}
inline auto fields(ConvergencePoint& p) {
  auto& [stage, simulations, cost] = p;
  return std::tie(stage, simulations, cost);
}
inline auto fields(StageResult& r) {
  auto& [stage, by, before, after, simulations, jacobians, seconds, heldout] = r;
  return std::tie(stage, by, before, after, simulations, jacobians, seconds, heldout);
}
inline auto fields(CeresSummary& c) {
  auto& [end, solves, steps, refused, released, jacobians, learnt, evaluations, initial, final] = c;
  return std::tie(end, solves, steps, refused, released, jacobians, learnt, evaluations, initial, final);
}
inline auto fields(ScreenedRow& r) {
  auto& [name, verdict, confounded_with, effect] = r;
  return std::tie(name, verdict, confounded_with, effect);
}
inline auto fields(EarnedEffect& e) {
  auto& [effect, gain, kept] = e;
  return std::tie(effect, gain, kept);
}

// A local search. Of its rows nothing is needed beyond it.
struct KeptSearch {
  Point point;
  double cost = 0, misfit = 0, promised_gain = 0;
  StopReason reason = StopReason::start_failed;
  SearchStop stop;
  CeresSummary ceres;
  Distrust distrust = Distrust::none;
  std::vector<ConvergencePoint> convergence;
  std::vector<StageResult> stages;
  FitWork work;
};
inline auto fields(KeptSearch& s) {
  auto& [point, cost, misfit, promised, reason, stop, ceres, distrust, convergence, stages, work] = s;
  return std::tie(point, cost, misfit, promised, reason, stop, ceres, distrust, convergence, stages, work);
}

// A genetic search after one of its generations.
struct KeptGeneration {
  std::string state;  // optimise/genetic_state.h
  std::vector<ConvergencePoint> convergence;
  FitWork work;
};
inline auto fields(KeptGeneration& g) {
  auto& [state, convergence, work] = g;
  return std::tie(state, convergence, work);
}

// The stages of a tune: what goes into all of them. How many generations, rounds and profiles are asked for goes into
// those that it concerns, so that a checkpoint serves a call that asks for more.
Stages stages_of_tune(const std::vector<Log>& logs, const Table& nominal, const RigFile& rig,
                      const TuneOptions& options);

}  // namespace servodx
