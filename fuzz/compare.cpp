// Two results beside each other, parted by a byte of zero.
#include "report/compare/compare.h"

#include <nlohmann/json.hpp>

#include "harness.h"
#include "report/shared/json.h"
#include "store/result_json.h"

namespace servodx::fuzz {

void read(std::string_view input) {
  const InputFolder folder;
  const std::size_t part = input.find('\0');
  const std::string a = folder.write("a.json", input.substr(0, part));
  const std::string b = part == std::string_view::npos ? a : folder.write("b.json", input.substr(part + 1));
  const auto in_a = store::read_result(a), in_b = store::read_result(b);
  const report::Comparison all = report::compare(a, in_a, b, in_b);
  report::text_of(all);
  report::compare_json(all).dump();
}

}  // namespace servodx::fuzz
