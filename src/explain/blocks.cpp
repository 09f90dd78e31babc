#include "explain/blocks.h"

#include <algorithm>
#include <cmath>

#include "fit/log_data.h"
#include "optimise/problem.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "simulate/balance.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

constexpr double window = 20e-3;  // [s] short against a stroke, long against the noise of a position

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

}  // namespace

std::vector<ReplayedBlock> replay_parts(const ValveSubject& subject, const Point& point, int log) {
  const auto problem = subject.problem({});
  const std::vector<Trajectory> runs = problem->trajectories(point);
  std::vector<ReplayedBlock> blocks = {
      {{"current -> spool", {"drive", "first_stage", "spool", "sensor:spool_position"}, "current", "A"}, {}},
      {{"spool and pressures -> flow A",
        {"metering", "flow_a", "supply", "sensor:spool_position", "sensor:pressure_a"},
        "flow_a",
        "m3/s"},
       {}},
      {{"spool and pressures -> flow B",
        {"metering", "flow_b", "supply", "sensor:spool_position", "sensor:pressure_b"},
        "flow_b",
        "m3/s"},
       {}},
      {{"pressures -> motion", {"piston_force", "sensor:pressure_a", "sensor:pressure_b"}, "piston_force", "N"}, {}}};
  for (std::size_t l = 0; l < subject.logs().size(); ++l) {
    if (log >= 0 && static_cast<int>(l) != log) continue;
    const LogData& data = subject.logs()[l];
    const ParameterVector candidate = problem->candidate(point, static_cast<int>(l));
    Measured measured;
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
      const FitChannel& channel = data.channels[c];
      const std::vector<double>* m = &channel.measured;
      if (channel.signal == Signal::piston_position) measured.piston = m;
      if (channel.signal == Signal::pressure_a) measured.pressure_a = m;
      if (channel.signal == Signal::pressure_b) measured.pressure_b = m;
      if (channel.signal != Signal::spool_position) continue;
      measured.spool = m;
      if (!runs[l].ok) continue;
      const std::vector<double> residual = problem->raw_residual(static_cast<int>(l), static_cast<int>(c), runs[l]);
      const std::vector<double>& simulated = runs[l].signals[static_cast<std::size_t>(channel.simulated)];
      const double per_metre = candidate[row::feedback_wire_stiffness] / candidate[row::torque_motor_gain];
      ReplayedPart part;
      std::vector<double> x, v;
      for (std::size_t k = 1; k < residual.size(); ++k) {
        if (!std::isfinite(residual[k])) continue;
        part.missing.push_back(per_metre * residual[k]);
        part.passing.push_back(data.scenario.command[k]);
        x.push_back(simulated[k]);
        v.push_back((simulated[k] - simulated[k - 1]) / (data.scenario.time[k] - data.scenario.time[k - 1]));
      }
      part.variables = {{"coil_current", part.passing},
                        {"spool_position", x},
                        {"spool_velocity", v},
                        {"direction of the spool", signs(v)}};
      if (!part.missing.empty()) blocks[0].parts.push_back(std::move(part));
    }
    const Balance b = balance(data.scenario, measured, candidate, window);
    if (b.time.empty()) continue;
    const auto part_of = [&](const std::vector<double>& missing, double area, const std::vector<double>& by) {
      ReplayedPart part;
      part.missing = missing;
      for (double v : by) part.passing.push_back(area * v);
      part.variables = {{"piston_position", b.piston},
                        {"piston_velocity", b.velocity},
                        {"direction of the piston", signs(b.velocity)},
                        {"load_pressure", b.load_pressure}};
      if (!b.spool.empty()) part.variables.push_back({"spool_position", b.spool});
      return part;
    };
    if (!b.flow_a.empty()) {
      blocks[1].parts.push_back(part_of(b.flow_a, candidate[row::piston_area_a], b.velocity));
      blocks[2].parts.push_back(part_of(b.flow_b, candidate[row::piston_area_b], b.velocity));
    }
    blocks[3].parts.push_back(part_of(b.force, candidate[row::piston_area_a], b.load_pressure));
  }
  std::erase_if(blocks, [](const ReplayedBlock& b) { return b.parts.empty(); });
  return blocks;
}

std::vector<BlockReplay> replay_blocks(const ValveSubject& subject, const Point& point, int log) {
  std::vector<BlockReplay> out;
  for (ReplayedBlock& b : replay_parts(subject, point, log)) out.push_back(pooled(b));
  return out;
}

}  // namespace servodx
