#include "fit/oil_of.h"

namespace servodx {

// By halves: an oil grows thinner all the way.
double kelvin_where(const Fluid& fluid, double viscosity_ratio) {
  double cold = 203.15, hot = 453.15;
  constexpr int halves = 40;  // to a nanokelvin: no step of a fit sees it
  for (int i = 0; i < halves; ++i) {
    const double middle = 0.5 * (cold + hot);
    (oil_of(fluid, middle).viscosity_ratio > viscosity_ratio ? cold : hot) = middle;
  }
  return 0.5 * (cold + hot);
}

}  // namespace servodx
