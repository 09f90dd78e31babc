// The simulation beside a log that grows: what is measured less what a healthy valve would show, in deviates.
//
// A deviate is the sensor's noise and what the tuned model is known to err by (fit/error_model.h). The simulated piston
// is drawn to the measured one below 1 Hz: it integrates every error of flow, and a run of hours would drift away. The
// driver is compared too, where command and coil current are both recorded: it has no simulation, but a lag.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <vector>

#include "online/watched_model.h"
#include "servodx/log.h"
#include "servodx/stepper.h"
#include "signals/sample.h"

namespace servodx {

struct Residual {
  double time = 0;            // [s]
  bool comparable = false;    // not while the run settles, nor right after a gap
  std::vector<double> value;  // [deviates] of each channel; NaN: not measured
};

class Residuals {
 public:
  Residuals(const WatchedModel& model, const std::vector<Signal>& recorded);
  // One a signal that is compared. `coil_current` stands for the driver.
  const std::vector<Signal>& channels() const { return channels_; }

  // The next samples, in the order of their time. The result is valid until the next call.
  std::span<const Residual> take(std::span<const Sample> part);
  long restarts() const { return restarts_; }

  nlohmann::json state() const;
  // Where the simulation's own state is another program's it begins anew: false then.
  bool resume(const nlohmann::json& state);

 private:
  void begin(std::span<const Sample> part);
  void compare(std::size_t at, const Sample& sample, double dt, Residual& to);
  double sigma_of(std::size_t channel, double shown, double dt);
  double driver_residual(const Sample& sample, double dt);
  void draw_rod(std::span<const Sample> part, double seconds);
  bool records(Signal s) const;

  const WatchedModel& model_;
  std::vector<Signal> recorded_, channels_;
  bool by_current_ = false;  // the coil current drives the model
  StepperOptions options_;
  std::optional<Stepper> stepper_;
  std::vector<Residual> out_;
  std::vector<StepperInputs> inputs_;
  struct Memory {
    double shown = 0, activity = 0;
    bool begun = false;
  };
  std::vector<Memory> memory_;  // of each channel
  double last_time_ = -1e300, last_command_ = 0, driver_current_ = 0;
  double usual_step_ = 0, unknown_until_ = -1e300, settled_from_ = 1e300;  // [s]
  long restarts_ = -1;                                                     // the first is a start
};

}  // namespace servodx
