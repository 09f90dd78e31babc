#include "rig/rig_faults.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.h"
#include "base/nearest.h"
#include "base/units.h"

namespace servodx::rig {
namespace {

// The contract's labels of faults that the rig calls by what it does.
struct Label {
  std::string label, name;
};
const std::vector<Label>& labels() {
  static const std::vector<Label> list{{"corner_wear", "corner_radius_wear"},
                                       {"driver_fault", "open_coil"},
                                       {"radial_clearance_wear", "edge_wear"}};  // a shape of it
  return list;
}

// Radius [m] that the corners have lost when the clearance has grown so many times. Spool and sleeve wear both (Borello
// 2009, degradation 5), by no law that it states: these points give the flight valve the rise of its Fig. 12 (0.5 mA at
// 5 Hz), E = 0.18, 0.255, 0.57 and 1.05e-9 m2, where the clearance alone lets E fall. Straight between them; the last
// piece goes on.
double corners_beside(double clearance) {
  struct Point {
    double times, radius;
  };
  constexpr Point points[] = {{1, 0}, {3, 4e-6}, {6, 10e-6}, {10, 40e-6}};
  std::size_t k = 1;
  while (k + 1 < std::size(points) && clearance > points[k].times) ++k;
  const Point &from = points[k - 1], &to = points[k];
  return from.radius + (to.radius - from.radius) * (clearance - from.times) / (to.times - from.times);
}

const RigFault& find(const std::string& wanted) {
  std::vector<std::string> words;
  for (const auto& fault : rig_faults()) {
    words.push_back(word_of(fault));
    if (wanted == fault.name || wanted == words.back()) return fault;
  }
  throw InputError({.file = "--fault"}, fmt::format("unknown fault '{}'", wanted),
                   fmt::format("{}known are {}", did_you_mean(wanted, words), fmt::join(words, ", ")));
}

bool move_the_same(const RigFault& a, const RigFault& b) {
  return a.quantity == b.quantity || (a.beside && a.beside == b.quantity) || (b.beside && b.beside == a.quantity);
}

void check(const RigFault& fault, const FaultCourse& course) {
  if (!(course.severity >= fault.low && course.severity <= fault.high)) {
    throw InputError(
        {.file = "--fault"},
        fmt::format("{} = {} is outside {} to {} {}", fault.name, course.severity, fault.low, fault.high, fault.unit),
        fmt::format("{} is healthy; mild, medium and severe are {}, {} and {}", fault.healthy, fault.severity[0],
                    fault.severity[1], fault.severity[2]));
  }
}

[[noreturn]] void refuse(const RigFault& fault, const std::string& text, const std::string& rule) {
  throw InputError({.file = "--fault"}, fmt::format("'{}' {}", text, rule),
                   fmt::format("write {0}={1}, {0}=medium, {0}={1}@2 to step in at 2 s, or {0}={1}@2..10 to grow",
                               fault.name, fault.severity[1]));
}

double severity_of(const RigFault& fault, const std::string& size, const std::string& text) {
  static const std::array<std::string, 3> words{"mild", "medium", "severe"};
  for (std::size_t i = 0; i < words.size(); ++i)
    if (size == words[i]) return fault.severity[i];
  if (const auto number = parse_number(size)) return *number;
  refuse(fault, text, "has no severity");
}

}  // namespace

std::string label_of(const std::string& name) {
  for (const Label& l : labels())
    if (l.name == name) return l.label;
  return name;
}

std::string word_of(const RigFault& fault) {
  const std::string label = label_of(fault.name);
  const bool taken = std::ranges::any_of(rig_faults(), [&](const RigFault& other) { return other.name == label; });
  return taken ? fault.name : label;
}

const std::vector<RigFault>& rig_faults() {
  // clang-format off
  static const std::vector<RigFault> list{
      // the contract's labels
      {"clogged_filter", "1", "blocked fraction of the pilot screen", 0.0, 0.0, 0.999, {0.25, 0.50, 0.75}, &Wear::filter_blocked},
      {"torque_motor_loss", "1", "ampere turns left of the torque motor", 1.0, 0.0, 1.0, {0.8, 0.5, 0.2}, &Wear::torque_gain},
      {"feedback_wire_backlash", "m", "clearance of the feedback ball in the spool", 0.0, 0.0, 2e-4, {5e-6, 10e-6, 20e-6}, &Wear::wire_clearance},
      {"feedback_wire_lost", "1", "stiffness left of the feedback wire; 0: it is fractured", 1.0, 0.0, 1.0, {0.5, 0.2, 0.0}, &Wear::wire_stiffness},
      {"sticky_spool", "1", "multiplier of the spool friction", 1.0, 1.0, 100.0, {4.0, 10.0, 20.0}, &Wear::spool_friction},
      {"radial_clearance_wear", "1", "multiplier of the radial clearance at the metering edges", 1.0, 1.0, 20.0, {3.0, 6.0, 10.0}, &Wear::edge_clearance},
      {"null_shift", "1", "shift of the null, fraction of rated current", 0.0, -0.5, 0.5, {0.06, 0.12, 0.20}, &Wear::null},
      {"plugged_nozzle", "1", "blocked fraction of nozzle 1, negative of nozzle 2, or of the jet", 0.0, -1.0, 1.0, {0.15, 0.50, 0.95}, &Wear::nozzle_blocked},
      {"cylinder_leakage", "m3/s/Pa", "leakage across the piston at 40 degC, beside the healthy one", 0.0, 0.0, 1e-10, {5e-13, 2e-12, 1e-11}, &Wear::piston_leakage},
      {"sensor_fault", "1", "gain of the piston position sensor", 1.0, 0.1, 2.0, {0.96, 0.90, 0.80}, &Wear::position_gain},
      {"supply_fault", "1", "supply pressure left of the pump's cut-off", 1.0, 0.05, 1.0, {0.90, 0.75, 0.50}, &Wear::supply_pressure},
      // further wear and sudden failures
      {"corner_radius_wear", "m", "radius worn on every metering corner", 0.0, 0.0, 1e-4, {5e-6, 10e-6, 20e-6}, &Wear::corner_wear},
      {"edge_wear", "1", "multiplier of the radial clearance, the metering corners worn along with it", 1.0, 1.0, 20.0, {3.0, 6.0, 10.0}, &Wear::edge_clearance, &Wear::corner_wear, corners_beside},
      {"seal_friction", "1", "multiplier of the actuator's seal friction", 1.0, 1.0, 50.0, {2.0, 4.0, 10.0}, &Wear::seal_friction},
      {"open_coil", "1", "driver voltage that still reaches the coil; of two parallel coils, what one of them conducts", 1.0, 0.0, 1.0, {0.3, 0.1, 0.0}, &Wear::coil_path},
      {"spool_jam", "N", "force by which a chip holds the spool", 0.0, 0.0, 2000.0, {50.0, 200.0, 1000.0}, &Wear::spool_jam},
  };
  // clang-format on
  return list;
}

double FaultCourse::at(double time, double healthy) const {
  if (time < start) return healthy;
  if (start < 0.0 || time >= end) return severity;
  return healthy + (severity - healthy) * (time - start) / (end - start);
}

Wear wear_of(const FaultSet& faults, double time) {
  Wear wear;
  for (const auto& [name, course] : faults) {
    const RigFault& fault = find(name);
    check(fault, course);
    const double severity = course.at(time, fault.healthy);
    wear.*fault.quantity = severity;
    if (fault.beside) wear.*fault.beside = fault.beside_at(severity);
  }
  return wear;
}

void add_fault(const std::string& text, FaultSet& faults) {
  const auto equals = text.find('='), when = text.find('@');
  const RigFault& fault = find(text.substr(0, std::min(equals, when)));
  if (equals == std::string::npos || equals > when) refuse(fault, text, "has no severity");
  FaultCourse course(severity_of(fault, text.substr(equals + 1, when - equals - 1), text));
  if (when != std::string::npos) {
    const std::string span = text.substr(when + 1);
    const auto dots = span.find("..");
    const auto start = parse_number(span.substr(0, dots));
    if (!start || *start < 0.0) refuse(fault, text, "has no time to start at");
    course.start = *start;
    if (dots != std::string::npos) {
      const auto end = parse_number(span.substr(dots + 2));
      if (!end || *end <= course.start) refuse(fault, text, "does not end after its start");
      course.end = *end;
    }
  }
  check(fault, course);
  for (const auto& [name, other] : faults)
    if (name != fault.name && move_the_same(fault, find(name)))
      throw InputError({.file = "--fault"}, fmt::format("{} and {} move the same", word_of(fault), word_of(find(name))),
                       "give one of them");
  if (!faults.emplace(fault.name, course).second) {
    throw InputError({.file = "--fault"}, fmt::format("{} is given twice", fault.name), "give it once");
  }
}

}  // namespace servodx::rig
