// JSON that is read keeps to limits: its size, its values and its levels.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "base/json_text.h"
#include "base/reading_limits.h"
#include "servodx/error.h"
#include "store/baseline_file.h"
#include "store/healthy_file.h"
#include "store/result_json.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

std::string list_of(long empty_lists) {
  std::string text = "[[]";
  for (long k = 1; k < empty_lists; ++k) text += ",[]";
  return text + "]";
}

TEST(JsonLimits, ValuesAreCountedAndTextsAreNone) {
  EXPECT_TRUE(has_few_values(list_of(300'000)));
  EXPECT_FALSE(has_few_values(list_of(600'000)));  // each a bracket and a comma
  EXPECT_TRUE(has_few_values("\"" + std::string(2 * most_json_values, ',') + "\""));
  EXPECT_TRUE(json_or_discarded<nlohmann::json>(list_of(600'000)).is_discarded());
}

template <class Reader>
std::string refusal(const Reader& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

// A file with a hole: refused by its size, it costs neither disk nor memory.
TEST(JsonLimits, ALargeFileIsRefusedBeforeItIsRead) {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.json", "{}");
  std::filesystem::resize_file(path, largest_json + 1);
  const std::string said = path + ": has more than 64 MB, the most that such a file may; give the file that is meant";
  EXPECT_EQ(refusal([&] { store::read_result(path); }), said);
  EXPECT_EQ(refusal([&] { store::read_baseline(path); }), said);
}

TEST(JsonLimits, AFileBeyondThemIsToldWhich) {
  const TemporaryFolder folder;
  const std::string wide = folder.write("wide.json", list_of(600'000));
  const std::string deep = folder.write("deep.json", std::string(200, '[') + std::string(200, ']'));
  const std::string baseline = "; make it again with 'servodx baseline'";
  const std::string result = "; name a file that --json wrote, or a baseline";
  EXPECT_EQ(refusal([&] { store::read_result(wide); }), wide + ": holds more than 1000000 values" + result);
  EXPECT_EQ(refusal([&] { store::read_result(deep); }), deep + ": nests deeper than 100 levels" + result);
  EXPECT_EQ(refusal([&] { store::read_baseline(wide); }), wide + ": holds more than 1000000 values" + baseline);
  EXPECT_EQ(refusal([&] { store::read_healthy(deep); }), deep + ": nests deeper than 100 levels" + baseline);
}

}  // namespace
}  // namespace servodx
