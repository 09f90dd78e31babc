// A result in a fleet's folder, and a truth beside a log.
#include <atomic>

#include "fleet/gather.h"
#include "fleet/result_file.h"
#include "harness.h"
#include "store/truth_file.h"

namespace servodx::fuzz {

void read(std::string_view input) {
  const InputFolder folder;
  const std::string result = folder.write("result.json", input);
  refusing([&] { csv_of(gather(folder.path(), std::atomic<bool>(false))); });
  standing_verdict(result, {.version = "0.1.0", .seed = 1, .inputs = {"a"}});
  folder.write("log.truth.json", input);
  store::truth_beside(folder.path() + "/log.csv", "a");
}

}  // namespace servodx::fuzz
