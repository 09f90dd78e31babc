// The oil's temperature of a log: measured, or estimated from how the valve answered, or taken for the reference's.
//
// The estimate: a healthy model is fitted, its nuisances alone, at oils from -40 to 100 degC in steps of 10 degC; the
// posterior over this grid is flat before and Gaussian in the misfit. Limits: wear that acts like cold oil shifts it;
// nothing between two steps is tried, and the error says no less than the spread of a step.
#pragma once
#include <functional>
#include <vector>

#include "fit/log_data.h"
#include "parameters/table.h"
#include "servodx/rig.h"

namespace servodx {

enum class OilSource { given, estimated, assumed };
const char* name_of(OilSource source);  // as a history keeps it

struct OilTemperature {
  double value = 0, std_error = 0;  // [K]
  OilSource source = OilSource::given;
};

// `simulations` counts on. `told`: what part is done. `stop`: true, and what comes back is of no use.
OilTemperature estimate_temperature(const LogData& log, const Table& tuned, const RigFile& rig, int threads,
                                    long* simulations, const std::function<void(double part)>& told = {},
                                    const std::function<bool()>& stop = {});

}  // namespace servodx
