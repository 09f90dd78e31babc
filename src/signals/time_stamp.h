// Date-time stamps of loggers as a time in seconds from the first of them.
//
// Reads "2021-03-04 10:11:12.000123" (also with 'T', 'Z', an offset "+01:00" or slashes), "04.03.2021 10:11:12,000",
// and a clock alone, "10:11:12.000", which goes on over midnight. Nanoseconds. Leaves out: day and month with slashes,
// which stand in either order; AM and PM; names of months; leap seconds and changes of summer time.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

namespace servodx {

struct TimeStamp {
  std::int64_t nanoseconds = 0;  // since 1970, or since midnight
  bool has_date = false;
};
std::optional<TimeStamp> parse_time_stamp(std::string_view text);
bool is_date(std::string_view text);  // "2021-03-04", "04.03.2021": of a column beside the clock's

class StampClock {
 public:
  explicit StampClock(TimeStamp first) : first_(first), last_(first.nanoseconds) {}
  // [s] since the first; nothing where the stamp is of the other kind.
  std::optional<double> seconds(TimeStamp stamp);

 private:
  TimeStamp first_;
  std::int64_t last_, days_ = 0;  // [ns]
};

}  // namespace servodx
