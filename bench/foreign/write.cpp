#include "write.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <vector>

namespace servodx::foreign {
namespace {

constexpr double bar = 1e5, litre_per_minute = 1e-3 / 60.0;

struct Column {
  const char* header;
  double unit;  // SI of one
};
constexpr Column columns[n_channels] = {
    {"spool_position [mm]", 1e-3}, {"piston_position [mm]", 1e-3},  {"pressure_a [bar]", bar},
    {"pressure_b [bar]", bar},     {"supply_pressure [bar]", bar},  {"return_pressure [bar]", bar},
    {"load_force [N]", 1.0},       {"oil_temperature [degC]", 1.0}, {"coil_current [mA]", 1e-3},
};

}  // namespace

std::string csv_of(const Design& d, const Recording& r) {
  std::string text = "time [s]";
  if (d.command_recorded) text += d.percent ? ",command [% of rated]" : ",command [mA]";
  for (int c = 0; c < n_channels; ++c)
    if (d.recorded[c]) text += std::string(",") + columns[c].header;
  text += '\n';
  const double unit = d.percent ? 0.01 * d.rated_current : 1e-3;
  auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < r.time.size(); ++i) {
    fmt::format_to(out, "{:.7g}", r.time[i]);
    if (d.command_recorded) fmt::format_to(out, ",{:.6g}", r.command[i] / unit);
    for (int c = 0; c < n_channels; ++c)
      if (d.recorded[c]) fmt::format_to(out, ",{:.7g}", r.channel[c][i] / columns[c].unit);
    text += '\n';
  }
  return text;
}

std::string rig_toml(const Design& d, const Sheet& s) {
  std::string text = fmt::format(
      "# Foreign rig {}. Data sheet knowledge only.\nname = \"foreign {}\"\nports = \"actuator\"\n", d.seed, d.seed);
  const auto line = [&](const char* key, double value, const char* unit) {
    text += fmt::format("{} = \"{:.4g} {}\"\n", key, value, unit);
  };
  text += "[valve]\n";
  line("rated_current", d.rated_current * 1e3, "mA");
  line("spool_stroke", s.stroke * 1e3, "mm");
  line("spool_stop", s.stop * 1e3, "mm");
  line("spool_diameter", s.spool_diameter * 1e3, "mm");
  line("rated_flow", s.rated_flow / litre_per_minute, "l/min");
  line("rated_pressure_drop", 70, "bar");
  line("phase_lag_90_frequency", s.lag_frequency, "Hz");
  line("null_leakage", s.null_leakage / litre_per_minute, "l/min");
  line("pilot_leakage", s.pilot_leakage / litre_per_minute, "l/min");
  line("radial_clearance", s.clearance * 1e6, "um");
  line("nozzle_diameter", s.nozzle * 1e3, "mm");
  line("fixed_orifice_diameter", s.orifice * 1e3, "mm");
  line("nozzle_gap", s.gap * 1e6, "um");
  line("torque_motor_frequency", s.motor_frequency, "Hz");
  text += "[actuator]\n";
  line("area_a", s.area_a * 1e4, "cm2");
  line("area_b", s.area_b * 1e4, "cm2");
  line("stroke", s.actuator_stroke * 1e3, "mm");
  line("moving_mass", s.mass, "kg");
  if (s.mount > 0.0) line("mount_stiffness", s.mount, "N/m");
  if (s.line_length > 0.0) {
    text += "[lines]\n";
    line("length", s.line_length, "m");
    line("bore", s.line_bore * 1e3, "mm");
    if (!d.lines.taps_at_valve) text += "taps = \"cylinder\"\n";
  }
  text += "[supply]\n";
  line("pressure", s.pressure / bar, "bar");
  line("return_pressure", s.return_pressure / bar, "bar");
  text += "[fluid]\n";
  line("density", s.density, "kg/m3");
  line("kinematic_viscosity", s.viscosity * 1e6, "mm2/s");
  return text;
}

std::string datasheet(const Design& d, const Sheet& s) {
  const auto none = [](bool recorded) { return recorded ? "recorded" : "not recorded"; };
  return fmt::format(
      "# Foreign rig {}\n\nTwo-stage flapper-nozzle valve, {:.3g} l/min at 70 bar +-5 %, {:.3g} mA; {} at {:.3g} bar; "
      "cylinder {:.4g} / {:.4g} cm2, moving mass {:.3g} kg.\nPressure taps {}, lines {:.2g} m. Sampled at {:g} Hz, "
      "controller and generator at {:g} Hz.\nSpool sensor {}, return pressure {}, supply pressure {}, temperature {}.\n"
      "Open-loop logs carry a centring term in the logged command; closed loops are proportional, {:.3g} 1/s.\n",
      d.seed, s.rated_flow / litre_per_minute, d.rated_current * 1e3, d.oil.name, s.pressure / bar, s.area_a * 1e4,
      s.area_b * 1e4, s.mass, d.lines.taps_at_valve ? "in the manifold at the valve" : "at the cylinder", s.line_length,
      d.rate, d.control_rate, none(d.recorded[ch_spool]), none(d.recorded[ch_return]), none(d.recorded[ch_supply]),
      none(d.recorded[ch_temperature]), d.position_gain);
}

std::string truth_header() {
  return "path,set,class,severity,severity_value,excitation,closed_loop,hidden_effect,onset_s,test_index,"
         "oil_temperature_C,air_fraction,null_bias_pct,sample_hz,size,hidden_value\n";
}

std::string truth_row(const Design& d, const Planned& p) {
  const Truth& t = p.truth;
  const bool hidden = !t.effect.empty();
  const auto number = [](bool given, double value) { return given ? fmt::format("{:.6g}", value) : std::string(); };
  return fmt::format("{},{},{},{},{},{},{:d},{},{},,{:.1f},{:.4f},{:.3f},{:g},{},{}\n", t.path, t.set, t.kind,
                     t.severity, number(t.with_value && !hidden, t.severity_value), p.job.excitation.name,
                     p.job.excitation.closed, t.effect, number(t.onset >= 0.0, t.onset), p.job.condition.celsius,
                     p.job.condition.air, p.job.condition.null * 100, d.rate, t.size,
                     number(t.with_value && hidden, t.severity_value));
}

std::string design_text(const Design& d) {
  const FirstStage& f = d.first;
  const Spool& e = d.spool;
  const Actuator& a = d.actuator;
  std::string text;
  const auto line = [&](const char* key, double value) { text += fmt::format("{} = {:.6g}\n", key, value); };
  text += fmt::format("oil = {}\n", d.oil.name);
  line("rated_flow [l/min]", d.rated_flow / litre_per_minute);
  line("rated_current [mA]", d.rated_current * 1e3);
  line("supply [bar]", d.supply.pressure / bar);
  line("supply droop at no-load flow [bar]", d.supply.pump_droop * d.no_load_flow / bar);
  line("valve crossover [Hz]", d.valve_bandwidth);
  line("torque motor [Hz]", d.motor_frequency);
  line("spool diameter [mm]", e.diameter * 1e3);
  line("spool stroke [mm]", e.stroke * 1e3);
  line("spool friction [N]", e.coulomb);
  line("clearance [um]", e.clearance * 1e6);
  for (const double lap : e.lap) line("lap [um]", lap * 1e6);
  line("nozzle [mm]", f.nozzle * 1e3);
  line("orifice [mm]", f.orifice * 1e3);
  line("gap [um]", f.gap * 1e6);
  line("wire [N/m]", f.wire);
  line("pilot flow [l/min]", f.pilot_flow / litre_per_minute);
  line("screen drop [bar]", f.screen_drop / bar);
  line("hysteresis [1]", f.loop[0] + f.loop[1]);
  line("area a [cm2]", a.area_a * 1e4);
  line("area b [cm2]", a.area_b * 1e4);
  line("stroke [mm]", a.stroke * 1e3);
  line("mass [kg]", a.mass);
  line("no-load speed [m/s]", d.speed);
  line("piston coulomb [N]", a.coulomb);
  line("piston viscous [N s/m]", a.viscous);
  line("piston leak [m3/s/Pa]", a.leak);
  line("mount [N/m]", a.mount);
  line("line [m]", d.lines.length);
  line("bore [mm]", d.lines.bore * 1e3);
  line("taps at valve", d.lines.taps_at_valve);
  line("position gain [1/s]", d.position_gain);
  for (int c = 0; c < n_channels; ++c)
    text += fmt::format("{}: gain {:.4f} lag {:.3g} ms noise {:.3g} recorded {:d}\n", columns[c].header,
                        d.sensors[c].gain, d.sensors[c].lag * 1e3, d.sensors[c].noise / columns[c].unit, d.recorded[c]);
  line("rate [Hz]", d.rate);
  line("step [us]", d.step * 1e6);
  return text;
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  // A file that is there is whole.
  std::filesystem::path part = path;
  part += ".part";
  std::ofstream file(part, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path.string());
  std::filesystem::rename(part, path);
}

}  // namespace servodx::foreign
