// A desk with two short logs and what judges them: a table that counts as tuned and a baseline that serves it.
//
// Verdicts mean nothing here; that every log gets one, once, does.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "base/sha256.h"
#include "program.h"

namespace servodx {

struct FleetDesk : Desk {
  FleetDesk() {
    write("tuned.csv", as_tuned());
    write("rig.toml", bytes_of(std::filesystem::path(SERVODX_SOURCE_DIR) / "data/rig.toml"));
    write(
        "base.json",
        R"({"command": "baseline", "schema": 1, "threshold": 3, "adequacy_limit": 1, "null_limit": 0.05, "tuned_sha256": ")" +
            sha256(as_tuned()) + R"(", "false_alarm": {"asked": 0.1, "promised": 0.25, "promised_95": 0.6, "logs": 3,
              "logs_needed": 9, "statement": ""},
              "scores": [{"log": "h.csv", "sha256": "1", "score": 1, "adequacy": 1, "gains": {}}]})");
    for (const char* folder : {"a", "b"}) std::filesystem::create_directory(path / folder);
    write("a/log.csv", excerpt("fault/f02_clogged_filter_severe.csv"));
    write("b/log.csv", excerpt("healthy/h04_multisine.csv"));
  }
  static std::string as_tuned() {
    std::string text;
    for (const char* error : {"spool_position: floor 1e-6 m", "piston_position: floor 1e-5 m",
                              "pressure_a: floor 2e4 Pa", "pressure_b: floor 2e4 Pa"})
      text += std::string("# model error ") + error + ", per activity 0.1, independent 20 1/s\n";
    std::istringstream table(shipped_table());
    for (std::string line; std::getline(table, line);)
      if (!line.empty()) text += line + (line[0] == '#' ? "" : line.starts_with("id,") ? ",std_error" : ",") + "\n";
    return text;
  }
  static std::string excerpt(const std::string& log, int rows = 120) { return servodx::excerpt(log, rows); }
  static constexpr const char* judged_with = " --params tuned.csv --baseline base.json --rig rig.toml --quiet ";

  Ended list(const std::string& more) const { return run("diagnose --list " + more + judged_with); }
  // Every result by its log, wall times left out; refusals too.
  std::map<std::string, nlohmann::json> results(const std::string& folder) const {
    std::map<std::string, nlohmann::json> all;
    for (const auto& entry : std::filesystem::directory_iterator(path / folder)) {
      auto json = nlohmann::json::parse(bytes_of(entry.path()));
      json.erase("seconds");
      all[json.contains("refused") ? json["log"] : json["results"][0]["log"]] = json;
    }
    return all;
  }
};

}  // namespace servodx
