// Laws the rig obeys whatever its numbers: balance, dissipation, convergence, determinism.
#include <gtest/gtest.h>

#include <algorithm>

#include "base/celsius.h"
#include "rig/contact.h"
#include "rig/fluid.h"
#include "rig/magnetics.h"
#include "rig/passage.h"
#include "rig/plant.h"
#include "rig/rig_model.h"
#include "rig/rig_run.h"
#include "rig/virtual_rig.h"
#include "rig_test_support.h"
#include "signals/log.h"

namespace servodx::rig {
namespace {

TEST(RigLaws, CommittedLogIsWhatTheRigWrites) {
  // Within twice the noise: other processors round otherwise.
  const Log committed = read_log(std::string(SERVODX_SOURCE_DIR) + "/data/healthy/h09_preflight_hot.csv");
  const auto log = run_rig(
      flight_rig(),
      {.excitation = "preflight", .duration = 2.4, .temperature = 65.0 + zero_celsius, .air = 0.010, .seed = 109});
  int compared = 0;
  for (const auto& column : log.columns) {
    if (column.signal == Signal::time || !committed.has(column.signal)) continue;
    const auto& expected = committed[column.signal];
    ASSERT_EQ(expected.size(), column.value.size());
    const std::string name(info(column.signal).name);
    const auto sensor = std::find_if(flight_rig().sensors.begin(), flight_rig().sensors.end(),
                                     [&](const Sensor& s) { return s.signal == name; });
    if (sensor == flight_rig().sensors.end()) continue;
    double worst = 0.0;
    for (std::size_t k = 0; k < expected.size(); ++k) worst = std::max(worst, std::fabs(expected[k] - column.value[k]));
    EXPECT_LE(worst, 2.0 * sensor->noise) << name;
    ++compared;
  }
  EXPECT_GE(compared, 4);
}

TEST(RigLaws, StoredOilEqualsFlowInMinusFlowOut) {
  for (const double celsius : {-30.0, 40.0, 70.0}) {
    VirtualRig rig = settled({.temperature = celsius + zero_celsius, .air = 0.02});
    const State start = rig.state();
    const double before = rig.plant().stored_oil(start);
    const double h = rig.model().solver_step;
    for (int i = 0; i < 100000; ++i) rig.step(i % 40000 < 20000 ? 0.02 : -0.02, i > 50000 ? 6000.0 : 0.0, 0.0, h);
    const State& end = rig.state();
    const double gained = (end[oil_in] - start[oil_in]) - (end[oil_out] - start[oil_out]);
    const double moved = end[oil_in] - start[oil_in];
    EXPECT_NEAR(rig.plant().stored_oil(end) - before, gained, 1e-7 * moved) << celsius;
  }
}

TEST(RigLaws, HalvingTheStepMovesNoChannelAboveItsNoise) {
  for (const char* excitation : {"steps_large", "steps_small", "mixed", "flight"}) {
    std::vector<std::vector<double>> coarse, fine;
    const auto record = [&](double step, std::vector<std::vector<double>>& to) {
      RigRun run{.excitation = excitation, .duration = 0.8, .noise = false, .step = step};
      for (auto& column : run_rig(flight_rig(), run).columns) to.push_back(std::move(column.value));
    };
    record(4e-6, coarse);
    record(2e-6, fine);
    const auto log = run_rig(flight_rig(), {.excitation = excitation, .duration = 0.01});
    for (std::size_t c = 0; c < coarse.size(); ++c) {
      const std::string name(info(log.columns[c].signal).name);
      const auto sensor = std::find_if(flight_rig().sensors.begin(), flight_rig().sensors.end(),
                                       [&](const Sensor& s) { return s.signal == name; });
      // time and command: one step of the converter at most
      const double noise = sensor != flight_rig().sensors.end() ? sensor->noise : 1.01e-5;
      double worst = 0.0;
      for (std::size_t k = 0; k < coarse[c].size(); ++k) worst = std::max(worst, std::fabs(coarse[c][k] - fine[c][k]));
      EXPECT_LE(worst, noise) << excitation << ' ' << name;
    }
  }
}

TEST(RigLaws, PistonAgainstItsStopUnderFullPressureIsStable) {
  // The stiffest state: smallest chamber, edge wide open, no pressure across it, hot oil without air.
  VirtualRig rig = settled({.temperature = 70.0 + zero_celsius, .air = 0.0}, 0.19);
  hold(rig, 0.02, 0.4);
  EXPECT_NEAR(rig.piston_position(), 0.2, 1e-3);
  double low = 1e9, high = 0.0;
  for (int i = 0; i < 5000; ++i) {
    rig.step(0.02, 0.0, 0.0, rig.model().solver_step);
    low = std::min(low, rig.state()[p_b]);
    high = std::max(high, rig.state()[p_b]);
  }
  EXPECT_LT(high - low, 1e4);
}

TEST(RigLaws, SameSeedSameBitsAndOtherSeedOtherNoise) {
  const RigRun run{.excitation = "prbs", .duration = 0.1, .seed = 7};
  RigRun other = run;
  other.seed = 8;
  const auto a = run_rig(flight_rig(), run), b = run_rig(flight_rig(), run), c = run_rig(flight_rig(), other);
  for (std::size_t i = 0; i < a.columns.size(); ++i) EXPECT_EQ(a.columns[i].value, b.columns[i].value);
  EXPECT_NE(a.columns[3].value, c.columns[3].value);
}

TEST(RigLaws, NoiseOfASensorDoesNotDependOnWhichOthersAreLogged) {
  RigRun run{.excitation = "sine", .duration = 0.1};
  const auto all = run_rig(flight_rig(), run);
  run.channels = {"spool_position"};
  const auto one = run_rig(flight_rig(), run);
  ASSERT_EQ(one.columns.size(), 3u);
  EXPECT_EQ(one.columns[2].value, all.columns[2].value);
}

TEST(RigLaws, MagneticHysteresisNeverGivesEnergyBack) {
  Hysteresis iron(0.3, 3.4e-6, 8e-6);
  double flux = 0.0, work = 0.0, least = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const double next = 4e-6 * std::sin(0.01 * i) * std::exp(-1e-4 * i);
    const double before = iron.mmf(flux);
    iron.commit(next);
    work += 0.5 * (before + iron.mmf(next)) * (next - flux);
    flux = next;
    least = std::min(least, work);
  }
  EXPECT_GE(least, -1e-12);
  EXPECT_GT(work, 0.0);
}

TEST(RigLaws, MagneticHysteresisRemembersItsTurningPoints) {
  // Return-point memory: a minor loop closes on itself, and leaves the major branch as if it had not been.
  Hysteresis with(0.3, 3.4e-6, 8e-6), without = with;
  const auto sweep = [](Hysteresis& iron, double from, double to) {
    for (int i = 1; i <= 100; ++i) iron.commit(from + (to - from) * i / 100.0);
  };
  for (Hysteresis* iron : {&with, &without}) {
    sweep(*iron, 0.0, -3.4e-6);
    sweep(*iron, -3.4e-6, 1e-6);
  }
  sweep(with, 1e-6, -0.5e-6);
  sweep(with, -0.5e-6, 1e-6);
  for (const double flux : {1e-6, 2e-6, 3e-6}) EXPECT_NEAR(with.mmf(flux), without.mmf(flux), 1e-12);
}

TEST(RigLaws, MagneticLoopOfAFullCycleIsTwiceTheCoerciveMmfWide) {
  Hysteresis iron(0.3, 3.4e-6, 8e-6);
  for (const double end : {3.4e-6, -3.4e-6, 0.0}) iron.commit(end);
  const double up = iron.mmf(0.0);
  for (const double end : {3.4e-6, 0.0}) iron.commit(end);
  EXPECT_NEAR(up - iron.mmf(0.0), 2.0 * 0.3, 0.03 * 0.6);  // a little narrower: the iron saturates
}

TEST(RigLaws, BristleFrictionDissipatesOverEveryCycle) {
  const Friction friction{1.5, 2.2, 5e-3, 1e6, 60.0, 0.0};
  for (const double speed : {1e-4, 1e-3, 1e-2, 1e-1}) {
    double z = 0.0, work = 0.0;
    const double h = 1e-6, frequency = 20.0;
    for (int i = 0; i < 100000; ++i) {
      const double v = speed * std::sin(6.283185307179586 * frequency * i * h);
      const auto r = friction.at(v, z);
      work += r.force * v * h;
      z += h * r.rate;
    }
    EXPECT_GT(work, 0.0) << speed;
  }
}

TEST(RigLaws, FlowThroughAnEdgeIsOddAndRisesWithPressure) {
  for (const double opening : {-5e-4, -1e-5, 0.0, 1e-5, 5e-4}) {
    double last = 0.0;
    for (const double dp : {1e2, 1e4, 1e6, 2e7}) {
      const double q = edge_flow(flight_rig(), edge_pa, opening + flight_rig().edges_lap_pa, dp);
      EXPECT_EQ(edge_flow(flight_rig(), edge_pa, opening + flight_rig().edges_lap_pa, -dp, dp), -q);
      EXPECT_GT(q, last);
      last = q;
    }
  }
}

TEST(RigLaws, DischargeCoefficientIsConstantAtHighAndRisesWithTheRootOfReynoldsNumberAtLow) {
  const double diameter = 1e-3, area = 1e-6, mu = 0.012, rho = 850.0;
  const Restriction r = orifice(0.61, area, diameter, slot_flow_number);
  for (const double dp : {1e-3, 1e-2, 1e6, 1e7}) {
    const double q = flow_through(r, mu, rho, dp), reynolds = rho * q / area * diameter / mu;
    const double discharge = q / (area * std::sqrt(2.0 * dp / rho));
    EXPECT_NEAR(discharge, dp > 1.0 ? 0.61 : 0.157 * std::sqrt(reynolds), 0.01 * discharge) << dp;
  }
}

TEST(RigLaws, CoveredLandLeaksAsAnEccentricAnnulus) {
  // Merritt 1967, sec. 3-2: w c^3 dp / (12 mu L) times 1 + 1.5 e^2
  const RigModel& m = flight_rig();
  const Oil oil(m, 313.15, 0.0);
  const double land = 0.4e-3, dp = 1e6, c = m.edges_clearance, mu = oil.viscosity_at(0.5 * dp);
  const double expected =
      m.edges_width * c * c * c * dp / (12.0 * mu * land) * (1.0 + 1.5 * m.edges_eccentricity * m.edges_eccentricity);
  const double x = m.edges_lap_pa - 2.0 * m.edges_corner_pa - land;
  EXPECT_NEAR(edge_flow(m, edge_pa, x, dp), expected, 0.01 * expected);
}

TEST(RigLaws, FreeAirSoftensTheOilAndDoesNotSlowThePiston) {
  // Under pressure a tenth of air is a third of a per cent of the oil: a steady piston runs as fast with it.
  const auto speed = [](double air) {
    const auto log = run_rig(flight_rig(), {.excitation = "triangle", .duration = 1.0, .air = air, .amplitude = 0.5});
    const auto at = [&](Signal s) {
      return std::find_if(log.columns.begin(), log.columns.end(), [&](const OutputColumn& c) { return c.signal == s; });
    };
    const auto& x = at(Signal::piston_position)->value;
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    return *high - *low;
  };
  EXPECT_NEAR(speed(0.10) / speed(0.001), 1.0, 0.01);
}

TEST(RigLaws, RoundedCornersOpenEarlier) {
  RigModel worn = flight_rig();
  worn.edges_corner_pa = 20e-6;
  EXPECT_GT(edge_flow(worn, edge_pa, worn.edges_lap_pa, 1e7),
            1.5 * edge_flow(flight_rig(), edge_pa, worn.edges_lap_pa, 1e7));
}

TEST(RigLaws, EnergyInEqualsEnergyStoredAndLost) {
  for (const char* excitation : {"steps_large", "flight"}) {
    for (const double celsius : {-30.0, 70.0}) {
      const auto log = run_rig(flight_rig(), {.excitation = excitation,
                                              .duration = 0.5,
                                              .temperature = celsius + zero_celsius,
                                              .faults = {{"feedback_wire_backlash", 10e-6}, {"sticky_spool", 4.0}}});
      EXPECT_LT(std::fabs(log.truth["balance"]["energy_error"].get<double>()), 1e-6) << excitation << celsius;
      EXPECT_LT(std::fabs(log.truth["balance"]["oil_error"].get<double>()), 1e-9) << excitation << celsius;
    }
  }
}

TEST(RigLaws, ReadsAsAContractLog) {
  const auto log = run_rig(flight_rig(), {.excitation = "steps_small", .duration = 0.1, .rate = 2000.0});
  ASSERT_EQ(log.columns.size(), 10u);
  EXPECT_EQ(log.columns[0].value.size(), 200u);
  EXPECT_EQ(log.columns[0].signal, Signal::time);
  EXPECT_EQ(log.columns[1].signal, Signal::command);
  EXPECT_EQ(log.truth["label"], "healthy");
}

}  // namespace
}  // namespace servodx::rig
