// The fields of what pickles. Each struct is bound by all that it holds, so one with a new field does not compile until
// that is here; what is bound and not tied (`whole`, the library's own) is left out.
#pragma once
#include <tuple>

#include "define.h"

namespace servodx {

inline auto fields(Fluid& f) {
  auto& [density, kinematic_viscosity, kinematic_viscosity_100, given, name] = f;
  return std::tie(density, kinematic_viscosity, kinematic_viscosity_100, given, name);
}
inline auto fields(Limit& l) {
  auto& [min, max] = l;
  return std::tie(min, max);
}
inline auto fields(ColumnMapping& c) {
  auto& [signal, column_unit, unit, gain, offset, gain_has_unit, line] = c;
  return std::tie(signal, column_unit, unit, gain, offset, gain_has_unit, line);
}
inline auto fields(ResponseFact& p) {
  auto& [frequency, amplitude, gain, phase_lag] = p;
  return std::tie(frequency, amplitude, gain, phase_lag);
}
inline auto fields(RigFile& r) {
  auto& [path, sha256, name, serial, ports, command_hold, mains_frequency, null_limit, oil_temperature, taps, fluid,
         facts, response, limits, words, lines, columns, open_questions] = r;
  return std::tie(path, sha256, name, serial, ports, command_hold, mains_frequency, null_limit, oil_temperature, taps,
                  fluid, facts, response, limits, words, lines, columns, open_questions);
}
inline auto fields(Channel& c) {
  auto& [value, unit, full_scale, resolution, column, missing] = c;
  return std::tie(value, unit, full_scale, resolution, column, missing);
}
inline auto fields(Note& n) {
  auto& [kind, text] = n;
  return std::tie(kind, text);
}
inline auto fields(Log& l) {
  auto& [path, sha256, time, channels, notes] = l;
  return std::tie(path, sha256, time, channels, notes);
}
inline auto fields(OutputColumn& c) {
  auto& [signal, unit, value, full_scale] = c;
  return std::tie(signal, unit, value, full_scale);
}
inline auto fields(Simulation& s) {
  auto& [time, columns, notes, step, impact_step] = s;
  return std::tie(time, columns, notes, step, impact_step);
}

inline auto fields(Row& r) {
  auto& [id, name, group, nominal, lower, upper, log_scale, estimate, unit, description, source, std_error] = r;
  return std::tie(id, name, group, nominal, lower, upper, log_scale, estimate, unit, description, source, std_error);
}
inline auto fields(Table& t) {
  auto& [path, sha256, rows, comments, state, has_std_error] = t;
  return std::tie(path, sha256, rows, comments, state, has_std_error);
}
inline auto fields(ParameterResult& p) {
  auto& [id, name, unit, nominal, estimate, std_error, verdict, confounded_with, profile_lower, profile_upper,
         effect_at_lower, effect_at_upper] = p;
  return std::tie(id, name, unit, nominal, estimate, std_error, verdict, confounded_with, profile_lower, profile_upper,
                  effect_at_lower, effect_at_upper);
}
inline auto fields(ChannelResult& c) {
  auto& [signal, unit, rms, noise_rms, heldout_rms] = c;
  return std::tie(signal, unit, rms, noise_rms, heldout_rms);
}
inline auto fields(Tuned& t) {
  auto& [table, channels, parameters, notes, simulations, failed_simulations, interrupted, whole] = t;
  return std::tie(table, channels, parameters, notes, simulations, failed_simulations, interrupted);
}
inline auto fields(TuneChart::Point& p) {
  auto& [stage, simulations, cost] = p;
  return std::tie(stage, simulations, cost);
}
inline auto fields(TuneChart& c) {
  auto& [convergence, starts] = c;
  return std::tie(convergence, starts);
}

inline auto fields(Verdict::Severity& s) {
  auto& [value, lower, upper, unit] = s;
  return std::tie(value, lower, upper, unit);
}
inline auto fields(Verdict::Suspicion& s) {
  auto& [name, severity, rate, logs_needed] = s;
  return std::tie(name, severity, rate, logs_needed);
}
inline auto fields(Verdict::Named& n) {
  auto& [name, probability, severity, channel] = n;
  return std::tie(name, probability, severity, channel);
}
inline auto fields(Verdict::Detectable& d) {
  auto& [value, unit] = d;
  return std::tie(value, unit);
}
inline auto fields(Verdict::Beyond& b) {
  auto& [first, where, depends_on, share, taken, outside] = b;
  return std::tie(first, where, depends_on, share, taken, outside);
}
inline auto fields(Verdict::Friction& f) {
  auto& [friction, largest] = f;
  return std::tie(friction, largest);
}

inline auto fields(Explanation::Gain& g) {
  auto& [value, lower, upper] = g;
  return std::tie(value, lower, upper);
}
inline auto fields(Explanation::Channel& c) {
  auto& [signal, unit, rms_before, rms_after, noise_rms, heldout_before, heldout_after] = c;
  return std::tie(signal, unit, rms_before, rms_after, noise_rms, heldout_before, heldout_after);
}
inline auto fields(Explanation::Parameter& p) {
  auto& [value, std_error, unit, lower, upper, told] = p;
  return std::tie(value, std_error, unit, lower, upper, told);
}
inline auto fields(Explanation::Cause& c) {
  auto& [effect, where, parameters, heldout_gain, delta_bic, confusable_with] = c;
  return std::tie(effect, where, parameters, heldout_gain, delta_bic, confusable_with);
}
inline auto fields(Explanation::Candidate& c) {
  auto& [effect, where, reason, taken] = c;
  return std::tie(effect, where, reason, taken);
}

inline auto fields(Trend::Remaining& r) {
  auto& [median, lower, upper] = r;
  return std::tie(median, lower, upper);
}
inline auto fields(Trend::OfCheck& c) {
  auto& [name, unit, state, slope, alert_at, remaining] = c;
  return std::tie(name, unit, state, slope, alert_at, remaining);
}
inline auto fields(TrendChart::Range& r) {
  auto& [lower, upper] = r;
  return std::tie(lower, upper);
}
inline auto fields(TrendChart::Point& p) {
  auto& [at, value, temperature, healthy] = p;
  return std::tie(at, value, temperature, healthy);
}
inline auto fields(TrendChart::OfCheck& c) {
  auto& [name, unit, cause, points, threshold, warning, failure, healthy, now, slope, grows, life] = c;
  return std::tie(name, unit, cause, points, threshold, warning, failure, healthy, now, slope, grows, life);
}
inline auto fields(TrendChart& c) {
  auto& [checks, life] = c;
  return std::tie(checks, life);
}
inline auto fields(LogChart::OfSignal& s) {
  auto& [signal, unit, measured, simulated, residual, sigma] = s;
  return std::tie(signal, unit, measured, simulated, residual, sigma);
}
inline auto fields(LogChart& c) {
  auto& [log, time, command, signals] = c;
  return std::tie(log, time, command, signals);
}

inline auto fields(PlannedTest::Piece& p) {
  auto& [shape, start, seconds, amplitude, rate] = p;
  return std::tie(shape, start, seconds, amplitude, rate);
}
inline auto fields(PlannedTest::Fault& f) {
  auto& [name, unit, least, from_mildest, severity, deviates, found, named, nearest] = f;
  return std::tie(name, unit, least, from_mildest, severity, deviates, found, named, nearest);
}
inline auto fields(PlannedTest::Pair& p) {
  auto& [first, second, told] = p;
  return std::tie(first, second, told);
}
inline auto fields(PlannedTest::Row& r) {
  auto& [name, unit, before, after] = r;
  return std::tie(name, unit, before, after);
}
inline auto fields(PlannedTest::Extremes& e) {
  auto& [current, stroke, speed, pressure_low, pressure_high, cavitates] = e;
  return std::tie(current, stroke, speed, pressure_low, pressure_high, cavitates);
}
inline auto fields(PlannedTest::Figures& f) {
  auto& [information, faults, pairs, rows, extremes] = f;
  return std::tie(information, faults, pairs, rows, extremes);
}
inline auto fields(PlannedTest& p) {
  auto& [time, command, setpoint, pieces, planned, random_command, random, threshold, notes, simulations,
         failed_simulations, interrupted, whole] = p;
  return std::tie(time, command, setpoint, pieces, planned, random_command, random, threshold, notes, simulations,
                  failed_simulations, interrupted);
}

inline auto fields(AcceptanceSheet::Figure& f) {
  auto& [name, signal, value, unit, uncertainty, limit, pass, note] = f;
  return std::tie(name, signal, value, unit, uncertainty, limit, pass, note);
}
inline auto fields(AcceptanceSheet::Curve& c) {
  auto& [signal, current, up, down, mean] = c;
  return std::tie(signal, current, up, down, mean);
}
inline auto fields(AcceptanceSheet::Response& r) {
  auto& [frequency, gain, phase, coherence] = r;
  return std::tie(frequency, gain, phase, coherence);
}
inline auto fields(AcceptanceSheet& s) {
  auto& [kind, figures, curves, response, response_signal, notes, whole] = s;
  return std::tie(kind, figures, curves, response, response_signal, notes);
}

inline auto fields(Fleet::Row& r) {
  auto& [file, log, kind, fault, severity, probability, error, threshold] = r;
  return std::tie(file, log, kind, fault, severity, probability, error, threshold);
}
inline auto fields(Fleet::Refused& r) {
  auto& [file, line, column, rule, mend] = r;
  return std::tie(file, line, column, rule, mend);
}
inline auto fields(Fleet& f) {
  auto& [rows, refused, unread, interrupted, without_schema, csv, whole] = f;
  return std::tie(rows, refused, unread, interrupted, without_schema, csv);
}

namespace python {

inline auto fields(TunedOnRig& t) {
  auto& [tuned, rig, chart] = t;
  return std::tie(tuned, rig, chart);
}
inline auto fields(SimulationOfLog& s) {
  auto& [run, log, rig] = s;
  return std::tie(run, log, rig);
}
inline auto fields(VerdictText& v) {
  auto& [log, interrupted, kind, error, threshold, p_value, fault, faults, severity, probabilities, ambiguous_with,
         separating_test, onset, suspicion, detectable, beyond, friction, action_class, action, parameters, channels,
         notes, simulations, failed_simulations, whole] = static_cast<Verdict&>(v);
  return std::tie(v.json, log, interrupted, kind, error, threshold, p_value, fault, faults, severity, probabilities,
                  ambiguous_with, separating_test, onset, suspicion, detectable, beyond, friction, action_class, action,
                  parameters, channels, notes, simulations, failed_simulations);
}
inline auto fields(ExplanationText& e) {
  auto& [kind, where, depends_on, channels, causes, standing, candidates, probabilities, table, notes, simulations,
         failed_simulations, interrupted, whole] = static_cast<Explanation&>(e);
  return std::tie(e.json, kind, where, depends_on, channels, causes, standing, candidates, probabilities, table, notes,
                  simulations, failed_simulations, interrupted);
}
inline auto fields(TrendWithChart& t) {
  auto& [valve, serial, state, at, checks, cause, alert_at, remaining, trends, notes, whole] = static_cast<Trend&>(t);
  return std::tie(valve, serial, state, at, checks, cause, alert_at, remaining, trends, notes, t.chart);
}

}  // namespace python
}  // namespace servodx
