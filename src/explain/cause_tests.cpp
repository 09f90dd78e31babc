#include "explain/cause_tests.h"

#include <map>

#include "effects/armature_angle.h"
#include "effects/edge_radius.h"
#include "effects/edge_transition.h"
#include "effects/line_inertia.h"
#include "effects/magnetic_hysteresis.h"
#include "effects/mains_pickup.h"
#include "effects/mount_compliance.h"
#include "effects/nozzle_land.h"
#include "effects/orifice_length.h"
#include "effects/port_line.h"
#include "effects/screen_drop.h"
#include "effects/seal_shear.h"
#include "effects/stiction.h"
#include "effects/supply_droop.h"
#include "effects/transport_delay.h"
#include "effects/viscosity_change.h"

namespace servodx {

std::string best_test_of(const std::string& effect) {
  static const std::map<std::string, const char*> tests = {
      {Stiction::name, "slow small triangle: the spool stands still at each reversal, longer the slower"},
      {MagneticHysteresis::name, "slow triangles of several amplitudes: a loop of the same width at any rate"},
      {ArmatureAngle::name, "full steps both ways: how long the spool slews before it slows down"},
      {TransportDelay::name, "steps and a multisine: lag in proportion to frequency, no loss of amplitude"},
      {MountCompliance::name, "steps into a stiff load: the body's resonance in the load pressure"},
      {MainsPickup::name, "rest: a line at the mains frequency with the valve still"},
      {ViscosityChange::name, "the same test in cold and in hot oil"},
      {EdgeTransition::name,
       "slow triangles of some per cent in cold and in hot oil: in the cold the piston lags by a wider lap"},
      {OrificeLength::name, "full steps in cold and in hot oil: in the cold the spool slews slower"},
      {NozzleLand::name, "slow triangles in cold and in hot oil with pilot pressures: in the cold they rise"},
      {SealShear::name, "the same fast strokes in cold and in hot oil"},
      {ScreenDrop::name, "full steps in cold and in hot oil: in the cold the pilot pressures fall"},
      {EdgeRadius::name,
       "the pressure's slope at null beside the leakage there: blunt edges leak more at the same slope"},
      {LineInertia::name,
       "fast steps with taps at the valve and at the cylinder: the two part by the piston's acceleration"},
      {PortLine::name, "leakage sweeps at two rates, ports blocked: a tail after null that lasts as long at either"},
      {SupplyDroop::name, "full steps with the supply pressure measured at the valve"},
      {"stribeck_friction", "slow ramps through standstill, both ways"},
      {"asymmetric_lap", "slow triangle about null with ports loaded"},
      {"hose_compliance", "steps against a blocked piston"},
      {"air_entrainment", "steps at low and at high mean pressure: air is stiff under pressure, a hose is not"},
      {"cross_piston_leakage", "hold a load: the piston creeps in proportion to the load pressure"},
      {"sensor_lag", "a fast sine: the sensor lags in proportion to frequency"},
      {"sensor_gain_error", "full strokes against a second reference"},
      {"flow_force", "full opening at several pressure drops"},
  };
  const auto it = tests.find(effect);
  return it != tests.end() ? it->second : "";
}

}  // namespace servodx
