// JSON that is read keeps to limits: its size, its values and its levels.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "base/json_text.h"
#include "base/reading_limits.h"
#include "servodx/error.h"
#include "store/baseline_file.h"
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

TEST(JsonLimits, ABaselineOfAHundredLogsKeepsThem) {
  EXPECT_LT(100 * 90'000u, largest_json);
  EXPECT_LT(100 * 3000, most_json_values);
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

}  // namespace
}  // namespace servodx
