#include "optimise/genetic_state.h"

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_text.h"

namespace servodx {
namespace {

using nlohmann::json;

json from_individual(const Individual& individual) { return {{"point", individual.point}, {"cost", individual.cost}}; }
Individual to_individual(const json& j) { return {j.at("point").get<Point>(), j.at("cost").get<double>()}; }

json from_list(const std::vector<Individual>& list) {
  json j = json::array();
  for (const Individual& individual : list) j.push_back(from_individual(individual));
  return j;
}
std::vector<Individual> to_list(const json& j) {
  std::vector<Individual> list;
  for (const json& item : j) list.push_back(to_individual(item));
  return list;
}

[[noreturn]] void refuse(const std::string& why) {
  throw InputError({}, "the saved genetic search " + why,
                   "start without --resume, or give the file that the run wrote");
}

// json::get_to turns any number into any other: 2^70 generations become a number that never ends.
int whole(const json& j, const char* key) {
  constexpr std::int64_t most = 1'000'000'000;
  const json& value = j.at(key);
  const bool fits = value.is_number_integer() && value.get<double>() >= 0 && value.get<double>() <= most;
  if (!fits) refuse(std::string("has no whole number up to 1e9 as '") + key + "'");
  return value.get<int>();
}
std::int64_t count(const json& j, const char* key) {
  const json& value = j.at(key);
  if (!value.is_number_integer() || value.get<double>() < 0 || value.get<double>() > 1e15)
    refuse(std::string("has no count as '") + key + "'");
  return value.get<std::int64_t>();
}

void require_sound(const Individual& one, int n) {
  if (static_cast<int>(one.point.size()) != n) refuse("holds a point of another dimension");
  for (const double x : one.point)
    if (!(x >= 0 && x <= 1)) refuse("holds a point outside its box");
}

void require_sound(const GeneticState& state) {
  if (state.n < 1) refuse("has no dimension");
  if (!state.best.point.empty()) require_sound(state.best, state.n);
  for (const Individual& one : state.archive) require_sound(one, state.n);
  for (const Island& island : state.islands) {
    if (island.population.empty()) refuse("has an empty population");
    for (const Individual& one : island.population) require_sound(one, state.n);
    if (island.reach.empty() || island.reach.size() != island.mixing.size() ||
        island.memory_at >= static_cast<int>(island.reach.size()))
      refuse("has another memory");
  }
}

}  // namespace

std::string to_json(const GeneticState& state) {
  json j{{"format", "servodx genetic state 2"},
         {"n", state.n},
         {"seed", state.seed},
         {"generation", state.generation},
         {"turn", state.turn},
         {"evaluations", state.evaluations},
         {"failed", state.failed},
         {"restarts", state.restarts},
         {"best", from_individual(state.best)},
         {"archive", from_list(state.archive)},
         {"islands", json::array()}};
  for (const Island& island : state.islands) {
    j["islands"].push_back({{"population", from_list(island.population)},
                            {"tries", island.tries},
                            {"wins", island.wins},
                            {"reach", island.reach},
                            {"mixing", island.mixing},
                            {"memory_at", island.memory_at},
                            {"gains", island.gains},
                            {"best_since_start", island.best_since_start},
                            {"mark", island.mark},
                            {"median_mark", island.median_mark},
                            {"stagnant", island.stagnant}});
  }
  return j.dump();
}

GeneticState genetic_state_from_json(const std::string& text) {
  try {
    // The program's own, of as many values as the search has.
    const json j = is_shallow_json(text) ? json::parse(text, nullptr, false) : json();
    if (!j.is_object()) refuse("is no JSON object");
    if (j.at("format") != "servodx genetic state 2") refuse("is of another format");
    GeneticState state;
    state.n = whole(j, "n");
    j.at("seed").get_to(state.seed);
    state.generation = whole(j, "generation"), state.turn = whole(j, "turn");
    state.evaluations = count(j, "evaluations"), state.failed = count(j, "failed");
    state.restarts = whole(j, "restarts");
    state.best = to_individual(j.at("best"));
    state.archive = to_list(j.at("archive"));
    for (const json& item : j.at("islands")) {
      Island island;
      island.population = to_list(item.at("population"));
      item.at("tries").get_to(island.tries);
      item.at("wins").get_to(island.wins);
      item.at("reach").get_to(island.reach);
      item.at("mixing").get_to(island.mixing);
      island.memory_at = whole(item, "memory_at");
      item.at("gains").get_to(island.gains);
      item.at("best_since_start").get_to(island.best_since_start);
      item.at("mark").get_to(island.mark);
      item.at("median_mark").get_to(island.median_mark);
      island.stagnant = whole(item, "stagnant");
      state.islands.push_back(std::move(island));
    }
    require_sound(state);
    return state;
  } catch (const json::out_of_range& error) {
    // "[json.exception.out_of_range.403] key 'archive' not found"
    const std::string told = error.what();
    const auto from = told.find('\''), to = told.rfind('\'');
    refuse(from < to ? "has no " + told.substr(from, to - from + 1) : "lacks a part");
  } catch (const json::exception&) {
    refuse("holds a value of another type than the program writes");
  }
}

}  // namespace servodx
