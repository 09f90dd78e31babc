#include "base/sleep_while_waiting.h"

#include <cstdlib>
#include <thread>

#ifdef __linux__
#include <unistd.h>
#endif

namespace servodx {

void sleep_while_waiting(char** argv) {
#ifdef __linux__
  // Some ten microseconds: longer than the threads of an idle machine wait, far shorter than a time slice.
  constexpr const char* spins = "10000";
  if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT") || std::thread::hardware_concurrency() < 2)
    return;
  if (setenv("GOMP_SPINCOUNT", spins, 0) == 0) execv("/proc/self/exe", argv);
#else
  (void)argv;
#endif
}

}  // namespace servodx
