// What to do by label: the program's own, and a shop's.
#include "servodx/actions.h"

#include <gtest/gtest.h>

#include "faults/fault.h"
#include "faults/registry.h"
#include "servodx/error.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

TEST(Actions, EveryLabelHasOneAndEveryFaultAsksForSomething) {
  const Actions actions = default_actions();
  EXPECT_EQ(actions.size(), fault_list().size() + 3);
  for (const Fault* fault : fault_list()) EXPECT_NE(actions.at(std::string(fault->name)).of, ActionClass::none);
  EXPECT_EQ(actions.at("healthy").of, ActionClass::none);
  EXPECT_NE(actions.at("unknown").of, ActionClass::none);
}

TEST(Actions, AShopsTableReplacesWhatItNamesAndNothingElse) {
  const TemporaryFolder folder;
  const Actions actions = read_actions(folder.write("actions.toml", "clogged_filter = \"abnormal: flush\"\n"));
  EXPECT_EQ(actions.at("clogged_filter").of, ActionClass::abnormal);
  EXPECT_EQ(actions.at("clogged_filter").text, "abnormal: flush");
  Actions rest = actions, usual = default_actions();
  rest.erase("clogged_filter"), usual.erase("clogged_filter");
  for (const auto& [label, action] : usual) EXPECT_EQ(rest.at(label).text, action.text);
}

TEST(Actions, WhatNamesNoLabelOrNoClassIsRefusedAtItsLine) {
  const TemporaryFolder folder;
  std::string deep = "\n";  // a name in so many levels
  for (int i = 0; i < 50000; ++i) deep += "a.";
  deep += "a = \"none: go on\"\n";
  for (const std::string text : {deep.c_str(), "\nclogged_filtre = \"abnormal: flush\"\n",
                                 "\nclogged_filter = \"flush\"\n", "\nclogged_filter = 3\n", "\nclogged_filter =\n"}) {
    try {
      read_actions(folder.write("actions.toml", text));
      ADD_FAILURE() << text.substr(0, 100);
    } catch (const InputError& error) {
      EXPECT_EQ(error.where.line, 2) << text.substr(0, 100);
      EXPECT_FALSE(error.mend.empty()) << text.substr(0, 100);
    }
  }
}

}  // namespace
}  // namespace servodx
