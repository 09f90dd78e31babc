// A row of the table: what is asked, what was measured, and what goes into the JSON file.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace servodx::bench {

struct Row {
  std::string what, must, aim, measured, spread;
};

struct Report {
  std::vector<Row> rows;
  std::vector<std::string> notes;
  nlohmann::ordered_json json;
};

struct Choice {
  int seeds = 15;          // of the twin objectives
  double peer_budget = 5;  // simulations a peer may use, in medians of ours
  int turns = 7;           // of each timing
};

void kernel_rows(Report& report, const Choice& choice);
void search_rows(Report& report, const Choice& choice);
void genetic_rows(Report& report, const Choice& choice);
void loading_rows(Report& report, const Choice& choice);
void scaling_rows(Report& report, const Choice& choice);

}  // namespace servodx::bench
