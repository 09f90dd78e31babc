// Two verdicts about one valve beside each other: what has become of it since its last test.
//
// Both come as `diagnose` wrote them (store/verdict_file.h), so a last test that an earlier version judged serves too.
// A row that one of the two hypotheses left alone stands there at its tuned value, without an error of its own: true
// where both were judged by one table, and left out where they were not.
#pragma once
#include <string>
#include <vector>

#include "diagnose/test_change.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "report/shared/parts.h"
#include "store/verdict_file.h"

namespace servodx::report {

struct TwoTests {
  std::string last_name;  // of the result
  store::TestSide last, now;
  TestChange change = TestChange::alike;
  bool same_reference = true;  // judged by the same table and baseline
  struct Row {
    std::string name, unit;
    double last = 0, now = 0, std_error = 0;  // [unit] of the difference
    double sigmas = NAN;
    bool matters = false;  // beyond three of the difference's standard errors
  };
  std::vector<Row> rows;  // those that moved most first
};

// `last_path`: the result that holds the last one.
TwoTests two_tests(const std::string& last_path, const store::StoredVerdict& last, const store::StoredVerdict& now);

std::string words_of(const TwoTests& tests);    // "new: the last test was healthy"
std::string finding_of(const TwoTests& tests);  // "sticky spool, 5.2 times the tuned friction; new: ..."
Tone tone_of(const TwoTests& tests);            // of the change
std::string text_of(const TwoTests& tests);
Json to_json(const TwoTests& tests);
void add_two_tests(Page& page, const TwoTests& tests);

}  // namespace servodx::report
