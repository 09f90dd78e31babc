#include "signals/plausible.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>

#include "base/median.h"
#include "base/units.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "signals/constants.h"
#include "signals/drive_of.h"
#include "signals/usual_step.h"

namespace servodx {
namespace {

using namespace signals_constants;

struct Run {
  std::size_t begin = 0, size = 0;
};

class Watch {
 public:
  Watch(const Log& log, const RigFile& rig, const std::array<Sweep, n_signals>& sweeps)
      : log_(log),
        rig_(rig),
        sweeps_(sweeps),
        drive_(drive_of(log)),
        drive_range_(sweeps[index(drive_)].high - sweeps[index(drive_)].low) {}

  // Of the log as a whole.
  std::vector<Note> notes() {
    clock();
    gaps();
    excitation();
    supply();
    return std::move(notes_);
  }

  // Of one signal.
  std::vector<Note> notes(const SignalInfo& signal) {
    if (signal.signal == Signal::time || !log_.has(signal.signal)) return {};
    bounds(signal);
    if (signal.signal == Signal::piston_position) use_of_stroke(signal);
    if (measures_response(signal.signal)) frozen(signal);
    if (signal.signal != Signal::command && signal.signal != Signal::setpoint) spikes(signal);
    return std::move(notes_);
  }

 private:
  static bool measures_response(Signal s) {
    switch (s) {
      case Signal::coil_current:
      case Signal::spool_position:
      case Signal::piston_position:
      case Signal::pressure_a:
      case Signal::pressure_b:
      case Signal::load_pressure:
      case Signal::flow_a:
      case Signal::flow_b:
      case Signal::control_flow:
        return true;
      default:
        return false;
    }
  }

  void add(std::string text, Note::Kind kind = Note::Kind::implausible) { notes_.push_back({kind, std::move(text)}); }

  template <class... Args>
  void note(const SignalInfo& signal, fmt::format_string<Args...> text, Args&&... args) {
    add(fmt::format("{}: '{}': {}", log_.path, signal.name, fmt::format(text, std::forward<Args>(args)...)));
  }

  double usual_step() const {
    const auto& t = log_.time;
    std::vector<double> some;  // an even sample of the steps
    for (std::size_t i = 1, stride = t.size() / scale_samples + 1; i < t.size(); i += stride)
      some.push_back(t[i] - t[i - 1]);
    return quantile(some, 0.5);
  }

  // Times in another unit than they were read in: everything after takes them at their word.
  void clock() {
    const auto& t = log_.time;
    if (t.size() < 3) return;
    const double rate = 1.0 / usual_step(), span = t.back() - t.front();
    const bool on_a_stand =
        rig_.ports != Ports::actuator || log_.has(Signal::leakage_flow) || log_.has(Signal::control_flow);
    if (rate < slowest && !on_a_stand)
      add(
          fmt::format("{}: {:.3g} samples a second are too few to see a valve move: is the time in ms, and "
                      "read as s?",
                      log_.path, rate));
    if (rate > fastest)
      add(
          fmt::format("{}: {:.3g} samples a second are more than loggers take: check the unit of time, or "
                      "thin the log",
                      log_.path, rate));
    if (std::abs(t.front()) > farthest_clock)
      add(fmt::format("{}: the time begins at {:.3g} s, which no clock shows: check its unit", log_.path, t.front()));
    if (span > longest_log)
      add(
          fmt::format("{}: the log lasts {:.3g} s, over a day: check the unit of time, or cut the log to "
                      "what matters",
                      log_.path, span));
  }

  void supply() {
    if (!log_.has(Signal::supply_pressure)) return;
    const double most = sweeps_[index(Signal::supply_pressure)].high;
    if (most < no_supply)
      note(info(Signal::supply_pressure), "at most {:.3g} bar: is the rig without pressure, or the unit another?",
           1e-5 * most);
  }

  void gaps() {
    const auto& t = log_.time;
    if (t.size() < 3) return;
    const double usual = usual_step(), longest = sweeps_[index(Signal::time)].largest_step;
    if (!(longest > gap_over_step * usual)) return;
    long count = 0;
    for (std::size_t i = 1; i < t.size(); ++i) count += t[i] - t[i - 1] > gap_over_step * usual;
    add(fmt::format("{}: {} gap{} in time, the longest {:.4g} s at a usual step of {:.4g} s", log_.path, count,
                    count == 1 ? "" : "s", longest, usual),
        Note::Kind::gaps);
  }

  void excitation() {
    if (!log_.has(drive_)) return;
    if (drive_range_ <= no_excitation * rig_.fact("valve.rated_current").value_or(0.0))
      note(info(drive_), "no excitation: it stays at {:.4g} A", sweeps_[index(drive_)].low);
  }

  // Outside these limits a wrong unit, gain or offset is likelier than the value.
  void bounds(const SignalInfo& signal) {
    double low = -INFINITY, high = INFINITY;
    const auto symmetric = [&](const char* key, double factor) {
      if (const auto fact = rig_.fact(key)) {
        high = factor * *fact;
        low = -high;
      }
    };
    switch (signal.dimension) {
      case Dimension::pressure:
        high = 150e6;
        low = signal.signal == Signal::load_pressure || signal.signal == Signal::valve_pressure_drop ? -high : -0.2e6;
        break;
      case Dimension::temperature:
        low = 200.0;
        high = 450.0;
        break;
      case Dimension::current:
        symmetric("valve.rated_current", 2.0);
        break;
      default:
        break;
    }
    if (signal.signal == Signal::spool_position) {
      high = 0.02;
      low = -high;
      symmetric("valve.spool_stroke", 2.0);
      symmetric("valve.spool_stop", 1.2);
    }
    if (signal.signal == Signal::piston_position) symmetric("actuator.stroke", 0.55);
    if (std::isinf(high)) return;
    const auto& x = log_[signal.signal];
    const Sweep& found = sweeps_[index(signal.signal)];
    if (!(found.low < low || found.high > high)) return;
    std::size_t count = 0;
    double worst = 0.0;
    for (double v : x) {
      if (!(v < low || v > high)) continue;
      ++count;
      if (std::abs(v) > std::abs(worst)) worst = v;
    }
    note(signal, "{} samples are hardly possible (up to {:.4g} {}): check unit, gain and offset", count, worst,
         signal.si_unit);
  }

  void use_of_stroke(const SignalInfo& signal) {
    const auto stroke = rig_.fact("actuator.stroke");
    const Sweep& found = sweeps_[index(signal.signal)];
    const double moved = found.high - found.low;
    if (stroke && moved > 0 && moved < least_of_stroke * *stroke)
      note(signal, "moves {:.2g} % of the stroke: check unit and gain", 100 * moved / *stroke);
  }

  void frozen(const SignalInfo& signal) {
    const std::span<const double> x = log_[signal.signal];
    if (!(drive_range_ > 0.0)) return;
    const std::size_t least =
        std::max(frozen_least, static_cast<std::size_t>(frozen_part * static_cast<double>(x.size())));
    // No run is longer than all repeats and one.
    if (sweeps_[index(signal.signal)].repeats + 1 < std::min(least, x.size())) return;
    Run longest;
    std::size_t runs = 0;
    for (std::size_t i = 0; i < x.size();) {
      std::size_t j = i + 1;
      while (j < x.size() && x[j] == x[i]) ++j;
      ++runs;
      if (j - i > longest.size) longest = {i, j - i};
      i = j;
    }
    if (longest.size == x.size()) {
      note(signal, "never changes: frozen sensor?");
      return;
    }
    if (longest.size < least || runs < 2) return;
    const double usual = static_cast<double>(x.size() - longest.size) / static_cast<double>(runs - 1);
    const Sweep drive = sweep_of(std::span(log_[drive_]).subspan(longest.begin, longest.size));
    if (usual < frozen_usual_run && drive.high - drive.low > frozen_drive * drive_range_)
      note(signal, "frozen sensor? It does not change for {:.4g} s from {:.4g} s on",
           log_.time[longest.begin + longest.size - 1] - log_.time[longest.begin], log_.time[longest.begin]);
  }

  void spikes(const SignalInfo& signal) {
    const auto& x = log_[signal.signal];
    // Scales that a few outliers do not move, from an even sample of the record.
    std::vector<double> some, steps;
    for (std::size_t i = 1, stride = x.size() / scale_samples + 1; i < x.size(); i += stride) {
      if (std::isnan(x[i]) || std::isnan(x[i - 1])) continue;
      some.push_back(x[i]);
      steps.push_back(std::abs(x[i] - x[i - 1]));
    }
    if (some.size() < 3) return;
    const double step = std::max(quantile(steps, 0.5), log_.channels[index(signal.signal)].resolution);
    const double high = quantile(some, 0.99);
    const double range = high - quantile(some, 0.01);
    const double limit = std::max(spike_over_range * range, spike_over_noise * step);
    if (!(sweeps_[index(signal.signal)].lone > limit)) return;
    std::size_t count = 0, first = 0;
    for (std::size_t i = 1; i + 1 < x.size(); ++i) {
      const double before = x[i] - x[i - 1], after = x[i] - x[i + 1];
      if (!(std::abs(before) > limit && std::abs(after) > limit && before * after > 0.0)) continue;
      if (count++ == 0) first = i;
    }
    note(signal, "{} spike{} of a single sample, the first at {:.4g} s", count, count == 1 ? "" : "s",
         log_.time[first]);
  }

  const Log& log_;
  const RigFile& rig_;
  const std::array<Sweep, n_signals>& sweeps_;
  const Signal drive_;
  const double drive_range_;
  std::vector<Note> notes_;
};

}  // namespace

std::vector<Note> implausible_values(const Log& log, const RigFile& rig, const std::array<Sweep, n_signals>& sweeps) {
  std::array<std::vector<Note>, n_signals> found;
  const Watch watch(log, rig, sweeps);
#pragma omp parallel for schedule(dynamic, 1)
  for (int s = 0; s < n_signals; ++s) found[s] = Watch(watch).notes(signal_list[s]);
  std::vector<Note> notes = Watch(watch).notes();
  for (auto& each : found) std::move(each.begin(), each.end(), std::back_inserter(notes));
  return notes;
}

}  // namespace servodx
