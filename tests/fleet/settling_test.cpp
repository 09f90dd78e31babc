// Files that come to rest, by a clock of the test's own.
#include "fleet/settling.h"

#include <gtest/gtest.h>

#include <chrono>

#include "base/error.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

using Names = std::vector<std::string>;

SeenFile file(const std::string& name, std::uintmax_t size, int second = 0) {
  return {name, size, std::filesystem::file_time_type(std::chrono::seconds(second))};
}

TEST(Settling, AFileIsNamedOnceWhenItHasNotChangedForAsLongAsAsked) {
  Settling settling(2);
  EXPECT_EQ(settling.settled({file("a", 1)}, 0), Names{});
  EXPECT_EQ(settling.settled({file("a", 2)}, 1), Names{});
  EXPECT_EQ(settling.settled({file("a", 2)}, 2.9), Names{});
  EXPECT_EQ(settling.unsettled(), 1u);
  EXPECT_EQ(settling.settled({file("a", 2)}, 3), Names{"a"});
  EXPECT_EQ(settling.settled({file("a", 2)}, 9), Names{});
  EXPECT_EQ(settling.unsettled(), 0u);
}

TEST(Settling, AFileThatChangesOrComesAgainSettlesAgain) {
  Settling settling(2);
  settling.settled({file("a", 2)}, 0);
  EXPECT_EQ(settling.settled({file("a", 2)}, 2), Names{"a"});
  EXPECT_EQ(settling.settled({file("a", 2, 5)}, 3), Names{});  // written anew, as long as it was
  EXPECT_EQ(settling.settled({file("a", 2, 5)}, 5), Names{"a"});
  EXPECT_EQ(settling.settled({}, 6), Names{});
  EXPECT_EQ(settling.settled({file("a", 2, 5)}, 7), Names{});
  EXPECT_EQ(settling.settled({file("a", 2, 5)}, 9), Names{"a"});
}

TEST(Settling, WithoutAWaitAFileIsNamedAtFirstSight) {
  Settling settling(0);
  EXPECT_EQ(settling.settled({file("a", 1), file("b", 1)}, 0), (Names{"a", "b"}));
}

TEST(Settling, LogsOfAFolderAreItsFilesWithTheEndingOfALog) {
  const TemporaryFolder folder;
  for (const char* name : {"b.csv", "a.MAT", "c.txt", "a.json", "a.html", ".hidden.csv", "d.csv.part", "plain"})
    folder.write(name, "123");
  std::filesystem::create_directory(folder / "e.csv");
  Names names;
  for (const SeenFile& seen : logs_in(folder.path.string())) {
    names.push_back(seen.name);
    EXPECT_EQ(seen.size, 3u);
  }
  EXPECT_EQ(names, (Names{"a.MAT", "b.csv", "c.txt"}));
  EXPECT_THROW(logs_in(folder / "gone"), InputError);
}

}  // namespace
}  // namespace servodx
