// The front door of `gather`.
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include "fleet/confusion.h"
#include "fleet/fleet_verdict.h"
#include "fleet/gather.h"
#include "servodx/diagnose.h"
#include "servodx/error.h"
#include "servodx/fleet.h"
#include "servodx/watch.h"

namespace servodx {
namespace {

Verdict::Kind kind_of(FleetVerdict verdict) {
  switch (verdict) {
    case FleetVerdict::healthy:
      return Verdict::Kind::healthy;
    case FleetVerdict::fault:
      return Verdict::Kind::fault;
    case FleetVerdict::unknown:
    case FleetVerdict::none:
      return Verdict::Kind::unknown;
  }
  return Verdict::Kind::unknown;
}

Fleet::Row row_of(const FleetRow& r) {
  Fleet::Row out{r.file, r.log, kind_of(r.verdict), r.fault, {}, r.probability, r.error, r.threshold};
  if (!std::isnan(r.severity)) out.severity = {r.severity, r.severity_lower, r.severity_upper, r.severity_unit};
  return out;
}

std::vector<Fleet::Refused> refused_of(const std::vector<SetAside>& files) {
  std::vector<Fleet::Refused> out;
  for (const SetAside& f : files) out.push_back({f.file, f.line, f.column, f.rule, f.mend});
  return out;
}

std::shared_ptr<const FleetTable> read(const std::string& folder, const Watch& watch) {
  std::atomic<bool> stop = false;
  FleetTable table = gather(folder, stop, [&](std::size_t done, std::size_t of) {
    watch.tell("gather", static_cast<double>(done) / static_cast<double>(of), 0);
    if (watch.stopped()) stop = true;
  });
  return std::make_shared<FleetTable>(std::move(table));
}

}  // namespace

Fleet gather_results(const std::string& folder, const Watch& watch) {
  const std::shared_ptr<const FleetTable> whole = read(folder, watch);
  const FleetTable& table = *whole;
  Fleet out;
  for (const FleetRow& r : table.rows) out.rows.push_back(row_of(r));
  out.refused = refused_of(table.refused), out.unread = refused_of(table.unread);
  out.interrupted = table.interrupted;
  out.without_schema = table.without_schema;
  out.csv = csv_of(table);
  out.whole = whole;
  return out;
}

FleetCounts count_fleet(const Fleet& fleet, const FleetTruth& truth, std::uint64_t seed) {
  if (!fleet.whole) throw InputError({}, "the fleet holds no results", "take what gather_results() returned");
  auto whole = std::make_shared<Confusion>(confusion_of(*fleet.whole, truth, seed));
  const Confusion& found = *whole;
  FleetCounts out;
  out.counts = found.counts;
  out.rates = found.rates;
  out.calibration = found.calibration, out.detectable = found.detectable;
  out.without_truth = found.without_truth, out.without_result = found.without_result;
  out.whole = std::move(whole);
  return out;
}

FleetCounts count_fleet(const std::string& folder, const std::string& truth) {
  const FleetTruth known = read_truth(truth);
  return count_fleet(gather_results(folder), known);
}

}  // namespace servodx
