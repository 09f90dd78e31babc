#include "fit/row_meaning.h"

#include <gtest/gtest.h>

#include "effects/effect.h"
#include "effects/registry.h"
#include "parameters/list.h"

namespace servodx {
namespace {

TEST(RowMeaning, EveryRowOfTableAndEffectsHasALine) {
  for (const ParameterInfo& p : parameter_list) EXPECT_EQ(meaning_of_row(std::string(p.name)), p.meaning);
  for (const EffectInfo& effect : effect_list())
    for (const EffectParameter& p : effect.parameters) EXPECT_FALSE(meaning_of_row(p.name).empty()) << p.name;
  EXPECT_EQ(meaning_of_row("no_such_row"), "");
}

}  // namespace
}  // namespace servodx
