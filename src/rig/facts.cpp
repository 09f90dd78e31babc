#include "rig/facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/celsius.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/reading_limits.h"
#include "base/two_pi.h"
#include "base/units.h"
#include "rig/fluid.h"
#include "rig/magnetics.h"
#include "rig/passage.h"
#include "rig/virtual_rig.h"
#include "servodx/rig.h"

namespace servodx::rig {
namespace {

struct Stand {
  const RigModel& type;

  VirtualRig rig(Ports ports) const {
    RigModel m = type;
    m.ports = ports;
    if (ports != Ports::actuator && m.bench_volume <= 0.0) m.bench_volume = m.actuator_dead_volume;
    if (ports == Ports::free && m.bench_loop_drop <= 0.0) m.bench_loop_drop = 1e5;
    VirtualRig made(m, {});
    hold(made, 0.0, 0.2);
    return made;
  }
  void hold(VirtualRig& made, double current, double seconds, double force = 0.0) const {
    const double h = type.solver_step;
    for (long i = std::lround(seconds / h); i > 0; --i) made.step(current, force, 0.0, h);
  }
  double rated() const { return type.driver_rated_current; }
};

struct Point {
  double current, spool, flow;
};
// A full triangle of `period` [s] from a quarter turn on, ports free, every 0.1 % of it: up is the branch of rising
// current.
struct Loop {
  std::vector<Point> up, down;
};
Loop flow_curve(const Stand& stand, double period) {
  VirtualRig rig = stand.rig(Ports::free);
  const double h = stand.type.solver_step;
  const long span = std::lround(period / h), tick = std::max(1L, span / 1000);
  Loop loop;
  for (long i = 0; i < span + span / 4; ++i) {
    const double turn = static_cast<double>(i) / static_cast<double>(span) + 0.25, phase = turn - std::floor(turn);
    rig.step(stand.rated() * (1.0 - 4.0 * std::fabs(phase - 0.5)), 0.0, 0.0, h);
    if (i > span / 4 && i % tick == 0) {
      (phase < 0.5 ? loop.up : loop.down)
          .push_back({rig.state()[current], rig.state()[x_spool], rig.last_flows().q_across});
    }
  }
  std::reverse(loop.down.begin(), loop.down.end());
  return loop;
}

// The branch's current where its flow passes `flow`; the branch runs from low to high.
double current_at(const std::vector<Point>& branch, double flow) {
  for (std::size_t i = 1; i < branch.size(); ++i) {
    if (branch[i].flow < flow) continue;
    const double part = (flow - branch[i - 1].flow) / (branch[i].flow - branch[i - 1].flow);
    return branch[i - 1].current + part * (branch[i].current - branch[i - 1].current);
  }
  return branch.back().current;
}
double flow_at(const std::vector<Point>& branch, double current) {
  for (std::size_t i = 1; i < branch.size(); ++i) {
    if (branch[i].current < current) continue;
    const double part = (current - branch[i - 1].current) / (branch[i].current - branch[i - 1].current);
    return branch[i - 1].flow + part * (branch[i].flow - branch[i - 1].flow);
  }
  return branch.back().flow;
}

double widest(const Loop& loop, double flow) {
  double width = 0.0;
  for (double part = -0.8; part <= 0.8; part += 0.1) {
    width = std::max(width, std::fabs(current_at(loop.down, part * flow) - current_at(loop.up, part * flow)));
  }
  return width;
}

void flow_facts(const Stand& stand, std::vector<Fact>& facts) {
  // The valve's lag behind a moving current, in proportion to its speed, is no hysteresis: take it out by two speeds.
  const Loop fast = flow_curve(stand, 1.0), slow = flow_curve(stand, 2.0);
  const double end = 0.98 * stand.rated();
  const auto middle = [&](double i) { return 0.5 * (flow_at(slow.up, i) + flow_at(slow.down, i)); };
  const double most = middle(end), least = middle(-end);
  const double rated_flow = 0.5 * (most - least) / 0.98;
  facts.push_back({"no_load_flow", "l/min", 6e4 * rated_flow});
  // Linearity: from the best line through the normal flow curve; symmetry: gains of the polarities, null left out.
  double s_ii = 0.0, s_iq = 0.0, s_i = 0.0, s_q = 0.0, n = 0.0;
  for (double part = -0.95; part < 0.96; part += 0.05) {
    const double i = part * stand.rated(), q = middle(i);
    s_i += i, s_q += q, s_ii += i * i, s_iq += i * q, n += 1.0;
  }
  const double gain = (n * s_iq - s_i * s_q) / (n * s_ii - s_i * s_i), level = (s_q - gain * s_i) / n;
  double off = 0.0;
  for (double part = -0.95; part < 0.96; part += 0.05) {
    const double i = part * stand.rated();
    off = std::max(off, std::fabs(middle(i) - level - gain * i));
  }
  facts.push_back({"flow_linearity", "%", 100.0 * off / rated_flow});
  const double above = most - middle(0.1 * stand.rated()), below = middle(-0.1 * stand.rated()) - least;
  facts.push_back({"flow_symmetry", "%", 100.0 * std::fabs(above - below) / std::max(above, below)});
  facts.push_back({"hysteresis", "% of rated",
                   100.0 * (2.0 * widest(slow, rated_flow) - widest(fast, rated_flow)) / stand.rated()});
}

double threshold(const Stand& stand) {
  // Coming up and then turning back: the current change that moves the spool by a tenth of a percent of its stroke.
  VirtualRig rig = stand.rig(Ports::free);
  const double h = stand.type.solver_step, rated = stand.rated();
  double u = 0.0;
  for (; u < 0.1 * rated; u += 0.5 * rated * h) rig.step(u, 0.0, 0.0, h);
  stand.hold(rig, u, 0.1);
  const double start = rig.state()[x_spool], turned = u;
  while (rig.state()[x_spool] > start - 1e-3 * stand.type.spool_stroke && u > 0.05 * rated) {
    u -= 0.05 * rated * h;
    rig.step(u, 0.0, 0.0, h);
  }
  return (turned - u) / rated;
}

// Supply pressure per stroke, steepest within 2 % of null: each port stands where its two edges carry the same flow.
double pressure_gain(const RigModel& m) {
  const Oil oil(m, 40.0 + zero_celsius, 0.0);
  const Edges edges(m);
  const double high = m.supply_pressure, tank = m.supply_tank_pressure;
  const auto load_pressure = [&](double x) {
    const Edges::Shape shape = edges.at(x);
    double low_a = tank, top_a = high, low_b = tank, top_b = high;
    for (int i = 0; i < 40; ++i) {
      const double a = 0.5 * (low_a + top_a), b = 0.5 * (low_b + top_b);
      const Four q = flows_through(shape.law, oil, four(high, a, high, b), four(a, tank, b, tank)).volume;
      (q[edge_pa] > q[edge_at] ? low_a : top_a) = a;
      (q[edge_pb] > q[edge_bt] ? low_b : top_b) = b;
    }
    return low_a - low_b;
  };
  const double percent = 0.01 * m.spool_stroke;
  double steepest = 0.0;
  for (double x = -2.0 * percent; x < 2.0 * percent; x += 0.1 * percent) {
    steepest = std::max(steepest, load_pressure(x + 0.5 * percent) - load_pressure(x - 0.5 * percent));
  }
  return steepest / high;
}

struct Response {
  double phase;  // [deg]
  double gain;   // [1] spool over stroke per current over rated
};
Response response(const Stand& stand, double frequency, double amplitude) {
  VirtualRig rig = stand.rig(Ports::free);
  const double h = stand.type.solver_step;
  const int periods = std::max(2, static_cast<int>(0.06 * frequency));
  const long span = std::lround(periods / frequency / h);
  double in = 0.0, out = 0.0;
  for (long i = 0; i < 2 * span; ++i) {
    const double turn = two_pi * frequency * static_cast<double>(i) * h;
    rig.step(amplitude * stand.rated() * std::sin(turn), 0.0, 0.0, h);
    if (i < span) continue;
    const double after = turn + two_pi * frequency * h;
    in += rig.state()[x_spool] * std::sin(after);
    out += rig.state()[x_spool] * std::cos(after);
  }
  return {std::atan2(out, in) * 360.0 / two_pi,
          std::hypot(in, out) * 2.0 / static_cast<double>(span) / (amplitude * stand.type.spool_stroke)};
}

// Frequency [Hz] up to which `holds`, by bisection between 10 and 500 Hz in its logarithm.
template <class Holds>
double frequency_up_to(const Holds& holds) {
  double low = 10.0, high = 500.0;
  while (high / low > 1.02) {
    const double middle = std::sqrt(low * high);
    (holds(middle) ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

void dynamic_facts(const Stand& stand, std::vector<Fact>& facts) {
  const double slow = response(stand, 5.0, 0.1).gain;
  facts.push_back({"lag_90_at_40_percent", "Hz", frequency_up_to([&](double f) {
                     const double phase = response(stand, f, 0.4).phase;
                     return phase > -90.0 && phase < 90.0;
                   })});
  facts.push_back({"amplitude_3_dB_at_10_percent", "Hz", frequency_up_to([&](double f) {
                     return response(stand, f, 0.1).gain > slow / std::numbers::sqrt2;
                   })});
  VirtualRig rig = stand.rig(Ports::free), settled = rig;
  stand.hold(settled, stand.rated(), 0.2);
  const double start = rig.state()[x_spool], travel = settled.state()[x_spool] - start, h = stand.type.solver_step;
  double reached = 0.0, highest = 0.0;
  for (int i = 1; i < std::lround(0.1 / h); ++i) {
    rig.step(stand.rated(), 0.0, 0.0, h);
    const double part = (rig.state()[x_spool] - start) / travel;
    if (reached == 0.0 && part >= 0.9) reached = i * h;
    highest = std::max(highest, part);
  }
  facts.push_back({"step_time", "ms", 1e3 * reached});
  facts.push_back({"step_overshoot", "%", 100.0 * std::max(0.0, highest - 1.0)});
}

void motor_facts(const RigModel& m, std::vector<Fact>& facts) {
  const double i = 0.01 * m.driver_rated_current, turn = 1e-4;
  const double gain = (motor_torque(m, i, 0.0) - motor_torque(m, -i, 0.0)) / (2.0 * i);
  const double spring = (motor_torque(m, 0.0, turn) - motor_torque(m, 0.0, -turn)) / (2.0 * turn);
  const double wire = m.wire_stiffness * m.armature_ball_arm * m.armature_ball_arm;
  facts.push_back({"torque_gain", "N m/A", gain});
  facts.push_back({"magnetic_spring", "N m/rad", spring});
  facts.push_back({"magnetic_over_flexure", "1", spring / m.armature_flexure});
  facts.push_back({"first_stage_frequency", "Hz",
                   std::sqrt(std::max(0.0, m.armature_flexure - spring + wire) / m.armature_inertia) / two_pi});
  facts.push_back(
      {"coil_inductance", "H", Magnetics(m).inductance() + m.motor_leakage_inductance * m.circuit_factor()});
  facts.push_back({"magnetic_loop", "% of rated",
                   100.0 * 2.0 * m.motor_coercive_mmf / (m.working_turns() * m.driver_rated_current)});
}

void actuator_facts(const Stand& stand, std::vector<Fact>& facts) {
  VirtualRig rig = stand.rig(Ports::actuator);
  rig.state()[x_piston] = rig.state()[x_surface] = -0.3 * stand.type.actuator_stroke;
  stand.hold(rig, stand.rated(), 0.25);
  const double before = rig.piston_position();
  stand.hold(rig, stand.rated(), 0.1);
  facts.push_back({"no_load_speed", "mm/s", 1e4 * (rig.piston_position() - before)});
  // The load that stops the piston lies between the one it still lifts and the one that pushes it back.
  const double differential_area = stand.type.piston_area_a() * stand.type.supply_pressure;
  double low = 0.7 * differential_area, high = 1.2 * differential_area, differential = 1.0;
  while (high - low > 0.002 * differential_area) {
    const double force = 0.5 * (low + high), h = stand.type.solver_step;
    VirtualRig loaded = stand.rig(Ports::actuator);
    const long n = std::lround(0.1 / h);
    for (long i = 0; i < n; ++i) {
      loaded.step(stand.rated(), force * static_cast<double>(i) / static_cast<double>(n), 0.0, h);
    }
    stand.hold(loaded, stand.rated(), 0.1, force);
    const double from = loaded.piston_position();
    stand.hold(loaded, stand.rated(), 0.1, force);
    (loaded.piston_position() > from + 1e-4 ? low : high) = force;
    differential = loaded.state()[p_supply] - loaded.state()[p_return];
  }
  facts.push_back({"stall_force", "N", low * 20.7e6 / differential});
}

}  // namespace

double motor_torque(const RigModel& model, double current, double angle) {
  const Magnetics motor(model);
  // The flux at which the armature's circuit takes up the ampere turns; it rises with them.
  double low = -1.0, high = 1.0;
  const double mmf = model.working_turns() * current;
  for (int i = 0; i < 100; ++i) {
    const double flux = 0.5 * (low + high);
    (motor.at(mmf, flux, angle, 0.0).flux_rate > 0.0 ? low : high) = flux;
  }
  return motor.at(mmf, 0.5 * (low + high), angle, 0.0).torque;
}

std::vector<TorquePoint> torque_map(const RigModel& model) {
  std::vector<TorquePoint> points;
  const double stop = model.armature_stop / model.armature_nozzle_arm;
  for (int a = -6; a <= 6; ++a) {
    for (int i = -10; i <= 10; ++i) {
      const double current = 0.1 * i * model.driver_rated_current, angle = a / 6.0 * stop;
      points.push_back({current, angle, motor_torque(model, current, angle)});
    }
  }
  return points;
}

std::vector<Fact> measure_facts(const RigModel& model) {
  const Stand stand{model};
  std::vector<Fact> facts;
  flow_facts(stand, facts);
  facts.push_back({"threshold", "% of rated", 100.0 * threshold(stand)});
  facts.push_back({"pressure_gain", "% of supply per % of rated", 100.0 * pressure_gain(model)});
  VirtualRig rest = stand.rig(Ports::blocked);
  stand.hold(rest, 0.0, 1.0);
  facts.push_back({"null_bias", "% of rated", -100.0 * rest.state()[x_spool] / model.spool_stroke});
  facts.push_back({"null_leakage", "l/min", 6e4 * rest.flows().q_return});
  facts.push_back({"pilot_pressure_1", "of supply", rest.state()[p_pilot_1] / rest.state()[p_supply]});
  facts.push_back({"pilot_pressure_2", "of supply", rest.state()[p_pilot_2] / rest.state()[p_supply]});
  dynamic_facts(stand, facts);
  motor_facts(model, facts);
  if (model.has_actuator()) actuator_facts(stand, facts);
  return facts;
}

std::vector<FactLimit> read_fact_limits(const std::string& path, const std::string& rig) {
  const std::string text = read_file_within(path, largest_table);
  CsvCursor csv(text, path);
  const std::vector<std::string> expected{"rig", "fact", "unit", "low", "high", "source"};
  if (csv.header() != expected) {
    throw InputError({path, csv.header_line(), ""}, "the header is not rig,fact,unit,low,high,source", "write it so");
  }
  std::vector<FactLimit> general, own;
  while (csv.next_row()) {
    std::vector<std::string> cells;
    for (std::string cell; csv.next_cell(cell);) cells.push_back(cell);
    const auto low = cells.size() == 6 ? parse_number(cells[3]) : std::nullopt;
    const auto high = cells.size() == 6 ? parse_number(cells[4]) : std::nullopt;
    if (!low || !high || *low > *high) {
      throw InputError({path, csv.line(), ""}, "is no row of rig, fact, unit, low, high, source",
                       "give six cells, low not above high");
    }
    const FactLimit limit{cells[1], cells[2], cells[5], *low, *high};
    if (cells[0].empty()) general.push_back(limit);
    if (cells[0] == rig || (!cells[0].empty() && rig.starts_with(cells[0] + ","))) own.push_back(limit);
  }
  for (const FactLimit& limit : general) {
    if (std::none_of(own.begin(), own.end(), [&](const FactLimit& mine) { return mine.name == limit.name; })) {
      own.push_back(limit);
    }
  }
  return own;
}

}  // namespace servodx::rig
