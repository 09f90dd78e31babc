// Date-time stamps of loggers as a time in seconds from the first of them.
//
// Reads "2021-03-04 10:11:12.000123" (also with 'T', 'Z', an offset "+01:00" or slashes), "04.03.2021 10:11:12,000" or
// with two digits of the year, and clocks alone: "10:11:12.000", which goes on over midnight, also with AM or PM, and
// "11:12.000", minutes and seconds, which goes on over the hour. Of "03/04/2021" and "03-04-21" nobody can tell the day
// from the month: their clock counts alone, for no log goes over more than one midnight at a step. Nanoseconds. Leaves
// out: names of months; leap seconds and changes of summer time.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

namespace servodx {

struct TimeStamp {
  std::int64_t nanoseconds = 0;  // since 1970; of a clock alone since midnight or the full hour
  std::int64_t turn = 0;         // [ns] after which a clock alone begins anew; 0: it has a date
};
std::optional<TimeStamp> parse_time_stamp(std::string_view text);
bool is_date(std::string_view text);  // "2021-03-04", "04.03.2021", "03/04/21": of a column beside the clock's

class StampClock {
 public:
  explicit StampClock(TimeStamp first) : first_(first), last_(first.nanoseconds) {}
  // [s] since the first; nothing where the stamp is of another kind.
  std::optional<double> seconds(TimeStamp stamp);

 private:
  TimeStamp first_;
  std::int64_t last_, turns_ = 0;  // [ns]
};

}  // namespace servodx
