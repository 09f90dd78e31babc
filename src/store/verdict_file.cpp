#include "store/verdict_file.h"

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_text.h"
#include "diagnose/decide.h"
#include "diagnose/test_change.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "store/result_json.h"

namespace servodx::store {
namespace {

using Json = nlohmann::ordered_json;

const Json& array_or_empty(const Json& object, const char* key) {
  static const Json none = Json::array();
  const auto at = object.find(key);
  return at != object.end() && at->is_array() ? *at : none;
}

// What judged a log, by hash: all that was read but the logs and what only words come from (rig file, sheet, actions).
std::set<std::string> reference_of(const Json& result) {
  std::set<std::string> logs, out;
  const auto settings = result.find("settings");
  if (settings != result.end()) logs.insert(text_or_empty(*settings, "against"));  // judges nothing
  for (const Json& verdict : array_or_empty(result, "results"))
    for (const Json& log : array_or_empty(verdict, "logs"))
      if (log.is_string()) logs.insert(log.get<std::string>());
  for (const Json& file : array_or_empty(result, "inputs")) {
    const std::string path = text_or_empty(file, "path");
    if (!logs.contains(path) && std::filesystem::path(path).extension() != ".toml")
      out.insert(text_or_empty(file, "sha256"));
  }
  return out;
}

std::optional<VerdictKind> verdict_called(const std::string& word) {
  if (word == "healthy") return VerdictKind::healthy;
  if (word == "fault") return VerdictKind::fault;
  if (word == "unknown") return VerdictKind::unknown;
  return {};
}

TestSide side_of(const Json& verdict) {
  TestSide side;
  side.log = text_or_empty(verdict, "log");
  const std::string word = text_or_empty(verdict, "verdict");
  side.verdict = verdict_called(word);
  if (!side.verdict) side.other_verdict = word;
  side.fault = text_or_empty(verdict, "fault");
  side.error = number_or_nan(verdict, "error");
  side.threshold = number_or_nan(verdict, "threshold");
  side.null = number_or_nan(verdict, "null");
  const auto size = verdict.find("severity");
  if (!side.fault.empty() && size != verdict.end() && size->is_object() && std::isfinite(number_or_nan(*size, "value")))
    side.size = TestSize{number_or_nan(*size, "value"), number_or_nan(*size, "lower"), number_or_nan(*size, "upper"),
                         text_or_empty(*size, "unit")};
  for (const Json& row : array_or_empty(verdict, "parameters"))
    side.rows.push_back({text_or_empty(row, "name"), text_or_empty(row, "unit"), number_or_nan(row, "nominal"),
                         number_or_nan(row, "estimate"), number_or_nan(row, "std_error")});
  for (const Json& place : array_or_empty(verdict, "operating_point"))
    if (const double value = number_or_nan(place, "value"); std::isfinite(value))
      side.places.push_back({text_or_empty(place, "condition"), text_or_empty(place, "unit"), value});
  return side;
}

TestFinding finding_of(const TestSide& side) {
  TestFinding finding{.healthy = side.healthy()};
  if (side.size) finding.size = {side.size->lower, side.size->upper};
  return finding;
}

}  // namespace

TwoFindings findings_of(const TestSide& last, const TestSide& now) {
  TwoFindings two{finding_of(last), finding_of(now)};
  const bool named = !last.fault.empty() || !now.fault.empty();
  two.same = named ? last.fault == now.fault : last.verdict == now.verdict && last.other_verdict == now.other_verdict;
  const Fault* fault = find_fault(now.fault);  // null of one that this version does not know
  two.worse_upwards = !fault || fault->worst > fault->healthy;
  return two;
}

bool holds_one_verdict(const Json& result) {
  const auto verdicts = result.find("results");
  return text_or_empty(result, "command") == "diagnose" && verdicts != result.end() && verdicts->is_array() &&
         verdicts->size() == 1 && verdicts->front().is_object();
}

StoredVerdict verdict_of(const Json& result) { return {side_of(result["results"].front()), reference_of(result)}; }

StoredVerdict read_one_verdict(const std::string& path) {
  const Json json = read_result(path);
  if (!holds_one_verdict(json))
    throw InputError(
        {path, 0, "results"},
        text_or_empty(json, "command") == "diagnose" ? "holds not one verdict" : "is no result of 'diagnose'",
        "name what 'diagnose LOG --json FILE' wrote of one log, or of a pool");
  return verdict_of(json);
}

}  // namespace servodx::store
