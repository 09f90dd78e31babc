// A verdict as `diagnose` wrote it, read back to stand beside another one.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "diagnose/decide.h"
#include "diagnose/test_change.h"

namespace servodx::store {

struct TestSize {
  double value = 0, lower = 0, upper = 0;  // [unit] 95 %
  std::string unit;
};

struct TestRow {
  std::string name, unit;
  double nominal = 0, estimate = 0, std_error = 0;  // [unit] NaN: no error is known
};

// A place where a test was recorded: "supply_pressure", [unit].
struct TestPlace {
  std::string condition, unit;
  double value = 0;
};

// What a verdict says, as its file holds it.
struct TestSide {
  std::string log, fault;              // fault: empty where none is named
  std::optional<VerdictKind> verdict;  // none: the file has another word, as a later version may, or none
  std::string other_verdict;           // that word
  double error = 0, threshold = 0, null = 0;
  std::optional<TestSize> size;
  std::vector<TestRow> rows;
  std::vector<TestPlace> places;

  bool healthy() const { return fault.empty() && verdict == VerdictKind::healthy; }
};

struct StoredVerdict {
  TestSide side;
  std::set<std::string> reference;  // what judged it: hashes of table and baseline
};

TwoFindings findings_of(const TestSide& last, const TestSide& now);

// Of `diagnose`, with one verdict.
bool holds_one_verdict(const nlohmann::ordered_json& result);
StoredVerdict verdict_of(const nlohmann::ordered_json& result);  // that holds one
StoredVerdict read_one_verdict(const std::string& path);         // throws InputError where it does not

}  // namespace servodx::store
