// An oil that thickens in the cold more, or less, than the rig file lets expect. Walther's law (ASTM D341) has a slope
// that one viscosity does not tell: about 2.5 for MIL-PRF-5606, 2.9 for phosphate esters, 3.6 for mineral oils of
// viscosity index 100, 3.7 for MIL-PRF-83282. At -20 degC the first and the last differ by a factor of four. A rig file
// that names the fluid, or states its viscosity at 100 degC, gives the slope.
//
// Acts on all that is laminar, and on nothing at 40 degC.
#pragma once
#include <cmath>

#include "effects/effect.h"
#include "model/state.h"

namespace servodx {

struct ViscositySlope {
  static constexpr const char* name = "viscosity_slope";
  static constexpr const char* place = "metering";
  static constexpr const char* meaning =
      "the oil's viscosity changes with temperature more, or less, than its law says";
  static constexpr Freed freed = Freed::across_temperatures;
  static constexpr bool as_made = true;  // in one log it is what viscosity_change is
  static constexpr bool of_construction = true;
  static constexpr const char* best_test = "the same test in cold and in hot oil";
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 1;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"viscosity_slope", "-", 1.0, 0.6, 1.8, 1.3, "slope of the oil's viscosity in Walther's law over the law's"},
  };
  // Factor on the oil's viscosity; q: own parameters. With w = lg(nu + 0.7), nu in mm2/s, the law is a straight line of
  // lg w over lg T, so a slope q[0] times as steep takes w to w40 (w / w40)^q[0].
  template <class T>
  static T viscosity(const T* q, const Oil& oil) {
    using std::exp;
    constexpr double shift = 0.7, ln_10 = 2.302585092994046;
    const double nu = 1e6 * oil.dynamic_viscosity / oil.density;
    const double w = std::log10(nu + shift), w_40 = std::log10(nu / oil.viscosity_ratio + shift);
    const T added = T(w) * (exp((q[0] - T(1.0)) * T(std::log(w / w_40))) - T(1.0));  // 0 at the law's slope
    return T(1.0) + T((nu + shift) / nu) * (exp(T(ln_10) * added) - T(1.0));
  }
};

}  // namespace servodx
