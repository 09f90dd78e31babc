#include "diagnose/worth_fitting.h"

#include <algorithm>

#include "diagnose/constants.h"
#include "evidence/constants.h"
#include "evidence/probabilities.h"

namespace servodx {

namespace k = diagnose_constants;
using evidence_constants::effect_error;

bool is_hopeless(double misfit, double healthy, double best, double degrees) {
  return misfit > healthy && misfit - best > k::hopeless * misfit_scale(healthy, best, degrees, effect_error);
}

double pair_gain(double misfit, double best, double healthy) {
  return best - misfit - k::lent_to_second * k::lent_to_second * std::max(0.0, healthy - misfit);
}

}  // namespace servodx
