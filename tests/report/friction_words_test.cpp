// A sticking spool's friction beside what leakage can press a land with, as a person and a program read it.
#include "report/diagnose/friction_words.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "diagnose/decide.h"
#include "diagnose/judge.h"
#include "diagnose/lateral_force.h"
#include "faults/registry.h"
#include "report/diagnose/diagnose_page.h"
#include "report/shared/json.h"
#include "report/shared/page.h"

namespace servodx::report {
namespace {

TEST(FrictionWords, SayWhetherOiledSteelCouldRubSo) {
  const std::string lock = friction_in_words({20, 200}), chip = friction_in_words({60, 200});
  EXPECT_NE(lock.find("20 N; leakage presses one land without grooves with 200 N at most"), std::string::npos) << lock;
  EXPECT_NE(lock.find("of 0.1: no more than oiled steel has"), std::string::npos) << lock;
  EXPECT_NE(chip.find("of 0.3: more than oiled steel has"), std::string::npos) << chip;
  EXPECT_EQ(friction_json(FrictionBesideForce{20, 200})["coefficient"], 0.1);
  EXPECT_TRUE(friction_json({}).is_null());
}

TEST(FrictionWords, StandAmongTheReasonsOfTheVerdict) {
  Diagnosis d;
  d.log = "log.csv", d.verdict = VerdictKind::fault, d.fault = find_fault("sticky_spool");
  EXPECT_EQ(diagnose_page({}, {d}, {}, {}, {}).html().find("Merritt"), std::string::npos);
  d.friction = FrictionBesideForce{20, 200};
  const std::string html = diagnose_page({}, {d}, {}, {}, {}).html();
  EXPECT_NE(html.substr(0, html.find("<section class=\"part\"")).find("Merritt"), std::string::npos);
}

}  // namespace
}  // namespace servodx::report
