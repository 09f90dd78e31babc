#include "report/fleet/detectable_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "report/fleet/fleet_words.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/parts.h"
#include "report/shared/replay_part.h"
#include "servodx/fleet.h"

namespace servodx::report {
namespace {

using Seen = FleetCounts::Seen;
using BesideBound = FleetCounts::BesideBound;

constexpr const char* title = "Faults of known size beside the least that their logs would have shown";
constexpr const char *beyond = "1 and more", *well_beyond = "1.2 and more", *unbounded = "not even the worst shown";

std::string range_words(const DetectableFound::Band& band) {
  return std::isfinite(band.to) ? fmt::format("{} to {}", digits(band.from), digits(band.to))
                                : digits(band.from) + " and more";
}

// Rows of the first table: all faults, by size.
std::vector<std::pair<std::string, Seen>> by_size(const DetectableFound& found) {
  std::vector<std::pair<std::string, Seen>> rows;
  for (const DetectableFound::Band& band : found.bands)
    if (band.seen.found.of > 0) rows.emplace_back(range_words(band), band.seen);
  rows.emplace_back(beyond, found.all.beyond), rows.emplace_back(well_beyond, found.all.well_beyond);
  if (found.all.unbounded.found.of > 0) rows.emplace_back(unbounded, found.all.unbounded);
  return rows;
}

std::string seen_words(const Seen& seen) {
  return seen.found.of > 0 ? fmt::format("{}, {} of {}", seen.found.counted, seen.named.counted, seen.found.of) : "";
}

std::vector<std::string> words_of_fault(const std::string& label, const BesideBound& of) {
  return {label, seen_words(of.below), seen_words(of.beyond), seen_words(of.well_beyond), seen_words(of.unbounded)};
}

std::vector<std::string> head_of_faults() { return {"found, named of", "below 1", beyond, well_beyond, unbounded}; }

bool is_empty(const DetectableFound& found) { return found.faults.empty() && found.unstated == 0; }

std::string rest_words(const DetectableFound& found) {
  std::string text = "95 of 100 from 1 on should be found";
  if (std::isfinite(found.median)) text += fmt::format("; half of them lie below {} times", digits(found.median));
  if (found.unstated > 0) text += fmt::format("; of {} more the log states no least", plural(found.unstated, "fault"));
  return text;
}

Json seen_json(const Seen& seen) { return {{"found", rate_json(seen.found)}, {"named", rate_json(seen.named)}}; }

Json beside_json(const BesideBound& of) {
  return {{"below", seen_json(of.below)},
          {"beyond", seen_json(of.beyond)},
          {"well_beyond", seen_json(of.well_beyond)},
          {"unbounded", seen_json(of.unbounded)}};
}

}  // namespace

std::string text_of(const DetectableFound& found) {
  if (is_empty(found)) return "";
  Columns sizes("lll", 2), faults("lllll", 2);
  sizes.row({"times the least", "found (95 %)", "named (95 %)"});
  for (const auto& [range, seen] : by_size(found)) sizes.row({range, rate_words(seen.found), rate_words(seen.named)});
  faults.row(head_of_faults());
  for (const auto& [label, of] : found.faults) faults.row(words_of_fault(label, of));
  return fmt::format("\n{}\n{}{}\n{}", title, sizes.text(), rest_words(found),
                     found.faults.empty() ? "" : "\n" + faults.text());
}

Json to_json(const DetectableFound& found) {
  Json faults = Json::object(), bands = Json::array();
  for (const auto& [label, of] : found.faults) faults[label] = beside_json(of);
  for (const DetectableFound::Band& band : found.bands)
    bands.push_back({{"from", band.from},
                     {"to", number(band.to)},
                     {"found", rate_json(band.seen.found)},
                     {"named", rate_json(band.seen.named)}});
  return {{"all", beside_json(found.all)},
          {"faults", faults},
          {"bands", bands},
          {"median", number(found.median)},
          {"unstated", found.unstated}};
}

void add_detectable_found(Page& page, const DetectableFound& found) {
  if (is_empty(found)) return;
  TablePart sizes{title, "lll", {"times the least", "found (95 %)", "named (95 %)"}, {}, 0};
  for (const auto& [range, seen] : by_size(found))
    sizes.rows.push_back({range, rate_cell(seen.found), rate_cell(seen.named)});
  page.add(sizes);
  page.text(sentence(rest_words(found)));
  TablePart faults{"The same by fault", "lllll", head_of_faults(), {}, 0};
  for (const auto& [label, of] : found.faults) {
    faults.rows.emplace_back();
    for (const std::string& cell : words_of_fault(words(label), of)) faults.rows.back().emplace_back(cell);
  }
  if (!faults.rows.empty()) page.add(faults);
}

}  // namespace servodx::report
