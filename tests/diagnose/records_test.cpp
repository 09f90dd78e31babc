// What the records tell without the model: laws on records made by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "diagnose/broken_sensors.h"
#include "diagnose/flow_into_chambers.h"
#include "diagnose/record_figures.h"
#include "diagnose/record_law.h"
#include "faults/registry.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "servodx/log.h"
#include "shipped_data.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

constexpr double duration = 4.0, rate = 1000.0;  // [s], [Hz]

// A sine of the drive and of the piston, a supply that falls with the piston's speed, and what a case changes.
struct Made {
  std::vector<double> time, command, current, piston, supply, pressure_a, pressure_b;
};
Made made(unsigned seed, double hertz) {
  Made m;
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 1);
  for (int k = 0; k < duration * rate; ++k) {
    const double t = k / rate, phase = 2 * std::numbers::pi * hertz * t;
    m.time.push_back(t);
    m.command.push_back(5e-3 * std::sin(phase));
    m.current.push_back(0.995 * m.command.back() + 2e-6 * noise(random));
    m.piston.push_back(-0.02 * std::cos(phase) + 1e-5 * noise(random));
    m.supply.push_back(200e5 - 8e5 * std::abs(std::sin(phase)) + 2e4 * noise(random));
    m.pressure_a.push_back(100e5 + 30e5 * std::sin(phase) + 1e4 * noise(random));
    m.pressure_b.push_back(100e5 - 30e5 * std::sin(phase) + 1e4 * noise(random));
  }
  return m;
}

Log log_of(const Made& m) {
  return make_log("made", {{"time [s]", m.time},
                           {"command [A]", m.command},
                           {"coil_current [A]", m.current},
                           {"piston_position [m]", m.piston},
                           {"supply_pressure [Pa]", m.supply},
                           {"pressure_a [Pa]", m.pressure_a},
                           {"pressure_b [Pa]", m.pressure_b}});
}

std::vector<RecordFigure> figures_of(const Made& m) {
  const Log log = log_of(m);
  return record_figures(log, prepare(log, {}), candidate_of(shipped_table()));
}

// Ten healthy logs of other speeds.
std::vector<std::vector<RecordFigure>> healthy() {
  std::vector<std::vector<RecordFigure>> out;
  for (unsigned i = 0; i < 10; ++i) out.push_back(figures_of(made(i, 0.5 + 0.3 * i)));
  return out;
}

std::vector<RecordFinding> findings_of(const Made& m) { return record_findings(figures_of(m), {}, healthy(), 0.005); }

TEST(Records, ALogLikeTheHealthyOnesIsNoFinding) {
  for (unsigned seed = 100; seed < 130; ++seed)
    EXPECT_TRUE(findings_of(made(seed, 0.4 + 0.1 * (seed - 100))).empty()) << seed;
}

TEST(Records, ASupplyThatIsSetLowIsFoundWithItsSizeWhateverTheFlowTakes) {
  for (const double hertz : {0.3, 1.0, 4.0})
    for (const double left : {0.88, 0.7}) {
      Made m = made(50, hertz);
      for (double& p : m.supply) p -= (1 - left) * 200e5;
      const auto found = findings_of(m);
      ASSERT_FALSE(found.empty()) << hertz << " Hz, " << left;
      EXPECT_EQ(found.front().fault, find_fault("supply_fault"));
      EXPECT_LT(found.front().lower, left);
      EXPECT_GT(found.front().upper, left);
      EXPECT_NEAR(found.front().severity, left, 0.02);
    }
}

TEST(Records, ASupplyThatFailsInTheLogIsFoundWithItsTime) {
  Made m = made(51, 1.0);
  for (std::size_t k = 0; k < m.supply.size(); ++k)
    if (m.time[k] > 2.2) m.supply[k] -= 50e5 * (1 - std::exp(-(m.time[k] - 2.2) / 0.5));
  const auto found = findings_of(m);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front().figure, FigureKind::supply_step);
  ASSERT_TRUE(found.front().since);
  EXPECT_NEAR(*found.front().since, 2.2, 0.2);
}

TEST(Records, ASupplyThatDroopsWithTheFlowIsNotOneThatIsSetLow) {
  Made m = made(52, 2.0);
  for (std::size_t k = 0; k < m.supply.size(); ++k)
    m.supply[k] -= 60e5 * std::abs(std::sin(4 * std::numbers::pi * m.time[k]));
  for (const RecordFinding& f : findings_of(m)) EXPECT_EQ(f.figure, FigureKind::supply_left);
  EXPECT_FALSE(findings_of(m).empty());
}

// A lost wire drives the piston to its end; the pump holds its pressure up to its own flow and no further.
TEST(Records, AValveThatGoesHardOverIsNoStepOfASupplyWhosePumpIsAtItsLimit) {
  for (const double stops : {0.8, 1.2, 1.6}) {
    Made m = made(53, 1.0);
    for (std::size_t k = 0; k < m.time.size(); ++k) {
      const double t = m.time[k], speed = t < 0.4 ? 0.25 * t / 0.4 : t < stops ? 0.25 : 0.0;
      m.piston[k] = k == 0 ? -0.1 : m.piston[k - 1] + speed / rate;
      m.supply[k] +=
          8e5 * std::abs(std::sin(2 * std::numbers::pi * t)) - 30e5 * speed - 400e5 * std::max(0.0, speed - 0.15);
    }
    for (const RecordFinding& f : findings_of(m)) EXPECT_NE(f.figure, FigureKind::supply_step) << stops << " s";
  }
}

TEST(Records, ADriverThatPassesOnLessIsFoundFromTheStartAndFromMidLog) {
  for (const double gain : {0.0, 0.5, 0.85})
    for (const double from : {0.0, 1.7}) {
      Made m = made(53, 1.0);
      for (std::size_t k = 0; k < m.current.size(); ++k)
        if (m.time[k] >= from) m.current[k] *= gain;
      const auto found = findings_of(m);
      ASSERT_FALSE(found.empty()) << gain << " from " << from;
      EXPECT_EQ(found.front().fault, find_fault("driver_fault")) << gain << " from " << from;
      if (from > 0) {
        ASSERT_TRUE(found.front().since) << gain;
        EXPECT_NEAR(*found.front().since, from, 0.1);
      } else {
        EXPECT_FALSE(found.front().since) << gain << ": it was wrong from the first sample on";
      }
    }
}

TEST(Records, NoiseAloneGivesADriverNoOnset) {
  for (unsigned seed = 200; seed < 230; ++seed)
    for (const RecordFigure& f : figures_of(made(seed, 1.0)))
      if (f.kind == FigureKind::driver_gain) {
        EXPECT_FALSE(f.since) << seed;
      }
}

TEST(Records, AnAmplifierThatSaturatesIsADriverFault) {
  Made m = made(54, 1.0);
  for (double& i : m.current) i = std::clamp(i, -2e-3, 2e-3);
  const auto found = findings_of(m);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front().fault, find_fault("driver_fault"));
}

TEST(Records, ASensorThatScattersIsFoundByItsName) {
  Made m = made(55, 1.0);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 8e4);
  for (double& p : m.pressure_b) p += noise(random);
  const auto found = findings_of(m);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found.front().fault, find_fault("sensor_fault"));
  EXPECT_EQ(found.front().signal, Signal::pressure_b);
  EXPECT_TRUE(std::isnan(found.front().severity)) << "a scatter is no gain";
}

TEST(Records, ASensorThatScattersForLessThanHalfOfALogIsFoundByAllOfItsNoise) {
  for (const double from : {0.0, 2.6}) {
    Made m = made(57, 1.0);
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 8e4);
    for (std::size_t k = 0; k < m.time.size(); ++k)
      if (m.time[k] >= from && m.time[k] < from + 1.4) m.pressure_b[k] += noise(random);
    const auto found = findings_of(m);
    ASSERT_EQ(found.size(), 1u) << from;
    EXPECT_EQ(found.front().signal, Signal::pressure_b) << from;
    EXPECT_NEAR(found.front().value, 8e4, 4e4) << from;
  }
}

// Half an hour at 100 Hz: the search for a step does not grow with the square of the log.
TEST(Records, ALongLogIsLookedAtInAsManyPartsAsAShortOne) {
  std::vector<double> time, command, piston, supply;
  for (int k = 0; k < 180000; ++k) {
    time.push_back(k / 100.0);
    command.push_back(5e-3 * std::sin(0.1 * time.back()));
    piston.push_back(-0.02 * std::cos(0.1 * time.back()));
    supply.push_back(time.back() < 900 ? 200e5 : 150e5);
  }
  const Log log = make_log("long", {{"time [s]", time},
                                    {"command [A]", command},
                                    {"piston_position [m]", piston},
                                    {"supply_pressure [Pa]", supply}});
  const auto figures = record_figures(log, prepare(log, {}), candidate_of(shipped_table()));
  const auto step = std::find_if(figures.begin(), figures.end(),
                                 [](const RecordFigure& f) { return f.kind == FigureKind::supply_step; });
  ASSERT_NE(step, figures.end());
  EXPECT_NEAR(step->value, 0.75, 0.01);
  EXPECT_NEAR(*step->since, 900, 1800.0 / 500);
}

TEST(Records, TwoHealthyLogsSayNothing) {
  Made low = made(56, 1.0);
  for (double& p : low.supply) p *= 0.5;
  auto few = healthy();
  few.resize(2);
  EXPECT_TRUE(record_findings(figures_of(low), {}, few, 0.005).empty());
}

// The simulation's sensors are the made ones without their noise.
Trajectory simulated(const Made& m) {
  Trajectory t;
  t.ok = true;
  t.signals[static_cast<std::size_t>(simulated_index(Signal::piston_position))] = m.piston;
  t.signals[static_cast<std::size_t>(simulated_index(Signal::pressure_a))] = m.pressure_a;
  t.signals[static_cast<std::size_t>(simulated_index(Signal::pressure_b))] = m.pressure_b;
  return t;
}

std::vector<BrokenSensor> broken_of(const Made& m) {
  return broken_sensors(prepare(log_of(m), {}), simulated(made(60, 1.0)));
}

TEST(Records, AFrozenATurnedAndASwappedSensorAreNamedAndHealthyOnesAreNot) {
  EXPECT_TRUE(broken_of(made(61, 1.0)).empty());

  Made frozen = made(61, 1.0);
  for (std::size_t k = 1500; k < frozen.piston.size(); ++k) frozen.piston[k] = frozen.piston[1500];
  auto found = broken_of(frozen);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found.front().finding, SensorFinding::frozen);
  EXPECT_EQ(found.front().signal, Signal::piston_position);

  Made turned = made(61, 1.0);
  for (double& x : turned.piston) x = -x;
  found = broken_of(turned);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found.front().finding, SensorFinding::turned);

  Made swapped = made(61, 1.0);
  std::swap(swapped.pressure_a, swapped.pressure_b);
  found = broken_of(swapped);
  ASSERT_EQ(found.size(), 2u);
  for (const BrokenSensor& b : found) EXPECT_EQ(b.finding, SensorFinding::swapped_ports);
}

// From 2.2 s on the piston would move a tenth as far. A sensor that repeats one value there has lost its noise; one
// whose steps hide its noise may show a piston that stands still.
TEST(Records, AStillSensorIsFrozenInAQuietPartOfALogWhereItsNoiseIsGoneToo) {
  const Made whole = made(62, 1.0);
  const auto quiet = [&](double resolution, double noise) {
    Made m = whole;
    std::mt19937 random(1);
    std::normal_distribution<double> normal(0, noise);
    const double stood = -0.02 * std::cos(2 * std::numbers::pi * 2.2);
    for (std::size_t k = 0; k < m.time.size(); ++k) {
      const double way = -0.02 * std::cos(2 * std::numbers::pi * m.time[k]);
      const double at = (m.time[k] < 2.2 ? way : stood) + normal(random);
      m.piston[k] = std::round(at / resolution) * resolution;
    }
    return m;
  };
  const auto frozen_of = [&](const Made& m) {
    Trajectory would = simulated(whole);
    std::vector<double>& x = would.signals[static_cast<std::size_t>(simulated_index(Signal::piston_position))];
    const double stood = x[2200];
    for (std::size_t k = 2200; k < x.size(); ++k) x[k] = stood + 0.1 * (x[k] - stood);
    return broken_sensors(prepare(log_of(m), {}), would);
  };
  for (const double resolution : {1e-5, 3e-5}) {  // finer and coarser than the noise
    Made noisy = quiet(resolution, 2e-5);
    EXPECT_TRUE(frozen_of(noisy).empty()) << "a piston that stands still";
    for (std::size_t k = 2200; k < noisy.piston.size(); ++k) noisy.piston[k] = noisy.piston[2200];
    const auto found = frozen_of(noisy);
    ASSERT_EQ(found.size(), 1u) << resolution;
    EXPECT_EQ(found.front().finding, SensorFinding::frozen);
  }
  for (const double noise : {1e-6, 1e-5, 2e-5})  // at rest such a sensor shows one value, though it zigzags elsewhere
    EXPECT_TRUE(frozen_of(quiet(1e-4, noise)).empty()) << "steps hide the noise " << noise;
  // No noise at all, and the staircase reads as half a step of it: only a zigzag tells them apart.
  EXPECT_TRUE(frozen_of(quiet(2.5e-4, 1e-6)).empty()) << "a staircase";
}

// A turned load makes the simulation's chambers change places too.
TEST(Records, ExchangedPortsAreNotNamedWhereTheFlowSaysThatTheyStandAsTheyShould) {
  const std::vector<BrokenSensor> found = {{SensorFinding::swapped_ports, Signal::pressure_a},
                                           {SensorFinding::frozen, Signal::piston_position},
                                           {SensorFinding::swapped_ports, Signal::pressure_b}};
  ASSERT_TRUE(names_exchanged_ports(found));
  for (const Chambers flow : {Chambers::not_told, Chambers::exchanged}) EXPECT_EQ(beside_flow(found, flow).size(), 3u);
  const auto left = beside_flow(found, Chambers::as_they_stand);
  ASSERT_EQ(left.size(), 1u);
  EXPECT_EQ(left.front().finding, SensorFinding::frozen);
}

TEST(Records, ASensorAtItsLimitIsNamedWhereTheSimulationGoesOn) {
  Made clipped = made(61, 1.0);
  for (double& p : clipped.pressure_a) p = std::min(p, 112e5);
  const auto found = broken_of(clipped);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found.front().finding, SensorFinding::clipped);
  EXPECT_EQ(found.front().signal, Signal::pressure_a);
  Trajectory as_measured = simulated(made(60, 1.0));
  as_measured.signals[static_cast<std::size_t>(simulated_index(Signal::pressure_a))] = clipped.pressure_a;
  EXPECT_TRUE(broken_sensors(prepare(log_of(clipped), {}), as_measured).empty()) << "a stop";
}

// A supply that swings moves both chambers the same way, so that each follows either simulation.
TEST(Records, SwappedChambersAreNamedThoughBothMoveWithTheSupply) {
  const auto swing = [](Made m) {
    for (std::size_t k = 0; k < m.time.size(); ++k)
      m.pressure_a[k] += 40e5 * std::sin(17 * m.time[k]), m.pressure_b[k] += 40e5 * std::sin(17 * m.time[k]);
    return m;
  };
  const Trajectory healthy = simulated(swing(made(60, 1.0)));
  Made m = swing(made(61, 1.0));
  EXPECT_TRUE(broken_sensors(prepare(log_of(m), {}), healthy).empty());
  std::swap(m.pressure_a, m.pressure_b);
  EXPECT_EQ(broken_sensors(prepare(log_of(m), {}), healthy).size(), 2u);
}

TEST(Records, TwoThatMoveAgainstTheSimulationAreNoSensorsFault) {
  Made m = made(61, 1.0);
  for (double& x : m.pressure_a) x = 200e5 - x;
  EXPECT_EQ(broken_of(m).size(), 1u);
  for (double& x : m.pressure_b) x = 200e5 - x;
  EXPECT_EQ(broken_of(m).size(), 2u) << "that is two swapped chambers";
  for (double& x : m.pressure_b) x = 200e5 - x;
  for (double& x : m.piston) x = -x;
  EXPECT_TRUE(broken_of(m).empty()) << "the command's sign";
}

TEST(Records, APistonThatDriftsToTheOtherSideIsNotTurned) {
  Made drifting = made(61, 1.0);
  for (std::size_t k = 0; k < drifting.piston.size(); ++k)
    drifting.piston[k] = 0.5 * drifting.piston[k] - 0.02 * drifting.time[k];
  Trajectory upward = simulated(made(60, 1.0));
  auto& piston = upward.signals[static_cast<std::size_t>(simulated_index(Signal::piston_position))];
  for (std::size_t k = 0; k < piston.size(); ++k) piston[k] += 0.02 * drifting.time[k];
  EXPECT_TRUE(broken_sensors(prepare(log_of(drifting), {}), upward).empty());
}

TEST(Records, WhereNothingFollowsItIsNoOneSensor) {
  Made m = made(61, 1.0);
  for (auto* x : {&m.piston, &m.pressure_a, &m.pressure_b})
    for (double& v : *x) v = -v;
  EXPECT_TRUE(broken_of(m).empty());
}

}  // namespace
}  // namespace servodx
