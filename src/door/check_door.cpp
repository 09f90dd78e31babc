// The front door of `check` and of the history that keeps what it finds.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <utility>

#include "base/csv.h"
#include "base/require_setting.h"
#include "base/sha256.h"
#include "door/require_samples.h"
#include "parameters/table_text.h"
#include "prognose/check.h"
#include "prognose/oil_temperature.h"
#include "prognose/valve_history.h"
#include "servodx/error.h"
#include "servodx/history.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/trend.h"
#include "servodx/tune.h"
#include "store/history.h"

namespace servodx {
namespace {

// The bytes that the table's hash is of: a history keeps them.
std::string text_of(const Table& table) {
  std::string text = table_text(table);
  return sha256(text) == table.sha256 ? text : read_file(table.path);
}

}  // namespace

Checked check(const Log& log, const Tuned& tuned, const Rig& rig, const CheckOptions& options) {
  options.validate();
  door::require_samples({log}, rig);
  auto result = std::make_shared<CheckResult>(check(log, tuned.table, rig, options));
  Checked out;
  out.log = result->log, out.sha256 = result->sha256;
  out.interrupted = result->interrupted;
  if (out.interrupted) return out;
  for (const Check& c : result->checks) out.figures.push_back({c.name.text(), c.value, c.std_error, c.unit});
  out.temperature = result->temperature.value;
  out.notes = result->notes;
  out.simulations = result->simulations, out.failed_simulations = result->failed_simulations;
  out.whole = std::move(result);
  return out;
}

History History::open(const std::string& path) { return History(std::make_shared<HistoryFile>(path, false)); }

History History::open_or_make(const std::string& path) {
  return History(std::make_shared<HistoryFile>(path, !HistoryFile::there(path)));
}

bool History::there(const std::string& path) { return HistoryFile::there(path); }
int History::schema() { return HistoryFile::schema_version(); }

void History::record(const std::string& valve, const Use& use, const Checked& checked, const Tuned& tuned) {
  require_setting(!valve.empty(), "--valve", "the name is empty", "name the valve");
  require_setting(std::isfinite(use.at) && use.at >= 0, "--at", "must be the hours of use, 0 or more", "--at 1250.5");
  require_setting(!use.cycles || (std::isfinite(*use.cycles) && *use.cycles >= 0), "--cycles",
                  "must be a number, 0 or more", "--cycles 120000");
  if (!checked.whole) throw InputError({}, "there are no checks to record", "take what check() returned");
  Recording recording;
  recording.at = use.at, recording.cycles = use.cycles;
  recording.log = checked.log, recording.log_sha256 = checked.sha256;
  recording.table_sha256 = tuned.table.sha256;
  recording.version = SERVODX_VERSION;
  recording.temperature = checked.whole->temperature.value;
  recording.temperature_source = name_of(checked.whole->temperature.source);
  recording.checks = checked.whole->checks;
  file_->record(valve, use.serial, recording, text_of(tuned.table));
}

bool History::holds(const std::string& valve, double at, const std::string& log_sha256, const Tuned& tuned) const {
  Recording wanted;
  wanted.at = at, wanted.log_sha256 = log_sha256, wanted.table_sha256 = tuned.table.sha256;
  return file_->holds(valve, wanted);
}

void require_event(double at, const std::string& kind) {
  require_setting(find_event(kind).has_value(), "KIND", "'" + kind + "' is no event", "use one of: " + event_names());
  require_setting(std::isfinite(at) && at >= 0, "--at", "must be the hours of use, 0 or more", "--at 1250.5");
}

void History::add_event(const std::string& valve, double at, const std::string& kind, const std::string& text) {
  require_event(at, kind);
  file_->of(valve);  // refuses a name that is only mistyped
  file_->add_event(valve, {at, find_event(kind).value(), text, {}});
}

std::vector<std::string> History::valves() const { return file_->valves(); }
std::string History::serial(const std::string& valve) const { return file_->serial(valve); }
std::string History::verify() const { return file_->verify(); }

std::vector<double> History::tracked(const std::string& valve) const {
  const auto last = file_->last(valve);
  return last ? tracked_in(*last) : std::vector<double>();
}

}  // namespace servodx
