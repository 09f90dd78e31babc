#include "base/toml_text.h"

#include <gtest/gtest.h>

#include <string>

#include "servodx/error.h"

namespace servodx {
namespace {

std::string repeated(const std::string& part, int times) {
  std::string out;
  for (int i = 0; i < times; ++i) out += part;
  return out;
}

std::string name_of(int levels) { return repeated("a.", levels - 1) + "a"; }

std::string refusal(const std::string& text) {
  try {
    parse_toml(text, "t.toml", "mend it");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Toml, AsManyLevelsAsStatedAreReadAndOneMoreIsRefusedWithItsPlace) {
  EXPECT_EQ(refusal(name_of(deepest_toml) + " = 1\n"), "accepted");
  EXPECT_EQ(refusal("b = 1\n" + name_of(deepest_toml + 1) + " = 1\n"),
            "t.toml:2: nests deeper than 100 levels, at character 200; mend it");
  EXPECT_EQ(refusal("[" + name_of(deepest_toml - 1) + "]\nb = 1\n"), "accepted");
  EXPECT_EQ(refusal("[" + name_of(deepest_toml) + "]\nb = 1\n"),
            "t.toml:2: nests deeper than 100 levels, at character 1; mend it");
}

TEST(Toml, DeepNamesOfEveryFormAreRefusedAndDoNotOverflowTheStack) {
  for (const int levels : {deepest_toml + 1, 1000, 100000}) {
    const std::string name = name_of(levels);
    for (const std::string& text :
         {"[" + name + "]\n", "[[" + name + "]]\n", name + " = 1\n", "[ a" + repeated(" . \"b.c\"", levels) + " ]\n",
          "x = { " + name + " = 1 }\n", "x = [ 1, { " + name + " = 1 } ]\n", "x = " + repeated("[", levels),
          "x = \"\"\"\n\" a\"\"\"\"\n[" + name + "]\n", "x = '#' # '\"\n[" + name + "]\n",
          "x = [\"\"\"a\"\"\"\"\", {" + name + " = 1}]\n"})
      EXPECT_NE(refusal(text).find("nests deeper than 100 levels, at character "), std::string::npos)
          << refusal(text).substr(0, 200) << " of " << text.substr(0, 50);
  }
}

// Header, keys and tables within values, none of them deep alone.
TEST(Toml, LevelsOfNamesWithinNamesAreCountedTogether) {
  const std::string half = name_of(60);
  EXPECT_NE(refusal("[" + half + "]\n" + half + " = 1\n"), "accepted");
  EXPECT_NE(refusal("x = {" + half + " = {" + half + " = 1 } }\n"), "accepted");
  EXPECT_EQ(refusal("[" + half + "]\n[b]\n" + half + " = 1\n"), "accepted");
  EXPECT_EQ(refusal("x = [{" + half + " = 1}, {" + half + " = 1}]\n" + half + " = 1\n"), "accepted");
}

TEST(Toml, DotsOfNumbersTextsAndCommentsAreNoLevels) {
  const std::string dots = name_of(1000);
  EXPECT_EQ(refusal("# " + dots + "\nx = \"" + dots + " \\\" " + dots + "\"\ny = '" + dots + "' # " + dots + "\nz = [" +
                    repeated("1.5, ", 1000) + "]\nu = \"\"\"\n" + dots + "\n\"\"\"\nv = '''" + dots + "'''\n\"" + dots +
                    "\" = 1\n"),
            "accepted");
  EXPECT_EQ(refusal(repeated("[[a.b]]\nc = { d = 1.5, e = [2, 3] }\n", 500)), "accepted");
}

TEST(Toml, WhatIsNoTomlNamesItsLine) { EXPECT_TRUE(refusal("x = 1\ny = no\n").starts_with("t.toml:2: is not TOML: ")); }

}  // namespace
}  // namespace servodx
