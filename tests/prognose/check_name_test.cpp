// What the text of a check's name says of it.
#include "prognose/check_name.h"

#include <gtest/gtest.h>

#include <optional>

#include "parameters/list.h"

namespace servodx {
namespace {

TEST(CheckName, ATextThatIsMadeIsReadBackAsWhatItWasMadeOf) {
  EXPECT_EQ(CheckName(CheckName::of_mean_error().text()).kind(), CheckKind::mean_error);
  EXPECT_EQ(CheckName(CheckName::of_fidelity().text()).kind(), CheckKind::fidelity);
  EXPECT_EQ(CheckName(CheckName::of_correlation(5).text()).kind(), CheckKind::correlation);
  for (int row = 0; row < n_parameters; ++row) {
    const CheckName read(CheckName::of_row(row).text());
    EXPECT_EQ(read.kind(), CheckKind::parameter);
    EXPECT_EQ(read.row(), row);
  }
}

// A sine's frequency is found in the command, with an error: two tests of one kind have checks of one name.
TEST(CheckName, FrequenciesAPartOfAHertzApartAreOneName) {
  EXPECT_EQ(CheckName::of_correlation(4.99), CheckName::of_correlation(5.01));
  EXPECT_NE(CheckName::of_correlation(5), CheckName::of_correlation(5.1));
}

TEST(CheckName, WhatNamesNoRowHasNone) {
  for (const char* text : {"parameter:", "parameter:0", "parameter:42", "parameter:09", "parameter:9 ", "parameter:-1",
                           "parameter:x", "fidelity", "9"})
    EXPECT_EQ(CheckName(text).row(), std::nullopt) << text;
  EXPECT_EQ(CheckName("parameter:x").kind(), CheckKind::parameter);
  EXPECT_EQ(CheckName("strange").kind(), CheckKind::other);
}

}  // namespace
}  // namespace servodx
