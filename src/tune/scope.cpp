#include "tune/scope.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "evidence/conditions.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/fast_log.h"
#include "fit/free_values.h"
#include "fit/ports_of.h"
#include "fit/thin.h"
#include "parameters/list.h"
#include "servodx/data_sheet.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/tune.h"
#include "tune/constants.h"
#include "tune/named_rows.h"

namespace servodx {
namespace {

using namespace tune_constants;

// Priors asked for, about the table's nominal.
void take_priors(std::vector<FreeValue>& shared, const std::map<std::string, double>& priors) {
  for (const auto& [name, sd] : priors) {
    const auto f = std::find_if(shared.begin(), shared.end(), [&](const FreeValue& v) { return v.name == name; });
    if (f == shared.end()) refuse_prior(name);
    f->prior_sd = sd / f->slope(f->start);
  }
}

// Clearances and frictions know their oil's viscosity as a factor only. Each log's is its own, with the prior of rigs'
// temperatures: a log held at 40 degC that was cold would set them all, and the data sheet's clearance could not agree.
void say_oil(TuneScope& scope) {
  if (std::any_of(scope.data.begin(), scope.data.end(), [](const LogData& d) { return d.scenario.oil_known; })) return;
  scope.notes.push_back(
      {Note::Kind::oil,
       "no log holds the oil's temperature: clearances and frictions hold for an oil as thick as these logs' on the "
       "average, taken as at 40 degC; the rig file's oil_temperature says what it was"});
}

bool hold_spool(const LogData& log) {
  return std::any_of(log.channels.begin(), log.channels.end(),
                     [](const FitChannel& c) { return c.signal == Signal::spool_position; });
}

// Without the spool's position only the product of its travel and the ports' width is told. Left alone, the travel
// scales with whatever the null has that the model lacks, and with it laps, clearance and the play at the ball.
void keep_width_without_spool(TuneScope& scope) {
  if (scope.on_stand || !states_width(scope.facts)) return;
  if (std::any_of(scope.data.begin(), scope.data.end(), hold_spool)) return;
  for (FreeValue& f : scope.shared) {
    if (f.at != row::port_width) continue;
    f.prior_sd = width_tolerance / std::log(f.upper / f.lower);
    scope.notes.push_back(
        {Note::Kind::no_spool,
         "no log holds the spool's position, so the logs show only the product of its travel and the ports' width: "
         "the width is kept near the data sheet's; '--prior port_width=SD' sets how near"});
  }
}

// Six repeats of one test hold the model's error of that test six times: alone they would say what a valve is made of.
void count_alike(TuneScope& scope, const std::vector<Log>& logs) {
  std::vector<TestConditions> tests;
  for (const Log& log : logs) tests.push_back(conditions_of(log));
  const std::vector<std::size_t> programme = programmes_of(tests);
  for (std::size_t l = 0; l < programme.size(); ++l)
    scope.data[l].alike = static_cast<int>(std::count(programme.begin(), programme.end(), programme[l]));
}

void take_logs(TuneScope& scope, const std::vector<Log>& logs, const RigFile& rig, const TuneOptions& options) {
  for (const Log& log : logs) {
    scope.data.push_back(prepare_to_fit(log, rig, {options.moving_average, {}}));
    const std::vector<Note>& notes = scope.data.back().notes;
    scope.notes.insert(scope.notes.end(), notes.begin() + static_cast<long>(log.notes.size()), notes.end());
  }
  count_alike(scope, logs);
  scope.simulate.threads = options.threads;
  scope.simulate.creep_step = creep_step_of(logs, rig);
  scope.on_stand = all_on_test_stand(logs, rig);
  for (const LogData& d : scope.data) require_channels(d);
}

void take_nuisances(TuneScope& scope) {
  for (std::size_t l = 0; l < scope.data.size(); ++l) {
    for (FreeValue& f : nuisance_values(scope.data[l], static_cast<int>(l), scope.base, tuning_null_limit))
      scope.nuisances.push_back(std::move(f));
    for (FreeValue& f : start_values(scope.data[l], static_cast<int>(l))) scope.nuisances.push_back(std::move(f));
  }
}

}  // namespace

std::vector<const LogData*> TuneScope::logs() const {
  std::vector<const LogData*> out;
  for (const LogData& d : data) out.push_back(&d);
  return out;
}

std::vector<FreeValue> TuneScope::all() const {
  std::vector<FreeValue> free = shared;
  free.insert(free.end(), nuisances.begin(), nuisances.end());
  return free;
}

TuneScope TuneScope::seen(double held) const {
  TuneScope out = *this;
  for (LogData& d : out.data) d = slice(d, 0, seen_samples(d.scenario.time.size(), held));
  return out;
}

TuneScope TuneScope::first_seconds(double seconds) const {
  TuneScope out = *this;
  for (LogData& d : out.data) {
    if (d.scenario.ports != Ports::actuator) continue;
    const std::vector<double>& t = d.scenario.time;
    d = slice(d, 0, static_cast<std::size_t>(std::lower_bound(t.begin(), t.end(), t.front() + seconds) - t.begin()));
  }
  return out;
}

TuneScope scope_of(const std::vector<Log>& logs, const Table& nominal, const RigFile& rig, const TuneOptions& options) {
  if (logs.empty()) throw InputError({}, "there is no log to tune on", "give fault-free logs of the valve");
  TuneScope scope;
  take_logs(scope, logs, rig, options);
  scope.facts = rig;
  if (scope.on_stand && rig.ports == Ports::actuator) scope.facts.ports = Ports::blocked;  // the logs say so
  scope.table = nominal;
  add_effect_rows(scope.table, options.effects.value_or(default_effects(rig_kind(logs, rig))));
  scope.table = apply_rig_facts(scope.table, scope.facts);
  scope.base = candidate_of(scope.table);
  say_oil(scope);
  scope.shared = shared_values(scope.table);
  keep_width_without_spool(scope);
  take_priors(scope.shared, options.priors);
  take_nuisances(scope);
  return scope;
}

}  // namespace servodx
