// A long log costs its samples in memory, not its text.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <filesystem>
#include <string>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/random.h"
#include "base/sha256.h"
#include "signals/log.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

TEST(LongLog, MemoryIsThatOfTheSamplesWhateverTheText) {
  const TemporaryFolder folder;
  const std::string path = folder / "long.csv";
  constexpr int rows = 250000;
  {
    AtomicFile file(path);
    file.write("time [s],command [mA],spool_position [mm],remark\n");
    const std::string remark(300, 'x');
    for (int i = 0; i < rows; ++i) {
      std::string row;
      for (double x : {i * 1e-3, 1e-3 * (i % 700), 1e-5 * (i % 900)}) append_number(row, x), row += ',';
      file.write(row + remark + "\n");
    }
    file.commit();
  }
  const double before = peak_megabytes();
  const Log log = read_log(path);
  ASSERT_EQ(log.samples(), static_cast<std::size_t>(rows));
  const double samples = 3 * 8 * rows / 1e6, text = static_cast<double>(std::filesystem::file_size(path)) / 1e6;
  EXPECT_GT(text, 60);
  EXPECT_LT(peak_megabytes() - before, samples + 12);
}

// Rows, quoted cells and the last line meet the ends of blocks wherever they fall.
TEST(LongLog, WhereBlocksEndDoesNotShow) {
  const TemporaryFolder folder;
  Random random(5);
  std::string text = "time [s],note,command [mA],spool_position [mm]\n";
  std::vector<double> sum(3, 0.0);
  int rows = 0;
  while (text.size() < 900000) {
    const std::string note(static_cast<std::size_t>(random.uniform(0, 4000)), rows % 2 ? '\n' : ';');
    std::string cells[3];
    const double x[3] = {0.001 * rows, random.normal(), random.normal()};
    for (int c = 0; c < 3; ++c) append_number(cells[c], x[c]), sum[c] += x[c];
    text += cells[0] + ",\"" + note + "\"\"\"," + cells[1] + "," + cells[2] + (rows % 3 ? "\n" : "\r\n");
    ++rows;
  }
  text.pop_back();
  if (text.back() == '\r') text.pop_back();
  const Log log = read_log(folder.write("log.csv", text));
  ASSERT_EQ(log.samples(), static_cast<std::size_t>(rows));
  EXPECT_EQ(log.sha256, sha256(text));
  double got[3] = {};
  for (std::size_t k = 0; k < log.samples(); ++k)
    got[0] += log.time[k], got[1] += 1e3 * log[Signal::command][k], got[2] += 1e3 * log[Signal::spool_position][k];
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], sum[c], 1e-6);
}

}  // namespace
}  // namespace servodx
