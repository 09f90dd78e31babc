// What each hypothesis leaves of what moves in a log (motion.h), in the part of the log that it speaks of.
#pragma once
#include <vector>

#include "diagnose/assessment.h"
#include "diagnose/broken_sensors.h"
#include "faults/fault.h"
#include "fit/log_data.h"
#include "simulate/scenario.h"

namespace servodx {

struct MotionByHypothesis {
  struct Left {
    const Fault* by = nullptr;  // null: health
    double part = 0;            // of the motion
  };
  std::vector<Left> left;
  double others = 0;  // by the tuned valve, of the sensors that are not broken
};
// `base`: the tuned candidate.
MotionByHypothesis motion_by_hypothesis(const LogData& data, const ParameterVector& base,
                                        const std::vector<HypothesisPrediction>& predictions,
                                        const std::vector<BrokenSensor>& broken, int threads);
// Of several logs of one state: the mean over them.
MotionByHypothesis motion_by_hypothesis(const std::vector<LogData>& data, const ParameterVector& base,
                                        const std::vector<HypothesisPrediction>& predictions,
                                        const std::vector<BrokenSensor>& broken, int threads);

}  // namespace servodx
