// The fields of what pickles. A field that is not here is lost by a pickle: tests/python compares all that shows.
#pragma once
#include <tuple>

#include "define.h"

namespace servodx {

inline auto fields(Fluid& f) {
  return std::tie(f.density, f.kinematic_viscosity, f.kinematic_viscosity_100, f.given, f.name);
}
inline auto fields(Limit& l) { return std::tie(l.min, l.max); }
inline auto fields(ColumnMapping& c) {
  return std::tie(c.signal, c.column_unit, c.unit, c.gain, c.offset, c.gain_has_unit, c.line);
}
inline auto fields(ResponseFact& p) { return std::tie(p.frequency, p.amplitude, p.gain, p.phase_lag); }
inline auto fields(RigFile& r) {
  return std::tie(r.path, r.sha256, r.name, r.serial, r.ports, r.command_hold, r.mains_frequency, r.null_limit,
                  r.oil_temperature, r.taps, r.fluid, r.facts, r.response, r.limits, r.words, r.lines, r.columns,
                  r.open_questions);
}
inline auto fields(Channel& c) { return std::tie(c.value, c.unit, c.full_scale, c.resolution, c.column, c.missing); }
inline auto fields(Note& n) { return std::tie(n.kind, n.text); }
inline auto fields(Log& l) { return std::tie(l.path, l.sha256, l.time, l.channels, l.notes); }
inline auto fields(OutputColumn& c) { return std::tie(c.signal, c.unit, c.value, c.full_scale); }
inline auto fields(Simulation& s) { return std::tie(s.time, s.columns, s.notes, s.step, s.impact_step); }

inline auto fields(Row& r) {
  return std::tie(r.id, r.name, r.group, r.nominal, r.lower, r.upper, r.log_scale, r.estimate, r.unit, r.description,
                  r.source, r.std_error);
}
inline auto fields(Table& t) { return std::tie(t.path, t.sha256, t.rows, t.comments, t.state, t.has_std_error); }
inline auto fields(ParameterResult& p) {
  return std::tie(p.id, p.name, p.unit, p.nominal, p.estimate, p.std_error, p.verdict, p.confounded_with,
                  p.profile_lower, p.profile_upper, p.effect_at_lower, p.effect_at_upper);
}
inline auto fields(ChannelResult& c) { return std::tie(c.signal, c.unit, c.rms, c.noise_rms, c.heldout_rms); }
inline auto fields(Tuned& t) {
  return std::tie(t.table, t.channels, t.parameters, t.notes, t.simulations, t.failed_simulations, t.interrupted);
}
inline auto fields(TuneChart::Point& p) { return std::tie(p.stage, p.simulations, p.cost); }
inline auto fields(TuneChart& c) { return std::tie(c.convergence, c.starts); }

inline auto fields(Verdict::Severity& s) { return std::tie(s.value, s.lower, s.upper, s.unit); }
inline auto fields(Verdict::Suspicion& s) { return std::tie(s.name, s.severity, s.rate, s.logs_needed); }
inline auto fields(Verdict::Named& n) { return std::tie(n.name, n.probability, n.severity, n.channel); }
inline auto fields(Verdict::Detectable& d) { return std::tie(d.value, d.unit); }
inline auto fields(Verdict::Beyond& b) { return std::tie(b.first, b.where, b.depends_on, b.share, b.taken); }
inline auto fields(Verdict::Friction& f) { return std::tie(f.friction, f.largest); }

inline auto fields(Explanation::Gain& g) { return std::tie(g.value, g.lower, g.upper); }
inline auto fields(Explanation::Channel& c) {
  return std::tie(c.signal, c.unit, c.rms_before, c.rms_after, c.noise_rms, c.heldout_before, c.heldout_after);
}
inline auto fields(Explanation::Parameter& p) {
  return std::tie(p.value, p.std_error, p.unit, p.lower, p.upper, p.told);
}
inline auto fields(Explanation::Cause& c) {
  return std::tie(c.effect, c.where, c.parameters, c.heldout_gain, c.delta_bic, c.confusable_with);
}
inline auto fields(Explanation::Candidate& c) { return std::tie(c.effect, c.where, c.reason, c.taken); }

inline auto fields(Trend::Remaining& r) { return std::tie(r.median, r.lower, r.upper); }
inline auto fields(Trend::OfCheck& c) { return std::tie(c.name, c.unit, c.state, c.slope, c.alert_at, c.remaining); }
inline auto fields(TrendChart::Range& r) { return std::tie(r.lower, r.upper); }
inline auto fields(TrendChart::Point& p) { return std::tie(p.at, p.value, p.temperature, p.healthy); }
inline auto fields(TrendChart::OfCheck& c) {
  return std::tie(c.name, c.unit, c.cause, c.points, c.threshold, c.warning, c.failure, c.healthy, c.now, c.slope,
                  c.grows, c.life);
}
inline auto fields(TrendChart& c) { return std::tie(c.checks, c.life); }
inline auto fields(LogChart::OfSignal& s) {
  return std::tie(s.signal, s.unit, s.measured, s.simulated, s.residual, s.sigma);
}
inline auto fields(LogChart& c) { return std::tie(c.log, c.time, c.command, c.signals); }

inline auto fields(PlannedTest::Piece& p) { return std::tie(p.shape, p.start, p.seconds, p.amplitude, p.rate); }
inline auto fields(PlannedTest::Fault& f) {
  return std::tie(f.name, f.unit, f.least, f.from_mildest, f.severity, f.deviates, f.found, f.named, f.nearest);
}
inline auto fields(PlannedTest::Pair& p) { return std::tie(p.first, p.second, p.told); }
inline auto fields(PlannedTest::Row& r) { return std::tie(r.name, r.unit, r.before, r.after); }
inline auto fields(PlannedTest::Extremes& e) {
  return std::tie(e.current, e.stroke, e.speed, e.pressure_low, e.pressure_high, e.cavitates);
}
inline auto fields(PlannedTest::Figures& f) { return std::tie(f.information, f.faults, f.pairs, f.rows, f.extremes); }
inline auto fields(PlannedTest& p) {
  return std::tie(p.time, p.command, p.setpoint, p.pieces, p.planned, p.random_command, p.random, p.threshold, p.notes,
                  p.simulations, p.failed_simulations, p.interrupted);
}

inline auto fields(AcceptanceSheet::Figure& f) {
  return std::tie(f.name, f.signal, f.value, f.unit, f.limit, f.pass, f.note);
}
inline auto fields(AcceptanceSheet::Curve& c) { return std::tie(c.signal, c.current, c.up, c.down, c.mean); }
inline auto fields(AcceptanceSheet::Response& r) { return std::tie(r.frequency, r.gain, r.phase, r.coherence); }
inline auto fields(AcceptanceSheet& s) {
  return std::tie(s.kind, s.figures, s.curves, s.response, s.response_signal, s.notes);
}

inline auto fields(Fleet::Row& r) {
  return std::tie(r.file, r.log, r.kind, r.fault, r.severity, r.probability, r.error, r.threshold);
}
inline auto fields(Fleet::Refused& r) { return std::tie(r.file, r.line, r.column, r.rule, r.mend); }
inline auto fields(Fleet& f) { return std::tie(f.rows, f.refused, f.unread, f.interrupted, f.without_schema, f.csv); }

namespace python {

inline auto fields(TunedOnRig& t) { return std::tie(t.tuned, t.rig, t.chart); }
inline auto fields(SimulationOfLog& s) { return std::tie(s.run, s.log, s.rig); }
inline auto fields(VerdictText& v) {
  return std::tie(v.json, v.log, v.interrupted, v.kind, v.error, v.threshold, v.p_value, v.fault, v.faults, v.severity,
                  v.probabilities, v.ambiguous_with, v.separating_test, v.onset, v.suspicion, v.detectable, v.beyond,
                  v.friction, v.action_class, v.action, v.parameters, v.channels, v.notes, v.simulations,
                  v.failed_simulations);
}
inline auto fields(ExplanationText& e) {
  return std::tie(e.json, e.kind, e.where, e.depends_on, e.channels, e.causes, e.standing, e.candidates,
                  e.probabilities, e.table, e.notes, e.simulations, e.failed_simulations, e.interrupted);
}
inline auto fields(TrendWithChart& t) {
  return std::tie(t.valve, t.serial, t.state, t.at, t.checks, t.cause, t.alert_at, t.remaining, t.trends, t.notes,
                  t.chart);
}

}  // namespace python
}  // namespace servodx
