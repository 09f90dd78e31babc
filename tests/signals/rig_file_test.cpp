#include <gtest/gtest.h>

#include <numbers>

#include "base/reading_limits.h"
#include "base/units.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "signals/signal.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

RigFile read(const std::string& text) {
  const TemporaryFolder folder;
  return read_rig_file(folder.write("rig.toml", text));
}

std::string refusal(const std::string& text) {
  const TemporaryFolder folder;
  const std::string path = folder.write("rig.toml", text);
  try {
    read_rig_file(path);
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.starts_with(path) ? "rig.toml" + what.substr(path.size()) : what;
  }
  return "accepted";
}

// Every key that the documentation shows.
const std::string whole = R"(name = "bench 3"
serial = "SN 5329"
ports = "blocked"
command_hold = "linear"
mains_frequency = "50 Hz"
null_limit = "4 %"
oil_temperature = "45 degC"
fluid = "MIL-PRF-5606"
[valve]
rated_current = "20 mA"
dither = { amplitude = "0.2 mA", frequency = "200 Hz" }
spool_stroke = "0.50 mm"
spool_stop = "0.58 mm"
spool_diameter = "6.5 mm"
rated_flow = "7 l/min"
rated_pressure_drop = "70 bar"
phase_lag_90_frequency = "100 Hz"
null_leakage = "0.8 l/min"
pilot_leakage = "0.4 l/min"
radial_clearance = "3 um"
nozzle_diameter = "0.34 mm"
fixed_orifice_diameter = "0.2 mm"
nozzle_gap = "35 um"
torque_motor_frequency = "750 Hz"
first_stage = "flapper_nozzle"
[actuator]
bore_diameter = "40 mm"
rod_diameter_a = "20 mm"
rod_diameter_b = "25 mm"
stroke = "400 mm"
moving_mass = "10 kg"
dead_volume_a = "20 cm3"
dead_volume_b = "21 cm3"
mount_stiffness = "3.1e7 N/m"
[lines]
length = "0.45 m"
bore = "10 mm"
taps = "cylinder"
[supply]
pressure = "207 bar"
return_pressure = "5 bar"
[columns]
"Pos fb" = { signal = "piston_position", unit = "V", gain = "20 mm/V", offset = "-100 mm" }
)";

TEST(RigFile, EveryKeyIsKeptInSiWithItsLine) {
  const RigFile rig = read(whole);
  EXPECT_EQ(rig.name, "bench 3");
  EXPECT_EQ(rig.serial, "SN 5329");
  EXPECT_EQ(rig.ports, Ports::blocked);
  EXPECT_EQ(rig.command_hold, CommandHold::linear);
  EXPECT_EQ(rig.mains_frequency, 50.0);
  EXPECT_EQ(rig.null_limit, 0.04);
  EXPECT_DOUBLE_EQ(*rig.oil_temperature, 318.15);
  EXPECT_EQ(rig.taps, Taps::at_cylinder);
  EXPECT_EQ(rig.fact("valve.rated_current"), 0.02);
  EXPECT_EQ(rig.fact("valve.dither.amplitude"), 0.2e-3);
  EXPECT_EQ(rig.fact("valve.dither.frequency"), 200.0);
  EXPECT_EQ(rig.fact("valve.rated_pressure_drop"), 7e6);
  EXPECT_EQ(rig.fact("actuator.dead_volume_b"), 21e-6);
  EXPECT_EQ(rig.fact("actuator.mount_stiffness"), 3.1e7);
  EXPECT_EQ(rig.fact("lines.bore"), 0.01);
  EXPECT_EQ(rig.words.at("valve.first_stage"), "flapper_nozzle");
  EXPECT_EQ(rig.line("valve.rated_current"), 10);
  EXPECT_EQ(rig.line("supply.return_pressure"), 41);
  const ColumnMapping& column = rig.columns.at("Pos fb");
  EXPECT_EQ(column.signal, "piston_position");
  EXPECT_EQ(column.column_unit, "V");
  EXPECT_EQ(column.unit, "mm");
  EXPECT_DOUBLE_EQ(column.gain, 0.02);
  EXPECT_DOUBLE_EQ(column.offset, -0.1);
}

TEST(RigFile, TheLowPassIsOfAllSignalsOrOfEach) {
  const RigFile all = read("[measurement]\nlow_pass = \"300 Hz\"\nlow_pass_order = \"4\"\n");
  EXPECT_EQ(all.fact("measurement.low_pass"), 300.0);
  EXPECT_EQ(all.words.at("measurement.low_pass_order"), "4");
  const RigFile each = read("[measurement]\nlow_pass = { spool_position = \"1 kHz\", pressure_a = \"200 Hz\" }\n");
  EXPECT_EQ(each.fact("measurement.low_pass.pressure_a"), 200.0);
  EXPECT_FALSE(each.fact("measurement.low_pass"));
  EXPECT_THROW(read("[measurement]\nlow_pass = { spool = \"1 kHz\" }\n"), InputError);
  EXPECT_THROW(read("[measurement]\nlow_pass = { coil_current = \"1 kHz\" }\n"), InputError);
  EXPECT_THROW(read("[measurement]\nlow_pass = \"0 Hz\"\n"), InputError);
  EXPECT_THROW(read("[measurement]\nlow_pass_order = \"9\"\n"), InputError);
  EXPECT_THROW(read("[measurement]\nlowpass = \"1 kHz\"\n"), InputError);
}

TEST(RigFile, FittingsAddUpByTheirLossesEachWithItsSource) {
  const RigFile rig = read(
      "[lines]\nfittings = [\"entrance\", \"elbow_90\", \"elbow_90\", { name = \"coupling\", loss = "
      "\"0.8\", source = \"maker's sheet\" }]\n");
  EXPECT_DOUBLE_EQ(*rig.fact("lines.loss"), 0.5 + 1.5 + 1.5 + 0.8);
  EXPECT_EQ(rig.words.at("lines.fittings"), "entrance, elbow_90, elbow_90, coupling (maker's sheet)");
  EXPECT_EQ(read("[lines]\nfittings = []\n").fact("lines.loss"), 0.0);
  EXPECT_THROW(read("[lines]\nfittings = \"elbow_90\"\n"), InputError);
  EXPECT_THROW(read("[lines]\nfittings = [\"elbow\"]\n"), InputError);
  EXPECT_THROW(read("[lines]\nfittings = [{ name = \"coupling\", loss = \"0.8\" }]\n"), InputError);
}

TEST(RigFile, AnEmptyFileSaysNothing) {
  const RigFile rig = read("");
  EXPECT_TRUE(rig.facts.empty());
  EXPECT_EQ(rig.ports, Ports::actuator);
  EXPECT_FALSE(rig.command_hold.has_value());
  EXPECT_FALSE(rig.mains_frequency.has_value());
  EXPECT_EQ(rig.null_limit, 0.05);
  EXPECT_FALSE(rig.oil_temperature);
  EXPECT_EQ(rig.taps, Taps::not_said);
  EXPECT_FALSE(rig.fluid.given);
}

TEST(RigFile, ColumnsThatAreStillQuestionsAreKnownByTheirLines) {
  const RigFile rig = read(
      "# a remark  # ? of no column\n[columns]\n\"pB\" = { signal = \"pressure_b\", unit = \"bar\" }  # ? answered\n"
      "# \"pA\" = { signal = \"pressure_a\" }  # ? 63 to 84: is 'pA' the pressure_a?\n"
      "# \"x\" = { signal = \"?\", unit = \"?\" }  # not recognised\n");
  EXPECT_EQ(rig.open_questions, (std::vector<long>{4}));
}

TEST(RigFile, BoreAndRodsGiveTheAreas) {
  const RigFile rig = read(whole);
  EXPECT_DOUBLE_EQ(*rig.fact("actuator.area_a"), std::numbers::pi / 4 * (0.04 * 0.04 - 0.02 * 0.02));
  EXPECT_DOUBLE_EQ(*rig.fact("actuator.area_b"), std::numbers::pi / 4 * (0.04 * 0.04 - 0.025 * 0.025));
  const RigFile single = read("[actuator]\nbore_diameter = \"40 mm\"\nrod_diameter_b = \"25 mm\"\n");
  EXPECT_DOUBLE_EQ(*single.fact("actuator.area_a"), std::numbers::pi / 4 * 0.04 * 0.04);
}

TEST(RigFile, AFluidIsAPresetOrItsProperties) {
  for (const char* name :
       {"5606", "MIL-PRF-5606", "MIL-H-5606", "83282", "MIL-PRF-83282", "AS1241", "ISO VG 32", "VG 46", "iso vg 46"}) {
    const RigFile rig = read("fluid = \"" + std::string(name) + "\"\n");
    EXPECT_TRUE(rig.fluid.given) << name;
    EXPECT_EQ(rig.fact("fluid.density"), rig.fluid.density) << name;
    EXPECT_GT(rig.fluid.density, 800.0);
    EXPECT_LT(rig.fluid.density, 1100.0);
  }
  EXPECT_EQ(read("fluid = \"VG 46\"\n").fluid.kinematic_viscosity, 46e-6);
  EXPECT_EQ(read("fluid = \"83282\"\n").fluid.kinematic_viscosity_100, 3.5e-6);
  const RigFile own = read("[fluid]\ndensity = \"850 kg/m3\"\nkinematic_viscosity = \"15 cSt\"\n");
  EXPECT_TRUE(own.fluid.given);
  EXPECT_EQ(own.fluid.density, 850.0);
  EXPECT_EQ(own.fluid.kinematic_viscosity, 15e-6);
  EXPECT_EQ(own.fact("fluid.kinematic_viscosity"), 15e-6);
  EXPECT_EQ(own.fluid.kinematic_viscosity_100, 0.0) << "not said";
  const RigFile both = read("[fluid]\nkinematic_viscosity = \"15 cSt\"\nkinematic_viscosity_100 = \"4 cSt\"\n");
  EXPECT_EQ(both.fluid.kinematic_viscosity_100, 4e-6);
}

TEST(RigFile, TheSheetsDynamicsAreKeptAsListed) {
  const RigFile rig = read(
      "[valve]\nstep_rise_time = \"8 ms\"\nstep_amplitude = \"50 %\"\n"
      "frequency_response = [{ frequency = \"50 Hz\", gain = \"-1.5 dB\" }]\n");
  EXPECT_DOUBLE_EQ(*rig.fact("valve.step_rise_time"), 8e-3);
  EXPECT_DOUBLE_EQ(*rig.fact("valve.step_amplitude"), 0.5);
  ASSERT_EQ(rig.response.size(), 1u);
  EXPECT_EQ(rig.response[0].gain, -1.5);
  EXPECT_EQ(rig.response[0].amplitude, 0.4) << "catalogues' usual";
  const RigFile tables = read(
      "[[valve.frequency_response]]\nfrequency = \"20 Hz\"\namplitude = \"100 %\"\nphase_lag = \"30 deg\"\n"
      "[[valve.frequency_response]]\nfrequency = \"0.1 kHz\"\ngain = \"0 dB\"\nphase_lag = \"90 deg\"\n");
  ASSERT_EQ(tables.response.size(), 2u);
  EXPECT_DOUBLE_EQ(*tables.response[0].phase_lag, std::numbers::pi / 6);
  EXPECT_FALSE(tables.response[0].gain);
  EXPECT_EQ(tables.response[0].amplitude, 1.0);
  EXPECT_EQ(tables.response[1].frequency, 100.0);
  EXPECT_EQ(tables.line("valve.frequency_response[2].gain"), 7);
}

TEST(RigFile, EachRefusalNamesPlaceRuleAndMend) {
  const std::string lengths = "m, cm, mm, um, in";
  const struct {
    std::string text, message;
  } cases[] = {
      {"\nnmae = \"x\"\n",
       "rig.toml:2: key 'nmae': unknown key; did you mean 'name'? known here: name, serial, ports, command_hold, "
       "mains_frequency, "
       "null_limit, oil_temperature, "
       "fluid, [valve], [actuator], [lines], [supply], [fluid], [limits], [columns], [page], [measurement]"},
      {"[supply]\npresure = \"207 bar\"\n",
       "rig.toml:2: key 'supply.presure': unknown key; did you mean 'pressure'? known here: pressure, return_pressure"},
      {"[valve]\ndither = { amplitude = \"1 mA\", phase = \"0\" }\n",
       "rig.toml:2: key 'valve.dither.phase': unknown key; known here: amplitude, frequency"},
      {"[valve]\nrated_current = 20\n",
       "rig.toml:2: key 'valve.rated_current': a bare number has no unit; write a quoted quantity with one of A, "
       "mA"},
      {"[valve]\nrated_current = \"20\"\n",
       "rig.toml:2: key 'valve.rated_current': '20' has no unit; add one of A, mA"},
      {"[valve]\nspool_stroke = \"0.5 bar\"\n",
       "rig.toml:2: key 'valve.spool_stroke': 'bar' is a unit of pressure, not of length; use one of " + lengths},
      {"[valve]\nspool_stroke = \"-0.5 mm\"\n",
       "rig.toml:2: key 'valve.spool_stroke': must be positive; check the sign, or leave the key out"},
      {"[valve]\nno_load_flow = \"14 l/min\"\nrated_flow = \"7 l/min\"\nrated_pressure_drop = \"70 bar\"\n",
       "rig.toml:3: key 'valve.rated_flow': given beside valve.no_load_flow; keep one of the two"},
      {"[valve]\nrated_flow = \"7 l/min\"\n",
       "rig.toml:2: key 'valve.rated_flow': needs valve.rated_pressure_drop; add the total drop over both edges, "
       "such as "
       "rated_pressure_drop = \"70 bar\""},
      {"[valve]\nfirst_stage = \"jet\"\n",
       "rig.toml:2: key 'valve.first_stage': unknown value 'jet'; use one of 'flapper_nozzle', 'jet_pipe'"},
      {"[valve]\nstep_amplitude = \"50 %\"\n",
       "rig.toml:2: key 'valve.step_amplitude': given without valve.step_rise_time; add step_rise_time or leave it "
       "out"},
      {"[valve]\nstep_rise_time = \"8 ms\"\nstep_amplitude = \"200 %\"\n",
       "rig.toml:3: key 'valve.step_amplitude': is beyond 150 % of rated current, where amplifiers end; give the peak "
       "of "
       "the current as a part of rated, such as \"40 %\""},
      {"[valve]\nstep_rise_time = \"8 mm\"\n",
       "rig.toml:2: key 'valve.step_rise_time': 'mm' is a unit of length, not of time; use one of s, ms, us, min, h"},
      {"[valve]\nfrequency_response = \"50 Hz\"\n",
       "rig.toml:2: key 'valve.frequency_response': is not a list of points; write each as "
       "[[valve.frequency_response]]"},
      {"[[valve.frequency_response]]\nfrequency = \"50 Hz\"\n",
       "rig.toml:1: key 'valve.frequency_response[1]': states neither gain nor phase_lag; add one of them, or leave "
       "the "
       "point out"},
      {"[[valve.frequency_response]]\ngain = \"-3 dB\"\n",
       "rig.toml:1: key 'valve.frequency_response[1]': states no frequency; add frequency = \"... Hz\""},
      {"[[valve.frequency_response]]\nphase = \"90 deg\"\n",
       "rig.toml:2: key 'valve.frequency_response[1].phase': unknown key; known here: frequency, amplitude, gain, "
       "phase_lag"},
      {"[[valve.frequency_response]]\nphase_lag = \"-90 deg\"\n",
       "rig.toml:2: key 'valve.frequency_response[1].phase_lag': must not be negative; check the sign, or leave the "
       "key "
       "out"},
      {"[[valve.frequency_response]]\nphase_lag = \"500 deg\"\n",
       "rig.toml:2: key 'valve.frequency_response[1].phase_lag': is beyond 360 deg; give the lag as a positive angle, "
       "such as \"90 deg\""},
      {"[[valve.frequency_response]]\ngain = \"-60 dB\"\n",
       "rig.toml:2: key 'valve.frequency_response[1].gain': is beyond 40 dB; give the gain over that at low frequency, "
       "such as \"-3 dB\""},
      {"[[valve.frequency_response]]\ngain = \"0.7\"\n",
       "rig.toml:2: key 'valve.frequency_response[1].gain': '0.7' has no unit; add one of dB"},
      {"ports = \"open\"\n", "rig.toml:1: key 'ports': unknown value 'open'; use one of 'actuator', 'blocked', 'free'"},
      {"valve = \"x\"\n", "rig.toml:1: key 'valve': is not a section; write it as [valve]"},
      {"fluid = \"water\"\n",
       "rig.toml:1: key 'fluid': unknown fluid 'water'; use one of MIL-PRF-5606, MIL-PRF-83282, AS1241, ISO VG 32, "
       "ISO VG "
       "46, or a [fluid] section with density and kinematic_viscosity"},
      {"[fluid]\nkinematic_viscosity = \"14 cSt\"\nkinematic_viscosity_100 = \"14 cSt\"\n",
       "rig.toml:3: key 'fluid.kinematic_viscosity_100': is not below the viscosity at 40 degC; give the viscosity at "
       "100 degC, as the oil's sheet states it"},
      {"[actuator]\narea_a = \"1 cm2\"\nbore_diameter = \"40 mm\"\n",
       "rig.toml:2: key 'actuator.area_a': given beside actuator.bore_diameter; keep areas or diameters, not both"},
      {"[actuator]\nrod_diameter_a = \"4 mm\"\n",
       "rig.toml:2: key 'actuator.rod_diameter_a': needs actuator.bore_diameter; add bore_diameter or give area_a "
       "and area_b"},
      {"[actuator]\nbore_diameter = \"4 mm\"\nrod_diameter_a = \"4 mm\"\n",
       "rig.toml:3: key 'actuator.rod_diameter_a': is not below actuator.bore_diameter; check both diameters"},
      {"[supply]\npressure = \"5 bar\"\nreturn_pressure = \"5 bar\"\n",
       "rig.toml:3: key 'supply.return_pressure': is not below supply.pressure; check both values"},
      {"[columns]\nx = { signal = \"spool\" }\n",
       "rig.toml:2: key 'columns.x.signal': unknown signal 'spool'; see 'servodx list signals'"},
      {"[columns]\nx = { unit = \"mm\" }\n", "rig.toml:2: key 'columns.x': names no signal; add signal = \"...\""},
      {"[columns]\nx = { signal = \"spool_position\", units = \"mm\" }\n",
       "rig.toml:2: key 'columns.x.units': unknown key; did you mean 'unit'? known here: signal, unit, gain, offset"},
      {"[columns]\nx = { signal = \"spool_position\", unit = \"V\" }\n",
       "rig.toml:2: key 'columns.x.unit': volts need a gain; add gain = \"... m/V\""},
      {"[columns]\nx = { signal = \"spool_position\", unit = \"V\", gain = \"-1\" }\n",
       "rig.toml:2: key 'columns.x.unit': volts need a gain; add gain = \"... m/V\""},
      {"[columns]\nx = { signal = \"spool_position\", unit = \"mm\", gain = \"20 mm/V\" }\n",
       "rig.toml:2: key 'columns.x.unit': 'mm' is not what the gain divides by ('V'); make unit and gain agree"},
      {"[columns]\nx = { signal = \"spool_position\", unit = \"bar\" }\n",
       "rig.toml:2: key 'columns.x.unit': 'bar' is no unit of 'spool_position'; use one of " + lengths +
           ", % of stroke, or V with a gain in the rig file"},
      {"[columns]\nx = { signal = \"spool_position\", gain = \"0\" }\n",
       "rig.toml:2: key 'columns.x.gain': a gain of zero loses the signal; write a number, or a number with a unit "
       "such as "
       "'20 m/V'"},
      {"[columns]\nx = { signal = \"spool_position\", offset = \"1 bar\" }\n",
       "rig.toml:2: key 'columns.x.offset': 'bar' is a unit of pressure, not of length; use one of " + lengths},
  };
  for (const auto& c : cases) EXPECT_EQ(refusal(c.text), c.message);
}

TEST(RigFile, AKeyBelowAHeadingThatIsStillACommentIsTold) {
  EXPECT_EQ(refusal("name = \"x\"\n# [valve]   # the data sheet's\nspool_stroke = \"0.5 mm\"\n"),
            "rig.toml:3: key 'spool_stroke': belongs to [valve], whose heading in line 2 is still a comment; take the "
            "'#' off that line too");
  EXPECT_EQ(
      refusal("[supply]\npressure = \"207 bar\"\n# [fluid]\ndensity = \"860 kg/m3\"\n"),
      "rig.toml:4: key 'supply.density': belongs to [fluid], whose heading in line 3 is still a comment; take the "
      "'#' off that line too");
  EXPECT_NE(refusal("# [valve]\n[supply]\nspool_stroke = \"0.5 mm\"\n").find("unknown key"), std::string::npos);
}

TEST(RigFile, ABrokenTomlNamesItsLine) {
  EXPECT_TRUE(refusal("name = \"x\"\nserial = SN\n").starts_with("rig.toml:2: is not TOML: "));
  EXPECT_TRUE(refusal("name = \"x\"\nname = \"y\"\n").starts_with("rig.toml:2: is not TOML: "));
}

TEST(RigFile, NamesAndFilesBeyondTheStatedLimitsAreRefused) {
  EXPECT_EQ(refusal("name = \"" + std::string(longest_name, 'x') + "\"\n"), "accepted");
  const std::string longer(longest_name + 1, 'x'), far_longer(15'000'000, 'x');
  for (const std::string& text : {"# a rig\nname = \"" + longer + "\"\n", "# a rig\n" + longer + " = \"x\"\n",
                                  "# a rig\nname = '''" + far_longer + "'''\n"})
    EXPECT_TRUE(refusal(text).starts_with("rig.toml:2: has a name or a text of more than 4096 bytes, at character "))
        << refusal(text).substr(0, 300);
  const std::string large = "name = \"" + std::string(50'000'000, 'x') + "\"\n";
  EXPECT_EQ(refusal(large),
            "rig.toml: has more than 16 MB, the most that such a file may; give the file that is meant");
}

TEST(Signals, TheTableIsInTheOrderOfTheEnum) {
  for (int i = 0; i < n_signals; ++i) {
    EXPECT_EQ(index(signal_list[i].signal), i);
    EXPECT_EQ(find_signal(signal_list[i].name), signal_list[i].signal);
    const Unit* unit = find_unit(signal_list[i].si_unit);
    ASSERT_NE(unit, nullptr);
    EXPECT_EQ(unit->dimension, signal_list[i].dimension);
    EXPECT_EQ(unit->to_si(3.0), 3.0);
  }
  EXPECT_FALSE(find_signal("spool").has_value());
}

}  // namespace
}  // namespace servodx
