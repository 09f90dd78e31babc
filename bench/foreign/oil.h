// Oil of a foreign rig at one temperature: viscosity after Vogel (temperature) and Barus (pressure), a stiffness that
// entrained air softens. Free air shrinks as a polytrope and goes into solution with pressure (Henry), taken as an
// exponential of its own. The stiffness is tabulated over the root of the absolute pressure, dense where air rules.
// Leaves out: vapour, the time that solution takes, heat.
#pragma once
#include <array>

namespace servodx::foreign {

inline constexpr double atmosphere = 1.01325e5;  // [Pa]

struct OilKind {
  const char* name;          // as in a data sheet
  bool flight;               // flight oils see the cold
  double density;            // [kg/m3] at 20 degC
  double viscosity_40;       // [m2/s]
  double viscosity_100;      // [m2/s]
  double vogel;              // [K] Vogel's shift, added to degC
  double stiffness;          // [Pa] at 40 degC without pressure
  double stiffness_per_K;    // [Pa/K]
  double stiffness_per_bar;  // [1] rise with pressure
  double barus;              // [1/Pa]
  double expansion;          // [1/K]
  double solution_pressure;  // [Pa] at which 1/e of the air is free
};

class Oil {
 public:
  Oil(const OilKind& kind, double celsius, double air, double viscosity_factor);
  double density() const { return density_; }  // [kg/m3]
  double viscosity(double p) const {           // [Pa s] p gauge
    const double y = barus_ * p;
    return viscosity_ * (1.0 + y * (1.0 + 0.5 * y));
  }
  double stiffness(double p) const;  // [Pa] effective bulk modulus at gauge pressure p

 private:
  static constexpr int knots = 1024;
  static constexpr double top = 800e5;  // [Pa] absolute, end of the table
  double density_, viscosity_, barus_;
  std::array<double, knots + 1> table_;
};

// [m2/s] without pressure, after Vogel.
double kinematic_viscosity(const OilKind& kind, double celsius);

}  // namespace servodx::foreign
