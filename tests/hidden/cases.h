// Logs with one effect hidden in them, or none, from the virtual rig: the fitted model has no part in them.
//
// A generator with a seed of its own picks effect, size and conditions, draws the valve from its tolerances, and writes
// CSV files and beside them a sealed truth, which only the scorer opens, after the answer. The effects are made in the
// rig's own terms (coercive force, jet angle, bristles, an attachment's stiffness) or on the way to the log (a late
// command, pick-up); sizes are stated where the rig's number and the model's mean the same.
#pragma once
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "explain/explain.h"
#include "explain/outcome.h"
#include "servodx/rig.h"
#include "signals/log.h"

namespace servodx::hidden {

struct Bench {
  std::filesystem::path folder;  // where logs are written
  std::string rig_model;         // params/rigs/*.toml
  RigFile rig;
  std::uint64_t valve = 0;
};

struct Case {
  std::vector<std::string> logs;
  std::string sealed;  // file of the truth
};
struct Truth {
  std::string effect;                        // none | a name of the list | unlisted:NAME
  std::vector<std::string> where;            // places that are right
  std::string parameter;                     // of the model; empty: no common size
  double change = 0;                         // [SI] of it against the healthy valve
  std::string size;                          // in words
  std::vector<std::string> depends_on = {};  // of what the list does not have: variables that are right
};

const std::vector<std::string>& effects();   // what can be hidden of the list
const std::vector<std::string>& unlisted();  // what the list does not have

// Fault-free logs of the bench's valve, for tuning and for the baseline.
std::vector<std::string> healthy_logs(const Bench& bench, std::uint64_t seed, int count, const std::string& name,
                                      double seconds);
// A case; effect empty: the generator picks one. "none": a control.
Case make_case(const Bench& bench, std::uint64_t seed, const std::string& effect, double seconds,
               const std::vector<std::string>& excitations = {"mixed", "flight"});
Truth unseal(const std::string& sealed);

struct Score {
  Truth truth;
  ExplainVerdict verdict = ExplainVerdict::sufficient;
  std::string first, where;
  bool named = false;  // the right name first, or the first declares it confusable
  bool placed = false;
  bool accused = false;             // any cause, or unexplained
  std::optional<bool> size_inside;  // 90 % interval
  std::optional<bool> variable;     // of what the list does not have: named and placed, by the right variable
  double heldout_gain = 0;
  std::optional<double> gain_share;  // of what the true effect gains alone on the same data, where that is known
  std::string note;                  // of a miss: what became of the true effect
};
Score score(const Truth& truth, const ExplainResult& answer);
// Counts over cases and controls, effect by effect, with Wilson's 95 % intervals.
std::string tally(const std::vector<Score>& scores);
nlohmann::json to_json(const Score& score);
Score from_json(const nlohmann::json& json);

}  // namespace servodx::hidden
