#include "curves/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/key_error.h"
#include "base/median.h"
#include "base/present.h"
#include "curves/constants.h"
#include "curves/sweep.h"
#include "servodx/error.h"
#include "servodx/note.h"
#include "servodx/rig.h"

namespace servodx::curves {
namespace {

using namespace curves_constants;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// A log's outputs that the sheet knows, in SI.
struct Outputs {
  std::vector<double> flow, pressure, leakage, spool;
  std::string flow_name, pressure_name;
};

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b, double factor) {
  std::vector<double> out(a.size());
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = factor * (a[k] - b[k]);
  return out;
}

Outputs outputs_of(const Log& log, const RigFile& rig) {
  Outputs o;
  if (log.has(Signal::control_flow)) {
    o.flow = log[Signal::control_flow], o.flow_name = "control_flow";
  } else if (log.has(Signal::flow_a) && log.has(Signal::flow_b) && rig.ports != Ports::blocked) {
    o.flow = difference(log[Signal::flow_a], log[Signal::flow_b], 0.5), o.flow_name = "flow_a - flow_b";
  }
  // A moving piston takes the pressure: only blocked ports show the gain.
  const bool moves = log.has(Signal::piston_position) && rig.ports == Ports::actuator;
  if (o.flow.empty() && !moves && rig.ports != Ports::free) {
    if (log.has(Signal::load_pressure)) {
      o.pressure = log[Signal::load_pressure], o.pressure_name = "load_pressure";
    } else if (log.has(Signal::pressure_a) && log.has(Signal::pressure_b)) {
      o.pressure = difference(log[Signal::pressure_a], log[Signal::pressure_b], 1.0);
      o.pressure_name = "pressure_a - pressure_b";
    }
  }
  if (log.has(Signal::leakage_flow)) o.leakage = log[Signal::leakage_flow];
  if (log.has(Signal::spool_position)) o.spool = log[Signal::spool_position];
  return o;
}

// What a reading of the output can be trusted to: three deviations of its noise, or its resolution.
double trusted_step(const std::vector<double>& y, double resolution) {
  std::vector<double> d;
  for (std::size_t k = 1; k + 1 < y.size(); ++k)
    if (const double v = y[k - 1] - 2 * y[k] + y[k + 1]; !std::isnan(v)) d.push_back(std::fabs(v));
  if (d.empty()) return resolution;
  return std::max(1.5 * resolution, 3.0 * median(std::move(d)) / (0.6745 * std::sqrt(6.0)));
}

class Reading {
 public:
  Reading(const Log& log, const RigFile& rig, Sheet& sheet) : log_(log), rig_(rig), sheet_(sheet) {
    const auto rated = rig.fact("valve.rated_current");
    if (!rated)
      throw key_error({rig.path.empty() ? log.path : rig.path, 0, "valve.rated_current"},
                      "is missing, and the figures are parts of it",
                      "give a rig file with [valve] rated_current = \"20 mA\"");
    rated_ = *rated;
  }

  void read() {
    const Outputs out = outputs_of(log_, rig_);
    if (const auto sweeps = sweeps_of(log_, rated_)) {
      sweeps_ = *sweeps;
      if (!sweeps_.both())
        sheet_.notes.push_back({Note::Kind::one_way_sweep, "the command sweeps one way only: no hysteresis"});
      if (const double rate = sweeps_.rate / rated_; rate > slow)
        sheet_.notes.push_back(
            {Note::Kind::fast_sweep,
             fmt::format("the command sweeps {:.2g} times rated current a second: lag of valve and sensors is in the "
                         "hysteresis",
                         rate)});
      if (!out.flow.empty()) flow(curve(Signal::control_flow, out.flow), out.flow_name, out.flow);
      if (!out.pressure.empty()) pressure(curve(Signal::load_pressure, out.pressure), out.pressure_name);
      if (!out.leakage.empty()) leakage(curve(Signal::leakage_flow, out.leakage));
      if (!out.spool.empty() && out.flow.empty()) spool(curve(Signal::spool_position, out.spool), out.spool);
    }
    // A triangle's harmonics are no sweep of frequencies.
    if (!sweeps_.periodic) response(out);
    if (sheet_.figures.empty())
      throw InputError({log_.path, 0, ""}, "shows none of the figures",
                       "log slow sweeps of the command, or a sine sweep, with control_flow, load_pressure, "
                       "leakage_flow or spool_position");
  }

 private:
  const SweepCurve& curve(Signal signal, const std::vector<double>& output) {
    sheet_.curves.push_back(curve_of(sweeps_, signal, output));
    return sheet_.curves.back();
  }

  void add(const std::string& name, const std::string& signal, double value, const std::string& unit,
           Remark remark = {}) {
    if (!std::isfinite(value) && remark.kind == Remark::Kind::none) return;
    sheet_.figures.push_back({.name = name, .signal = signal, .value = value, .unit = unit, .remark = remark});
  }

  // Largest distance of the branches in current at one output, over the inner part of the outputs that both reach.
  double hysteresis(const SweepCurve& c) const {
    if (!sweeps_.both()) return nan;
    const auto range = [](const std::vector<double>& y) {
      double low = nan, high = nan;
      for (double v : y)
        if (!std::isnan(v)) low = std::fmin(low, v), high = std::fmax(high, v);
      return std::pair(low, high);
    };
    const auto [up_low, up_high] = range(c.up);
    const auto [down_low, down_high] = range(c.down);
    const double low = std::max(up_low, down_low), high = std::min(up_high, down_high);
    double largest = nan;
    for (int k = 0; k <= hysteresis_levels; ++k) {
      const double level =
          0.5 * (low + high) + inner_outputs * (high - low) * (static_cast<double>(k) / hysteresis_levels - 0.5);
      largest = std::fmax(largest, distance(c.current, c, level));
    }
    return largest / rated_;
  }
  bool too_fast() const { return sweeps_.rate > fastest * rated_; }

  void add_hysteresis(const std::string& name, const SweepCurve& c) {
    if (too_fast())
      add("hysteresis", name, nan, "-", {Remark::Kind::too_fast, sweeps_.rate / rated_});
    else if (sweeps_.both())
      add("hysteresis", name, hysteresis(c), "-");
    else
      add("hysteresis", name, nan, "-", {Remark::Kind::one_way});
  }
  static double distance(const std::vector<double>& current, const SweepCurve& c, double level) {
    return std::fabs(crossing(current, c.up, level) - crossing(current, c.down, level));
  }

  // Null, hysteresis and threshold are read alike from every output that follows the command.
  void follows(const SweepCurve& c, const std::string& name, const std::vector<double>& output, double gain) {
    add("null_bias", name, crossing(c.current, c.mean, 0.0) / rated_, "-");
    add_hysteresis(name, c);
    if (!too_fast()) threshold(name, output, gain);
  }

  // Smallest step of the output's readings near a sample: meters are coarser where they read more.
  static double resolution_near(const std::vector<double>& y, std::size_t at) {
    double least = 0, last = nan;
    for (std::size_t k = at > resolution_reach ? at - resolution_reach : 0;
         k < std::min(y.size(), at + resolution_reach); ++k) {
      if (std::isnan(y[k])) continue;
      if (const double step = std::fabs(y[k] - last); step > 0 && (least == 0 || step < least)) least = step;
      last = y[k];
    }
    return least;
  }

  void threshold(const std::string& name, const std::vector<double>& y, double gain) {
    double sum = 0, finest = std::numeric_limits<double>::infinity(), widest = 0;
    long n = 0;
    for (std::size_t turn : sweeps_.reversals) {
      if (std::isnan(y[turn])) continue;
      const double seen = trusted_step(y, resolution_near(y, turn));
      const double in_current = std::max(seen / std::fabs(gain), sweeps_.resolution) / rated_;
      finest = std::min(finest, in_current);
      if (!(in_current < coarsest_threshold)) continue;
      const double way = sweeps_.direction[turn] > 0 ? 1.0 : -1.0, sign = gain > 0 ? way : -way;
      double extreme = y[turn];
      for (std::size_t k = turn; k < y.size() && sweeps_.direction[k] == sweeps_.direction[turn]; ++k) {
        if (std::isnan(y[k])) continue;
        extreme = sign > 0 ? std::min(extreme, y[k]) : std::max(extreme, y[k]);
        if ((y[k] - extreme) * sign < seen) continue;
        sum += std::max(0.0, std::fabs(sweeps_.current[k] - sweeps_.current[turn]) - seen / std::fabs(gain));
        widest = std::max(widest, in_current);
        ++n;
        break;
      }
    }
    if (n > 0)
      add("threshold", name, sum / static_cast<double>(n) / rated_, "-",
          {Remark::Kind::mean_of_reversals, static_cast<double>(n), widest});
    else if (std::isfinite(finest))
      add("threshold", name, nan, "-", {Remark::Kind::coarse_readings, finest});
  }

  void flow(const SweepCurve& c, const std::string& name, const std::vector<double>& output) {
    // At rated current, both ways, brought to the rated drop where the log says the drop it was taken at.
    const auto drop = rig_.fact("valve.rated_pressure_drop");
    const bool has_drop = log_.has(Signal::valve_pressure_drop);
    const double at =
        has_drop ? mean_of_present(log_[Signal::valve_pressure_drop])
        : log_.has(Signal::supply_pressure)
            ? mean_of_present(log_[Signal::supply_pressure]) -
                  (log_.has(Signal::return_pressure) ? mean_of_present(log_[Signal::return_pressure]) : 0.0)
            : nan;
    const double to_rated = drop && std::isfinite(at) ? std::sqrt(*drop / at) : 1.0;
    const Remark how = to_rated == 1.0 ? Remark{} : Remark{Remark::Kind::brought_to_rated_drop, at, *drop};
    const double reach = 0.98 * rated_;
    if (c.current.front() <= -reach && c.current.back() >= reach) {
      const Line high = line_through(c.current, c.mean, 0.9 * rated_, 1.02 * rated_);
      const Line low = line_through(c.current, c.mean, -1.02 * rated_, -0.9 * rated_);
      const double plus = high.at_zero + high.slope * rated_, minus = low.at_zero - low.slope * rated_;
      add("rated_flow", name, 0.5 * std::fabs(plus - minus) * to_rated, "m3/s", how);
      add("rated_flow_positive", name, std::fabs(plus) * to_rated, "m3/s", how);
      add("rated_flow_negative", name, std::fabs(minus) * to_rated, "m3/s", how);
    } else {
      add("rated_flow", name, nan, "m3/s",
          {Remark::Kind::short_command, 100 * c.current.front() / rated_, 100 * c.current.back() / rated_});
    }
    const double top = std::min(c.current.back(), -c.current.front());
    const Line all = line_through(c.current, c.mean, -top, top);
    follows(c, name, output, all.slope);
    if (std::isnan(all.slope)) return;
    add("flow_gain", name, std::fabs(all.slope), "m3/s/A");
    double largest = 0;
    for (std::size_t k = 0; k < c.current.size(); ++k)
      if (!std::isnan(c.mean[k]) && std::fabs(c.current[k]) <= inner_sweep * top)
        largest = std::max(largest, std::fabs(c.mean[k] - all.at_zero - all.slope * c.current[k]));
    add("linearity", name, largest / std::fabs(all.slope) / rated_, "-");
    // Straight parts of both polarities, clear of the null region.
    const Line plus = line_through(c.current, c.mean, 0.1 * rated_, top);
    const Line minus = line_through(c.current, c.mean, -top, -0.1 * rated_);
    if (std::isnan(plus.slope) || std::isnan(minus.slope)) return;
    const double larger = std::max(std::fabs(plus.slope), std::fabs(minus.slope));
    add("symmetry", name, std::fabs(std::fabs(plus.slope) - std::fabs(minus.slope)) / larger, "-");
    add("lap", name, (-plus.at_zero / plus.slope + minus.at_zero / minus.slope) / rated_, "-",
        {Remark::Kind::positive_is_overlap});
  }
  void pressure(const SweepCurve& c, const std::string& name) {
    double supply = log_.has(Signal::supply_pressure) ? mean_of_present(log_[Signal::supply_pressure])
                                                      : rig_.fact("supply.pressure").value_or(nan);
    supply -= log_.has(Signal::return_pressure) ? mean_of_present(log_[Signal::return_pressure])
                                                : rig_.fact("supply.return_pressure").value_or(0.0);
    Remark how;
    if (std::isnan(supply)) {
      supply = 0;
      for (double p : c.mean)
        if (!std::isnan(p)) supply = std::max(supply, std::fabs(p));
      how.kind = Remark::Kind::of_largest_pressure;
    }
    add("null_bias", name, crossing(c.current, c.mean, 0.0) / rated_, "-");
    add_hysteresis(name, c);
    // Each branch by itself: their mean is flatter than either.
    const auto gain = [&](const std::vector<double>& branch) {
      const double from = crossing(c.current, branch, -0.4 * supply), to = crossing(c.current, branch, 0.4 * supply);
      return 0.8 / (std::fabs(to - from) / rated_ * 100.0);
    };
    const double up = gain(c.up), down = gain(c.down);
    const double value = std::isnan(up) ? down : std::isnan(down) ? up : 0.5 * (up + down);
    if (0.8 / value / 100.0 * rated_ < 2 * sweeps_.step)
      return add("pressure_gain", name, nan, "1/%", {Remark::Kind::coarse_command, 100 * sweeps_.step / rated_, value});
    add("pressure_gain", name, value, "1/%", how);
  }

  void leakage(const SweepCurve& c) {
    const std::string name = "leakage_flow";
    double most = nan, least = nan, at = nan;
    for (std::size_t k = 0; k < c.current.size(); ++k) {
      if (std::isnan(c.mean[k])) continue;
      if (std::isnan(most) || c.mean[k] > most) most = c.mean[k], at = c.current[k];
      if (std::isnan(least) || c.mean[k] < least) least = c.mean[k];
    }
    add("null_leakage", name, most, "m3/s", {Remark::Kind::pilot_stage_included});
    add("pilot_leakage", name, least, "m3/s", {Remark::Kind::least_of_sweep});
    add("leakage_peak_at", name, at / rated_, "-");
    // The peak's flanks carry the loop, and the lag of a slow meter.
    SweepCurve back = c;
    for (auto* v : {&back.current, &back.up, &back.down}) std::reverse(v->begin(), v->end());
    const double half = 0.5 * (most + least);
    const double left = distance(c.current, c, half), right = distance(back.current, back, half);
    add("leakage_hysteresis", name, 0.5 * (left + right) / rated_, "-", {Remark::Kind::at_half_height});
  }

  void spool(const SweepCurve& c, const std::vector<double>& output) {
    const Line all = line_through(c.current, c.mean, -rated_, rated_);
    follows(c, "spool_position", output, all.slope);
    if (std::isnan(all.slope)) return;
    double largest = 0;
    for (std::size_t k = 0; k < c.current.size(); ++k)
      if (!std::isnan(c.mean[k]) && std::fabs(c.current[k]) <= 0.95 * rated_)
        largest = std::max(largest, std::fabs(c.mean[k] - all.at_zero - all.slope * c.current[k]));
    add("stroke", "spool_position", all.slope * rated_, "m", {Remark::Kind::at_rated_current});
    add("linearity", "spool_position", largest / std::fabs(all.slope) / rated_, "-");
  }

  void response(const Outputs& out) {
    const auto& y = !out.spool.empty() ? out.spool : out.flow;
    if (y.empty()) return;
    const Signal drive = log_.has(Signal::command) ? Signal::command : Signal::coil_current;
    auto points = frequency_response(log_.time, log_[drive], y);
    if (points.size() < 8 || points.back().frequency < lively) return;
    // A held command acts half a sample late: that is the log's lag and not the valve's.
    if (drive == Signal::command && rig_.command_hold.value_or(CommandHold::zero) == CommandHold::zero) {
      const double period = (log_.time.back() - log_.time.front()) / static_cast<double>(log_.samples() - 1);
      for (ResponsePoint& p : points) p.phase += std::numbers::pi * p.frequency * period;
    }
    // An output wired the other way round is no lag.
    if (std::fabs(points.front().phase) > 0.5 * std::numbers::pi)
      for (ResponsePoint& p : points) p.phase -= std::copysign(std::numbers::pi, points.front().phase);
    sheet_.response_signal = !out.spool.empty() ? "spool_position" : out.flow_name;
    const Remark not_reached{Remark::Kind::not_reached, points.back().frequency};
    const double lag = frequency_of_lag(points, 0.5 * std::numbers::pi);
    const double gain = frequency_of_gain(points, std::sqrt(0.5));
    add("phase_lag_90_frequency", sheet_.response_signal, lag, "Hz", std::isnan(lag) ? not_reached : Remark{});
    add("amplitude_3db_frequency", sheet_.response_signal, gain, "Hz", std::isnan(gain) ? not_reached : Remark{});
    sheet_.response = std::move(points);
  }

  const Log& log_;
  const RigFile& rig_;
  Sheet& sheet_;
  Sweeps sweeps_;
  double rated_ = 0;
};

}  // namespace

Sheet read_figures(const Log& log, const RigFile& rig) {
  Sheet sheet;
  sheet.notes = log.notes;
  sheet.curves.reserve(4);  // references to them are held while reading
  Reading(log, rig, sheet).read();
  return sheet;
}

Sheet read_curves(const Log& log, const RigFile& rig, const SheetOptions& options) {
  Sheet sheet = read_figures(log, rig);
  add_uncertainty(sheet, log, rig, options.instruments);
  judge(sheet, rig, options.guard);
  return sheet;
}

}  // namespace servodx::curves
