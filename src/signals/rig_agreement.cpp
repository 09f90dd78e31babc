#include "signals/rig_agreement.h"

#include <numbers>
#include <string>

#include "signals/rig_values.h"

namespace servodx {
namespace {

constexpr double most_amplitude = 1.5;  // [fraction of rated current] where amplifiers end

void check_pairs(const RigFile& rig) {
  const RigValues values(rig);
  const auto has = [&](const char* key) { return rig.facts.contains(key); };
  if (has("valve.no_load_flow") && has("valve.rated_flow"))
    throw InputError(values.place("valve.rated_flow"), "given beside valve.no_load_flow", "keep one of the two");
  if (has("valve.rated_flow") && !has("valve.rated_pressure_drop"))
    throw InputError(values.place("valve.rated_flow"), "needs valve.rated_pressure_drop",
                     "add the total drop over both edges, such as rated_pressure_drop = \"70 bar\"");
  if (has("valve.rated_pressure_drop") && !has("valve.rated_flow"))
    throw InputError(values.place("valve.rated_pressure_drop"), "given without valve.rated_flow",
                     "add rated_flow or leave it out");
  if (has("valve.step_amplitude")) {
    if (!has("valve.step_rise_time"))
      throw InputError(values.place("valve.step_amplitude"), "given without valve.step_rise_time",
                       "add step_rise_time or leave it out");
    require_drivable(*rig.fact("valve.step_amplitude"), values.place("valve.step_amplitude"));
  }
  if (has("supply.pressure") && has("supply.return_pressure") &&
      !(*rig.fact("supply.return_pressure") < *rig.fact("supply.pressure")))
    throw InputError(values.place("supply.return_pressure"), "is not below supply.pressure", "check both values");
}

void derive_areas(RigFile& rig) {
  const RigValues values(rig);
  const auto bore = rig.fact("actuator.bore_diameter");
  for (const char side : {'a', 'b'}) {
    const std::string area_key = std::string("actuator.area_") + side;
    const std::string rod_key = std::string("actuator.rod_diameter_") + side;
    const auto rod = rig.fact(rod_key);
    if (rod && !bore)
      throw InputError(values.place(rod_key), "needs actuator.bore_diameter",
                       "add bore_diameter or give area_a and area_b");
    if (!bore) continue;
    if (rig.fact(area_key))
      throw InputError(values.place(area_key), "given beside actuator.bore_diameter",
                       "keep areas or diameters, not both");
    const double d = rod.value_or(0.0);
    if (d >= *bore)
      throw InputError(values.place(rod_key), "is not below actuator.bore_diameter", "check both diameters");
    rig.facts[area_key] = std::numbers::pi / 4.0 * (*bore * *bore - d * d);
    rig.lines[area_key] = rig.line("actuator.bore_diameter");
  }
}

void settle_fluid(RigFile& rig) {
  const RigValues values(rig);
  const auto density = rig.fact("fluid.density"), viscosity = rig.fact("fluid.kinematic_viscosity");
  if (density) rig.fluid.density = *density;
  if (viscosity) rig.fluid.kinematic_viscosity = *viscosity;
  if (const auto hot = rig.fact("fluid.kinematic_viscosity_100")) {
    if (*hot >= rig.fluid.kinematic_viscosity)
      throw InputError(values.place("fluid.kinematic_viscosity_100"), "is not below the viscosity at 40 degC",
                       "give the viscosity at 100 degC, as the oil's sheet states it");
    rig.fluid.kinematic_viscosity_100 = *hot;
  }
  rig.fluid.given = rig.fluid.given || density || viscosity;
  if (rig.fluid.name.empty()) return;
  rig.facts["fluid.density"] = rig.fluid.density;
  rig.facts["fluid.kinematic_viscosity"] = rig.fluid.kinematic_viscosity;
  rig.lines["fluid.density"] = rig.lines["fluid.kinematic_viscosity"] = rig.line("fluid");
}

}  // namespace

void require_drivable(double amplitude, const Place& at) {
  if (amplitude > most_amplitude)
    throw InputError(at, "is beyond 150 % of rated current, where amplifiers end",
                     "give the peak of the current as a part of rated, such as \"40 %\"");
}

void settle_facts(RigFile& rig) {
  check_pairs(rig);
  derive_areas(rig);
  settle_fluid(rig);
}

}  // namespace servodx
