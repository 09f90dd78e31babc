#include "signals/time_stamp.h"

#include <chrono>
#include <utility>

namespace servodx {
namespace {

constexpr std::int64_t second = 1'000'000'000, day = 86400 * second;  // [ns]

// A text that is read from its front.
class Front {
 public:
  explicit Front(std::string_view text) : text_(text) {}

  bool at_end() const { return text_.empty(); }
  char take_one_of(std::string_view characters) {
    if (text_.empty() || characters.find(text_.front()) == characters.npos) return 0;
    const char taken = text_.front();
    text_.remove_prefix(1);
    return taken;
  }
  // Digits, at least and at most so many.
  std::optional<std::int64_t> take_number(std::size_t least, std::size_t most) {
    std::int64_t value = 0;
    std::size_t n = 0;
    for (; n < most && n < text_.size() && text_[n] >= '0' && text_[n] <= '9'; ++n)
      value = value * 10 + (text_[n] - '0');
    if (n < least) return std::nullopt;
    text_.remove_prefix(n);
    return value;
  }
  // ".123456" [ns]
  std::int64_t take_fraction() {
    std::int64_t part = 0, unit = second;
    while (!text_.empty() && text_.front() >= '0' && text_.front() <= '9') {
      unit /= 10;
      part += unit * (text_.front() - '0');
      text_.remove_prefix(1);
    }
    return part;
  }

 private:
  std::string_view text_;
};

// [ns] since 1970
std::optional<std::int64_t> take_date(Front& text) {
  const auto first = text.take_number(1, 4);
  const char mark = first ? text.take_one_of("-/.") : char{0};
  if (!mark) return std::nullopt;
  const auto month = text.take_number(1, 2);
  if (!month || !text.take_one_of({&mark, 1})) return std::nullopt;
  auto last = text.take_number(1, 4);
  if (!last) return std::nullopt;
  auto year = *first, of_month = *last;
  if (mark == '.') std::swap(year, of_month);
  const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(year)),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(of_month))};
  if (year < 1970 || year > 2200 || !date.ok()) return std::nullopt;
  return day * std::chrono::sys_days(date).time_since_epoch().count();
}

// [ns] since midnight
std::optional<std::int64_t> take_clock(Front& text) {
  const auto hour = text.take_number(1, 2);
  if (!hour || *hour > 23 || !text.take_one_of(":")) return std::nullopt;
  const auto minute = text.take_number(2, 2);
  if (!minute || *minute > 59 || !text.take_one_of(":")) return std::nullopt;
  const auto whole = text.take_number(2, 2);
  if (!whole || *whole > 59) return std::nullopt;
  std::int64_t clock = ((*hour * 60 + *minute) * 60 + *whole) * second;
  if (text.take_one_of(".,")) clock += text.take_fraction();
  return clock;
}

// "Z", "+01:00" [ns]
std::optional<std::int64_t> take_zone(Front& text) {
  if (text.at_end() || text.take_one_of("Zz")) return 0;
  const char sign = text.take_one_of("+-");
  const auto hours = sign ? text.take_number(2, 2) : std::nullopt;
  if (!hours) return std::nullopt;
  text.take_one_of(":");
  const std::int64_t minutes = text.take_number(2, 2).value_or(0);
  return (sign == '-' ? -1 : 1) * (*hours * 60 + minutes) * 60 * second;
}

}  // namespace

std::optional<TimeStamp> parse_time_stamp(std::string_view text) {
  Front dated(text);
  if (const auto date = take_date(dated)) {
    if (!dated.take_one_of(" Tt")) return std::nullopt;
    while (dated.take_one_of(" ")) {
    }
    const auto clock = take_clock(dated);
    const auto zone = clock ? take_zone(dated) : std::nullopt;
    if (!zone || !dated.at_end()) return std::nullopt;
    return TimeStamp{*date + *clock - *zone, true};
  }
  Front bare(text);
  const auto clock = take_clock(bare);
  if (!clock || !bare.at_end()) return std::nullopt;
  return TimeStamp{*clock, false};
}

bool is_date(std::string_view text) {
  Front front(text);
  return take_date(front) && front.at_end();
}

std::optional<double> StampClock::seconds(TimeStamp stamp) {
  if (stamp.has_date != first_.has_date) return std::nullopt;
  if (!stamp.has_date && stamp.nanoseconds < last_ - day / 2) days_ += day;  // midnight
  last_ = stamp.nanoseconds;
  return static_cast<double>(stamp.nanoseconds - first_.nanoseconds + days_) / static_cast<double>(second);
}

}  // namespace servodx
