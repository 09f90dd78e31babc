// Measuring chains of a rig: first-order lag, gain, offset, mains pick-up, white noise, rounding to the quantum of the
// log column.
// Limits: noise is white to half the sample rate; pick-up is a sine at mains frequency; no drift.
#pragma once
#include <cstdint>

#include "base/random.h"
#include "base/units.h"
#include "rig/rig_model.h"
#include "rig/virtual_rig.h"
#include "signals/log.h"

namespace servodx::rig {

// What the sensors see beside the rig's state.
struct Seen {
  double load_force = 0.0;   // [N]
  double temperature = 0.0;  // [K]
};

class SensorChain {
 public:
  // `stream` separates the sensors' noise; `signal` must be one the rig can measure, else InputError.
  SensorChain(const Sensor& sensor, std::uint64_t seed, std::uint32_t stream, double mains_frequency = 50.0);
  void reset(const VirtualRig& rig, const Seen& seen);             // lag settled
  void follow(const VirtualRig& rig, const Seen& seen, double h);  // after each step
  double read();                                                   // [SI] the next sample, as the log shows it
  Signal signal() const { return signal_; }
  const std::string& unit() const { return sensor_.unit; }

 private:
  double truth(const VirtualRig& rig, const Seen& seen) const;
  Sensor sensor_;
  Signal signal_;
  const Unit* unit_;
  Random random_;
  double mains_, phase_ = 0.0, time_ = 0.0;
  double input_ = 0.0, output_ = 0.0, h_ = 0.0, keep_ = 0.0;
};

double rounded(double shown, double quantum);  // to a multiple of the quantum, with the quantum's decimals

}  // namespace servodx::rig
