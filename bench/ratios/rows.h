// A row of the table: what is asked, what was measured, and what goes into the JSON file.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/shared/line_chart.h"

namespace servodx::bench {

struct Row {
  std::string what, must, aim, measured, spread;
};

struct Report {
  std::vector<Row> rows;
  std::vector<std::string> notes;
  std::vector<report::ChartPanel> panels;
  nlohmann::ordered_json json;

  // The row goes to standard error as soon as it is known: the whole takes minutes.
  void add(Row row) {
    fmt::print(stderr, "  {}: {} ({})\n", row.what, row.measured, row.spread);
    rows.push_back(std::move(row));
  }
  // Why a figure is null.
  void excuse(const std::string& what, const std::string& why) {
    nlohmann::ordered_json& all = json["reasons"][what];
    if (std::find(all.begin(), all.end(), why) == all.end()) all.push_back(why);
  }
};

struct Choice {
  int seeds = 15;                       // of the twin objectives
  std::vector<int> free = {8, 15, 25};  // parameters of the fits to a floor
  double peer_budget = 10;              // simulations a peer may use, in medians of ours
  long floor_search = 20000;            // simulations that seek the floor of the virtual rig's logs
  int turns = 7;                        // of each timing
};

void kernel_rows(Report& report, const Choice& choice);
void search_rows(Report& report, const Choice& choice);
void virtual_rows(Report& report, const Choice& choice);
void function_rows(Report& report, const Choice& choice);
void genetic_rows(Report& report, const Choice& choice);
void loading_rows(Report& report, const Choice& choice);
void diagnose_rows(Report& report, const Choice& choice);
void scaling_rows(Report& report, const Choice& choice);

}  // namespace servodx::bench
