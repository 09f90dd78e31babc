// Two results of one command beside each other: what changed, by how much, and what it may come from.
//
// Works on the JSON files, so results of earlier versions and of other machines compare too. Parameters are compared in
// standard errors of the difference (independent fits: sqrt(a^2 + b^2)); verdicts log by log; whatever else a command
// reports number by number.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "report/diagnose/two_tests.h"
#include "report/shared/json.h"
#include "report/shared/page.h"

namespace servodx::report {

struct Comparison {
  std::string command, a, b;            // paths
  std::vector<std::string> notes;       // of files of earlier versions
  std::vector<std::string> conditions;  // version, seed, settings and inputs that differ
  struct Difference {
    std::string what, a, b, change;
    double sigmas = NAN;
    bool matters = false;  // a verdict, or beyond 3 sigmas
  };
  std::vector<Difference> differences;  // those that matter first
  std::size_t same = 0;                 // things compared that are equal
  std::optional<TwoTests> tests;        // of two verdicts about one log each
};

// `a`, `b`: what the files hold (store/result_json.h). Throws InputError where they are not results of one command.
Comparison compare(const std::string& path_a, Json a, const std::string& path_b, Json b);

std::string text_of(const Comparison& comparison);
Json compare_json(const Comparison& comparison);
Page compare_page(const Header& header, const Comparison& comparison);

}  // namespace servodx::report
