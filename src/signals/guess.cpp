#include "signals/guess.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <string_view>

#include "base/units.h"
#include "servodx/log.h"

namespace servodx {
namespace {

// Words that all must stand in a name, most telling patterns first within a signal.
struct Pattern {
  Signal signal;
  std::string_view words;  // with blanks between
};
constexpr Pattern patterns[] = {
    {Signal::time, "time"},
    {Signal::time, "zeit"},
    {Signal::time, "timestamp"},
    {Signal::time, "t"},
    {Signal::coil_current, "coil current"},
    {Signal::coil_current, "current measured"},
    {Signal::coil_current, "current fb"},
    {Signal::coil_current, "current feedback"},
    {Signal::coil_current, "spulenstrom"},
    {Signal::coil_current, "i coil"},
    {Signal::coil_current, "iststrom"},
    {Signal::command, "command"},
    {Signal::command, "cmd"},
    {Signal::command, "current demand"},
    {Signal::command, "current"},
    {Signal::command, "i cmd"},
    {Signal::command, "i ref"},
    {Signal::command, "strom"},
    {Signal::command, "sollstrom"},
    {Signal::command, "ventilstrom"},
    {Signal::command, "steuerstrom"},
    {Signal::command, "i"},
    {Signal::command, "isoll"},
    {Signal::command, "i soll"},
    {Signal::command, "i set"},
    {Signal::command, "u soll"},
    {Signal::command, "usoll"},
    {Signal::command, "u"},
    {Signal::command, "stellsignal"},
    {Signal::command, "drive"},
    {Signal::setpoint, "setpoint"},
    {Signal::setpoint, "position demand"},
    {Signal::setpoint, "pos demand"},
    {Signal::setpoint, "pos ref"},
    {Signal::setpoint, "position command"},
    {Signal::setpoint, "pos cmd"},
    {Signal::setpoint, "sollweg"},
    {Signal::setpoint, "sollposition"},
    {Signal::setpoint, "x ref"},
    {Signal::setpoint, "x soll"},
    {Signal::setpoint, "reference"},
    {Signal::setpoint, "demand"},
    {Signal::spool_position, "spool"},
    {Signal::spool_position, "lvdt"},
    {Signal::spool_position, "schieber"},
    {Signal::spool_position, "schieberweg"},
    {Signal::spool_position, "steuerkolben"},
    {Signal::spool_position, "valve position"},
    {Signal::spool_position, "valve pos"},
    {Signal::spool_position, "valve stroke"},
    {Signal::spool_position, "xs"},
    {Signal::spool_position, "xv"},
    {Signal::spool_position, "x s"},
    {Signal::spool_position, "x v"},
    {Signal::piston_position, "piston"},
    {Signal::piston_position, "rod"},
    {Signal::piston_position, "ram"},
    {Signal::piston_position, "actuator position"},
    {Signal::piston_position, "actuator pos"},
    {Signal::piston_position, "pos fb"},
    {Signal::piston_position, "position"},
    {Signal::piston_position, "pos"},
    {Signal::piston_position, "kolben"},
    {Signal::piston_position, "kolbenweg"},
    {Signal::piston_position, "cylinder"},
    {Signal::piston_position, "cyl"},
    {Signal::piston_position, "zylinder"},
    {Signal::piston_position, "zylinderweg"},
    {Signal::piston_position, "actuator"},
    {Signal::piston_position, "xp"},
    {Signal::piston_position, "x p"},
    {Signal::piston_position, "xk"},
    {Signal::piston_position, "x k"},
    {Signal::pressure_a, "pressure a"},
    {Signal::pressure_a, "press a"},
    {Signal::pressure_a, "druck a"},
    {Signal::pressure_a, "kammerdruck a"},
    {Signal::pressure_a, "zylinderdruck a"},
    {Signal::pressure_a, "p a"},
    {Signal::pressure_a, "pa"},
    {Signal::pressure_a, "port a"},
    {Signal::pressure_a, "p1"},
    {Signal::pressure_a, "p 1"},
    {Signal::pressure_b, "pressure b"},
    {Signal::pressure_b, "press b"},
    {Signal::pressure_b, "druck b"},
    {Signal::pressure_b, "kammerdruck b"},
    {Signal::pressure_b, "zylinderdruck b"},
    {Signal::pressure_b, "p b"},
    {Signal::pressure_b, "pb"},
    {Signal::pressure_b, "port b"},
    {Signal::pressure_b, "p2"},
    {Signal::pressure_b, "p 2"},
    {Signal::supply_pressure, "supply"},
    {Signal::supply_pressure, "psupply"},
    {Signal::supply_pressure, "pump"},
    {Signal::supply_pressure, "ps"},
    {Signal::supply_pressure, "p s"},
    {Signal::supply_pressure, "pp"},
    {Signal::supply_pressure, "p p"},
    {Signal::supply_pressure, "p0"},
    {Signal::supply_pressure, "p 0"},
    {Signal::supply_pressure, "p sup"},
    {Signal::supply_pressure, "p sys"},
    {Signal::supply_pressure, "system pressure"},
    {Signal::supply_pressure, "pressure p"},
    {Signal::supply_pressure, "versorgungsdruck"},
    {Signal::supply_pressure, "systemdruck"},
    {Signal::supply_pressure, "pumpendruck"},
    {Signal::supply_pressure, "speisedruck"},
    {Signal::supply_pressure, "druck p"},
    {Signal::return_pressure, "return"},
    {Signal::return_pressure, "preturn"},
    {Signal::return_pressure, "tank"},
    {Signal::return_pressure, "pt"},
    {Signal::return_pressure, "p t"},
    {Signal::return_pressure, "pr"},
    {Signal::return_pressure, "pressure t"},
    {Signal::return_pressure, "ruecklauf"},
    {Signal::return_pressure, "ruecklaufdruck"},
    {Signal::return_pressure, "druck t"},
    {Signal::return_pressure, "tankdruck"},
    {Signal::pilot_pressure_1, "pilot 1"},
    {Signal::pilot_pressure_1, "nozzle 1"},
    {Signal::pilot_pressure_2, "pilot 2"},
    {Signal::pilot_pressure_2, "nozzle 2"},
    {Signal::load_pressure, "load pressure"},
    {Signal::load_pressure, "pl"},
    {Signal::load_pressure, "p load"},
    {Signal::load_pressure, "lastdruck"},
    {Signal::valve_pressure_drop, "valve drop"},
    {Signal::valve_pressure_drop, "drop"},
    {Signal::load_force, "load force"},
    {Signal::load_force, "force"},
    {Signal::load_force, "load"},
    {Signal::load_force, "kraft"},
    {Signal::load_force, "f l"},
    {Signal::load_force, "fl"},
    {Signal::load_force, "f load"},
    {Signal::load_force, "last"},
    {Signal::leakage_flow, "leakage"},
    {Signal::leakage_flow, "leak"},
    {Signal::leakage_flow, "leckage"},
    {Signal::flow_a, "flow a"},
    {Signal::flow_a, "qa"},
    {Signal::flow_a, "q a"},
    {Signal::flow_b, "flow b"},
    {Signal::flow_b, "qb"},
    {Signal::flow_b, "q b"},
    {Signal::control_flow, "flow"},
    {Signal::control_flow, "q"},
    {Signal::control_flow, "durchfluss"},
    {Signal::oil_temperature, "oil temperature"},
    {Signal::oil_temperature, "temperature"},
    {Signal::oil_temperature, "temp"},
    {Signal::oil_temperature, "oil"},
    {Signal::oil_temperature, "oel"},
    {Signal::oil_temperature, "oeltemp"},
    {Signal::oil_temperature, "oeltemperatur"},
    {Signal::oil_temperature, "temperatur"},
};

// How else people write units of the table, capitals aside.
constexpr std::pair<std::string_view, std::string_view> unit_words[] = {
    {"sec", "s"},
    {"seconds", "s"},
    {"msec", "ms"},
    {"\xC2\xB5s", "us"},
    {"\xC2\xB5m", "um"},
    {"micron", "um"},
    {"inch", "in"},
    {"inches", "in"},
    {"amp", "A"},
    {"amps", "A"},
    {"barg", "bar"},
    {"bara", "bar"},
    {"c", "degC"},
    {"degc", "degC"},
    {"\xC2\xB0"
     "c",
     "degC"},
    {"deg c", "degC"},
    {"celsius", "degC"},
    {"f", "degF"},
    {"degf", "degF"},
    {"\xC2\xB0"
     "f",
     "degF"},
    {"lpm", "l/min"},
    {"volt", "V"},
    {"volts", "V"},
    {"mpa", "MPa"},
    {"kpa", "kPa"},
    {"kn", "kN"},
    {"psig", "psi"},
    {"ma", "mA"},
};

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string small(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// Umlauts as they are written without: "Oeltemperatur".
std::string without_umlauts(std::string text) {
  constexpr std::pair<std::string_view, std::string_view> umlauts[] = {
      {"\xC3\xA4", "ae"}, {"\xC3\xB6", "oe"}, {"\xC3\xBC", "ue"}, {"\xC3\x9F", "ss"},
      {"\xC3\x84", "Ae"}, {"\xC3\x96", "Oe"}, {"\xC3\x9C", "Ue"}};
  for (const auto& [umlaut, letters] : umlauts)
    for (auto at = text.find(umlaut); at != text.npos; at = text.find(umlaut, at))
      text.replace(at, umlaut.size(), letters);
  return text;
}

// Lower-case words: cut at everything that is no letter or digit, and where camelCase turns.
std::vector<std::string> words_of(const std::string& written) {
  const std::string name = without_umlauts(written);
  std::vector<std::string> words;
  std::string word;
  bool was_lower = false;
  const auto end = [&] {
    if (!word.empty()) words.push_back(word);
    word.clear();
  };
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u)) {
      if (std::isupper(u) && was_lower) end();
      word += static_cast<char>(std::tolower(u));
      was_lower = std::islower(u) != 0;
    } else if (u >= 0x80) {  // a letter of another alphabet
      word += c;
      was_lower = true;
    } else {
      end();
      was_lower = false;
    }
  }
  end();
  return words;
}

// Number of words of the pattern if all are there, plus one where nothing else is; 0: no match.
int match(std::vector<std::string> name, std::string_view pattern) {
  const std::size_t words = name.size();
  int matched = 0;
  while (!pattern.empty()) {
    const auto blank = std::min(pattern.find(' '), pattern.size());
    const auto word = std::find(name.begin(), name.end(), pattern.substr(0, blank));
    if (word == name.end()) return 0;
    name.erase(word);  // each counts once: "p_T" is no "p p"
    ++matched;
    pattern.remove_prefix(std::min(blank + 1, pattern.size()));
  }
  return 2 * matched + (static_cast<std::size_t>(matched) == words);
}

bool unit_fits(const std::string& unit, Signal signal) {
  const Unit* u = find_unit(unit);
  if (!u || u->dimension == Dimension::voltage) return true;
  const auto relative = relative_unit(signal);
  return u->dimension == info(signal).dimension || (relative && (u->dimension == relative->dimension || unit == "%"));
}

struct Match {
  int points;
  std::size_t column;
  Signal signal;
};

// The signals that a name may stand for with this unit.
std::vector<Match> matches_of(const std::string& name, const std::string& unit, std::size_t column) {
  std::vector<Match> matches;
  const std::vector<std::string> words = words_of(name);
  for (const Pattern& p : patterns)
    if (const int points = match(words, p.words); points > 0 && unit_fits(unit, p.signal))
      matches.push_back({points, column, p.signal});
  return matches;
}

bool is_whole(const Match& m) { return m.points % 2 == 1; }

// "name (unit)", "name [unit]".
bool split_brackets(ColumnGuess& g) {
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    const auto at = g.name.rfind(open);
    if (at == std::string::npos || at == 0 || g.name.back() != close) continue;
    const std::string written = trimmed(g.name.substr(at + 1, g.name.size() - at - 2));
    g.unit = unit_meant(written);
    g.unit_in_brackets = open == '[' && !g.unit.empty() && g.unit == written;
    g.name = trimmed(g.name.substr(0, at));
    return true;
  }
  return false;
}

// "pressure_bar", "Q l/min": the last word is a unit; "p/bar": what follows the stroke is. A subscript is none: "p_A"
// is no p in amperes, "u_in" no u in inches.
void split_last_word(ColumnGuess& g) {
  const std::vector<Match> whole = matches_of(g.name, "", 0);
  for (const char* marks : {"_ ", "/"}) {
    const auto at = g.name.find_last_of(marks);
    if (at == std::string::npos || at == 0) continue;
    const std::string name = trimmed(g.name.substr(0, at)), unit = unit_meant(g.name.substr(at + 1));
    if (unit.empty() || (unit.size() == 1 && unit != "V" && unit != "A" && unit != "s")) continue;
    if (*marks != '/' && (std::any_of(whole.begin(), whole.end(), is_whole) ||
                          (!whole.empty() && matches_of(name, unit, 0).empty() && !find_signal(name))))
      continue;
    g.name = name;
    g.unit = unit;
    return;
  }
}

}  // namespace

std::string unit_meant(const std::string& written) {
  if (find_unit(written)) return written;
  const std::string low = small(written);
  for (const auto& [word, unit] : unit_words)
    if (low == word) return std::string(unit);
  return find_unit(low) ? low : "";
}

namespace {

bool is_number(std::string cell) {
  std::replace(cell.begin(), cell.end(), ',', '.');
  return parse_number(cell).has_value();
}

// The cells without their brackets, where one at least is a unit and none a number.
std::vector<std::string> as_units(std::vector<std::string> units) {
  bool any = false;
  for (std::string& cell : units) {
    if (is_number(cell)) return {};
    const std::size_t n = cell.size();
    if (n > 1 && ((cell[0] == '[' && cell[n - 1] == ']') || (cell[0] == '(' && cell[n - 1] == ')')))
      cell = trimmed(cell.substr(1, n - 2));
    any = any || !unit_meant(cell).empty();
  }
  return any ? units : std::vector<std::string>{};
}

}  // namespace

std::vector<std::string> units_row(CsvCursor& csv) {
  const std::vector<std::string> units = as_units(csv.row_ahead());
  return units.size() == csv.header().size() ? units : std::vector<std::string>{};
}

long pass_lines_above_header(CsvCursor& csv) {
  constexpr std::size_t most = 100;  // lines
  std::vector<std::vector<std::string>> rows = {csv.header()};
  const std::string_view text = csv.ahead();
  for (std::size_t at = 0; at < text.size() && rows.size() <= most;) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    at = end + 1;
    if (line.find_first_not_of(" \t\r") == line.npos) continue;
    if (line.starts_with('#') || std::count(line.begin(), line.end(), '"') % 2 != 0) {
      rows.emplace_back();
      continue;
    }
    std::vector<std::string> cells = CsvCursor(line, "").header();
    const auto empty = [](const std::string& cell) { return cell.empty(); };
    const bool numbers = std::all_of(cells.begin(), cells.end(),
                                     [&](const std::string& cell) { return cell.empty() || is_number(cell); });
    if (!numbers || std::count_if(cells.begin(), cells.end(), std::not_fn(empty)) < 2) {
      rows.push_back(std::move(cells));
      continue;
    }
    const std::size_t width = cells.size(), last = rows.size() - 1;
    if (rows.front().size() == width || rows[last].size() != width) return 0;
    const bool units = rows[last - 1].size() == width && !as_units(rows[last]).empty();
    const std::size_t above = units ? last - 1 : last;
    for (std::size_t k = 0; k < above; ++k) csv.next_header();
    return static_cast<long>(above);
  }
  return 0;
}

std::vector<ColumnGuess> guess_columns(const std::vector<std::string>& header, const std::vector<std::string>& units) {
  std::vector<ColumnGuess> guesses;
  std::vector<Match> matches;
  for (std::size_t i = 0; i < header.size(); ++i) {
    ColumnGuess g;
    g.cell = header[i];
    g.name = trimmed(header[i]);
    const bool bracketed = split_brackets(g);
    if (!bracketed && i < units.size()) {
      g.unit = unit_meant(units[i]);
      g.unit_in_brackets = !g.unit.empty() && g.unit == units[i];
    } else if (!bracketed) {
      split_last_word(g);
    }
    if (const auto own = find_signal(g.name)) {
      g.canonical = true;
      matches.push_back({100, i, *own});
    }
    const std::vector<Match> more = matches_of(g.name, g.unit, i);
    matches.insert(matches.end(), more.begin(), more.end());
    guesses.push_back(std::move(g));
  }
  std::stable_sort(matches.begin(), matches.end(), [](const Match& a, const Match& b) { return a.points > b.points; });
  std::array<bool, n_signals> taken{};
  for (const Match& m : matches) {
    if (guesses[m.column].signal || taken[static_cast<std::size_t>(index(m.signal))]) continue;
    guesses[m.column].signal = m.signal;
    taken[static_cast<std::size_t>(index(m.signal))] = true;
  }
  for (ColumnGuess& g : guesses) {
    // A name in no list, but a unit that only one signal has; or T, where the time is another column.
    const Unit* unit = find_unit(g.unit);
    bool& oil = taken[static_cast<std::size_t>(index(Signal::oil_temperature))];
    if (!g.signal && !oil && (unit ? unit->dimension == Dimension::temperature : g.name == "T")) {
      g.signal = Signal::oil_temperature;
      oil = true;
    }
    // Of what a per cent is a part, the signal says.
    if (const auto relative = g.signal ? relative_unit(*g.signal) : std::nullopt; relative && g.unit == "%") {
      for (const Unit& u : unit_table())
        if (u.dimension == relative->dimension) g.unit = u.name;
      g.unit_in_brackets = false;
    }
  }
  return guesses;
}

}  // namespace servodx
