#include "optimise/genetic_state.h"

#include <nlohmann/json.hpp>

#include "base/error.h"

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
    const json j = json::parse(text);
    if (j.at("format") != "servodx genetic state 2") throw InputError({}, "not a genetic state of format 2", "");
    GeneticState state;
    j.at("n").get_to(state.n);
    j.at("seed").get_to(state.seed);
    j.at("generation").get_to(state.generation);
    j.at("turn").get_to(state.turn);
    j.at("evaluations").get_to(state.evaluations);
    j.at("failed").get_to(state.failed);
    j.at("restarts").get_to(state.restarts);
    state.best = to_individual(j.at("best"));
    state.archive = to_list(j.at("archive"));
    for (const json& item : j.at("islands")) {
      Island island;
      island.population = to_list(item.at("population"));
      item.at("tries").get_to(island.tries);
      item.at("wins").get_to(island.wins);
      item.at("reach").get_to(island.reach);
      item.at("mixing").get_to(island.mixing);
      item.at("memory_at").get_to(island.memory_at);
      item.at("gains").get_to(island.gains);
      item.at("best_since_start").get_to(island.best_since_start);
      item.at("mark").get_to(island.mark);
      item.at("median_mark").get_to(island.median_mark);
      item.at("stagnant").get_to(island.stagnant);
      state.islands.push_back(std::move(island));
    }
    return state;
  } catch (const json::exception& error) {
    throw InputError({}, std::string("the saved genetic search cannot be read: ") + error.what(),
                     "start without --resume, or give the file that the run wrote");
  }
}

}  // namespace servodx
