#include "explain/blocks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "effects/unexplained.h"
#include "explain/constants.h"
#include "fit/log_data.h"
#include "optimise/unit_cube.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "simulate/balance.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

double mean_square(const std::vector<double>& x) {
  double sum = 0;
  for (double v : x) sum += v * v;
  return x.empty() ? 0 : sum / static_cast<double>(x.size());
}

// Share of the square of y about its mean that a line in x takes.
double line_share(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(y.size());
  double mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t k = 0; k < y.size(); ++k) mx += x[k] / n, my += y[k] / n;
  for (std::size_t k = 0; k < y.size(); ++k)
    xx += (x[k] - mx) * (x[k] - mx), yy += (y[k] - my) * (y[k] - my), xy += (x[k] - mx) * (y[k] - my);
  return xx > 0 && yy > 0 ? xy * xy / (xx * yy) : 0;
}

std::vector<double> signs(const std::vector<double>& x) {
  std::vector<double> out;
  for (double v : x) out.push_back(v > 0 ? 1.0 : v < 0 ? -1.0 : 0.0);
  return out;
}

BlockReplay pooled(ReplayedBlock& block) {
  BlockReplay out = std::move(block.about);
  std::vector<double> missing, passing;
  for (const ReplayedPart& p : block.parts) {
    missing.insert(missing.end(), p.missing.begin(), p.missing.end());
    passing.insert(passing.end(), p.passing.begin(), p.passing.end());
  }
  out.missing = std::sqrt(mean_square(missing)), out.passing = std::sqrt(mean_square(passing));
  for (std::size_t v = 0; v < block.parts.front().variables.size(); ++v) {
    std::vector<double> x;
    for (const ReplayedPart& p : block.parts)
      x.insert(x.end(), p.variables[v].second.begin(), p.variables[v].second.end());
    if (const double share = line_share(x, missing); share > out.share)
      out.share = share, out.variable = block.parts.front().variables[v].first;
  }
  return out;
}

ReplayedBlock to_spool() {
  return {{"current -> spool", {"drive", "first_stage", "spool", "sensor:spool_position"}, "current", "A"},
          {},
          Unexplained::drive};
}
ReplayedBlock to_flow_a() {
  return {{"spool and pressures -> flow A",
           {"metering", "flow_a", "supply", "sensor:spool_position", "sensor:pressure_a"},
           "flow_a",
           "m3/s"},
          {},
          Unexplained::at_a};
}
ReplayedBlock to_flow_b() {
  return {{"spool and pressures -> flow B",
           {"metering", "flow_b", "supply", "sensor:spool_position", "sensor:pressure_b"},
           "flow_b",
           "m3/s"},
          {},
          Unexplained::at_b};
}
ReplayedBlock to_motion() {
  return {{"pressures -> motion", {"piston_force", "sensor:pressure_a", "sensor:pressure_b"}, "piston_force", "N"},
          {},
          Unexplained::piston};
}

Measured measured_of(const LogData& data) {
  Measured out;
  for (const FitChannel& channel : data.channels) {
    const std::vector<double>* m = &channel.measured;
    if (channel.signal == Signal::spool_position) out.spool = m;
    if (channel.signal == Signal::piston_position) out.piston = m;
    if (channel.signal == Signal::pressure_a) out.pressure_a = m;
    if (channel.signal == Signal::pressure_b) out.pressure_b = m;
  }
  return out;
}

// What is missing of the spool's travel, as the current that the feedback wire would balance.
ReplayedPart spool_part(const Scenario& in, const std::vector<double>& residual, const std::vector<double>& simulated,
                        const ParameterVector& candidate) {
  const double per_metre = candidate[row::feedback_wire_stiffness] / candidate[row::torque_motor_gain];
  ReplayedPart part;
  std::vector<double> x, v;
  for (std::size_t k = 1; k < residual.size(); ++k) {
    if (!std::isfinite(residual[k])) continue;
    part.missing.push_back(per_metre * residual[k]);
    part.passing.push_back(in.command[k]);
    x.push_back(simulated[k]);
    v.push_back((simulated[k] - simulated[k - 1]) / (in.time[k] - in.time[k - 1]));
  }
  part.variables = {{"coil_current", part.passing},
                    {"spool_position", x},
                    {"spool_velocity", v},
                    {"direction of the spool", signs(v)}};
  return part;
}

// What a balance misses beside what passes, area times `by`: flow by the piston's velocity, force by the load pressure.
ReplayedPart balance_part(const Balance& b, const std::vector<double>& missing, double area,
                          const std::vector<double>& by) {
  ReplayedPart part;
  part.missing = missing;
  for (double v : by) part.passing.push_back(area * v);
  part.variables = {{"piston_position", b.piston},
                    {"piston_velocity", b.velocity},
                    {"direction of the piston", signs(b.velocity)},
                    {"load_pressure", b.load_pressure}};
  if (!b.spool.empty()) part.variables.push_back({"spool_position", b.spool});
  return part;
}

}  // namespace

std::vector<ReplayedBlock> replay_parts(const ValveSubject& subject, const Point& point, int log) {
  const auto problem = subject.problem({});
  const std::vector<Trajectory> runs = problem->trajectories(point);
  ReplayedBlock spool = to_spool(), flow_a = to_flow_a(), flow_b = to_flow_b(), motion = to_motion();
  for (std::size_t l = 0; l < subject.logs().size(); ++l) {
    if (log >= 0 && static_cast<int>(l) != log) continue;
    const LogData& data = subject.logs()[l];
    const ParameterVector candidate = problem->candidate(point, static_cast<int>(l));
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
      if (data.channels[c].signal != Signal::spool_position || !runs[l].ok) continue;
      const std::vector<double> residual = problem->raw_residual(static_cast<int>(l), static_cast<int>(c), runs[l]);
      const auto simulated = static_cast<std::size_t>(data.channels[c].simulated);
      ReplayedPart part = spool_part(data.scenario, residual, runs[l].signals[simulated], candidate);
      if (!part.missing.empty()) spool.parts.push_back(std::move(part));
    }
    const Balance b = balance(data.scenario, measured_of(data), candidate, explain_constants::window);
    if (b.time.empty()) continue;
    if (!b.flow_a.empty()) {
      flow_a.parts.push_back(balance_part(b, b.flow_a, candidate[row::piston_area_a], b.velocity));
      flow_b.parts.push_back(balance_part(b, b.flow_b, candidate[row::piston_area_b], b.velocity));
    }
    motion.parts.push_back(balance_part(b, b.force, candidate[row::piston_area_a], b.load_pressure));
  }
  std::vector<ReplayedBlock> blocks;
  for (ReplayedBlock* block : {&spool, &flow_a, &flow_b, &motion})
    if (!block->parts.empty()) blocks.push_back(std::move(*block));
  return blocks;
}

std::vector<BlockReplay> replay_blocks(const ValveSubject& subject, const Point& point, int log) {
  std::vector<BlockReplay> out;
  for (ReplayedBlock& b : replay_parts(subject, point, log)) out.push_back(pooled(b));
  return out;
}

}  // namespace servodx
