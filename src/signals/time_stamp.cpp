#include "signals/time_stamp.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace servodx {
namespace {

constexpr std::int64_t second = 1'000'000'000, hour = 3600 * second, day = 24 * hour;  // [ns]

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

struct Date {
  std::int64_t since_1970;  // [ns]
  bool is_known;            // false: which of its numbers is the day, nobody can tell
};

std::optional<Date> take_date(Front& text) {
  const auto first = text.take_number(1, 4);
  const char mark = first ? text.take_one_of("-/.") : char{0};
  if (!mark) return std::nullopt;
  const auto second_one = text.take_number(1, 2);
  if (!second_one || !text.take_one_of({&mark, 1})) return std::nullopt;
  const auto last = text.take_number(1, 4);
  if (!last) return std::nullopt;
  constexpr std::int64_t longest_month = 31, months = 12;
  std::int64_t year = *first, month = *second_one, of_month = *last;
  if (year <= longest_month) {
    std::swap(year, of_month);
    if (year < 100) year += 2000;
    if (mark != '.' && of_month >= 1 && month >= 1 && month <= longest_month && std::min(month, of_month) <= months)
      return Date{0, false};
  }
  const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(year)),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(of_month))};
  if (year < 1970 || year > 2200 || !date.ok()) return std::nullopt;
  return Date{day * std::chrono::sys_days(date).time_since_epoch().count(), true};
}

// "59.500" [ns]
std::optional<std::int64_t> take_seconds(Front& text, bool with_fraction) {
  const auto whole = text.take_number(2, 2);
  if (!whole || *whole > 59) return std::nullopt;
  const bool has_fraction = text.take_one_of(".,") != 0;
  if (with_fraction && !has_fraction) return std::nullopt;
  return *whole * second + (has_fraction ? text.take_fraction() : 0);
}

// " PM" [ns] to be added to a clock of twelve hours; nothing where its hour is none of those.
std::optional<std::int64_t> take_half_of_day(Front& text, std::int64_t hours) {
  Front half = text;
  while (half.take_one_of(" ")) {
  }
  const char letter = half.take_one_of("AaPp");
  if (!letter || !half.take_one_of("Mm")) return 0;
  text = half;
  if (hours < 1 || hours > 12) return std::nullopt;
  const bool afternoon = letter == 'P' || letter == 'p';
  return (afternoon - (hours == 12)) * 12 * hour;
}

// [ns] since midnight
std::optional<std::int64_t> take_clock(Front& text) {
  const auto hours = text.take_number(1, 2);
  if (!hours || *hours > 23 || !text.take_one_of(":")) return std::nullopt;
  const auto minutes = text.take_number(2, 2);
  if (!minutes || *minutes > 59 || !text.take_one_of(":")) return std::nullopt;
  const auto seconds = take_seconds(text, false);
  const auto half = seconds ? take_half_of_day(text, *hours) : std::nullopt;
  if (!half) return std::nullopt;
  return *hours * hour + *minutes * 60 * second + *seconds + *half;
}

// "11:59.500" [ns] since the full hour; without a fraction it may be hours and minutes.
std::optional<std::int64_t> take_minutes(Front& text) {
  const auto minutes = text.take_number(1, 2);
  if (!minutes || *minutes > 59 || !text.take_one_of(":")) return std::nullopt;
  const auto seconds = take_seconds(text, true);
  if (!seconds) return std::nullopt;
  return *minutes * 60 * second + *seconds;
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
    return date->is_known ? TimeStamp{date->since_1970 + *clock - *zone, 0} : TimeStamp{*clock, day};
  }
  Front whole(text), short_one(text);
  if (const auto clock = take_clock(whole); clock && whole.at_end()) return TimeStamp{*clock, day};
  if (const auto clock = take_minutes(short_one); clock && short_one.at_end()) return TimeStamp{*clock, hour};
  return std::nullopt;
}

bool is_date(std::string_view text) {
  Front front(text);
  return take_date(front) && front.at_end();
}

std::optional<double> StampClock::seconds(TimeStamp stamp) {
  if (stamp.turn != first_.turn) return std::nullopt;
  if (stamp.nanoseconds < last_ - stamp.turn / 2) turns_ += stamp.turn;  // midnight, or the full hour
  last_ = stamp.nanoseconds;
  return static_cast<double>(stamp.nanoseconds - first_.nanoseconds + turns_) / static_cast<double>(second);
}

}  // namespace servodx
