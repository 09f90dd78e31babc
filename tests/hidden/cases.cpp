#include "hidden/cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "base/random.h"
#include "base/wilson.h"
#include "report/explain/explain_words.h"
#include "rig/excitations.h"
#include "rig/rig_model.h"
#include "rig/rig_run.h"

namespace servodx::hidden {
namespace {

using Json = nlohmann::json;
using rig::RigModel;
using rig::RigRun;

struct Hiding {
  RigModel model;
  RigRun run;
  int late = 0;  // samples by which the valve gets the command later than the log says
  std::function<rig::Load(double)> unlogged_load;
  Truth truth;
};

rig::Sensor& sensor(RigModel& m, const std::string& signal) {
  return *std::find_if(m.sensors.begin(), m.sensors.end(), [&](const rig::Sensor& s) { return s.signal == signal; });
}

using Hide = void (*)(Hiding&, Random&);
struct Effect {
  std::string name;
  Hide hide;
};

const std::vector<Effect>& listed_effects() {
  static const std::vector<Effect> list = {
      {"magnetic_hysteresis",
       [](Hiding& h, Random& r) {
         const double by = r.uniform(2.5, 5);
         h.model.motor_coercive_mmf *= by;
         h.truth = {"magnetic_hysteresis", {"drive"}, "", 0, fmt::format("coercive force times {:.2f}", by)};
       }},
      {"mount_compliance",
       [](Hiding& h, Random& r) {
         const double by = r.uniform(4, 12), was = h.model.actuator_earth_stiffness;
         h.model.actuator_earth_stiffness /= by;
         h.truth = {"mount_compliance",
                    {"piston_force"},
                    "mount_compliance",
                    (by - 1) / was,
                    fmt::format("earth attachment {:.1f} times softer", by)};
       }},
      {"stiction",
       [](Hiding& h, Random& r) {
         const double by = r.uniform(4, 12);
         h.model.spool_coulomb *= by, h.model.spool_breakaway *= 1.2 * by;
         h.truth = {"stiction", {"spool"}, "", 0, fmt::format("spool friction times {:.1f}", by)};
       }},
      {"transport_delay",
       [](Hiding& h, Random& r) {
         h.late = 1 + static_cast<int>(r.below(4));
         h.truth = {"transport_delay", {"drive"}, "transport_delay", h.late * 1e-3, fmt::format("{} ms", h.late)};
       }},
      {"mains_pickup",
       [](Hiding& h, Random& r) {
         static const std::vector<std::pair<std::string, double>> lines = {
             {"spool_position", 1e-6}, {"piston_position", 6e-5}, {"pressure_a", 6e4}, {"pressure_b", 6e4}};
         const auto& [signal, size] = lines[r.below(4)];
         sensor(h.model, signal).pickup = size * r.uniform(1, 3);
         h.truth = {"mains_pickup", {"sensor:" + signal}, "", 0, signal};
       }},
      {"viscosity_change",
       [](Hiding& h, Random& r) {
         const double by = r.uniform() < 0.5 ? r.uniform(0.3, 0.5) : r.uniform(2, 3.5);
         h.run.viscosity = by;  // another oil in the same hardware
         h.truth = {"viscosity_change",
                    {"metering", "piston_force"},
                    "viscosity_factor",
                    by - 1,
                    fmt::format("times {:.2f}", by)};
       }},
      {"supply_droop",
       [](Hiding& h, Random& r) {
         // The log has the pressure at the pump, steady; the line to the valve is choked.
         const double drop = r.uniform(15e5, 40e5);
         h.model.supply_line_drop = drop;
         h.run.channels = {"spool_position",  "piston_position", "pressure_a",     "pressure_b",
                           "return_pressure", "load_force",      "oil_temperature"};
         h.truth = {"supply_droop", {"supply"}, "", 0, fmt::format("{:.0f} bar at rated flow", drop * 1e-5)};
       }},
      {"stribeck_friction",
       [](Hiding& h, Random& r) {
         const double more = r.uniform(200, 600);
         h.model.actuator_breakaway += more;
         h.truth = {"stribeck_friction",
                    {"piston_force"},
                    "piston_stribeck_friction",
                    more,
                    fmt::format("{:.0f} N above sliding", more)};
       }},
      {"asymmetric_lap",
       [](Hiding& h, Random& r) {
         const double by = r.uniform(6e-6, 20e-6) * (r.uniform() < 0.5 ? -1 : 1);
         (r.uniform() < 0.5 ? h.model.edges_lap_pa : h.model.edges_lap_bt) += by;
         h.truth = {"asymmetric_lap", {"metering"}, "", 0, fmt::format("one edge by {:.1f} um", by * 1e6)};
       }},
      {"air_entrainment",
       [](Hiding& h, Random& r) {
         h.run.air = r.uniform(0.04, 0.09);
         h.truth = {"air_entrainment", {"flow_a", "flow_b"}, "", 0, fmt::format("{:.1f} % of air", h.run.air * 100)};
       }},
      {"cross_piston_leakage",
       [](Hiding& h, Random& r) {
         const double more = r.uniform(1e-12, 6e-12);
         h.model.actuator_leakage += more;
         // Stated with oil at no pressure; the model's is as it is in the chambers, at half the supply.
         const double thick = 0.5 * h.model.supply_pressure * h.model.oil_viscosity_pressure;
         h.truth = {"cross_piston_leakage",
                    {"flow_a", "flow_b"},
                    "cross_piston_leakage",
                    more / (1 + thick * (1 + 0.5 * thick)),
                    fmt::format("{:.3g} m3/s/Pa", more)};
       }},
      {"sensor_lag",
       [](Hiding& h, Random& r) {
         static const std::vector<std::string> signals = {"piston_position", "spool_position", "pressure_a"};
         const std::string& s = signals[r.below(3)];
         const double more = s == "spool_position" ? r.uniform(1e-3, 4e-3) : r.uniform(3e-3, 12e-3);
         sensor(h.model, s).lag += more;
         h.truth = {"sensor_lag",
                    {"sensor:" + s},
                    s == "piston_position"  ? "position_sensor_lag"
                    : s == "spool_position" ? "spool_sensor_lag"
                                            : "pressure_a_sensor_lag",
                    more,
                    fmt::format("{} {:.1f} ms", s, more * 1e3)};
       }},
      {"sensor_gain_error",
       [](Hiding& h, Random& r) {
         static const std::vector<std::string> signals = {"piston_position", "spool_position", "pressure_b"};
         const std::string& s = signals[r.below(3)];
         const double by = r.uniform(0.03, 0.10) * (r.uniform() < 0.5 ? -1 : 1);
         sensor(h.model, s).gain *= 1 + by;
         h.truth = {"sensor_gain_error",
                    {"sensor:" + s},
                    s == "piston_position"  ? "position_sensor_gain"
                    : s == "spool_position" ? "spool_sensor_gain"
                                            : "pressure_b_sensor_gain",
                    by,
                    fmt::format("{} by {:.1f} %", s, by * 100)};
       }},
      {"flow_force",
       [](Hiding& h, Random& r) {
         h.model.spool_jet_angle = r.uniform(35, 55);
         h.truth = {"flow_force", {"spool"}, "", 0, fmt::format("jet angle {:.0f} deg", h.model.spool_jet_angle)};
       }},
  };
  return list;
}

const std::vector<Effect>& unlisted_effects() {
  static const std::vector<Effect> list = {
      {"unlisted:spring",  // something pulls at the rod that the load cell does not see
       [](Hiding& h, Random& r) {
         const double stiffness = r.uniform(2e4, 8e4);
         h.unlogged_load = [stiffness](double) { return rig::Load{0.0, stiffness}; };
         h.truth = {"unlisted:spring",  {"piston_force"}, "", 0, fmt::format("{:.0f} N/mm", 1e-3 * stiffness),
                    {"piston_position"}};
       }},
      {"unlisted:saturation",  // the armature's iron saturates
       [](Hiding& h, Random& r) {
         const double times = r.uniform(0.35, 0.5);
         h.model.motor_saturation_flux *= times;
         h.truth = {"unlisted:saturation", {"drive", "first_stage"}, "", 0, fmt::format("flux times {:.2f}", times),
                    {"coil_current"}};
       }},
      {"unlisted:cushion",  // a brake about mid-stroke: the stops' cushions reach far
       [](Hiding& h, Random& r) {
         h.model.actuator_cushion_length = 0.1;
         h.model.actuator_stroke = 0.2;
         h.model.actuator_cushion_damping = r.uniform(1e4, 3e4);
         h.truth = {"unlisted:cushion",
                    {"piston_force"},
                    "",
                    0,
                    fmt::format("{:.0f} kN s/m", 1e-3 * h.model.actuator_cushion_damping),
                    {"piston_velocity", "piston_position by piston_velocity"}};
       }},
  };
  return list;
}

std::string write(const Hiding& h, const std::filesystem::path& path) {
  rig::RigLog log;
  if (h.unlogged_load) {
    rig::Stimulus s =
        rig::make_stimulus(h.run.excitation, h.model, {h.run.duration, h.run.amplitude, h.run.frequency, h.run.seed});
    const auto own = s.load;
    const auto more = h.unlogged_load;
    s.load = [own, more](double t) {
      rig::Load l = own ? own(t) : rig::Load{};
      l.stiffness += more(t).stiffness;
      return l;
    };
    log = run_rig(h.model, h.run, s);
    // The cell is not in its way: what it shows is left out of the log.
    std::erase_if(log.columns, [](const OutputColumn& c) { return c.signal == Signal::load_force; });
  } else {
    log = run_rig(h.model, h.run);
  }
  if (h.late > 0)
    for (OutputColumn& c : log.columns) {
      if (c.signal == Signal::command)
        c.value.erase(c.value.begin(), c.value.begin() + h.late);
      else
        c.value.erase(c.value.end() - h.late, c.value.end());
    }
  write_log(path.string(), log.columns);
  return path.string();
}

RigRun conditions(Random& r, double seconds) {
  RigRun run;
  run.duration = seconds;
  run.temperature = 273.15 + r.uniform(25, 55);
  run.air = 0.003 * std::exp(r.uniform(0, 1));
  run.seed = r.bits64();
  return run;
}

std::vector<std::string> names(const std::vector<Effect>& list) {
  std::vector<std::string> out;
  for (const Effect& e : list) out.push_back(e.name);
  return out;
}

}  // namespace

const std::vector<std::string>& effects() {
  static const std::vector<std::string> list = names(listed_effects());
  return list;
}
const std::vector<std::string>& unlisted() {
  static const std::vector<std::string> list = names(unlisted_effects());
  return list;
}

std::vector<std::string> healthy_logs(const Bench& bench, std::uint64_t seed, int count, const std::string& name,
                                      double seconds) {
  static const std::vector<std::string> excitations = {"mixed", "flight", "steps_large", "mixed", "flight", "triangle"};
  const RigModel model = rig::another_valve(rig::read_rig_model(bench.rig_model), bench.valve);
  std::vector<std::string> out;
  for (int k = 0; k < count; ++k) {
    Random random(seed, static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(bench.valve), 0x4ea1);
    Hiding h{model, conditions(random, seconds), 0, {}, {}};
    h.run.excitation = excitations[static_cast<std::size_t>(k) % excitations.size()];
    out.push_back(write(h, bench.folder / fmt::format("{}_{:02}_{}.csv", name, k, h.run.excitation)));
  }
  return out;
}

Case make_case(const Bench& bench, std::uint64_t seed, const std::string& effect, double seconds,
               const std::vector<std::string>& excitations) {
  const RigModel model = rig::another_valve(rig::read_rig_model(bench.rig_model), bench.valve);
  Random random(seed, 0, static_cast<std::uint32_t>(bench.valve), 0x41dd);
  Hiding h{model, conditions(random, seconds), 0, {}, {"none", {}, "", 0, ""}};
  std::string picked = effect.empty() ? effects()[random.below(static_cast<std::uint32_t>(effects().size()))] : effect;
  for (const auto* list : {&listed_effects(), &unlisted_effects()})
    for (const Effect& e : *list)
      if (e.name == picked) e.hide(h, random);
  Case out;
  const std::string stem = fmt::format("case_v{}_{}", bench.valve, seed);
  for (const std::string& excitation : excitations) {
    h.run.excitation = excitation;
    h.run.seed += 1;
    out.logs.push_back(write(h, bench.folder / fmt::format("{}_{}.csv", stem, excitation)));
  }
  out.sealed = (bench.folder / (stem + ".sealed")).string();
  std::ofstream(out.sealed) << Json{{"effect", h.truth.effect},       {"where", h.truth.where},
                                    {"parameter", h.truth.parameter}, {"change", h.truth.change},
                                    {"size", h.truth.size},           {"depends_on", h.truth.depends_on}};
  return out;
}

Truth unseal(const std::string& sealed) {
  std::ifstream in(sealed);
  const Json j = Json::parse(in);
  return {j.at("effect"), j.at("where").get<std::vector<std::string>>(),     j.at("parameter"), j.at("change"),
          j.at("size"),   j.at("depends_on").get<std::vector<std::string>>()};
}

Score score(const Truth& truth, const ExplainResult& answer) {
  Score out;
  out.truth = truth;
  out.verdict = answer.verdict;
  out.accused = answer.verdict != ExplainVerdict::sufficient;
  out.where = answer.where;
  if (!answer.causes.empty()) {
    const ExplainedCause& first = answer.causes.front();
    out.first = first.effect;
    out.named =
        first.effect == truth.effect || std::any_of(first.confusable_with.begin(), first.confusable_with.end(),
                                                    [&](const std::string& c) { return c.starts_with(truth.effect); });
    out.heldout_gain = answer.heldout_gain.value;
    if (first.effect == truth.effect && !truth.parameter.empty())
      for (const ExplainedParameter& p : first.parameters)
        if (p.name == truth.parameter && p.told != SizeTold::at_bound)
          out.size_inside = p.lower <= p.before + truth.change && p.before + truth.change <= p.upper;
  }
  if (truth.effect.starts_with("unlisted:")) out.named = answer.verdict == ExplainVerdict::unexplained;
  const auto one_of = [](const std::vector<std::string>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  out.placed = one_of(truth.where, out.where);
  if (!truth.depends_on.empty()) out.variable = out.named && out.placed && one_of(truth.depends_on, answer.depends_on);
  for (const ExplainedCandidate& c : answer.candidates) {
    if (c.effect != truth.effect || std::find(truth.where.begin(), truth.where.end(), c.where) == truth.where.end())
      continue;
    if (c.fitted && c.heldout_gain.value > 0 && !answer.causes.empty())
      out.gain_share = out.heldout_gain / c.heldout_gain.value;
    if (!out.named)
      out.note = fmt::format("{} {}: {} (gain {:.1f}, p {:.3g})", c.effect, c.where, report::words_of(c.fate),
                             c.predicted_gain, c.p_new.value_or(-1));
    break;
  }
  return out;
}

namespace {

// "12 of 14 (86 %, 60 to 96)"
std::string share(int k, int n) {
  if (n == 0) return "0 of 0";
  const RateInterval rate = wilson_95(k, n);
  return fmt::format("{} of {} ({:.0f} %, {:.0f} to {:.0f})", k, n, 100.0 * k / n, 100 * rate.lower, 100 * rate.upper);
}

}  // namespace

std::string tally(const std::vector<Score>& scores) {
  struct Count {
    int n = 0, named = 0, placed = 0, silent = 0, sized = 0, inside = 0, gained = 0, enough = 0, by_variable = 0;
  };
  std::map<std::string, Count> by;
  Count listed, not_listed, none;
  for (const Score& s : scores) {
    Count& kind = s.truth.effect == "none" ? none : s.truth.effect.starts_with("unlisted:") ? not_listed : listed;
    for (Count* c : {&by[s.truth.effect], &kind}) {
      c->n++, c->named += s.named, c->placed += s.placed, c->silent += !s.accused;
      if (s.size_inside) c->sized++, c->inside += *s.size_inside;
      if (s.variable) c->by_variable += *s.variable;
      if (s.gain_share) c->gained++, c->enough += *s.gain_share >= 0.8;
    }
  }
  std::string out = fmt::format("{:24} {:>5} {:>6} {:>7} {:>7} {:>12}\n", "effect", "cases", "named", "placed",
                                "silent", "size inside");
  for (const auto& [name, c] : by)
    out +=
        fmt::format("{:24} {:5} {:6} {:7} {:7} {:>9}/{}\n", name, c.n, c.named, c.placed, c.silent, c.inside, c.sized);
  out += "named first or as a declared alternative: " + share(listed.named, listed.n) + "\n";
  out += "placed: " + share(listed.placed, listed.n) + "\n";
  out += "sizes inside their 90 % interval: " + share(listed.inside, listed.sized) + "\n";
  out += "held-out gain at least 80 % of the true effect's: " + share(listed.enough, listed.gained) + "\n";
  out += "controls accused: " + share(none.n - none.silent, none.n) + "\n";
  if (not_listed.n > 0) {
    out += "not in the list, called unexplained: " + share(not_listed.named, not_listed.n) + "\n";
    out += "  and placed: " + share(not_listed.placed, not_listed.n) + "\n";
    out += "  and by the right variable: " + share(not_listed.by_variable, not_listed.n) + "\n";
  }
  return out;
}

nlohmann::json to_json(const Score& s) {
  const auto maybe = [](const auto& value) { return value ? Json(*value) : Json(nullptr); };
  return {{"effect", s.truth.effect},
          {"places", s.truth.where},
          {"size", s.truth.size},
          {"verdict", report::word_of(s.verdict)},
          {"first", s.first},
          {"where", s.where},
          {"named", s.named},
          {"placed", s.placed},
          {"accused", s.accused},
          {"size_inside", maybe(s.size_inside)},
          {"variable", maybe(s.variable)},
          {"heldout_gain", s.heldout_gain},
          {"gain_share", maybe(s.gain_share)},
          {"note", s.note}};
}

Score from_json(const nlohmann::json& j) {
  Score s;
  s.truth.effect = j.at("effect"), s.truth.where = j.at("places").get<std::vector<std::string>>();
  s.truth.size = j.at("size");
  for (const ExplainVerdict v : {ExplainVerdict::sufficient, ExplainVerdict::extended, ExplainVerdict::unexplained})
    if (j.at("verdict") == report::word_of(v)) s.verdict = v;
  s.first = j.at("first"), s.where = j.at("where");
  s.named = j.at("named"), s.placed = j.at("placed"), s.accused = j.at("accused");
  if (!j.at("size_inside").is_null()) s.size_inside = j.at("size_inside").get<bool>();
  if (const auto v = j.value("variable", Json(nullptr)); !v.is_null()) s.variable = v.get<bool>();
  s.heldout_gain = j.at("heldout_gain");
  if (!j.at("gain_share").is_null()) s.gain_share = j.at("gain_share").get<double>();
  s.note = j.at("note");
  return s;
}

}  // namespace servodx::hidden
