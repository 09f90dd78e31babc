// What is committed holds no path of the machine that made it: it would be wrong on any other.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

// Quoted texts that begin with a path from the root.
std::vector<std::string> absolute_paths(const std::string& text) {
  static const std::regex absolute(R"("(/[\w.+-]+){2,})");  // begins a quoted text, and has a folder
  std::vector<std::string> found;
  // A search from quote to quote: std::regex recurses over long texts.
  for (std::size_t at = text.find("\"/"); at != std::string::npos; at = text.find("\"/", at + 1)) {
    const std::string quoted = text.substr(at, 200);
    if (std::regex_search(quoted, absolute, std::regex_constants::match_continuous))
      found.push_back(quoted.substr(0, quoted.find('"', 1) + 1));
  }
  return found;
}

TEST(Paths, ShippedFilesNameOthersRelatively) {
  const std::set<std::string> kinds = {".json", ".csv", ".toml"};
  int looked_at = 0;
  for (const char* folder : {"data", "params", "tests", "docs", "examples"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(SERVODX_SOURCE_DIR) / folder)) {
      if (!kinds.contains(entry.path().extension().string())) continue;
      ++looked_at;
      std::ifstream in(entry.path());
      const std::string text{std::istreambuf_iterator<char>(in), {}};
      for (const std::string& path : absolute_paths(text))
        ADD_FAILURE() << fs::relative(entry.path(), SERVODX_SOURCE_DIR) << ": " << path;
    }
  EXPECT_GT(looked_at, 50);
}

TEST(Paths, APathFromTheRootIsTold) {
  EXPECT_EQ(absolute_paths(
                R"({"log": "/home/somebody/a.csv", "unit": "/s", "rig": "data/rig.toml", "x": "1", "y": "/tmp/b"})"),
            (std::vector<std::string>{"\"/home/somebody/a.csv\"", "\"/tmp/b\""}));
}

}  // namespace
