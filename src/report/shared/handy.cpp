#include "report/shared/handy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include "base/units.h"
#include "servodx/tune.h"
#include "signals/signal.h"

namespace servodx::report {
namespace {

struct Ladder {
  std::string_view unit;
  double below;  // magnitude in `unit` up to which `name` serves
  std::string_view name;
  double factor;
};

constexpr double always = HUGE_VAL;
// In each unit from the smallest up.
constexpr Ladder ladders[] = {
    {"m", 2e-4, "um", 1e6},
    {"m", 1.0, "mm", 1e3},
    {"m2", 1e-3, "mm2", 1e6},
    {"m2", always, "cm2", 1e4},
    {"m3", always, "cm3", 1e6},
    {"s", 1e-3, "us", 1e6},
    {"s", 0.1, "ms", 1e3},
    {"A", 1.0, "mA", 1e3},
    {"Pa", 1e8, "bar", 1e-5},
    {"Pa", always, "MPa", 1e-6},
    {"m3/s", always, "l/min", 6e4},
    {"m3/s/Pa", always, "l/min/bar", 6e9},
    {"Pa s/m3", always, "bar/(l/min)", 1e-5 / 6e4},
    {"m/N", always, "um/kN", 1e9},
    {"N/m", 1e5, "N/mm", 1e-3},
    {"N/m", always, "N/um", 1e-6},
    {"Pa s2/m6", always, "bar/(l/min)2", 1e-5 / (6e4 * 6e4)},
    {"m3/Pa", always, "cm3/bar", 1e11},
};

}  // namespace

std::string digits(double value, int significant) {
  if (!std::isfinite(value)) return "-";
  if (value == 0) return "0";
  const double magnitude = std::abs(value);
  if (magnitude < 1e-4 || magnitude >= 1e7) return fmt::format("{:.{}g}", value, significant);
  const int places = significant - 1 - static_cast<int>(std::floor(std::log10(magnitude)));
  std::string text = fmt::format("{:.{}f}", value, std::max(places, 0));
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text;
}

HandyUnit handy_unit(const std::string& unit, double magnitude) {
  if (unit.empty() || unit == "-" || unit == "1") return {"", 1.0};
  for (const Ladder& step : ladders)
    if (unit == step.unit && std::abs(magnitude) < step.below) return {std::string(step.name), step.factor};
  // "blocked fraction of the filter area" reads as "52 % of the filter area blocked".
  constexpr std::string_view word = "fraction";
  if (const auto at = unit.find(word); at != std::string::npos) {
    std::string before = unit.substr(0, at);
    std::string after = unit.substr(at + word.size());
    while (before.ends_with(' ')) before.pop_back();
    if (!before.empty()) after.insert(std::min(after.find(','), after.size()), " " + before);
    return {"%" + after, 100.0};
  }
  return {unit, 1.0};
}

std::string handy(double value, const std::string& unit) {
  const HandyUnit in = handy_unit(unit, value);
  const std::string number = digits(value * in.factor);
  return in.name.empty() ? number : number + " " + in.name;
}

std::string handy_interval(double value, double lower, double upper, const std::string& unit, int confidence) {
  std::string text = handy(value, unit);
  if (!std::isfinite(lower) || !std::isfinite(upper)) return text;
  const double factor = handy_unit(unit, value).factor;
  return text + fmt::format(" ({} to {}, {} %)", digits(lower * factor), digits(upper * factor), confidence);
}

std::string percent(double fraction) { return digits(100.0 * fraction, fraction < 0.1 ? 2 : 3) + " %"; }

std::string chance(double probability) {
  if (probability > 0.999) return "over 99.9 %";
  if (probability < 0.001) return "under 0.1 %";
  return percent(probability);
}

std::string sentence(std::string words) {
  if (words.empty()) return words;
  words.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(words.front())));
  return words + ".";
}

std::string duration(double seconds) {
  if (seconds < 60) return digits(seconds, seconds < 10 ? 2 : 3) + " s";
  const long whole = std::lround(seconds);
  return whole < 3600 ? fmt::format("{} min {} s", whole / 60, whole % 60)
                      : fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

ChannelFigures figures(const ChannelResult& channel) {
  const SignalInfo& signal = info(channel.signal);
  const Unit* unit = find_unit(channel.unit);
  if (!unit || unit->dimension != signal.dimension) unit = find_unit(signal.si_unit);
  const double per_si = 1.0 / unit->scale();  // differences: a unit's offset does not enter
  return {std::string(unit->name), channel.rms * per_si, channel.noise_rms * per_si, channel.heldout_rms * per_si};
}

std::string plural(long n, const std::string& thing) { return fmt::format("{} {}{}", n, thing, n == 1 ? "" : "s"); }

InHandyUnit::InHandyUnit(const ParameterResult& p)
    : unit(handy_unit(p.unit, std::max(std::abs(p.nominal), std::abs(p.estimate)))) {}

}  // namespace servodx::report
