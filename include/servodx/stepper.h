// The simulation step by step: for a log that grows, a control loop, a replay that goes its own way.
//
// Inputs come sample by sample; what the sensors would show comes back. The same bits as a run over the whole log, in
// whatever parts it comes. The state is a text: a stepper made from it goes on as if nothing had happened. Leaves out:
// the smoothing of measured inputs that `simulate` does ahead of a run, which needs samples to come.
#pragma once
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"

namespace servodx {

// Inputs at a sample. NaN: not measured. What the first sample lacks comes from the table all the way; what a later one
// lacks stays as it was.
struct StepperInputs {
  double time = 0;                                                    // [s] above that of the sample before
  double command = 0;                                                 // [A] or the coil current (StepperOptions)
  double supply_pressure = std::numeric_limits<double>::quiet_NaN();  // [Pa]
  double return_pressure = std::numeric_limits<double>::quiet_NaN();  // [Pa]
  double load_force = std::numeric_limits<double>::quiet_NaN();       // [N]
};

// What is measured at the first sample; the rest settles beside it.
struct StepperStart {
  std::optional<double> spool_position, piston_position;  // [m]
  std::optional<double> pressure_a, pressure_b;           // [Pa]
  double piston_velocity = 0;                             // [m/s]
};

struct StepperOptions {
  std::vector<Signal> outputs = {Signal::spool_position, Signal::piston_position, Signal::pressure_a,
                                 Signal::pressure_b};  // those that the model reports
  bool command_is_current = false;                     // `command` is the measured coil current: the driver is left out
  std::optional<double> step = {};  // [s] largest step of the integrator; empty: 1/3 ms, what fits go by
  double oil_temperature = 313.15;  // [K]

  // Throws InputError that names the option.
  void validate() const;
};

class Stepper {
 public:
  // Ready at the first sample, which has its outputs. Throws InputError where an option or an input cannot be.
  Stepper(const Table& table, const Rig& rig, const StepperInputs& first, const StepperStart& start = {},
          const StepperOptions& options = {});
  // Goes on from a state that was saved by a stepper of the same table, rig file and options, in a program of the same
  // version on a processor of the same instruction set. Throws InputError where one of them is another.
  static Stepper resume(const Table& table, const Rig& rig, const std::string& state,
                        const StepperOptions& options = {});
  ~Stepper();
  Stepper(Stepper&&) noexcept;
  Stepper& operator=(Stepper&&) noexcept;

  // To the next sample; several at once cost less. False once the simulation has left the finite numbers: it stands
  // still from there on. Throws InputError where time does not increase.
  bool step(const StepperInputs& next);
  bool step(std::span<const StepperInputs> next);

  double time() const;  // [s] of the last sample
  bool ok() const;
  double output(Signal signal) const;                    // [SI] at the last sample; NaN: not among the outputs
  std::span<const double> outputs(Signal signal) const;  // [SI] at every sample of the last call of step

  // Moves the rod by so much [m], and nothing else: an observer keeps a long run beside its measured piston so.
  void shift_rod(double by);

  std::string state() const;

 private:
  struct Parts;
  explicit Stepper(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace servodx
