#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/celsius.h"
#include "base/median.h"
#include "diagnose/constants.h"
#include "diagnose/load_sign.h"
#include "diagnose/swapped.h"
#include "evidence/conditions.h"
#include "fit/log_data.h"
#include "servodx/check_log.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/operating_point.h"
#include "servodx/rig.h"
#include "signals/drive_of.h"
#include "signals/noise.h"
#include "signals/signal.h"
#include "signals/usual_step.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

using namespace diagnose_constants::survey_of_log;

bool is_measured(Signal s) { return s != Signal::time && s != Signal::command && s != Signal::setpoint; }

void survey_time(const std::vector<double>& t, LogSurvey& s) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < t.size(); ++k) steps.push_back(t[k] - t[k - 1]);
  const double usual = median(steps);
  double square = 0;
  std::size_t n = 0;
  for (const double step : steps) {
    if (step > gap_over_step * usual) {
      ++s.gaps;
      s.lost += static_cast<std::size_t>(std::lround(step / usual)) - 1;
      s.longest_gap = std::max(s.longest_gap, step);
    } else {
      square += (step / usual - 1) * (step / usual - 1), ++n;
    }
  }
  // Samples over time: the median of jittered steps is not quite their mean.
  s.rate = t.back() > t.front() ? static_cast<double>(t.size() - 1 + s.lost) / (t.back() - t.front()) : 0;
  s.jitter = n ? std::sqrt(square / static_cast<double>(n)) : 0;
}

ChannelSurvey survey_channel(const Log& log, Signal signal) {
  const Channel& channel = log.channels[index(signal)];
  ChannelSurvey c{signal,
                  channel.column,
                  channel.unit,
                  channel.missing,
                  HUGE_VAL,
                  -HUGE_VAL,
                  0,
                  channel.resolution,
                  channel.full_scale,
                  0};
  const std::vector<double>& x = channel.value;
  for (const double v : x)
    if (std::isfinite(v)) c.lowest = std::min(c.lowest, v), c.highest = std::max(c.highest, v);
  c.noise = noise_of(x, channel.resolution);
  // Flat stays at an extreme mean a limit only where the signal is restless elsewhere: a temperature that creeps
  // through its steps is at no limit.
  std::size_t at_extreme = 0, elsewhere = 0, runs = 0;
  for (std::size_t k = 0; k < x.size();) {
    std::size_t end = k + 1;
    while (end < x.size() && x[end] == x[k]) ++end;
    if ((x[k] == c.lowest || x[k] == c.highest) && end - k >= clipped_run)
      at_extreme += end - k;
    else
      elsewhere += end - k, ++runs;
    k = end;
  }
  const bool restless = runs > 0 && static_cast<double>(elsewhere) < restless_run * static_cast<double>(runs);
  if (restless) c.clipped = static_cast<double>(at_extreme) / static_cast<double>(x.size());
  return c;
}

// Rows that repeat the one before in everything measured: a logger faster than its source.
double repeats(const Log& log) {
  std::vector<const std::vector<double>*> measured;
  for (const SignalInfo& s : signal_list) {
    if (!is_measured(s.signal) || !log.has(s.signal)) continue;
    const auto& x = log[s.signal];
    if (std::any_of(x.begin(), x.end(), [&](double v) { return v != x.front(); })) measured.push_back(&x);
  }
  if (measured.empty() || log.samples() < 2) return 0;
  std::size_t same = 0;
  for (std::size_t k = 1; k < log.samples(); ++k)
    same += std::all_of(measured.begin(), measured.end(), [&](const auto* x) { return (*x)[k] == (*x)[k - 1]; });
  return static_cast<double>(same) / static_cast<double>(log.samples() - 1);
}

// Least and greatest correlation of y with x so many samples earlier.
std::pair<double, double> correlations(const std::vector<double>& x, const std::vector<double>& y, std::size_t lags) {
  double least = 0, greatest = 0;
  for (std::size_t lag = 0; lag <= lags && lag < x.size(); ++lag) {
    double n = 0, sx = 0, sy = 0, sxx = 0, syy = 0, sxy = 0;
    for (std::size_t k = lag; k < x.size(); ++k) {
      const double a = x[k - lag], b = y[k];
      if (!std::isfinite(a) || !std::isfinite(b)) continue;
      n += 1, sx += a, sy += b, sxx += a * a, syy += b * b, sxy += a * b;
    }
    const double scale = (n * sxx - sx * sx) * (n * syy - sy * sy);
    if (n < 8 || scale <= 0) continue;
    const double r = (n * sxy - sx * sy) / std::sqrt(scale);
    least = std::min(least, r), greatest = std::max(greatest, r);
  }
  return {least, greatest};
}

// Spool and piston speed follow the drive, within their lag. One that runs against it has a sign turned.
void find_turned(const Log& log, LogSurvey& s) {
  const std::vector<double>& drive = log[drive_of(log)];
  const auto samples = [&](double time) { return static_cast<std::size_t>(std::lround(time * s.rate)); };
  const auto turned = [&](Signal signal, const std::vector<double>& answer, double lag) {
    const auto [least, greatest] = correlations(drive, answer, samples(lag));
    if (least > against || greatest > with) return;
    s.findings.push_back({FindingKind::sign,
                          fmt::format("'{}' runs against the drive: give its column, or the drive's, "
                                      "gain = \"-1\" in the rig file",
                                      info(signal).name),
                          {signal}});
  };
  if (log.has(Signal::spool_position)) turned(Signal::spool_position, log[Signal::spool_position], spool_lag);
  if (!log.has(Signal::piston_position)) return;
  const std::vector<double>& x = log[Signal::piston_position];
  const std::size_t half = std::max<std::size_t>(1, samples(half_window));
  std::vector<double> speed(x.size(), std::nan(""));
  for (std::size_t k = half; k + half < x.size(); ++k) speed[k] = x[k + half] - x[k - half];
  turned(Signal::piston_position, speed, piston_lag);
}

// A verdict needs a response to judge: where all that is measured stands still or is noise, any would be nonsense.
void find_no_response(LogSurvey& s) {
  std::string still, noise;
  for (const ChannelSurvey& c : s.channels) {
    if (simulated_index(c.signal) < 0) continue;
    const double range = c.highest - c.lowest;
    if (range > of_noise_alone * c.noise) return;
    std::string& list = range > 0 ? noise : still;
    list += (list.empty() ? "'" : ", '") + std::string(info(c.signal).name) + "'";
  }
  if (still.empty() && noise.empty()) return;
  std::string text = "nothing that is measured moves";
  if (!still.empty()) text += ": " + still + " never changed";
  if (!noise.empty()) text += (still.empty() ? ": " : ", ") + noise + " moved no further than noise does";
  s.findings.push_back({FindingKind::response, text + "; no pressure, no sensors, or another log?"});
}

// A return that takes much of the supply is another column or unit as a rule, and else a line that is throttled.
void find_high_return(const Log& log, const RigFile& rig, LogSurvey& s) {
  if (!log.has(Signal::return_pressure)) return;
  const auto usual = [](std::vector<double> x) {
    std::erase_if(x, [](double v) { return !std::isfinite(v); });
    return x.empty() ? std::nan("") : median(x);
  };
  const double back = usual(log[Signal::return_pressure]);
  const double supply =
      log.has(Signal::supply_pressure) ? usual(log[Signal::supply_pressure]) : rig.fact("supply.pressure").value_or(0);
  // A return above the supply has its own finding.
  if (!(back > high_return * supply) || !(back < supply)) return;
  s.findings.push_back({FindingKind::return_line,
                        fmt::format("'return_pressure' is {:.0f} % of the supply ({:.3g} of {:.3g} bar): another "
                                    "signal or unit in its column, or a return line that is throttled",
                                    100 * back / supply, 1e-5 * back, 1e-5 * supply),
                        {Signal::return_pressure}});
}

// What the reader saw: limits, spikes, frozen sensors, no excitation. Gaps are told with more figures here.
void add_notes_of_reader(const Log& log, LogSurvey& s) {
  const std::string front = log.path + ": ";
  for (const Note& note : log.notes) {
    if (note.kind == Note::Kind::gaps && s.gaps > 0) continue;
    s.findings.push_back({note.kind == Note::Kind::unmapped_column ? FindingKind::columns : FindingKind::values,
                          note.text.starts_with(front) ? note.text.substr(front.size()) : note.text,
                          {},
                          false,
                          note.kind == Note::Kind::ignored_columns || note.kind == Note::Kind::preamble});
  }
}

// Spool and piston turned about do to the chambers what exchanging these does; the drive has told then which it is.
bool of_chambers(const Finding& f) { return f.signals == std::vector{Signal::pressure_a, Signal::pressure_b}; }

void find_suspicious(const Log& log, const RigFile& rig, LogSurvey& s) {
  const auto found = [&](FindingKind kind, std::string text) { s.findings.push_back({kind, std::move(text)}); };
  if (s.jitter > much_jitter)
    found(FindingKind::jitter,
          fmt::format("time stamps jitter by {:.2g} % of a step (rms): they are used as they are", 100 * s.jitter));
  if (s.gaps > 0)
    found(
        FindingKind::gaps,
        fmt::format("{} gap{} in time, {} sample{} lost, the longest {:.3g} ms; the command across a gap is not known",
                    s.gaps, s.gaps == 1 ? "" : "s", s.lost, s.lost == 1 ? "" : "s", 1e3 * s.longest_gap));
  if (const double part = repeats(log); part > many_repeats)
    found(FindingKind::repeats,
          fmt::format("{:.2g} % of the rows repeat the row before in every measured signal: the source is slower "
                      "than the log",
                      100 * part));
  if (s.temperature && (*s.temperature < cold || *s.temperature > hot))
    found(FindingKind::temperature,
          fmt::format("{} oil, {:.0f} degC: judge it against fault-free logs of like temperature",
                      *s.temperature < cold ? "cold" : "hot", *s.temperature - zero_celsius));
  for (const ChannelSurvey& c : s.channels) {
    const std::string name = fmt::format("'{}'", info(c.signal).name);
    if (c.missing > 0) found(FindingKind::missing, fmt::format("{}: {} samples are missing", name, c.missing));
    if (!is_measured(c.signal)) continue;
    if (c.clipped > much_clipped)
      found(FindingKind::saturation,
            fmt::format("{}: {:.2g} % of the samples lie flat on its lowest or highest value: a sensor or "
                        "converter at its limit?",
                        name, 100 * c.clipped));
    const double range = c.highest - c.lowest;
    if (simulated_index(c.signal) >= 0 && range > 0 && c.resolution > coarse_step * range &&
        c.noise < 1.01 * c.resolution / std::sqrt(12.0))
      found(FindingKind::quantisation,
            fmt::format("{}: steps of {:.2g} {} hide the noise and are {:.2g} % of what it moves", name, c.resolution,
                        info(c.signal).si_unit, 100 * c.resolution / range));
  }
  find_no_response(s);
  find_high_return(log, rig, s);
  find_turned(log, s);
  const auto is_turned = [](const Finding& f) { return f.kind == FindingKind::sign; };
  const bool both_turned = std::count_if(s.findings.begin(), s.findings.end(), is_turned) > 1;
  for (Finding& each : swapped_channels(log, rig, s.rate))
    if (!both_turned || !of_chambers(each)) s.findings.push_back(std::move(each));
  if (auto load = load_against_pressures(log, rig, s.rate)) s.findings.push_back(std::move(*load));
  add_notes_of_reader(log, s);
}

}  // namespace

LogSurvey survey(const Log& log, const RigFile& rig) {
  LogSurvey s;
  s.path = log.path;
  s.sha256 = log.sha256;
  s.samples = log.samples();
  s.duration = log.time.back() - log.time.front();
  survey_time(log.time, s);
  s.closed_loop = log.has(Signal::setpoint);
  const TestConditions test = conditions_of(log);
  s.temperature = test.temperature, s.drive_span = test.drive_span, s.drive_band = test.drive_band;
  s.conditions = conditions_beside({operating_point_of(log)}, sheet_point(rig), {});
  for (const SignalInfo& signal : signal_list)
    if (signal.signal != Signal::time && log.has(signal.signal))
      s.channels.push_back(survey_channel(log, signal.signal));
  find_suspicious(log, rig, s);
  return s;
}

void compare_surveys(std::vector<LogSurvey>& surveys) {
  if (surveys.size() < 3) return;
  std::vector<double> rates, temperatures;
  for (const LogSurvey& s : surveys) {
    rates.push_back(s.rate);
    if (s.temperature) temperatures.push_back(*s.temperature);
  }
  const double rate = median(rates), temperature = median(temperatures);
  for (LogSurvey& s : surveys) {
    if (s.rate > other_rate * rate || s.rate < rate / other_rate)
      s.findings.push_back({FindingKind::rate, fmt::format("{:.4g} Hz, the other logs {:.4g} Hz", s.rate, rate)});
    const bool said = std::any_of(s.findings.begin(), s.findings.end(),
                                  [](const Finding& f) { return f.kind == FindingKind::temperature; });
    if (s.temperature && !said && std::abs(*s.temperature - temperature) > other_temperature)
      s.findings.push_back(
          {FindingKind::temperature, fmt::format("{:.0f} degC, the other logs about {:.0f} degC",
                                                 *s.temperature - zero_celsius, temperature - zero_celsius)});
  }
}

}  // namespace servodx
