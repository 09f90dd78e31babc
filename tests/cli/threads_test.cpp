// How the program's threads wait for each other, as libgomp shows it when it is loaded.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <thread>

#include "program.h"

namespace servodx {
namespace {

// A variable of the environment, for as long as this lives.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) { setenv(name, value, 1); }
  ~Variable() { unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

bool spins_briefly(const Desk& desk) {
  desk.write("log.csv", small_log());
  const Ended ended = desk.run("check-log log.csv");
  EXPECT_EQ(ended.code, 0) << ended.err;
  return ended.err.find("GOMP_SPINCOUNT = '10000'") != std::string::npos;
}

TEST(Threads, SleepAfterAMomentUnlessTheEnvironmentSaysHowToWait) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "one core: no threads wait";
  const Desk desk;
  const Variable shown("OMP_DISPLAY_ENV", "VERBOSE");
  EXPECT_TRUE(spins_briefly(desk));
  const Variable said("OMP_WAIT_POLICY", "active");
  EXPECT_FALSE(spins_briefly(desk));
}

}  // namespace
}  // namespace servodx
