#include "fit/nominal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/csv.h"
#include "base/key_error.h"
#include "effects/mount_compliance.h"
#include "fit/constants.h"
#include "fit/sheet.h"
#include "parameters/list.h"
#include "servodx/rig.h"
#include "servodx/table.h"

namespace servodx {
namespace {

using std::numbers::pi;

using namespace fit_constants::stated;

double disc(double diameter) { return pi / 4 * diameter * diameter; }

std::string text_of(double value, const std::string& unit) {
  std::string text;
  append_number(text, value);
  return unit == "-" ? text : text + " " + unit;
}

// Rounded to five digits: a formula's last bits are noise in a table that people read.
double tidy(double value) {
  if (value == 0 || !std::isfinite(value)) return value;
  const double scale = std::pow(10.0, 4 - std::floor(std::log10(std::abs(value))));
  return std::round(value * scale) / scale;
}

class Facts {
 public:
  Facts(Table table, const RigFile& rig, std::vector<std::string>* where_from)
      : table_(std::move(table)), rig_(rig), where_from_(where_from) {
    // What the table implies where the rig file is silent.
    rated_current_ = rig_.fact("valve.rated_current").value_or(value(row::current_limit) / limit_over_rated);
    stroke_ = rig_.fact("valve.spool_stroke")
                  .value_or(value(row::torque_motor_gain) * (value(row::current_limit) / limit_over_rated) /
                            value(row::feedback_wire_stiffness));
    of_table_ = size(value(row::torque_motor_gain) * (value(row::current_limit) / limit_over_rated) /
                     value(row::feedback_wire_stiffness));
  }

  // What an actuator's frictions and volumes go with, as the table stands.
  struct Size {
    double force = 0;                   // [N] at stall, of the mean area
    double speed = 0;                   // [m/s] without load
    double volume_a = 0, volume_b = 0;  // [m3] swept
  };
  Size size(double stroke_of_spool) const {
    const double area = 0.5 * (value(row::piston_area_a) + value(row::piston_area_b));
    const double flow = nominal::cd_metering * value(row::port_width) * stroke_of_spool *
                        std::sqrt(differential() / rig_.fluid.density);
    return {differential() * area, flow / area, value(row::piston_area_a) * value(row::piston_stroke),
            value(row::piston_area_b) * value(row::piston_stroke)};
  }

  Table apply() {
    supply();
    spool();
    pilot_stage();
    loop_gain();
    drive();
    metering();
    actuator();
    lines();
    if (rig_.ports != Ports::actuator) test_stand();
    return std::move(table_);
  }

 private:
  double value(int row) const { return table_[row].nominal; }
  std::optional<double> fact(const char* key) const { return rig_.fact(key); }
  double differential() const { return value(row::supply_pressure) - value(row::return_pressure); }

  [[noreturn]] void refuse(const std::string& key, const std::string& rule, const std::string& mend) const {
    throw key_error({rig_.path, rig_.line(key), key}, rule, mend);
  }

  void set(int position, double nominal, double lower, double upper, const std::string& key,
           const std::string& formula) {
    Row& row = table_[position];
    row.nominal = row.log_scale ? tidy(nominal) : nominal;
    row.lower = std::min(tidy(lower), row.nominal);
    row.upper = std::max(tidy(upper), row.nominal);
    row.source = "rig.toml: " + key;
    if (where_from_)
      where_from_->push_back(row.name + " = " + text_of(row.nominal, row.unit) + ": " + row.source +
                             (formula.empty() ? "" : "; " + formula));
  }
  void set_within(int position, double nominal, double factor, const std::string& key, const std::string& formula) {
    set(position, nominal, nominal / factor, nominal * factor, key, formula);
  }

  void supply() {
    if (const auto p = fact("supply.pressure"))
      set(row::supply_pressure, *p, supply_low * *p, supply_high * *p, "supply.pressure", "");
    if (const auto p = fact("supply.return_pressure"))
      set(row::return_pressure, *p, 0, std::max(least_return_high, return_high * *p), "supply.return_pressure", "");
    if (differential() <= 0)
      refuse(fact("supply.pressure") ? "supply.pressure" : "supply.return_pressure",
             "the supply (" + text_of(value(row::supply_pressure), "Pa") + ") is not above the return (" +
                 text_of(value(row::return_pressure), "Pa") + ")",
             "give both pressures");
  }

  void spool() {
    if (const auto d = fact("valve.spool_diameter"))
      set_within(row::spool_diameter, *d, drawing, "valve.spool_diameter", "");
    if (const auto stop = fact("valve.spool_stop")) {
      if (*stop < stroke_)
        refuse("valve.spool_stop",
               "the stop (" + text_of(*stop, "m") + ") is nearer than the stroke at rated current (" +
                   text_of(stroke_, "m") + ")",
               "correct spool_stop or spool_stroke");
      set(row::spool_stop, *stop, stop_low * *stop, stop_high * *stop, "valve.spool_stop", "");
    } else if (fact("valve.spool_stroke")) {
      const double usual = stop_over_stroke * stroke_;
      set(row::spool_stop, usual, stop_low * usual, stop_high * usual, "valve.spool_stroke", "1.16 * stroke");
    }
    if (fact("valve.spool_stroke")) {
      set(row::valve_glitch, 0, 0, most_glitch * stroke_, "valve.spool_stroke", "play up to a fifth of the stroke");
      for (const int lap : {row::lap_pa, row::lap_pb, row::lap_at, row::lap_bt})
        set(lap, 0, -most_lap * stroke_, most_lap * stroke_, "valve.spool_stroke",
            "critical centre within 6 % of the stroke");
    }
  }

  void pilot_stage() {
    if (const auto f = fact("valve.torque_motor_frequency"))
      set_within(row::torque_motor_frequency, *f, dynamics, "valve.torque_motor_frequency", "");
    if (const auto d = fact("valve.nozzle_diameter"))
      set_within(row::hydraulic_amplifier_gain, pi * *d, drawing, "valve.nozzle_diameter", "pi * nozzle_diameter");
    if (const auto gap = fact("valve.nozzle_gap")) set_within(row::nozzle_gap, *gap, drawing, "valve.nozzle_gap", "");
    if (const auto d = fact("valve.fixed_orifice_diameter")) {
      set_within(row::fixed_orifice_diameter, *d * std::sqrt(short_tube_cd / nominal::cd_orifice), drawing,
                 "valve.fixed_orifice_diameter", "d * sqrt(0.8 / 0.65): a short tube as the model's orifice");
    } else if (const auto leak = fact("valve.pilot_leakage"); leak && *leak > 0) {
      // Half of the leakage through each nozzle gives the pilot pressure; the rest of the supply drops at the orifice.
      const double half = *leak / 2;
      const auto pilot_pressure = [&] {
        const double curtain = value(row::hydraulic_amplifier_gain) * value(row::nozzle_gap);
        return std::pow(half / (nominal::cd_nozzle * curtain), 2) * rig_.fluid.density / 2;
      };
      // Nozzles that the sheet does not tell are as wide as the leakage asks for.
      if (pilot_pressure() > usual_pilot * differential() && !fact("valve.nozzle_diameter") &&
          !fact("valve.nozzle_gap"))
        set_within(
            row::hydraulic_amplifier_gain,
            half / (nominal::cd_nozzle * value(row::nozzle_gap) * std::sqrt(differential() / rig_.fluid.density)),
            drawing, "valve.pilot_leakage", "nozzles pass half of it each at half the supply");
      const double p_pilot = pilot_pressure();
      if (p_pilot > most_pilot * differential())
        refuse("valve.pilot_leakage",
               "the leakage asks for " + text_of(std::round(p_pilot / 1e5), "bar") + " at the nozzles, of " +
                   text_of(std::round(differential() / 1e5), "bar") + " supplied",
               "correct it, nozzle_diameter or nozzle_gap, or give fixed_orifice_diameter");
      const double dp_orifice = (differential() - p_pilot) / filter_loss();
      const double area = half / (nominal::cd_orifice * std::sqrt(2 * dp_orifice / rig_.fluid.density));
      set_within(row::fixed_orifice_diameter, std::sqrt(4 * area / pi), drawing, "valve.pilot_leakage",
                 "orifice in series with the nozzle passes half of it");
    }
  }

  // Drop at filter and orifice over that at the orifice: the filter passes both orifices' flow.
  static double filter_loss() { return 1 + 1 / (nominal::clean_filter_area_ratio * nominal::clean_filter_area_ratio); }

  // Spool speed per flapper travel [1/s], the spool free of load.
  double amplifier_rate() const {
    const double curtain = nominal::cd_nozzle * value(row::hydraulic_amplifier_gain) * value(row::nozzle_gap);
    const double orifice = nominal::cd_orifice * disc(value(row::fixed_orifice_diameter));
    const double p_pilot = differential() / (1 + filter_loss() * std::pow(curtain / orifice, 2));
    return nominal::cd_nozzle * value(row::hydraulic_amplifier_gain) * std::sqrt(2 * p_pilot / rig_.fluid.density) /
           disc(value(row::spool_diameter));
  }

  void loop_gain() {
    const auto f = fact("valve.phase_lag_90_frequency");
    if (!f) return;
    const double wanted = loop_over_phase_lag * 2 * pi * *f;
    const double available = amplifier_rate();
    if (available <= wanted)
      refuse("valve.phase_lag_90_frequency",
             "the pilot stage moves the spool at " + text_of(std::round(available), "1/s") +
                 " per flapper travel, less than the loop gain of " + text_of(std::round(wanted), "1/s") +
                 " that this frequency asks for",
             "correct it, or give nozzle_diameter, fixed_orifice_diameter and spool_diameter");
    // A soft flapper hardly moves the loop, so the range is the loop's: to a quarter of what the sheet says.
    const double wire = value(row::feedback_wire_stiffness), stiffness = wire * (available / wanted - 1);
    set(row::flapper_stiffness, stiffness, stiffness / loop, wire * (loop * available / wanted - 1),
        "valve.phase_lag_90_frequency", "k_f = k_w (G / K_v - 1), K_v = 2/3 * 2 pi f");
  }

  void drive() {
    const bool current = fact("valve.rated_current").has_value(), stroke = fact("valve.spool_stroke").has_value();
    const std::string key = current && stroke ? "valve.rated_current, valve.spool_stroke"
                            : current         ? "valve.rated_current"
                                              : "valve.spool_stroke";
    if (current || stroke) {
      const double gain = value(row::feedback_wire_stiffness) * stroke_ / rated_current_;
      set(row::torque_motor_gain, gain, motor_low * gain, motor_high * gain, key, "k_w * stroke / rated current");
    }
    if (current)
      set(row::current_limit, limit_over_rated * rated_current_, limit_low * rated_current_,
          limit_high * rated_current_, "valve.rated_current", "1.5 * rated current");
  }

  void metering() {
    const double density = rig_.fluid.density;
    std::optional<double> flow = fact("valve.no_load_flow");
    std::string key = "valve.no_load_flow";
    double drop = differential();
    if (!flow) {
      flow = fact("valve.rated_flow");
      key = "valve.rated_flow";
      drop = fact("valve.rated_pressure_drop").value_or(rated_drop);
    }
    // Two equal edges in series: each takes half of the drop.
    if (flow)
      set_within(row::port_width, *flow / (nominal::cd_metering * stroke_ * std::sqrt(drop / density)), catalogue_flow,
                 key, "Q / (0.61 * stroke * sqrt(drop / density)), half of the drop over each edge");

    const auto null_leak = fact("valve.null_leakage");
    // Open height of an edge at null that passes the leakage which is not the pilot's: laminar and turbulent drop.
    const double edge_flow =
        null_leak ? (*null_leak - fact("valve.pilot_leakage").value_or(pilot_part * *null_leak)) / 2 : 0;
    if (null_leak && edge_flow < 0)
      refuse("valve.null_leakage", "it is less than pilot_leakage, which it includes", "correct one of the two");
    const double per_width = edge_flow / value(row::port_width);
    const double viscosity = density * rig_.fluid.kinematic_viscosity;
    const double height = std::sqrt((12 * viscosity * nominal::slot_resistance * per_width +
                                     density * std::pow(per_width / nominal::cd_metering, 2) / 2) /
                                    (differential() / 2));
    const std::string law = "open height of an edge at null from leakage";
    if (const auto clearance = fact("valve.radial_clearance")) {
      set(row::radial_clearance, *clearance, *clearance / tightest, most_worn * *clearance, "valve.radial_clearance",
          "");
    } else if (edge_flow > 0) {
      const double fit = std::clamp(height, lapped_fit_min, lapped_fit_max);
      set(row::radial_clearance, fit, fit / tightest, most_worn * fit, "valve.null_leakage",
          law + ", within 2 to 5 um of lapped fits");
    }
    // Leakage that the clearance cannot pass is underlap; a sheet gives the limit, so it widens a bound and no more.
    const double underlap = std::sqrt(std::max(0.0, height * height - std::pow(value(row::radial_clearance), 2)));
    for (const int lap : {row::lap_pa, row::lap_pb, row::lap_at, row::lap_bt})
      if (-most_underlap * underlap < table_[lap].lower)
        set(lap, value(lap), -most_underlap * underlap, table_[lap].upper, "valve.null_leakage",
            law + ": twice the underlap");
  }

  void actuator() {
    if (const auto a = fact("actuator.area_a"))
      set_within(row::piston_area_a, *a, geometry, area_key("actuator.area_a"), area_formula("a"));
    if (const auto a = fact("actuator.area_b"))
      set_within(row::piston_area_b, *a, geometry, area_key("actuator.area_b"), area_formula("b"));
    if (const auto s = fact("actuator.stroke")) set_within(row::piston_stroke, *s, geometry, "actuator.stroke", "");
    if (const auto m = fact("actuator.moving_mass"))
      set_within(row::moving_mass, *m, moving, "actuator.moving_mass", "");
    if (const auto v = fact("actuator.dead_volume_a"))
      set_within(row::dead_volume_a, *v, volumes, "actuator.dead_volume_a", "");
    if (const auto v = fact("actuator.dead_volume_b"))
      set_within(row::dead_volume_b, *v, volumes, "actuator.dead_volume_b", "");
    if (fact("actuator.area_a")) as_large_as_the_cylinder();
    // An effect's row: only an extended table has it.
    const int mount = table_.find(MountCompliance::parameters[0].name);
    if (const auto k = fact("actuator.mount_stiffness"); k && mount >= 0)
      set(mount, 1 / *k, table_[mount].lower, std::max(table_[mount].upper, mount_high / *k),
          "actuator.mount_stiffness", "1 / mount_stiffness");
  }
  // No sheet gives frictions, and few the dead volumes: they keep the table's part of stall force, of that over no-load
  // speed, and of the swept volume. A cylinder of 20 tons has not the seals of one of 2.
  void as_large_as_the_cylinder() {
    const Size now = size(stroke_);
    const double force = now.force / of_table_.force, damping = force / (now.speed / of_table_.speed);
    const auto scale = [&](int position, double factor, double least_upper, const char* formula) {
      const Row& row = table_[position];
      set(position, tidy(factor * row.nominal), factor * row.lower, std::max(factor * row.upper, least_upper),
          "actuator.area_a", formula);
    };
    for (const int friction : {row::piston_coulomb_friction, row::piston_stribeck_friction})
      scale(friction, force, 0, "the table's part of stall force");
    scale(row::piston_viscous_friction, damping, most_viscous * now.force / now.speed,
          "the table's part of stall force over no-load speed; up to half of it");
    if (!fact("actuator.dead_volume_a"))
      scale(row::dead_volume_a, now.volume_a / of_table_.volume_a, 0, "the table's part of the swept volume");
    if (!fact("actuator.dead_volume_b"))
      scale(row::dead_volume_b, now.volume_b / of_table_.volume_b, 0, "the table's part of the swept volume");
  }
  std::string area_key(const char* key) const {
    return fact("actuator.bore_diameter") ? "actuator.bore_diameter" : key;
  }
  std::string area_formula(const char* side) const {
    return fact("actuator.bore_diameter") ? std::string("pi/4 (bore^2 - rod_diameter_") + side + "^2)" : "";
  }

  void lines() {
    const auto length = fact("lines.length"), bore = fact("lines.bore");
    if (!length && !bore && fact("lines.loss"))
      refuse("lines.fittings", "fittings are of a line with a length and a bore", "add [lines] length and bore");
    if (!length && !bore) return;
    if (!length) refuse("lines.bore", "a line has a length too", "add [lines] length");
    if (!bore) refuse("lines.length", "a line has a bore too", "add [lines] bore");
    const double area = disc(*bore), volume = area * *length;
    const double losses = fact("lines.loss").value_or(fitting_losses);
    const double resistance = (darcy_friction * *length / *bore + losses) * rig_.fluid.density / (2 * area * area);
    const bool of_its_own = lines_of_their_own(*length, *bore, resistance);
    set(row::hose_resistance, tidy(of_its_own ? part_ahead_of_tap * resistance : resistance), 0, line_wide * resistance,
        line_keys(), of_its_own ? "a tenth of line_loss, ahead of the tap" : line_formula());
    const double compliance = volume * (1 / value(row::bulk_modulus) + 1 / (line_wall_over_bore * steel_modulus));
    set(row::hose_compliance, tidy(compliance), 0, hose_high * compliance, "lines.length, lines.bore",
        "volume (1 / bulk_modulus + D / (E wall)), steel, wall D/10; a hose within the bound");
  }

  const char* line_keys() const {
    return fact("lines.loss") ? "lines.length, lines.bore, lines.fittings" : "lines.length, lines.bore";
  }
  std::string line_formula() const {
    const double losses = fact("lines.loss").value_or(fitting_losses);
    constexpr const char* list_key = "lines.fittings";
    const auto listed = rig_.words.find(list_key);
    return fmt::format("(0.03 L/D + {:.4g}) density / (2 area^2)", losses) +
           (listed == rig_.words.end() ? "" : ", of " + listed->second);
  }

  // Rows of an effect that only an extended table has: then the drop stands behind the taps.
  bool lines_of_their_own(double length, double bore, double resistance) {
    const auto set_row = [&](const char* name, double nominal, double range, const std::string& formula) {
      const int at = table_.find(name);
      if (at >= 0) set(at, tidy(nominal), 0, range * nominal, "lines.length, lines.bore", formula);
      return at >= 0;
    };
    const double viscosity = rig_.fluid.density * rig_.fluid.kinematic_viscosity;
    set_row("line_resistance", 128 * viscosity * length / (pi * std::pow(bore, 4)), line_wide,
            "128 viscosity L / (pi D^4)");
    set_row("line_loss", resistance, line_wide, line_formula());
    set_taps("line_tap");
    return set_row("line_inertance", rig_.fluid.density * length / disc(bore), line_known, "density L / area");
  }

  // Where the file does not say it, the logs may.
  void set_taps(const char* name) {
    const int at = table_.find(name);
    if (at < 0 || rig_.taps == Taps::not_said) return;
    set(at, rig_.taps == Taps::at_cylinder ? 1 : 0, 0, 1, "lines.taps", "");
    table_[at].estimate = false;
  }

  // Free within wide bounds.
  void test_stand() {
    for (const auto& [position, key] :
         {std::pair{row::dead_volume_a, "actuator.dead_volume_a"}, {row::dead_volume_b, "actuator.dead_volume_b"}}) {
      if (!fact(key))
        set(position, stand_volume, stand_volume / stand_volume_down, stand_volume * stand_volume_up, "ports",
            "of a test stand");
      table_[position].estimate = true;
    }
    if (fact("lines.length")) return;
    set(row::hose_resistance, value(row::hose_resistance), 0, stand_resistance, "ports", "of a test stand");
    set(row::hose_compliance, stand_compliance / stand_compliance_over_usual, 0, stand_compliance, "ports",
        "of a test stand");
  }

  Table table_;
  const RigFile& rig_;
  std::vector<std::string>* where_from_;
  double rated_current_ = 0;  // [A]
  double stroke_ = 0;         // [m] spool travel at rated current
  Size of_table_;             // ahead of any fact
};

// The rows that the sheet's step and frequency response tell, in place of what the formulas made of them.
void meet_sheet(Table& table, const RigFile& rig, std::vector<std::string>* where_from) {
  std::string keys;
  for (const auto& [key, given] :
       {std::pair{"valve.step_rise_time", rig.fact("valve.step_rise_time").has_value()},
        std::pair{"valve.frequency_response", !rig.response.empty()},
        std::pair{"valve.phase_lag_90_frequency", rig.fact("valve.phase_lag_90_frequency").has_value()}})
    if (given) keys += (keys.empty() ? "" : ", ") + std::string(key);
  for (const SheetRow& met : beside_sheet(table, rig, true).rows) {
    Row& row = table[met.position];
    row.nominal = std::clamp(tidy(met.after), row.lower, row.upper);
    row.source = "rig.toml: " + keys + "; from " + text_of(met.before, row.unit);
    if (where_from) where_from->push_back(row.name + " = " + text_of(row.nominal, row.unit) + ": " + row.source);
  }
}

void refuse_jet_pipe(const RigFile& rig) {
  if (const auto it = rig.words.find("valve.first_stage"); it != rig.words.end() && it->second == "jet_pipe")
    throw key_error({rig.path, rig.line("valve.first_stage"), "valve.first_stage"},
                    "a jet pipe cannot be fitted: the model's pilot pressures come from two nozzles and a flapper, and "
                    "no setting of rows 3 to 10 recovers a jet's",
                    "use the virtual rig for jet pipes, or leave the key out for a flapper-nozzle valve");
}

}  // namespace

Table apply_rig_facts(const Table& table, const RigFile& rig, std::vector<std::string>* where_from) {
  refuse_jet_pipe(rig);
  if (table.has_std_error) {
    if (where_from) where_from->push_back(table.path + " is tuned: its values stand, the facts are not applied");
    return table;
  }
  Table out = Facts(table, rig, where_from).apply();
  if (states_dynamics(rig)) meet_sheet(out, rig, where_from);
  return out;
}

SheetFit data_sheet(const Table& table, const RigFile& rig) {
  refuse_jet_pipe(rig);
  if (table.has_std_error) return beside_sheet(table, rig, false);
  return beside_sheet(Facts(table, rig, nullptr).apply(), rig, states_dynamics(rig));
}

}  // namespace servodx
