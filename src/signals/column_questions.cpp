#include "signals/column_questions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/median.h"
#include "base/units.h"
#include "servodx/log.h"
#include "signals/constants.h"
#include "signals/signal.h"

namespace servodx {
namespace {

using namespace signals_constants;

enum class Measure { size, span, level, step };

// What a signal of a servovalve's rig measures in SI: surely, and at the utmost.
struct Usual {
  Measure measure;
  double least, most;                     // likely: a unit is taken by it
  double least_of_all, most_of_all;       // beyond it is absurd
  std::array<std::string_view, 5> units;  // that people log it in, most usual first
};

Usual usual(Signal s) {
  switch (s) {
    case Signal::time:
      return {Measure::step, 2e-5, 2e-2, 1e-6, 0.5, {"s", "ms", "us"}};
    case Signal::command:
    case Signal::coil_current:
      return {Measure::size, 2e-3, 0.5, 1e-4, 5, {"mA", "A"}};
    case Signal::spool_position:
      return {Measure::span, 1e-4, 1e-2, 1e-6, 2e-2, {"mm", "um", "m", "in"}};
    case Signal::setpoint:
    case Signal::piston_position:
      return {Measure::span, 5e-3, 1, 1e-3, 10, {"mm", "m", "in", "cm"}};
    case Signal::return_pressure:
      return {Measure::size, 1e4, 5e6, 0, 1e7, {"bar", "MPa", "psi", "kPa", "Pa"}};
    case Signal::load_pressure:
    case Signal::valve_pressure_drop:
      return {Measure::size, 2e5, 1e8, 1e4, 1.5e8, {"bar", "MPa", "psi", "kPa", "Pa"}};
    case Signal::pressure_a:
    case Signal::pressure_b:
    case Signal::supply_pressure:
    case Signal::pilot_pressure_1:
    case Signal::pilot_pressure_2:
      return {Measure::size, 1e6, 1e8, 2e5, 1.5e8, {"bar", "MPa", "psi", "kPa", "Pa"}};
    case Signal::load_force:
      return {Measure::size, 5, 1e6, 0, 5e6, {"N", "kN", "lbf"}};
    case Signal::flow_a:
    case Signal::flow_b:
    case Signal::control_flow:
      return {Measure::size, 1e-5, 2e-2, 0, 0.1, {"l/min", "m3/s", "gpm", "cm3/s"}};
    case Signal::leakage_flow:
      return {Measure::size, 1e-7, 2e-4, 0, 0.01, {"l/min", "m3/s", "gpm", "cm3/s"}};
    case Signal::oil_temperature:
      return {Measure::level, 263, 393, 230, 420, {"degC", "K", "degF"}};
  }
  return {};
}

constexpr double milliampere = 1e-3;  // [A]

bool is_drive(Signal s) { return s == Signal::command || s == Signal::coil_current; }
bool is_stroke(Signal s) { return s == Signal::piston_position || s == Signal::setpoint; }

bool lies_within(const Unit& unit, const ColumnNumbers& n, Measure measure, double least, double most) {
  const double low = unit.to_si(n.low), high = unit.to_si(n.high);
  switch (measure) {
    case Measure::size:
      return std::max(std::abs(low), std::abs(high)) >= least && std::max(std::abs(low), std::abs(high)) <= most;
    case Measure::span:
      return high - low >= least && high - low <= most;
    case Measure::level:
      return low >= least && high <= most;
    case Measure::step:
      return n.step * unit.scale() >= least && n.step * unit.scale() <= most;
  }
  return false;
}

// A column's unit with its gain in it: a mil is 0.001 in.
std::optional<Unit> unit_of(const ColumnGuess& g) {
  const Unit* const known = find_unit(g.unit);
  if (!known) return std::nullopt;
  Unit unit = *known;
  unit.multiply *= parse_number(g.gain).value_or(1.0);
  return unit;
}

// Clocks that count from a date, and what they show from 2000 to 2050.
struct Clock {
  std::string_view what;
  double least, most;
  std::string_view unit, gain;  // as in a rig file
};
constexpr Clock clocks[] = {
    {"seconds since 1970", 9.4e8, 2.6e9, "s", ""},
    {"milliseconds since 1970", 9.4e11, 2.6e12, "ms", ""},
    {"microseconds since 1970", 9.4e14, 2.6e15, "us", ""},
    {"nanoseconds since 1970", 9.4e17, 2.6e18, "us", "0.001"},
    {"ticks of 100 ns since 1601", 1.25e17, 1.42e17, "us", "0.1"},
    {"ticks of 100 ns since the year 1", 6.3e17, 6.5e17, "us", "0.1"},
};

double seconds_of(const Clock& clock) {
  return find_unit(clock.unit)->scale() * parse_number(clock.gain).value_or(1.0);
}

bool is_usual_step(double seconds) {
  const Usual u = usual(Signal::time);
  return seconds >= u.least && seconds <= u.most;
}

// By size and step.
const Clock* clock_of(const ColumnNumbers& n) {
  for (const Clock& clock : clocks)
    if (n.low >= clock.least && n.high <= clock.most && is_usual_step(n.step * seconds_of(clock))) return &clock;
  return nullptr;
}

// 4 to 20 mA, and all between.
bool is_transmitters_range(const ColumnNumbers& n, double unit) {
  return n.low * unit > transmitter[0] && n.high * unit < transmitter[1];
}

// The units in which the numbers are those of the signal, most usual first.
std::vector<std::string> likely_units(Signal signal, const ColumnNumbers& n) {
  const Usual u = usual(signal);
  std::vector<std::string> likely;
  for (const std::string_view name : u.units)
    if (const Unit* unit = find_unit(name); unit && lies_within(*unit, n, u.measure, u.least, u.most))
      likely.emplace_back(name);
  if (is_drive(signal)) {
    const double size = std::max(std::abs(n.low), std::abs(n.high));
    if (size >= 1 && size <= 11) likely.emplace_back("V");
    if (size >= 20 && size <= 110) likely.emplace_back("% of rated");
  }
  return likely;
}

std::string in_words(const std::vector<std::string>& units) {
  std::string text;
  for (std::size_t k = 0; k < units.size(); ++k)
    text += (k == 0 ? "" : k + 1 < units.size() ? ", " : " or ") + units[k];
  return text;
}

// Of a clock that counts from a date, the unit where the header has none; a gain where it has another.
bool take_clock(ColumnGuess& g, const ColumnNumbers& n) {
  const Clock* const clock = clock_of(n);
  if (!clock) return false;
  const Unit* const unit = find_unit(g.unit);
  if (!unit) {
    g.unit = clock->unit, g.gain = clock->gain;
    g.by_numbers = true;
    return true;
  }
  const double factor = seconds_of(*clock) / unit->scale();
  if (unit->dimension != Dimension::time || std::abs(factor - 1) < 1e-9) return false;
  g.gain = fmt::format("{:g}", factor);
  g.ask(fmt::format("no time in {} by its size: is it {}?", g.unit, clock->what));
  return true;
}

void ask_missing_unit(ColumnGuess& g, const ColumnNumbers& n) {
  const Signal signal = *g.signal;
  const std::vector<std::string> likely = likely_units(signal, n);
  if (signal == Signal::time && n.counts) {
    g.ask("counts rows: in which unit is it a time, or what is the gain, the time of a row?");
    g.unit = likely.empty() ? "s" : likely.front();
    return;
  }
  // Whole numbers without a date may be either.
  if (signal == Signal::time && n.whole && is_usual_step(n.step * tick)) {
    g.unit = "us";
    if (likely.empty()) g.gain = "0.1";
    return g.ask(likely.empty() ? "no unit in the header: by the values ticks of 100 ns?"
                                : "no unit in the header: by the values us, or ticks of 100 ns with gain = \"0.1\"?");
  }
  std::vector<std::string> words = likely;
  if (signal != Signal::time && !is_drive(signal) && is_transmitters_range(n, milliampere))
    words.emplace_back("the mA of a transmitter");
  if (words.size() == 1 && (signal == Signal::time || words.front() == info(signal).si_unit)) {
    g.unit = likely.front();
    g.by_numbers = true;
    return;
  }
  g.ask(words.empty()
            ? fmt::format("no unit in the header, and the values are those of no {} in a usual unit", info(signal).name)
            : "no unit in the header: by the values " + in_words(words) + "?");
  if (!likely.empty())
    g.unit = likely.front();
  else if (!words.empty())
    g.unit = "mA", g.gain_is_open = g.offset_is_open = true;
}

void ask_absurd_numbers(ColumnGuess& g, const ColumnNumbers& n) {
  const Usual u = usual(*g.signal);
  const std::optional<Unit> unit = unit_of(g);
  if (!unit || unit->dimension != info(*g.signal).dimension) return;
  if (is_drive(*g.signal) && n.low == n.high) return;  // no excitation, and said elsewhere
  if (lies_within(*unit, n, u.measure, u.least_of_all, u.most_of_all)) return;
  std::vector<std::string> likely = likely_units(*g.signal, n);
  std::erase(likely, g.unit);
  g.ask(fmt::format("hardly possible as {} in {}: {}?", info(*g.signal).name, g.unit,
                    likely.empty() ? "another signal, or another unit" : in_words(likely)));
}

void ask_sign(ColumnGuess& g, const ColumnNumbers& n) {
  if (!is_drive(*g.signal) || n.low == n.high || n.high <= 0 || n.low < -unsigned_below * n.high) return;
  const std::optional<Unit> unit = unit_of(g);
  if (unit && is_transmitters_range(n, unit->scale()))
    g.ask("the 4 to 20 mA of a transmitter, or the coil's current? A transmitter's needs gain and offset");
  else
    g.ask("never negative: has it lost its sign, or an offset?");
}

void ask_middle(ColumnGuess& g, const ColumnNumbers& n) {
  const std::optional<Unit> unit = unit_of(g);
  if (!is_stroke(*g.signal) || !unit || unit->dimension != Dimension::length || !(n.high > n.low)) return;
  const double span = n.high - n.low, off = std::max(n.low, -n.high);  // of the near end from zero
  const bool goes_far = !g.canonical && span * unit->scale() > long_way && off > -unsigned_below * span;
  if (off < aside * span && !goes_far) return;
  g.ask(fmt::format("measured from an end, not from mid-stroke? Then the offset is {}half the stroke",
                    n.high > 0 ? "minus " : ""));
  g.offset_is_open = true;  // the middle of what this log reaches is no middle of the stroke
}

// Pressure of the tank or its temperature, where neither name nor unit tells: the likelier one by what the values are.
void ask_of_rival(ColumnGuess& g, const ColumnNumbers& n) {
  g.weak = false;
  const bool warm = n.low > tank_is_warm;
  if (warm) std::swap(*g.signal, *g.rival);
  g.unit = warm ? "degC" : "bar";
  g.ask(fmt::format("no unit in the header, and the name means either: the {} in {}, or the {} in {}?",
                    info(*g.signal).name, g.unit, info(*g.rival).name, warm ? "bar" : "degC"));
}

// Range and zero of a transmitter are on its plate; where no transmitter gives such currents, it is no signal.
void ask_transmitter(ColumnGuess& g, const ColumnNumbers& n) {
  if (std::max(std::abs(n.low), std::abs(n.high)) * milliampere > most_of_transmitter) {
    g.signal.reset();
    return;
  }
  g.gain_is_open = g.offset_is_open = true;
  const SignalInfo& signal = info(*g.signal);
  const std::string is = fmt::format("is it the transmitter of the {}? Then ", signal.name);
  g.ask(is_transmitters_range(n, milliampere)
            ? is + fmt::format("its gain is its range over 16 mA, in {}/mA, and its offset what it shows at 4 mA less "
                               "4 gains",
                               signal.si_unit)
            : is + fmt::format("which gain has it, in {}/mA, and which offset?", signal.si_unit));
}

void ask_column(ColumnGuess& g, const ColumnNumbers& n) {
  if (n.stamps) {
    if (*g.signal != Signal::time) g.ask("holds time stamps");
    g.unit = std::string("s");
    return;
  }
  if (n.count == 0) return g.ask("holds no numbers");
  if (is_transmitters(g.unit, *g.signal)) return ask_transmitter(g, n);
  if (g.rival && g.unit.empty() && g.question.empty()) return ask_of_rival(g, n);
  const bool told = g.question.empty();
  const bool is_clock = told && *g.signal == Signal::time && take_clock(g, n);
  if (g.unit.empty() && told)
    ask_missing_unit(g, n);
  else if (told && !is_clock)
    ask_absurd_numbers(g, n);
  if (const Unit* unit = find_unit(g.unit); unit && unit->dimension == Dimension::voltage && !g.by_numbers)
    g.ask(fmt::format("which gain has the sensor, in {}/V, and which offset?", info(*g.signal).si_unit));
  ask_sign(g, n);
  ask_middle(g, n);
  if (g.weak) g.ask(fmt::format("is '{}' the {}?", g.name, info(*g.signal).name));
}

// Pressures that are only numbered: which is the pump's and which the tank's, their values say.
void sort_numbered_pressures(std::vector<ColumnGuess>& columns, const std::vector<ColumnNumbers>& numbers) {
  std::vector<std::size_t> numbered;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::string bare = columns[c].name.substr(0, columns[c].name.find_first_of("_ "));
    if (bare.size() == 2 && (bare[0] == 'P' || bare[0] == 'p') && bare[1] >= '0' && bare[1] <= '9' &&
        numbers[c].count > 0 && (!columns[c].signal || columns[c].weak))
      numbered.push_back(c);
  }
  if (numbered.size() < 2) return;
  const auto taken = [&](Signal s) {
    return std::any_of(columns.begin(), columns.end(), [&](const ColumnGuess& g) { return g.signal == s; });
  };
  const auto highest = *std::max_element(numbered.begin(), numbered.end(), [&](std::size_t a, std::size_t b) {
    return numbers[a].low + numbers[a].high < numbers[b].low + numbers[b].high;
  });
  const auto lowest = *std::min_element(numbered.begin(), numbered.end(), [&](std::size_t a, std::size_t b) {
    return numbers[a].high < numbers[b].high;
  });
  std::vector<Signal> chambers = {Signal::pressure_b, Signal::pressure_a};
  const bool pump = numbers[highest].high - numbers[highest].low < flat_pressure * numbers[highest].high;
  const bool tank = numbers[lowest].high < low_pressure * numbers[highest].high;
  for (const std::size_t c : numbered) columns[c].signal.reset();
  for (const std::size_t c : numbered) {
    std::optional<Signal> is;
    if (c == highest && pump && !taken(Signal::supply_pressure)) {
      is = Signal::supply_pressure;
    } else if (c == lowest && tank && !taken(Signal::return_pressure)) {
      is = Signal::return_pressure;
    } else {
      while (!chambers.empty() && taken(chambers.back())) chambers.pop_back();
      if (!chambers.empty()) is = chambers.back();
    }
    columns[c].signal = is;
    columns[c].weak = is.has_value();
  }
}

// Where no name says which is the time, the first column of time stamps is; a column that only rises may be, and is
// asked.
void look_for_time(std::vector<ColumnGuess>& columns, const std::vector<ColumnNumbers>& numbers) {
  if (std::any_of(columns.begin(), columns.end(), [](const ColumnGuess& g) { return g.signal == Signal::time; }))
    return;
  for (std::size_t c = 0; c < columns.size(); ++c)
    if (numbers[c].stamps && !columns[c].signal) {
      columns[c].signal = Signal::time;
      return;
    }
  for (std::size_t c = 0; c < columns.size(); ++c) {
    ColumnGuess& g = columns[c];
    const Unit* const unit = find_unit(g.unit);
    const bool may_be = unit ? unit->dimension == Dimension::time : g.written_unit.empty();
    if (g.signal || !may_be || !numbers[c].rises || numbers[c].counts) continue;
    g.signal = Signal::time;
    g.weak = true;
    return;
  }
}

void ask_of_exchanged_positions(std::vector<ColumnGuess>& columns, const std::vector<ColumnNumbers>& numbers) {
  const auto span_of = [&](Signal s, ColumnGuess*& column) {
    for (std::size_t c = 0; c < columns.size(); ++c)
      if (const std::optional<Unit> unit = unit_of(columns[c]);
          columns[c].signal == s && numbers[c].count > 0 && unit && unit->dimension == Dimension::length) {
        column = &columns[c];
        return (numbers[c].high - numbers[c].low) * unit->scale();
      }
    return 0.0;
  };
  ColumnGuess *spool = nullptr, *piston = nullptr;
  const double spool_span = span_of(Signal::spool_position, spool);
  const double piston_span = span_of(Signal::piston_position, piston);
  if (!spool || !piston || piston_span >= spool_span) return;
  for (ColumnGuess* g : {spool, piston}) g->ask("the piston moves less than the spool: are the two exchanged?");
}

}  // namespace

void NumbersCollector::take(double x) {
  if (std::isfinite(x)) {
    low_ = count_ ? std::min(low_, x) : x, high_ = count_ ? std::max(high_, x) : x;
    if (count_ > 0 && steps_.size() < steps_looked_at) steps_.push_back(x - last_);
    last_ = x;
    whole_ = whole_ && x == std::floor(x);
    ++count_;
  }
}

ColumnNumbers NumbersCollector::numbers() const {
  ColumnNumbers n{.count = count_, .low = low_, .high = high_, .whole = whole_};
  if (steps_.empty()) return n;
  n.counts = std::all_of(steps_.begin(), steps_.end(), [](double step) { return step == 1; });
  n.rises = std::all_of(steps_.begin(), steps_.end(), [](double step) { return step > 0; });
  n.step = median(steps_);
  return n;
}

void ask_by_numbers(std::vector<ColumnGuess>& columns, const std::vector<ColumnNumbers>& numbers) {
  sort_numbered_pressures(columns, numbers);
  look_for_time(columns, numbers);
  for (std::size_t c = 0; c < columns.size(); ++c)
    if (columns[c].signal) ask_column(columns[c], numbers[c]);
  ask_of_exchanged_positions(columns, numbers);
}

}  // namespace servodx
