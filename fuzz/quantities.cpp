// Quantities with their units, gains and time stamps, as options and files give them.
#include "base/units.h"
#include "fleet/log_list.h"
#include "harness.h"
#include "signals/time_stamp.h"

namespace servodx::fuzz {

void read(std::string_view input) {
  for (const Dimension dimension : {Dimension::length, Dimension::pressure, Dimension::temperature}) {
    refusing([&] { parse_quantity(input, dimension, {"rig.toml", 1, "key"}); });
    refusing([&] { parse_gain(input, dimension, {"rig.toml", 1, "key"}); });
  }
  find_unit(input);
  is_date(input);
  if (const auto stamp = parse_time_stamp(input)) StampClock(TimeStamp{}).seconds(*stamp);
  read_chunk(std::string(input));
}

}  // namespace servodx::fuzz
