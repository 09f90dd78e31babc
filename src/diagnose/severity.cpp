#include "diagnose/severity.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "diagnose/constants.h"
#include "diagnose/hypotheses.h"
#include "faults/registry.h"
#include "faults/sizes.h"
#include "fit/chart.h"
#include "fit/free_values.h"
#include "fit/log_data.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

// Severity as a free number, from the mildest that is called a fault to the worst, on the side of the start.
FreeValue severity_value(const Fault& fault, const FaultSizes& sizes, double start, double null_limit) {
  FreeValue f;
  f.name = std::string("severity of ") + std::string(fault.name);
  f.apply = fault.apply;
  f.log_scale = fault.log_scale;
  double least = fault.beyond_limit_of ? null_limit : sizes.least, worst = sizes.worst;
  if (start < 0) least = -least, worst = -worst;
  f.lower = std::min(least, worst);
  f.upper = std::max(least, worst);
  f.start = std::clamp(start, f.lower, f.upper);
  return f;
}

bool two_sided(const Fault& fault) {
  return std::any_of(fault.starts.begin(), fault.starts.end(), [](double s) { return s < 0; });
}

// The same severity within its tolerance. Where the healthy value is an end of the scale (nothing is less than clean),
// the tolerance has one side.
FreeValue tolerance_value(const Fault& fault, double least) {
  FreeValue f;
  f.name = std::string("tolerance of ") + std::string(fault.name);
  f.apply = fault.apply;
  f.log_scale = fault.log_scale;
  f.start = fault.healthy;
  if (fault.log_scale) {
    f.lower = std::min(least, fault.healthy * fault.healthy / least);
    f.upper = std::max(least, fault.healthy * fault.healthy / least);
    f.prior_sd = k::inside_prior;
  } else if (fault.healthy != 0) {
    const double width = std::abs(least - fault.healthy);
    f.lower = fault.healthy - width, f.upper = fault.healthy + width;
    f.prior_sd = k::inside_prior;
  } else if (two_sided(fault)) {
    f.lower = -least, f.upper = least;
    f.prior_sd = k::inside_prior;
  } else {
    f.lower = 0, f.upper = least;
    f.prior_sd = k::end_prior;
  }
  return f;
}

// `tolerated`: of a fault within its tolerance. Its own hypothesis does not begin where that ended.
FreeValue shape_value(const Fault& fault, const FaultShape& shape, bool tolerated) {
  FreeValue f;
  f.name = std::string(tolerated ? "tolerated shape of " : "shape of ") + std::string(fault.name) + ": " +
           std::string(shape.name);
  f.apply = shape.apply;
  f.lower = shape.lower, f.upper = shape.upper;
  f.start = tolerated ? shape.in_health : shape.start;
  f.prior_sd = k::shape_prior;
  return f;
}

}  // namespace

std::vector<FreeValue> hypothesis_values(const std::vector<const LogData*>& logs, const ParameterVector& base,
                                         const std::vector<FaultStart>& faults, double null_limit,
                                         const TimesDrawing& times_drawing) {
  std::vector<FreeValue> free;
  const auto among = [&](const auto& matches) {
    return std::any_of(faults.begin(), faults.end(), [&](const FaultStart& s) { return s.fault && matches(*s.fault); });
  };
  for (const FaultStart& s : faults)
    if (s.fault)
      free.push_back(severity_value(*s.fault, sizes_of(*s.fault, base.data(), times_drawing), s.severity, null_limit));
  for (const FaultStart& s : faults)
    if (s.fault)
      for (const FaultShape& shape : s.fault->shapes) free.push_back(shape_value(*s.fault, shape, false));
  for (std::size_t l = 0; l < logs.size(); ++l)
    for (FreeValue& f : nuisance_values(*logs[l], static_cast<int>(l), base, null_limit))
      if (!among([&](const Fault& fault) { return f.at == fault.beyond_limit_of; })) free.push_back(std::move(f));
  // A row within its limit is a nuisance already.
  for (const Fault* other : fitted_faults(logs))
    if (!among([&](const Fault& fault) { return &fault == other; }) && !other->beyond_limit_of) {
      free.push_back(tolerance_value(*other, sizes_of(*other, base.data()).least));
      for (const FaultShape& shape : other->shapes) free.push_back(shape_value(*other, shape, true));
    }
  return free;
}

// The fault's own identifiers and an even grid over its range. Lanes are cheap, and a friction
// or a backlash has more than one valley.
std::vector<double> starting_severities(const Fault& fault, const ParameterVector& base, double null_limit,
                                        const TimesDrawing& times_drawing) {
  const FaultSizes sizes = sizes_of(fault, base.data(), times_drawing);
  std::vector<double> severities = sizes.starts;
  for (double side : {1.0, -1.0}) {
    if (side < 0 && !two_sided(fault)) continue;
    const FreeValue range = severity_value(fault, sizes, side, null_limit);
    for (int i = 0; i < k::severity_grid; ++i) severities.push_back(range.from_unit((i + 0.5) / k::severity_grid));
  }
  return severities;
}

}  // namespace servodx
