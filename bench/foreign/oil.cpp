#include "oil.h"

#include <algorithm>
#include <cmath>

namespace servodx::foreign {
namespace {

constexpr double polytropic = 1.2;      // between slow and fast
constexpr double floor_pressure = 2e3;  // [Pa] absolute; below it oil would boil

}  // namespace

double kinematic_viscosity(const OilKind& kind, double celsius) {
  const double per_40 = 1.0 / (40.0 + kind.vogel), per_100 = 1.0 / (100.0 + kind.vogel);
  const double slope = std::log(kind.viscosity_40 / kind.viscosity_100) / (per_40 - per_100);
  return kind.viscosity_40 * std::exp(slope * (1.0 / (celsius + kind.vogel) - per_40));
}

Oil::Oil(const OilKind& kind, double celsius, double air, double viscosity_factor)
    : density_(kind.density * (1.0 - kind.expansion * (celsius - 20.0))),
      viscosity_(kinematic_viscosity(kind, celsius) * density_ * viscosity_factor),
      barus_(kind.barus) {
  const double bare = kind.stiffness + kind.stiffness_per_K * (celsius - 40.0);
  for (int i = 0; i <= knots; ++i) {
    const double root = static_cast<double>(i) / knots;
    const double p = std::max(root * root * top, floor_pressure);  // absolute
    const double liquid = bare + kind.stiffness_per_bar * (p - atmosphere);
    const double free = air * std::pow(atmosphere / p, 1.0 / polytropic) * std::exp(-p / kind.solution_pressure);
    const double softness = 1.0 / liquid + free / (polytropic * p);
    table_[i] = (1.0 + free) / softness;
  }
}

double Oil::stiffness(double p) const {
  const double root = std::sqrt(std::clamp((p + atmosphere) / top, 0.0, 0.9999));
  const double at = root * knots;
  const int i = static_cast<int>(at);
  const double part = at - i;
  return table_[i] + part * (table_[i + 1] - table_[i]);
}

}  // namespace servodx::foreign
