#include "report/diagnosis_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/handy.h"
#include "report/replay_part.h"

namespace servodx::report {
namespace {

constexpr double kelvin = 273.15;

// By its error where that is known, else by its size.
double moved(const MovedRow& row) {
  const double change = std::abs(row.estimate - row.nominal);
  if (row.std_error > 0) return change / row.std_error;
  return change > 0 ? change / std::max(std::abs(row.nominal), std::abs(row.estimate)) : 0.0;
}

const HypothesisResult* find(const Diagnosis& d, const std::string& name) {
  for (const HypothesisResult& h : d.assessment.hypotheses)
    if (h.name == name) return &h;
  return nullptr;
}

}  // namespace

std::string chance_words(const Diagnosis& d) {
  std::string text = "p = " + digits(d.p_value, 2);
  if (d.baseline_logs > 0 && d.p_value * (d.baseline_logs + 1) < 1.5)
    text += fmt::format(", the least that {} logs can show", d.baseline_logs);
  return text;
}

std::string size_words(const HypothesisResult& h) {
  return h.at_least ? "none of it seen" : handy_interval(h.severity, h.severity_lower, h.severity_upper, h.unit);
}

std::string size_words(const Diagnosis& d) {
  if (!d.fault || !std::isfinite(d.severity.value)) return "";
  const HypothesisResult* h = find(d, *d.fault);
  if (h && h->at_least && h->severity == d.severity.value)
    return "at its least, " + handy(d.severity.value, d.severity.unit);
  return handy_interval(d.severity.value, d.severity.lower, d.severity.upper, d.severity.unit);
}

std::string test_words(const TestConditions& test) {
  std::string text =
      fmt::format("drive spans {} at about {} Hz", handy(test.drive_span, "A"), digits(test.drive_band, 2));
  if (test.temperature) text += fmt::format(", oil {} degC", std::lround(*test.temperature - kelvin));
  return text;
}

std::string unlike_words(const Diagnosis& d) {
  if (!d.unlike) return "";
  return fmt::format("no log of the baseline is of a test like this ({}); the nearest, {}: {}",
                     test_words(d.assessment.test), file_name(d.unlike->log), test_words(d.unlike->test));
}

MovedParts moved_parts(const Diagnosis& d) {
  MovedParts parts;
  for (const MovedRow& row : d.moved) (row.by == MovedRow::By::fault ? parts.fault : parts.health).push_back(row);
  for (auto* rows : {&parts.fault, &parts.health})
    std::stable_sort(rows->begin(), rows->end(), [](const auto& a, const auto& b) { return moved(a) > moved(b); });
  return parts;
}

}  // namespace servodx::report
