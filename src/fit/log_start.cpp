#include "fit/log_start.h"

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "fit/constants.h"
#include "fit/log_data.h"
#include "servodx/log.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

std::optional<double> first_present(const std::vector<double>& x) {
  for (double v : x)
    if (!std::isnan(v)) return v;
  return std::nullopt;
}

using fit_constants::start_span;

// Slope of the first samples, least squares.
double starting_slope(const std::vector<double>& t, const std::vector<double>& x) {
  double st = 0, sx = 0, stt = 0, stx = 0;
  int n = 0;
  for (std::size_t k = 0; k < x.size() && t[k] - t[0] < start_span; ++k) {
    if (std::isnan(x[k])) continue;
    const double s = t[k] - t[0];
    st += s, sx += x[k], stt += s * s, stx += s * x[k], ++n;
  }
  const double spread = n * stt - st * st;
  return n >= 3 && spread > 0 ? (n * stx - st * sx) / spread : 0.0;
}

}  // namespace

void take_start(LogData& log) {
  Scenario& s = log.scenario;
  for (const FitChannel& c : log.channels) {
    if (c.signal == Signal::spool_position) s.spool_start = first_present(c.measured);
    if (c.signal == Signal::pressure_a) s.pressure_a_start = first_present(c.measured);
    if (c.signal == Signal::pressure_b) s.pressure_b_start = first_present(c.measured);
    if (c.signal == Signal::piston_position) {
      s.piston_start = first_present(c.measured);
      s.piston_velocity_start = starting_slope(s.time, c.measured);
    }
  }
}

double starting_slope_error(const std::vector<double>& t) {
  double st = 0, stt = 0, n = 0;
  for (std::size_t k = 0; k < t.size() && t[k] - t[0] < start_span; ++k) {
    const double s = t[k] - t[0];
    st += s, stt += s * s, ++n;
  }
  const double spread = n * stt - st * st;
  return n >= 3 && spread > 0 ? std::sqrt(n / spread) : 0.0;
}

}  // namespace servodx
