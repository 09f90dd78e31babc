// Learnt curves share their rows of a candidate: one that is on is the one that runs, whatever others are in the list.
#include "explain/learnt_curves.h"

#include <gtest/gtest.h>

#include "effects/registry.h"
#include "effects/unexplained.h"
#include "explain/subject.h"
#include "explain/valve.h"
#include "optimise/unit_cube.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "servodx/rig.h"
#include "signals/log.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

using U = Unexplained;

TEST(Curves, OfAllInTheListTheOneThatIsOnRuns) {
  const std::string source = SERVODX_SOURCE_DIR;
  const RigFile rig = read_rig_file(source + "/data/rig.toml");
  ValveSubject subject({read_log(source + "/data/healthy/h08_preflight_cold.csv", rig)},
                       read_table(source + "/tests/hidden/valve_1.csv"), rig, 1, KnownRig{});
  const std::vector<Curve> curves = add_curves(subject);
  std::vector<int> all;
  std::size_t at = 0;
  for (const Curve& c : curves) all.push_back(c.cause);
  const auto problem = subject.problem(all);
  Point start = problem->start();
  at = start.size() - curves.size() * static_cast<std::size_t>(U::knots);
  for (const Curve& c : curves) {
    Point x = start;
    const Number& knot = subject.causes()[static_cast<std::size_t>(c.cause)].numbers[2];
    x[at + 2] = knot.to_unit(0.5 * U::places[c.place].typical);
    const ParameterVector v = problem->candidate(x, 0);
    const auto row = [&](int k) { return v[static_cast<std::size_t>(effect_row<U>(k))]; };
    EXPECT_EQ(row(0), c.place);
    EXPECT_EQ(row(1), c.variable);
    EXPECT_EQ(row(2), c.factor);
    EXPECT_NEAR(row(4 + 2), 0.5 * U::places[c.place].typical, 1e-9 * U::places[c.place].largest);
    at += static_cast<std::size_t>(U::knots);
  }
}

// Or a fit drives the simulation out of bounds where the logs do not reach.
TEST(Curves, NoFrictionDrivesThePiston) {
  const std::string source = SERVODX_SOURCE_DIR;
  const RigFile rig = read_rig_file(source + "/data/rig.toml");
  const Table table = read_table(source + "/tests/hidden/valve_1.csv");
  ValveSubject subject({read_log(source + "/data/healthy/h08_preflight_cold.csv", rig)}, table, rig, 1, KnownRig{});
  int frictions = 0;
  for (const Curve& c : add_curves(subject))
    for (const Number& knot : subject.causes()[static_cast<std::size_t>(c.cause)].numbers) {
      if (c.factor != U::by_velocity && c.factor != U::by_direction) continue;
      ++frictions;
      const double own = c.factor == U::by_velocity ? table[row::piston_viscous_friction].nominal * U::factor_speed
                                                    : table[row::piston_coulomb_friction].nominal;
      EXPECT_LE(knot.upper, own);
      EXPECT_LT(knot.lower, -1000);
    }
  EXPECT_GE(frictions, 3 * U::knots);
}

}  // namespace
}  // namespace servodx
