// The visible list of effects: missing physics, one file and one line each.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "effects/armature_angle.h"
#include "effects/edge_radius.h"
#include "effects/edge_transition.h"
#include "effects/effect.h"
#include "effects/flow_meter_lag.h"
#include "effects/line_inertia.h"
#include "effects/magnetic_hysteresis.h"
#include "effects/mains_pickup.h"
#include "effects/mount_compliance.h"
#include "effects/nozzle_land.h"
#include "effects/nozzle_mismatch.h"
#include "effects/nozzle_plugging.h"
#include "effects/oil_stiffening.h"
#include "effects/orifice_length.h"
#include "effects/port_line.h"
#include "effects/pressure_viscosity.h"
#include "effects/return_drop.h"
#include "effects/rod_cavity.h"
#include "effects/screen_drop.h"
#include "effects/seal_film.h"
#include "effects/seal_shear.h"
#include "effects/sensor_response.h"
#include "effects/stiction.h"
#include "effects/supply_droop.h"
#include "effects/transport_delay.h"
#include "effects/unexplained.h"
#include "effects/viscosity_change.h"
#include "effects/viscosity_slope.h"
#include "model/hooks.h"

namespace servodx {

using NoEffects = EffectList<>;
using AllEffects = EffectList<MagneticHysteresis,  //
                              ArmatureAngle,       //
                              MountCompliance,     //
                              NozzlePlugging,      //
                              Stiction,            //
                              TransportDelay,      //
                              ViscosityChange,     //
                              SupplyDroop,         //
                              MainsPickup,         //
                              SensorResponse,      //
                              FlowMeterLag,        //
                              EdgeRadius,          //
                              PortLine,            //
                              RodCavity,           //
                              EdgeTransition,      //
                              OrificeLength,       //
                              ScreenDrop,          //
                              NozzleLand,          //
                              SealFilm,            //
                              SealShear,           //
                              NozzleMismatch,      //
                              ReturnDrop,          //
                              ViscositySlope,      //
                              PressureViscosity,   //
                              OilStiffening>;
// A state costs a step more than most effects do. Without the four that few candidates switch on, a step takes three
// quarters of the time (docs/performance.md).
using CommonEffects = Without<AllEffects, SupplyDroop, PortLine, RodCavity>;
// Four states more, for rigs with long lines only: these have a kernel of their own.
using LinedEffects = Append<CommonEffects, LineInertia>;
// A learnt curve costs more than all effects: the same.
using CorrectedEffects = Append<Append<AllEffects, LineInertia>, Unexplained>;
inline constexpr int n_values = n_parameters + CorrectedEffects::n_parameters;  // length of a parameter vector

struct EffectInfo {
  std::string name, place, meaning;
  int first = 0;  // position of its first parameter in a parameter vector
  std::vector<EffectParameter> parameters;
  bool rare = false;        // left out where a kernel carries the common effects alone
  bool stand_only = false;  // sought only in logs of a valve on a test stand
  bool as_made = false;     // told by healthy logs; not sought
  Freed freed = Freed::never;
  bool shapes_rows = false;  // belongs to a row effect (row_effects.h) and means nothing without it
  SoughtAs sought_as = SoughtAs::whole;
  bool known_oil_only = false;   // sought only where each log's oil is known
  bool of_construction = false;  // there from the first day or never
  std::string best_test = {};    // the input that shows it best, in words; empty: none stands out
  std::optional<RowAlong> along = {};
  // Writes its numbers on a rig of these rows, where they go with the size of the rig.
  void (*as_large_as_rig)(double* own, const double* rows) = nullptr;
};
const std::vector<EffectInfo>& effect_list();
// What stands behind the 41 rows at a position of a parameter vector.
const EffectParameter& parameter_at(int position);

// Position of effect E's j-th parameter in a parameter vector.
template <class E>
constexpr int effect_row(int j) {
  return n_parameters + CorrectedEffects::parameter_offset<E>() + j;
}

}  // namespace servodx
