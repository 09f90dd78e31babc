#include "fleet/detectable_found.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/median.h"
#include "faults/fault.h"
#include "faults/registry.h"

namespace servodx {
namespace {

using Bound = BoundCase::Bound;

constexpr double well = 1.2;  // times the bound: a bound is itself read off a line between two severities
constexpr std::array band_ends = {0.0, 0.5, 1.0, well, 2.0, 4.0, HUGE_VAL};

void add(FleetCounts::Seen& to, const BoundCase& c) {
  ++to.found.of, ++to.named.of;
  to.found.counted += c.is_found, to.named.counted += c.is_named;
}

void add(FleetCounts::BesideBound& to, const BoundCase& c) {
  if (c.bound == Bound::none) return add(to.unbounded, c);
  add(c.times < 1 ? to.below : to.beyond, c);
  if (c.times >= well) add(to.well_beyond, c);
}

std::vector<DetectableFound::Band> empty_bands() {
  std::vector<DetectableFound::Band> out;
  for (std::size_t i = 0; i + 1 < band_ends.size(); ++i) out.push_back({band_ends[i], band_ends[i + 1], {}});
  return out;
}

void add(std::vector<DetectableFound::Band>& bands, const BoundCase& c) {
  const auto past = std::find_if(bands.begin(), bands.end(), [&](const auto& band) { return c.times < band.to; });
  add((past == bands.end() ? bands.back() : *past).seen, c);
}

// From health towards the worst; a fault that goes both ways (a null, a nozzle) has a scale that begins at nought.
bool is_worn(const Fault& fault, double severity) {
  return fault.healthy == 0 || (severity - fault.healthy) * (fault.worst - fault.healthy) >= 0;
}

}  // namespace

std::optional<BoundCase> bound_case_of(const FleetRow& row, const std::string& label, double severity) {
  const Fault* fault = find_fault(label);
  if (!fault || !is_worn(*fault, severity)) return {};
  const double way = way_from_health(*fault, severity);
  if (std::isnan(way)) return {};
  BoundCase out{label, Bound::unstated, 0, !row.is_healthy(), row.name() == label};
  const auto least =
      std::find_if(row.detectable.begin(), row.detectable.end(), [&](const LeastShown& l) { return l.fault == fault; });
  if (least == row.detectable.end()) return out;
  out.bound = std::isnan(least->severity) ? Bound::none : Bound::known;
  if (out.bound == Bound::known) out.times = way / way_from_health(*fault, least->severity);
  if (std::isnan(out.times)) out.bound = Bound::unstated;  // the bound is none of that scale's, or is health itself
  return out;
}

DetectableFound detectable_found_of(const std::vector<BoundCase>& cases) {
  DetectableFound out;
  out.bands = empty_bands();
  std::vector<double> beyond;
  for (const BoundCase& c : cases) {
    out.unstated += c.bound == Bound::unstated;
    if (c.bound == Bound::unstated) continue;
    add(out.all, c), add(out.faults[c.label], c);
    if (c.bound == Bound::known) add(out.bands, c);
    if (c.bound == Bound::known && c.times >= 1) beyond.push_back(c.times);
  }
  out.median = beyond.empty() ? NAN : median(beyond);
  return out;
}

}  // namespace servodx
