#include "signals/guess.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/small_letters.h"
#include "base/trimmed.h"
#include "base/units.h"
#include "servodx/log.h"
#include "signals/name_words.h"
#include "signals/signal_words.h"

namespace servodx {
namespace {

constexpr int by_own_name = 100;  // points: more than any words give
constexpr int alone = 3;          // points of a name that holds nothing else; odd, as is_whole asks

bool is_ascii(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

// Two for each word of the pattern if all are there, and three where nothing else is, so that "PA" stands before
// "Cyl 2 pressure A"; 0: no match. Chinese has no blanks
// between words: there the pattern is a part of the name, and three letters are as good as a word.
int match(std::vector<std::string> name, std::string_view pattern) {
  if (!is_ascii(pattern) && pattern.find(' ') == pattern.npos) {
    for (const std::string& word : name)
      if (word.find(pattern) != word.npos)
        return 2 * (1 + static_cast<int>(pattern.size()) / 9) + (name.size() == 1 && word == pattern ? alone : 0);
    return 0;
  }
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
  return 2 * matched + (static_cast<std::size_t>(matched) == words ? alone : 0);
}

bool unit_fits(const std::string& unit, Signal signal) {
  const Unit* u = find_unit(unit);
  if (!u || u->dimension == Dimension::voltage) return true;
  const auto relative = relative_unit(signal);
  return u->dimension == info(signal).dimension || (relative && (u->dimension == relative->dimension || unit == "%"));
}

bool is_own_unit(const std::string& unit, Signal signal) {
  const Unit* u = find_unit(unit);
  const auto relative = relative_unit(signal);
  return u && (u->dimension == info(signal).dimension || (relative && u->dimension == relative->dimension));
}

// Whether the name holds words by which it is no such signal of the valve's.
bool is_other(const std::vector<std::string>& name, Signal signal) {
  return std::any_of(other_words().begin(), other_words().end(), [&](const OtherWords& other) {
    return (!other.of || *other.of == info(signal).dimension) && match(name, other.words) > 0 &&
           (other.unless.empty() || match(name, other.unless) == 0);
  });
}

bool is_one_of(std::span<const std::string_view> words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool holds_any(const std::vector<std::string>& name, std::span<const std::string_view> words) {
  return std::any_of(words.begin(), words.end(), [&](std::string_view word) { return match(name, word) > 0; });
}

// "P-T", "PA - PB", "A minus B": of two ports, and so the pressure of neither.
bool names_two_ports(std::string_view name, const std::vector<std::string>& words) {
  constexpr std::string_view ports[][2] = {{"a", "pa"}, {"b", "pb"}, {"t", "pt"}};
  const auto named = std::count_if(std::begin(ports), std::end(ports), [&](const auto& port) {
    return std::any_of(words.begin(), words.end(),
                       [&](const std::string& word) { return word == port[0] || word == port[1]; });
  });
  if (named > 1) return true;
  const auto is_port = [](char c) { return std::string_view("ABPT").find(c) != std::string_view::npos; };
  const auto is_letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
  for (auto at = name.find('-'); at != name.npos; at = name.find('-', at + 1)) {
    const std::string_view left = trimmed(name.substr(0, at)), right = trimmed(name.substr(at + 1));
    const bool ends = !left.empty() && is_port(left.back()) && (left.size() == 1 || !is_letter(left[left.size() - 2]));
    const bool begins = !right.empty() && is_port(right.front()) && (right.size() == 1 || !is_letter(right[1]));
    if (ends && begins) return true;
  }
  return false;
}

// "Valve A pressure B": the first letter is the valve's. "Valve A pressure" has but one, and may well mean the port.
std::vector<std::string> without_letter_of_machine(std::vector<std::string> words) {
  const auto is_port = [](const std::string& word) { return word == "a" || word == "b"; };
  if (std::count_if(words.begin(), words.end(), is_port) < 2) return words;
  const auto is_machine = [](const std::string& word) {
    return std::find(machine_words().begin(), machine_words().end(), word) != machine_words().end();
  };
  for (std::size_t i = 1; i < words.size(); ++i)
    if (is_port(words[i]) && is_machine(words[i - 1])) {
      words.erase(words.begin() + static_cast<long>(i));
      break;
    }
  return words;
}

bool is_measured(Signal signal) {
  return signal != Signal::command && signal != Signal::coil_current && signal != Signal::setpoint;
}

struct Match {
  int points;
  std::size_t column;
  Signal signal;
  bool weak = false;
};

bool names_valve(std::string_view word) {
  return std::any_of(valve_words().begin(), valve_words().end(), [&](std::string_view valve) {
    return is_ascii(valve) ? word.ends_with(valve) : word.find(valve) != word.npos;
  });
}

// "Door position": a word that no pattern of the signal knows, and that does not say how it is measured. Of two letters
// and with digits they number channels.
bool has_word_left(const std::vector<std::string>& name, Signal signal) {
  constexpr std::size_t shortest = 3;
  const auto is_of_signal = [&](const std::string& word) {
    return std::any_of(signal_words().begin(), signal_words().end(), [&](const SignalWords& known) {
      return known.signal == signal && (" " + std::string(known.words) + " ").find(" " + word + " ") != word.npos;
    });
  };
  return std::any_of(name.begin(), name.end(), [&](const std::string& word) {
    return word.size() >= shortest && is_ascii(word) && word.find_first_of("0123456789") == word.npos &&
           !names_valve(word) && !is_of_signal(word) && !is_one_of(neutral_words(), word);
  });
}

// A position of the valve is its spool's.
void take_spool_of_valve(std::vector<Match>& matches, const std::string& unit, std::size_t column, bool demand) {
  int points = 0;
  std::erase_if(matches, [&](const Match& m) {
    const bool stroke = m.signal == Signal::piston_position || m.signal == Signal::setpoint;
    points = std::max(points, stroke ? m.points : 0);
    return stroke;
  });
  const bool has_spool =
      std::any_of(matches.begin(), matches.end(), [](const Match& m) { return m.signal == Signal::spool_position; });
  if (points > 0 && !demand && !has_spool && unit_fits(unit, Signal::spool_position))
    matches.push_back({points, column, Signal::spool_position, true});
}

// The signals that a name may stand for with this unit.
std::vector<Match> matches_of(const std::string& name, const std::string& unit, std::size_t column) {
  std::vector<Match> matches;
  const std::vector<std::string> words = without_letter_of_machine(words_of_name(name));
  const bool demand = holds_any(words, demand_words());
  const bool difference = holds_any(words, difference_words()) || names_two_ports(name, words);
  bool of_spool = false, of_current = false, of_cylinder = false;
  for (const SignalWords& known : signal_words()) {
    const int points = match(words, known.words);
    if (points == 0) continue;
    of_spool = of_spool || known.signal == Signal::spool_position;
    of_current = of_current || info(known.signal).dimension == Dimension::current;
    const bool generic = is_one_of(generic_words(), known.words);
    of_cylinder = of_cylinder || (known.signal == Signal::piston_position && !known.weak && !generic);
    const bool of_transmitter = is_transmitters(unit, known.signal);
    if (!(unit_fits(unit, known.signal) || of_transmitter) || is_other(words, known.signal)) continue;
    if (demand && is_measured(known.signal)) continue;
    if (difference && info(known.signal).dimension == Dimension::pressure && known.signal != Signal::load_pressure)
      continue;
    const bool vague = generic && has_word_left(words, known.signal);
    matches.push_back({points, column, known.signal, known.weak || of_transmitter || vague});
  }
  if (!of_cylinder && std::any_of(words.begin(), words.end(), names_valve))
    take_spool_of_valve(matches, unit, column, demand);
  // A name that speaks of a current means one.
  if (of_current) std::erase_if(matches, [&](const Match& m) { return is_transmitters(unit, m.signal); });
  // What the spool's own loop is asked for is not where the piston shall go.
  if (demand && of_spool) std::erase_if(matches, [](const Match& m) { return m.signal == Signal::setpoint; });
  return matches;
}

// A T is a tank in German, and a temperature.
bool means_either(Signal first, Signal second) {
  return first == Signal::return_pressure && second == Signal::oil_temperature;
}

bool is_whole(const Match& m) { return m.points % 2 == 1; }

// Where the bracket opens that the text's last letter closes.
std::size_t opening(std::string_view text, char open, char close) {
  int depth = 0;
  for (std::size_t k = text.size(); k-- > 0;) {
    depth += (text[k] == close) - (text[k] == open);
    if (depth == 0) return k;
  }
  return text.npos;
}

// "name (unit)", "name [unit]".
bool split_brackets(ColumnGuess& g) {
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    if (g.name.empty() || g.name.back() != close) continue;
    const auto at = opening(g.name, open, close);
    if (at == std::string::npos || at == 0) continue;
    g.written_unit = trimmed(std::string_view(g.name).substr(at + 1, g.name.size() - at - 2));
    g.unit = unit_meant(g.written_unit);
    g.unit_in_brackets = open == '[' && !g.unit.empty() && g.unit == g.written_unit;
    g.name = std::string(trimmed(std::string_view(g.name).substr(0, at)));
    return true;
  }
  return false;
}

std::string small_without_blanks(const std::string& written) {
  std::string low = in_small_letters(written);
  std::erase(low, ' ');
  return low;
}

bool is_unit_of_no_signal(const std::string& written) {
  return is_one_of(units_of_no_signal(), small_without_blanks(written));
}

const ForeignUnit* foreign_unit(const std::string& written) {
  const std::string low = small_without_blanks(written);
  for (const ForeignUnit& unit : foreign_units())
    if (unit.word == low) return &unit;
  return nullptr;
}

// "(mm)" as Chinese writes it.
std::string with_plain_brackets(std::string text) {
  constexpr std::pair<std::string_view, std::string_view> wide[] = {{"\xEF\xBC\x88", "("}, {"\xEF\xBC\x89", ")"}};
  for (const auto& [from, to] : wide)
    for (auto at = text.find(from); at != text.npos; at = text.find(from)) text.replace(at, from.size(), to);
  return text;
}

// Where the capitals begin that end a name, "TankPSI", "OilF"; npos where none do. "ValveIN" holds a word.
std::size_t capitals_at_end(const std::string& name) {
  const auto is_capital = [](char c) { return c >= 'A' && c <= 'Z'; };
  std::size_t at = name.size();
  while (at > 0 && is_capital(name[at - 1])) --at;
  const bool of_a_word = at > 0 && name[at - 1] >= 'a' && name[at - 1] <= 'z';
  return of_a_word && at < name.size() && name.substr(at) != "IN" ? at : std::string::npos;
}

// "TankPSI": a unit in capitals behind a word. Of one letter only a temperature's is: "PressA" is no press in amperes.
void split_capitals(ColumnGuess& g) {
  const std::size_t at = capitals_at_end(g.name);
  if (at == std::string::npos) return;
  const std::string written = g.name.substr(at), unit = unit_meant(written);
  if (unit.empty() || (written.size() == 1 && find_unit(unit)->dimension != Dimension::temperature)) return;
  g.written_unit = written, g.unit = unit;
  g.name.resize(at);
}

// "Leckage ml/min", "speed/mm/s": a ratio that is no unit of the table is a unit as a whole.
bool split_ratio(ColumnGuess& g) {
  const auto stroke = g.name.rfind('/');
  const auto at = stroke == std::string::npos || stroke == 0 ? stroke : g.name.find_last_of("_ /", stroke - 1);
  if (stroke == std::string::npos || at == std::string::npos || at == 0) return false;
  const std::string word = g.name.substr(at + 1);
  if (find_unit(word) || !(foreign_unit(word) || is_unit_of_no_signal(word))) return false;
  g.written_unit = word;
  g.name = std::string(trimmed(std::string_view(g.name).substr(0, at)));
  return true;
}

// "pressure_bar", "Q l/min": the last word is a unit; "p/bar": what follows the stroke is. A subscript is none: "p_A"
// is no p in amperes, "u_in" no u in inches.
void split_last_word(ColumnGuess& g) {
  if (split_ratio(g)) return;
  const std::vector<Match> whole = matches_of(g.name, "", 0);
  for (const char* marks : {"_ ", "/"}) {
    const auto at = g.name.find_last_of(marks);
    if (at == std::string::npos || at == 0) continue;
    std::string name(trimmed(std::string_view(g.name).substr(0, at)));
    if (name.ends_with(',')) name.pop_back();  // "pressure, bar"
    const std::string unit = unit_meant(g.name.substr(at + 1));
    if (unit.empty() || (unit.size() == 1 && unit != "V" && unit != "A" && unit != "s")) continue;
    if (*marks != '/' && (std::any_of(whole.begin(), whole.end(), is_whole) ||
                          (!whole.empty() && matches_of(name, unit, 0).empty() && !find_signal(name))))
      continue;
    g.written_unit = trimmed(std::string_view(g.name).substr(at + 1));
    g.name = name;
    g.unit = unit;
    return;
  }
  split_capitals(g);
}

// The unit that a match is judged by: of one beyond the table, the one that it would become.
std::string unit_to_match(const ColumnGuess& g) {
  if (!g.unit.empty() || g.written_unit.empty()) return g.unit;
  const ForeignUnit* const foreign = foreign_unit(g.written_unit);
  return foreign ? std::string(foreign->unit) : "";
}

ColumnGuess split(const std::string& cell, const std::string* unit_below) {
  ColumnGuess g;
  g.cell = cell;
  g.name = trimmed(with_plain_brackets(cell));
  if (split_brackets(g)) return g;
  if (unit_below) {
    g.written_unit = *unit_below;
    g.unit = unit_meant(*unit_below);
    g.unit_in_brackets = !g.unit.empty() && g.unit == *unit_below;
  } else {
    split_last_word(g);
  }
  return g;
}

// Of two columns whose names say as much of a signal, "Cyl1 pos" and "Cyl2 pos", the first is taken, and the user
// asked.
void ask_which(std::vector<ColumnGuess>& guesses, const std::vector<Match>& matches) {
  std::array<const Match*, n_signals> first{};
  for (const Match& m : matches) {
    const Match*& best = first[static_cast<std::size_t>(index(m.signal))];
    ColumnGuess& taken = guesses[best ? best->column : m.column];
    if (!best && taken.signal == m.signal) best = &m;
    if (!best || best->column == m.column || best->points != m.points || guesses[m.column].signal) continue;
    if (!taken.question.empty()) continue;  // one other is enough to ask by
    const ColumnGuess& other = guesses[m.column];
    const bool alike = taken.name == other.name;
    const auto in_quotes = [&](const ColumnGuess& g) {
      return "'" + g.name + "'" + (alike && !g.written_unit.empty() ? " in " + g.written_unit : "");
    };
    taken.ask("is it " + in_quotes(taken) + " or " + in_quotes(other) + " that is the " +
              std::string(info(m.signal).name) + "?");
  }
}

// A unit that the table has not is the user's to confirm, with what would make it one of the table.
void ask_unknown_unit(ColumnGuess& g) {
  if (!g.signal || !g.unit.empty() || g.written_unit.empty()) return;
  const ForeignUnit* const foreign = foreign_unit(g.written_unit);
  if (!foreign) {
    g.question = "unknown unit '" + g.written_unit + "': what is it in " + units_of(info(*g.signal).dimension) + "?";
    return;
  }
  g.unit = foreign->unit;
  if (foreign->gain != "1") g.gain = foreign->gain;
  g.offset = foreign->offset;
  g.question = "unknown unit '" + g.written_unit + "': " +
               (g.offset.empty() ? "is it " + std::string(foreign->gain) + " " + g.unit + "?"
                                 : "an absolute pressure, an atmosphere over the gauge pressure?");
}

}  // namespace

bool is_transmitters(const std::string& unit, Signal signal) {
  return unit == "mA" && info(signal).dimension != Dimension::current && signal != Signal::time;
}

std::string unit_meant(const std::string& written) {
  if (find_unit(written)) return written;
  const std::string low = in_small_letters(written);
  for (const UnitWord& known : unit_words())
    if (low == known.word) return std::string(known.unit);
  return find_unit(low) ? low : "";
}

bool is_unit_as_written(const std::string& written) {
  return !unit_meant(written).empty() || foreign_unit(written) || is_unit_of_no_signal(written);
}

std::vector<ColumnGuess> guess_columns(const std::vector<std::string>& header, const std::vector<std::string>& units) {
  std::vector<ColumnGuess> guesses;
  std::vector<Match> matches;
  for (std::size_t i = 0; i < header.size(); ++i) {
    ColumnGuess g = split(header[i], i < units.size() ? &units[i] : nullptr);
    if (is_unit_of_no_signal(g.written_unit)) {
      guesses.push_back(std::move(g));
      continue;
    }
    const std::string unit = unit_to_match(g);
    // "command [mm]" is no command: the unit decides.
    if (const auto own = find_signal(g.name); own && unit_fits(unit, *own)) {
      g.canonical = true;
      matches.push_back({by_own_name, i, *own});
    }
    for (Match& m : matches_of(g.name, unit, i)) {
      m.points += is_own_unit(unit, m.signal) ? 2 : 0;
      matches.push_back(m);
    }
    guesses.push_back(std::move(g));
  }
  std::stable_sort(matches.begin(), matches.end(), [](const Match& a, const Match& b) { return a.points > b.points; });
  std::array<bool, n_signals> taken{};
  for (const Match& m : matches) {
    ColumnGuess& g = guesses[m.column];
    if (g.signal && m.points == g.points && m.signal != *g.signal && !g.rival && means_either(*g.signal, m.signal) &&
        !taken[static_cast<std::size_t>(index(m.signal))])
      g.weak = true, g.rival = m.signal;
    if (g.signal || taken[static_cast<std::size_t>(index(m.signal))]) continue;
    g.signal = m.signal;
    g.weak = m.weak;
    g.points = m.points;
    taken[static_cast<std::size_t>(index(m.signal))] = true;
  }
  ask_which(guesses, matches);
  for (ColumnGuess& g : guesses) {
    // A name in no list, but a unit that only one signal has; or T, where the time is another column.
    const Unit* unit = find_unit(g.unit);
    bool& oil = taken[static_cast<std::size_t>(index(Signal::oil_temperature))];
    if (!g.signal && !oil && !is_other(words_of_name(g.name), Signal::oil_temperature) &&
        (unit ? unit->dimension == Dimension::temperature : g.name == "T" && !is_unit_of_no_signal(g.written_unit))) {
      g.signal = Signal::oil_temperature;
      g.weak = oil = true;
    }
    g.canonical = g.canonical && g.signal == find_signal(g.name);
    // Of what a per cent is a part, the signal says.
    if (const auto relative = g.signal ? relative_unit(*g.signal) : std::nullopt; relative && g.unit == "%") {
      for (const Unit& u : unit_table())
        if (u.dimension == relative->dimension) g.unit = u.name;
      g.unit_in_brackets = false;
    }
    ask_unknown_unit(g);
  }
  return guesses;
}

}  // namespace servodx
