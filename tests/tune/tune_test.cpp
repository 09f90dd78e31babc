// What a whole tune promises of its search.
#include "tune/tune.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "effects/edge_radius.h"
#include "effects/line_inertia.h"
#include "effects/magnetic_hysteresis.h"
#include "effects/mount_compliance.h"
#include "effects/oil_stiffening.h"
#include "effects/port_line.h"
#include "effects/return_drop.h"
#include "effects/sensor_response.h"
#include "effects/supply_droop.h"
#include "effects/transport_delay.h"
#include "effects/viscosity_change.h"
#include "effects/viscosity_slope.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/error_model.h"
#include "fit/free_values.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "fit/tuned_state.h"
#include "optimise/box_least_squares.h"
#include "optimise/ceres_refinement.h"
#include "optimise/unit_cube.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "recovery/twins.h"
#include "servodx/data_sheet.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "servodx/tuned_by.h"
#include "shipped_data.h"
#include "simulate/scenario.h"
#include "tune/constants.h"
#include "tune/scope.h"
#include "tune/search.h"
#include "tune/summary.h"
#include "tune/watch.h"
#include "tune/weights.h"

namespace servodx {
namespace {

// A child that is worse than its parent after some logs does not run the others. Between generations 10 and 20 there
// are 488 children (waves of 64, the last of 40), and the best is shown in full once.
TEST(Tune, ALosingChildDoesNotRunTheLogsThatAreLeft) {
  std::vector<Log> logs;
  for (const char* name : {"h01_steps_large", "h04_multisine", "h05_prbs", "h06_sweep", "h12_mixed", "h13_mixed_cold"})
    logs.push_back(twins::cut(shipped_log(std::string("healthy/") + name), 400));
  Table table = shipped_table();
  for (Row& row : table.rows)
    row.estimate = std::find(twins::rows().begin(), twins::rows().begin() + 8, row.name) != twins::rows().begin() + 8;
  TuneOptions o;
  o.generations = 20;
  o.rounds = 1;
  o.effects.emplace();
  const TuneResult result = tune_table(logs, table, shipped_rig(), o);
  std::vector<long> shown;
  for (const ConvergencePoint& p : result.convergence)
    if (p.stage.kind == Stage::Kind::genetic) shown.push_back(p.simulations);
  ASSERT_EQ(shown.size(), 3u);  // before the first generation, after 10 and 20
  const long all = 488 * static_cast<long>(logs.size());
  std::printf("%ld runs of %ld\n", shown[2] - shown[1], all + static_cast<long>(logs.size()));
  EXPECT_LT(shown[2] - shown[1], all);
  EXPECT_GT(shown[2] - shown[1], all / 6);  // the first logs are everybody's
}

bool frees(const RigKind& kind, const std::string& effect) {
  const std::vector<std::string> freed = default_effects(kind);
  return std::find(freed.begin(), freed.end(), effect) != freed.end();
}

// Overlap and clearance alone would take what rounded corners do near null: flights then accuse corners that are made
// so.
TEST(Tune, FreesTheCornersOfTheEdgesOnStandsAndActuators) {
  for (const bool on_stand : {false, true}) EXPECT_TRUE(frees({.on_stand = on_stand}, EdgeRadius::name));
}

// Else the log that comes first, and is cold, would set clearances and frictions for all.
TEST(Tune, WithoutATemperatureAnywhereEachLogHasAViscosityOfItsOwn) {
  std::vector<Log> logs;
  for (const char* name : {"healthy/h01_steps_large", "healthy/h04_multisine"}) {
    logs.push_back(twins::cut(shipped_log(name), 400));
    logs.back().channels[index(Signal::oil_temperature)].value.clear();
  }
  const TuneScope scope = scope_of(logs, shipped_table(), shipped_rig(), {});
  std::vector<int> whose;
  for (const FreeValue& f : scope.nuisances)
    if (f.name == ViscosityChange::parameters[0].name) whose.push_back(f.log);
  EXPECT_EQ(whose, (std::vector<int>{0, 1}));
  EXPECT_TRUE(std::any_of(scope.notes.begin(), scope.notes.end(), [](const Note& n) {
    return n.kind == Note::Kind::oil && n.text.find("oil's temperature") != std::string::npos;
  }));
}

TEST(Tune, LogsOfOneProgrammeAreCountedAsAlike) {
  std::vector<Log> logs;
  for (const char* name : {"healthy/h01_steps_large", "healthy/h04_multisine", "healthy/h01_steps_large"})
    logs.push_back(shipped_log(name));
  std::vector<int> alike;
  for (const LogData& d : scope_of(logs, shipped_table(), shipped_rig(), {}).data) alike.push_back(d.alike);
  EXPECT_EQ(alike, (std::vector<int>{2, 1, 2}));
}

TEST(Tune, WithoutTheSpoolsPositionTheWidthOfThePortsStaysNearTheSheets) {
  const auto prior = [](bool with_spool, RigFile rig) {
    std::vector<Log> logs = {twins::cut(shipped_log("healthy/h01_steps_large"), 400)};
    if (!with_spool) logs.back().channels[index(Signal::spool_position)].value.clear();
    const TuneScope scope = scope_of(logs, shipped_table(), rig, {});
    for (const FreeValue& f : scope.shared)
      if (f.at == row::port_width) return f.prior_sd * std::log(f.upper / f.lower);
    return 0.0;
  };
  const double told = prior(true, shipped_rig()), kept = prior(false, shipped_rig());
  EXPECT_GT(told, 0.3) << "the spool's travel tells the width";
  EXPECT_NEAR(kept, 0.033, 0.001);
  RigFile silent = shipped_rig();
  silent.facts.erase("valve.spool_stroke");
  EXPECT_EQ(prior(false, silent), told) << "no sheet to keep to";
}

TEST(DefaultEffects, AreThoseThatSuchLogsCanTell) {
  EXPECT_TRUE(frees({}, MagneticHysteresis::name) && frees({.on_stand = true}, MagneticHysteresis::name));
  EXPECT_TRUE(frees({}, MountCompliance::name) && !frees({.on_stand = true}, MountCompliance::name));
  EXPECT_TRUE(!frees({}, PortLine::name) && frees({.on_stand = true}, PortLine::name));
  EXPECT_TRUE(!frees({}, SupplyDroop::name) && frees({.supply_measured = false}, SupplyDroop::name));
  EXPECT_TRUE(!frees({}, ReturnDrop::name) && frees({.return_measured = false}, ReturnDrop::name));
  EXPECT_TRUE(!frees({}, LineInertia::name) && frees({.long_lines = true}, LineInertia::name));
  EXPECT_FALSE(frees({.long_lines = true}, TransportDelay::name));
  EXPECT_TRUE(!frees({}, ViscositySlope::name) && frees({.temperatures_differ = true}, ViscositySlope::name));
}

TEST(DefaultEffects, LogsInColdAndInWarmOilTellTheSlopeOfItsViscosity) {
  std::vector<Log> logs = {twins::cut(shipped_log("healthy/h01_steps_large"), 400)};
  logs.push_back(logs.front());
  const auto differ = [&](double kelvin) {
    logs.back().channels[index(Signal::oil_temperature)].value.assign(400, kelvin);
    return rig_kind(logs, shipped_rig()).temperatures_differ;
  };
  logs.front().channels[index(Signal::oil_temperature)].value.assign(400, 313.15);
  EXPECT_FALSE(differ(303.15));
  EXPECT_TRUE(differ(263.15) && differ(353.15));
  logs.back().channels[index(Signal::oil_temperature)].value.clear();
  EXPECT_FALSE(rig_kind(logs, shipped_rig()).temperatures_differ) << "one log alone says nothing of a slope";
}

TEST(DefaultEffects, LongLinesAreFreedWhereverTheTapsSitAndThePlaceIsHeldWhereTheFileSaysIt) {
  RigFile rig = shipped_rig();
  rig.facts["lines.length"] = 1.0, rig.facts["lines.bore"] = 12e-3;
  const Table table_of_line = with_effects(shipped_table(), {LineInertia::name});
  const double unsaid = table_of_line.rows[static_cast<std::size_t>(table_of_line.find("line_tap"))].nominal;
  for (const auto& [taps, place] :
       {std::pair{Taps::not_said, unsaid}, {Taps::at_valve, 0.0}, {Taps::at_cylinder, 1.0}}) {
    rig.taps = taps;
    EXPECT_TRUE(rig_kind({shipped_log("healthy/h12_mixed")}, rig).long_lines);
    const Table table = apply_rig_facts(table_of_line, rig);
    const Row& tap = table.rows[static_cast<std::size_t>(table.find("line_tap"))];
    EXPECT_EQ(tap.nominal, place);
    EXPECT_EQ(tap.estimate, taps == Taps::not_said);
  }
}

// The spool sensor's gain scales what torque gain and ports scale as well; those of two pressures have nothing beside.
TEST(DefaultEffects, PressureSensorsHaveGainsWithinTheirClassAndTheSpoolsHasNone) {
  Table table = shipped_table();
  add_effect_rows(table, {SensorResponse::name});
  const std::vector<FreeValue> shared = shared_values(table);
  const auto find = [&](const char* name) {
    return std::find_if(shared.begin(), shared.end(), [&](const FreeValue& f) { return f.name == name; });
  };
  EXPECT_EQ(find("spool_sensor_gain"), shared.end());
  EXPECT_EQ(table[table.find("spool_sensor_gain")].nominal, 1.0);
  for (const char* name : {"pressure_a_sensor_gain", "pressure_b_sensor_gain"}) {
    const auto f = find(name);
    ASSERT_NE(f, shared.end());
    EXPECT_EQ(f->start, 1.0);
    EXPECT_NEAR(f->prior_sd * (f->upper - f->lower), 0.01, 1e-12);
  }
}

// Oils stiffen by 8 to 12 times the pressure; its bounds alone would let the rise stand in for something else.
TEST(DefaultEffects, TheRiseOfTheOilsStiffnessStaysNearWhatOilsHave) {
  Table table = shipped_table();
  add_effect_rows(table, {OilStiffening::name});
  for (const FreeValue& f : shared_values(table)) {
    if (f.name != OilStiffening::parameters[0].name) continue;
    EXPECT_EQ(f.start, 10.0);
    EXPECT_DOUBLE_EQ(f.prior_sd * (f.upper - f.lower), 2.0);
    return;
  }
  FAIL() << "not freed";
}

// A tuned table of one row; the log is short, as only what the table carries beside its rows is looked at.
TuneResult quick_tune(const Table& table) {
  TuneOptions o;
  o.generations = 0;
  o.rounds = 1;
  o.effects.emplace();
  return tune_table({twins::cut(shipped_log("healthy/h12_mixed"), 400)}, table, shipped_rig(), o);
}

bool ends_with_ceres(const TuneResult& result, Stage stage) {
  const auto by = [&](StageMethod method) {
    return std::any_of(result.stages.begin(), result.stages.end(),
                       [&](const StageResult& s) { return s.stage == stage && s.by == method && s.after <= s.before; });
  };
  return by(StageMethod::least_squares) && by(StageMethod::ceres);
}

Table one_free_row() {
  Table table = shipped_table();
  for (Row& row : table.rows) row.estimate = false;
  table[row::driver_bandwidth].estimate = true;
  return table;
}

std::vector<std::string> logs_of(const Table& table) {
  std::vector<std::string> hashes;
  for (const TunedBy& by : tuned_state(table).by) hashes.push_back(by.sha256);
  return hashes;
}

const std::string old_log(64, 'a'), new_log(64, 'b');

std::vector<std::string> old_set() {
  return {"moving average: 5 samples", "model error spool_position: floor 1 m, per activity 2, independent 9.9 1/s",
          "tuned by " + old_log + " old.csv"};
}

TEST(Tune, ATunedTableThatIsTunedAgainKeepsNothingOfTheOldErrorModelFilterAndLogs) {
  Table table = one_free_row();
  table.comments = old_set();
  table.comments.insert(table.comments.begin(), "tuned by hand before that");
  const TuneResult result = quick_tune(table);
  const ErrorModel carried = error_model_of(result.table);
  ASSERT_EQ(carried.channels.size(), result.error.channels.size());
  for (std::size_t i = 0; i < carried.channels.size(); ++i)
    EXPECT_EQ(carried.channels[i].independent, result.error.channels[i].independent);
  EXPECT_EQ(recorder_of(result.table).moving_average, 1);
  EXPECT_EQ(logs_of(result.table), std::vector<std::string>{shipped_log("healthy/h12_mixed").sha256});
  EXPECT_EQ(result.table.comments, std::vector<std::string>{"tuned by hand before that"});
}

TEST(Tune, EveryFitEndsWithCeresAndSaysWhatItGained) {
  const TuneResult result = quick_tune(one_free_row());
  for (const Stage stage : {Stage{Stage::Kind::start, 1}, Stage{Stage::Kind::weights}, Stage{Stage::Kind::everything}})
    EXPECT_TRUE(ends_with_ceres(result, stage)) << static_cast<int>(stage.kind);
  EXPECT_NE(result.ceres.end, CeresEnd::not_run);
  EXPECT_GE(result.ceres.evaluations, 1);
  const auto last = std::find_if(result.stages.rbegin(), result.stages.rend(),
                                 [](const StageResult& s) { return s.by == StageMethod::ceres; });
  EXPECT_EQ(result.ceres.final_cost, last->after);
}

std::vector<StartEnd::From> begun_from(Table table, const std::vector<std::string>& effects) {
  TuneOptions o;
  o.generations = 0, o.rounds = 1, o.effects = effects;
  std::vector<StartEnd::From> out;
  for (const StartEnd& s :
       tune_table({twins::cut(shipped_log("healthy/h12_mixed"), 400)}, table, shipped_rig(), o).starts)
    out.push_back(s.from);
  return out;
}

TEST(Tune, AnEffectThatGoesWithTheSizeOfTheRigIsAlsoBegunAsLargeAsTheRig) {
  using From = StartEnd::From;
  EXPECT_EQ(begun_from(one_free_row(), {"mount_compliance"}), (std::vector{From::table, From::rig_size}));
  EXPECT_EQ(begun_from(one_free_row(), {"oil_stiffening"}), std::vector{From::table}) << "its size is an oil's";
  Table tuned = quick_tune(with_effects(one_free_row(), {"mount_compliance"})).table;
  EXPECT_EQ(begun_from(tuned, {"mount_compliance"}), std::vector{From::table}) << "it has been found";
}

// All but what stands between the steps: the runs that learn an error model, and those that show what is held out.
TEST(Tune, ItsStepsAccountForNineTenthsOfItsSimulations) {
  Table table = one_free_row();
  table[row::flapper_stiffness].estimate = true;  // the sheet's is far enough off for round upon round of weights
  const TuneResult result = quick_tune(table);
  long told = 0;
  for (const StageResult& s : result.stages) told += s.simulations;
  EXPECT_LE(told, result.simulations);
  EXPECT_GE(static_cast<double>(told), 0.9 * static_cast<double>(result.simulations));
  EXPECT_EQ(result.stages.front().stage.kind, Stage::Kind::screening);
  EXPECT_EQ(result.stages.back().stage.kind, Stage::Kind::errors);
}

TEST(Tune, EachStepThatHoldsAPartOutSaysHowThatIsMet) {
  const TuneResult result = quick_tune(one_free_row());
  for (const Stage::Kind kind : {Stage::Kind::start, Stage::Kind::weights})
    EXPECT_TRUE(std::any_of(result.stages.begin(), result.stages.end(), [&](const StageResult& s) {
      return s.stage.kind == kind && std::isfinite(s.heldout_over_noise);
    })) << static_cast<int>(kind);
  for (const StageResult& s : result.stages) {
    if (s.stage.kind == Stage::Kind::everything) {
      EXPECT_TRUE(std::isnan(s.heldout_over_noise));
    }
  }
}

// A bend that grows from nothing: no step that a noise or a start could be read from.
void bend_last_part(Log& log, double part) {
  const auto from = static_cast<std::size_t>((1.0 - part) * static_cast<double>(log.samples()));
  for (const Signal signal : {Signal::spool_position, Signal::pressure_a, Signal::pressure_b}) {
    std::vector<double>& x = log.channels[index(signal)].value;
    const double span = *std::max_element(x.begin(), x.end()) - *std::min_element(x.begin(), x.end());
    for (std::size_t k = from; k < x.size(); ++k)
      x[k] += span * std::pow(static_cast<double>(k - from) / static_cast<double>(x.size() - from), 3);
  }
}

TEST(Tune, WhatIsHeldOutTellsTheFitNothingUntilItHasEnded) {
  TuneOptions o;
  o.generations = 0, o.rounds = 1;
  o.effects.emplace();
  const auto tuned = [&](double bent) {
    Log log = twins::cut(shipped_log("healthy/h12_mixed"), 400);
    if (bent > 0) bend_last_part(log, bent);
    return tune_table({log}, one_free_row(), shipped_rig(), o);
  };
  const TuneResult as_it_is = tuned(0), bent = tuned(0.9 * o.heldout);
  // How long weights are learnt anew is what the held-out part may say.
  std::set<Stage::Kind> met;
  for (std::size_t k = 0; k < std::min(as_it_is.stages.size(), bent.stages.size()); ++k) {
    const StageResult &one = as_it_is.stages[k], &other = bent.stages[k];
    if (one.stage.kind != other.stage.kind) break;
    if (one.stage.kind != Stage::Kind::start && one.stage.kind != Stage::Kind::weights) continue;
    EXPECT_NEAR(one.after, other.after, 1e-3 * one.after) << k;
    met.insert(one.stage.kind);
  }
  EXPECT_EQ(met, (std::set{Stage::Kind::start, Stage::Kind::weights}));
  EXPECT_GT(bent.channels.front().heldout_rms, as_it_is.channels.front().heldout_rms);
}

// What the fits by learnt weights leave of what is held out, as they were made: of two starts, the first the best by
// its cost and far off, of which the second lies `second_lies` from that part and the first 1.
struct FitsOfTwoStarts {
  std::vector<double> heldout;
  double kept = 0;
};
FitsOfTwoStarts fits_of_two_starts(double second_lies) {
  TuneOptions o;
  o.generations = 0;
  o.effects.emplace();
  const TuneScope scope =
      scope_of({twins::cut(shipped_log("healthy/h12_mixed"), 400)}, one_free_row(), shipped_rig(), o);
  const TuneScope seen = scope.seen(o.heldout);
  FitProblem part = seen.problem();
  Point far = part.start();
  far.front() = 0.05;
  SearchEnds searched;
  searched.ends = {{{}, far, 1}, {{}, part.start(), second_lies}};
  TuneWatch watch(o);
  FitsOfTwoStarts out;
  out.kept = refine_best(searched, part, scope.problem(), scope.on_stand, watch).heldout;
  for (const StageResult& s : watch.stages)
    if (std::isfinite(s.heldout_over_noise)) out.heldout.push_back(s.heldout_over_noise);
  return out;
}

TEST(Tune, TheStartNearestToWhatIsHeldOutIsFittedBesideTheBestOfCostAndTheNearerKept) {
  const FitsOfTwoStarts both = fits_of_two_starts(0.9), one = fits_of_two_starts(1e9);
  EXPECT_EQ(both.heldout.size(), one.heldout.size() + 1);
  EXPECT_EQ(both.heldout[0], one.heldout[0]);
  EXPECT_LE(both.kept, both.heldout[1]);
}

TEST(Tune, WeightsAreLearntAnewUntilWhatIsHeldOutIsMetNoBetter) {
  const std::vector<double> fits = fits_of_two_starts(1e9).heldout;
  ASSERT_GE(fits.size(), 2u) << "the weights of the start alone";
  for (std::size_t k = 1; k < fits.size(); ++k)
    EXPECT_EQ(fits[k] < tune_constants::nearer_by * fits[k - 1], k + 1 < fits.size()) << k;
}

TEST(Tune, AChannelWhoseErrorLastsIsFittedToTheEndAsIfItHadTensOfSamplesASecond) {
  TuneOptions o;
  o.generations = 0;
  o.effects.emplace();
  Log log = twins::cut(shipped_log("healthy/h12_mixed"), 400);
  std::vector<double>& piston = log.channels[index(Signal::piston_position)].value;
  const double all = static_cast<double>(piston.size());
  for (std::size_t k = 0; k < piston.size(); ++k)  // [m] a swing that the model does not know
    piston[k] += 1e-3 * std::sin(2 * std::numbers::pi * static_cast<double>(k) / all);
  const TuneScope scope = scope_of({log}, one_free_row(), shipped_rig(), o);
  FitProblem problem = scope.problem();
  TuneWatch watch(o);
  ErrorModel error;
  const LeastSquaresResult end = refine_whole(problem, problem.start(), error, 2, false, {}, watch);
  const ErrorModel learnt = learn_error_model(problem, end.point);
  ASSERT_LT(learnt.find(Signal::piston_position)->independent, tune_constants::least_independent_rate);
  EXPECT_EQ(error.find(Signal::piston_position)->independent, tune_constants::least_independent_rate);
}

TEST(Tune, AStartIsInTheBestValleyByItsCostOrByItsOwnPromise) {
  LeastSquaresResult end;
  end.cost = 104;
  EXPECT_TRUE(in_best_valley(end, 100));
  end.cost = 140, end.promised_gain = 30;
  EXPECT_FALSE(in_best_valley(end, 100)) << "its own derivatives promise it 110";
  end.promised_gain = 36;
  EXPECT_TRUE(in_best_valley(end, 100));
  end.promised_gain = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(in_best_valley(end, 100)) << "nothing is promised without derivatives";
}

TEST(Tune, WithoutDerivativesNothingSaysThatItHasArrived) {
  TuneOptions o;
  o.generations = 0, o.rounds = 1;
  o.effects.emplace();
  o.local = TuneLocal::nlopt;
  const TuneResult r =
      tune_table({twins::cut(shipped_log("healthy/h12_mixed"), 400)}, one_free_row(), shipped_rig(), o);
  EXPECT_NE(r.stop, StopReason::converged);
  EXPECT_TRUE(std::isinf(r.still_promised));
}

TEST(Tune, CeresAloneArrivesWhereBothArrive) {
  TuneOptions o;
  o.generations = 0;
  o.rounds = 2;
  o.effects.emplace();
  const std::vector<Log> logs = {twins::cut(shipped_log("healthy/h12_mixed"), 400)};
  const TuneResult both = tune_table(logs, one_free_row(), shipped_rig(), o);
  o.local = TuneLocal::ceres;
  const TuneResult alone = tune_table(logs, one_free_row(), shipped_rig(), o);
  for (const StageResult& s : alone.stages) {
    if (s.by != StageMethod::none) {
      EXPECT_EQ(s.by, StageMethod::ceres) << static_cast<int>(s.stage.kind);
    }
  }
  const double there = both.table[row::driver_bandwidth].nominal;
  // Half a standard error: the valley is flat to that.
  EXPECT_NEAR(alone.table[row::driver_bandwidth].nominal, there,
              0.5 * both.table[row::driver_bandwidth].std_error.value());
}

TEST(Tune, OfATableThatHoldsTwoTuningsTheLastCounts) {
  Table table = shipped_table();
  table.comments = old_set();
  table.comments.push_back("model error spool_position: floor 3 m, per activity 4, independent 178 1/s");
  table.comments.push_back("tuned by " + new_log + " new.csv");
  const ErrorModel error = error_model_of(table);
  ASSERT_EQ(error.channels.size(), 1u);
  EXPECT_EQ(error.channels[0].independent, 178);
  EXPECT_EQ(recorder_of(table).moving_average, 1);
  EXPECT_EQ(logs_of(table), std::vector<std::string>{new_log});
}

TEST(Tune, OptionsAreRefusedByNameBeforeAnyWork) {
  const auto refused = [](auto change) -> std::string {
    TuneOptions o;
    change(o);
    try {
      tune_table({}, Table{}, RigFile{}, o);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const auto names = [](const std::string& text, const char* option) { return text.find(option) != std::string::npos; };
  EXPECT_TRUE(names(refused([](TuneOptions& o) { o.rounds = 0; }), "--rounds"));
  EXPECT_TRUE(names(refused([](TuneOptions& o) { o.population = 23; }), "--population"));
  EXPECT_TRUE(names(refused([](TuneOptions& o) { o.generations = -1; }), "--generations"));
  EXPECT_TRUE(names(refused([](TuneOptions& o) { o.moving_average = 4; }), "--moving-average"));
  EXPECT_TRUE(names(refused([](TuneOptions& o) { o.resume = true; }), "--resume"));
}

TEST(Tune, AChannelIsNotFollowedWhereItIsFarBeyondItsNoiseAndByMuchOfItsReach) {
  const ParameterVector v = candidate_of(shipped_table());
  const double supply = v[row::supply_pressure];
  const auto followed = [&](double rms, double noise) {
    return unfollowed_channels({{Signal::pressure_a, "bar", rms, noise, rms}}, v).empty();
  };
  EXPECT_FALSE(followed(0.01 * supply, 0.001 * supply));
  EXPECT_TRUE(followed(0.01 * supply, 0.002 * supply)) << "five times its noise is what a textbook model leaves";
  EXPECT_TRUE(followed(0.001 * supply, 1e-5 * supply)) << "a sensor better than it need be is no reason for doubt";
}

}  // namespace
}  // namespace servodx
