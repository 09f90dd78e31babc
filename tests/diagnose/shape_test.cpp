// The further numbers of a fault: what it may look like at one size.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "diagnose/severity.h"
#include "effects/edge_radius.h"
#include "effects/registry.h"
#include "effects/stiction.h"
#include "faults/fault.h"
#include "faults/record.h"
#include "faults/registry.h"
#include "faults/sizes.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/log_data.h"
#include "model/constants.h"
#include "model/derived.h"
#include "model/state.h"
#include "parameters/list.h"
#include "shipped_data.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

ParameterVector with(const Fault& fault, double severity, double shape, std::size_t which = 0) {
  ParameterVector v = candidate_of(shipped_table());
  fault.apply(v.data(), severity);
  fault.shapes[which].apply(v.data(), shape);
  return v;
}

TEST(FaultShape, AStickySpoolBreaksAwayAtOneForceHoweverMuchOfItLastsInMotion) {
  const Fault& sticky = *find_fault("sticky_spool");
  const double whole = with(sticky, 10, 0)[row::spool_friction];
  EXPECT_EQ(with(sticky, 10, 0)[effect_row<Stiction>(0)], 0.0) << "as the paper has it: sliding friction alone";
  for (const double share : {0.25, 0.5, 1.0}) {
    const ParameterVector v = with(sticky, 10, share);
    EXPECT_NEAR(v[row::spool_friction] + v[effect_row<Stiction>(0)], whole, 1e-12 * whole);
    EXPECT_NEAR(v[row::spool_friction], (1 - share) * whole, 1e-12 * whole);
  }
}

TEST(FaultShape, AStickySpoolThatYieldsHoldsAsMuchOverALongerWay) {
  const Fault& sticky = *find_fault("sticky_spool");
  const ParameterVector stiff = with(sticky, 10, 0.0, 1), soft = with(sticky, 10, 6e-6, 1);
  EXPECT_EQ(stiff[row::spool_friction], soft[row::spool_friction]);
  using List = AllEffects;
  const auto reach = [](const ParameterVector& v) {
    return derive<double, List>(v.data(), oil_at(860.0, 14e-6, 313.15)).spool_presliding;
  };
  EXPECT_EQ(reach(stiff), constants::spool_presliding);
  EXPECT_NEAR(reach(soft), constants::spool_presliding + 6e-6, 1e-18);
}

TEST(FaultShape, AFilterMayBeBlockedAtOneDirectionOfFlowAlone) {
  const Fault& filter = *find_fault("clogged_filter");
  const auto both = with(filter, 0.6, 0), positive = with(filter, 0.6, 1), negative = with(filter, 0.6, -1);
  EXPECT_EQ(both[row::filter_blockage_positive], both[row::filter_blockage_negative]);
  EXPECT_EQ(positive[row::filter_blockage_positive], 0.6);
  EXPECT_EQ(positive[row::filter_blockage_negative], 0.0);
  EXPECT_EQ(negative[row::filter_blockage_positive], 0.0);
  EXPECT_EQ(negative[row::filter_blockage_negative], 0.6);
}

// Laws of an edge near null differ in how far a clearance rounds it: from not at all to by the clearance itself.
TEST(FaultShape, AWornClearanceMayRoundItsEdgesByUpToItself) {
  const Fault& wear = *find_fault("radial_clearance_wear");
  const ParameterVector sharp = with(wear, 6, 0), half = with(wear, 6, 0.5), whole = with(wear, 6, 1);
  const double clearance = sharp[row::radial_clearance];
  for (const int edge : {0, 1}) {
    const int at = effect_row<EdgeRadius>(edge);
    EXPECT_EQ(sharp[at], 0.0);
    EXPECT_DOUBLE_EQ(half[at], 0.5 * clearance);
    EXPECT_DOUBLE_EQ(whole[at], clearance);
  }
  EXPECT_EQ(whole[row::radial_clearance], clearance) << "the size is the clearance's";
}

// A tune that trades the healthy clearance for blunter corners must not put a worn one beyond what is searched.
TEST(FaultSizes, AClearanceTunedBelowItsDrawingIsSearchedAsFarAsTheDrawingsIs) {
  const LogData log = prepare(shipped_log("healthy/h12_mixed"), shipped_rig());
  const ParameterVector base = candidate_of(shipped_table());
  const Fault& wear = *find_fault("radial_clearance_wear");
  const auto searched = [&](const TimesDrawing& times) {
    const FreeValue f = hypothesis_values({&log}, base, {{&wear, 3.0}}, 0.05, times).front();
    return std::pair(f.lower, f.upper);
  };
  const auto [least, worst] = searched({});
  EXPECT_EQ(searched({{&wear, 0.25}}), std::pair(least, 4 * worst));
  EXPECT_EQ(searched({{&wear, 2.0}}), std::pair(least, worst)) << "larger than drawn: what is seen is worn less";
  const std::vector<double> starts = starting_severities(wear, base, 0.05, {{&wear, 0.25}});
  EXPECT_GT(*std::ranges::max_element(starts), worst) << "no start where the range goes further";
}

// Else a fault at its least size would gain by a shape that health was not asked for.
TEST(FaultShape, IsFreeInHealthAsInEveryFault) {
  const LogData log = prepare(shipped_log("healthy/h12_mixed"), shipped_rig());
  const ParameterVector base = candidate_of(shipped_table());
  const auto names = [&](const Fault* fault) {
    std::vector<std::string> shapes;
    for (const FreeValue& f : hypothesis_values({&log}, base, {{fault, fault ? fault->starts.front() : 0.0}}, 0.05))
      if (const auto at = f.name.find("shape of "); at != std::string::npos) shapes.push_back(f.name.substr(at));
    std::sort(shapes.begin(), shapes.end());
    return shapes;
  };
  const std::vector<std::string> in_health = names(nullptr);
  EXPECT_EQ(in_health.size(), 4u);
  for (const Fault* fault : fault_list())
    if (fault->told_by != Record::driver) {
      EXPECT_EQ(names(fault), in_health) << fault->name;
    }
}

}  // namespace
}  // namespace servodx
