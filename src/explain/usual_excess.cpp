#include "explain/usual_excess.h"

#include <map>
#include <string>
#include <string_view>

#include "base/csv.h"
#include "explain/constants.h"

namespace servodx {
namespace explain_assets {
extern const std::string_view usual_excess_csv;  // embedded by the build
}

namespace {

std::map<std::string, double> read() {
  std::map<std::string, double> out;
  CsvCursor csv(explain_assets::usual_excess_csv, "usual_excess.csv");
  std::string effect;
  for (double mean = 0; csv.next_row() && csv.next_cell(effect) && csv.next_number(mean) == Cell::number;)
    out[effect] = mean;
  return out;
}

}  // namespace

double usual_excess(const std::string& effect) {
  static const std::map<std::string, double> of_other_valves = read();
  const auto it = of_other_valves.find(effect);
  return it == of_other_valves.end() ? explain_constants::usual_share : it->second;
}

}  // namespace servodx
