// Studies that search rows themselves: tune-up, the rows that it sets aside, how many can be freed at once, and how far
// apart the parameter sets of one large fault lie.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "base/random.h"
#include "diagnose/whitening.h"
#include "experiments/record.h"
#include "experiments/studies.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/free_values.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "fit/tuned_state.h"
#include "optimise/box_least_squares.h"
#include "optimise/genetic.h"
#include "optimise/genetic_state.h"
#include "optimise/local.h"
#include "optimise/robust_loss.h"
#include "optimise/unit_cube.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "servodx/table.h"
#include "servodx/tune.h"
#include "simulate/scenario.h"
#include "tune/tune.h"

namespace servodx::experiments {
namespace {

constexpr std::size_t excerpt = 1500;  // samples of the mixed log: all that it excites

// Rows of the tuned table that may move, without priors: what the paper's search sees.
std::vector<FreeValue> bare_rows(const Table& table) {
  std::vector<FreeValue> rows;
  for (FreeValue& f : shared_values(table))
    if (f.at < n_parameters) rows.push_back(f), rows.back().prior_sd = std::numeric_limits<double>::infinity();
  return rows;
}

// `count` of them, drawn by seed.
std::vector<FreeValue> drawn(std::vector<FreeValue> rows, std::size_t count, unsigned seed) {
  Random random(seed);
  for (std::size_t i = 0; i < std::min(count, rows.size()); ++i)
    std::swap(rows[i], rows[i + random.below(static_cast<std::uint32_t>(rows.size() - i))]);
  rows.resize(std::min(count, rows.size()));
  return rows;
}

// Each row moved by up to a quarter of its range, within it.
ParameterVector moved(ParameterVector v, const std::vector<FreeValue>& rows, unsigned seed) {
  Random random(seed, 1);
  for (const FreeValue& f : rows)
    v[static_cast<std::size_t>(f.at)] =
        f.from_unit(std::clamp(f.to_unit(f.start) + random.uniform(-0.25, 0.25), 0.02, 0.98));
  return v;
}

struct Search {
  Point by_genes, refined;
  double cost_by_genes = 0, cost_refined = 0;
  long simulations = 0;
};
// Fifty individuals, so many generations, from anywhere; then the local stage.
Search search(const FitProblem& problem, int generations, unsigned seed) {
  GeneticOptions o;
  o.population = 50;
  o.generations = generations;
  o.seed = seed;
  const BatchCost cost = [&](std::span<const Point> points) { return problem.costs(points, RobustLoss::none, 1.0); };
  GeneticHooks hooks;
  hooks.screen = [&](std::span<const Point> points, std::span<const double> bounds) {
    return problem.costs(points, RobustLoss::none, 1.0, true, bounds);
  };
  const Individual best = minimise_genetic(problem.n(), cost, o, {}, hooks).state.best;
  LeastSquaresOptions local;
  local.max_iterations = 20;
  local.difference = Difference::forward;
  const LeastSquaresResult end = minimise_locally(problem.least_squares(), best.point, local).end;
  return {best.point, end.point, best.cost, end.misfit, problem.simulations()};
}

// Rows within a tenth of their range of the truth.
int found(const FitProblem& problem, const Point& x, const ParameterVector& truth) {
  int n = 0;
  for (std::size_t j = 0; j < x.size(); ++j) {
    const FreeValue& f = problem.free()[j];
    n += std::abs(x[j] - f.to_unit(truth[static_cast<std::size_t>(f.at)])) < 0.1;
  }
  return n;
}

}  // namespace

namespace {

// One tune of two logs that the model wrote at six rows moved.
void tune_trials(Setup& setup, Record& record, unsigned first, int trials) {
  for (int i = 0; i < trials; ++i) {
    const unsigned seed = first + static_cast<unsigned>(i);
    const std::string trial = std::to_string(seed);
    if (record.has(trial) || !setup.may()) continue;
    const std::vector<FreeValue> rows = drawn(bare_rows(setup.tuned), 6, seed);
    const ParameterVector truth = moved(candidate_of(setup.tuned), rows, seed);
    const std::vector<Log> logs = {
        written_by_model(setup, shipped(setup, "healthy/h12_mixed"), truth, seed),
        written_by_model(setup, shipped(setup, "healthy/h01_steps_large"), truth, seed + 500)};
    TuneOptions o;
    o.generations = 5;
    o.rounds = 2;
    o.seed = seed;
    o.effects = std::vector<std::string>{};
    const auto start = std::chrono::steady_clock::now();
    const TuneResult t = tune_table(logs, setup.textbook, setup.rig, o);
    double worst = 0;
    for (const ChannelResult& c : t.channels) worst = std::max(worst, c.rms / c.noise_rms);
    int kept = 0, right = 0, aside = 0;
    for (const ParameterResult& p : t.parameters) {
      if (p.id < 1) continue;
      if (p.verdict != RowVerdict::bounded) {
        aside += p.verdict != RowVerdict::frozen;
        continue;
      }
      ++kept;
      right += std::abs(p.estimate - truth[static_cast<std::size_t>(p.id - 1)]) < 2 * p.std_error;
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    record.add(trial, {fmt::format("{:.3f}", worst), std::to_string(kept), std::to_string(right), std::to_string(aside),
                       std::to_string(t.simulations), fmt::format("{:.1f}", seconds)});
  }
}
const char* const tune_head = "worst_rms_over_noise,told,told_rightly,not_told,simulations,seconds";

}  // namespace

void tune_up(Setup& setup) {
  Record record(setup.dir + "/tune_up.csv", tune_head);
  tune_trials(setup, record, 10, 10);
  int met = 0;
  for (const auto& [trial, cells] : record.rows()) met += std::stod(cells[0]) < 1.2;
  fmt::print("Tune-up: {} of {} trials end within 1.2 times the sensors' noise in every channel.\n", met,
             record.rows().size());
}

void selection(Setup& setup) {
  Record record(setup.dir + "/selection.csv", tune_head);
  tune_trials(setup, record, 30, 10);
  int told = 0, right = 0, aside = 0;
  for (const auto& [trial, cells] : record.rows())
    told += std::stoi(cells[1]), right += std::stoi(cells[2]), aside += std::stoi(cells[3]);
  fmt::print(
      "Selection: of {} rows that were called told, {} lie within two standard errors; {} were set aside, in {} "
      "trials.\n",
      told, right, aside, record.rows().size());
}

void rows_at_once(Setup& setup) {
  Record record(setup.dir + "/rows_at_once.csv", "rows,found_by_genes,found_refined,cost_by_genes,cost_refined");
  LogData part = slice(prepare(shipped(setup, "healthy/h12_mixed"), setup.rig), 0, excerpt);
  for (const int count : {2, 4, 8, 12, 16, 20})
    for (unsigned seed = 1; seed <= 10; ++seed) {
      const std::string trial = fmt::format("{}@{}", count, seed);
      if (record.has(trial) || !setup.may()) continue;
      const std::vector<FreeValue> rows = drawn(bare_rows(setup.tuned), static_cast<std::size_t>(count), seed);
      const ParameterVector base = candidate_of(setup.tuned), truth = moved(base, rows, seed);
      LogData written = part;
      SimulateOptions how;
      how.wanted.fill(true);
      const Trajectory run = simulate(written.scenario, truth, how);
      for (std::size_t c = 0; c < written.channels.size(); ++c) {
        Random random(seed, static_cast<std::uint32_t>(c));
        FitChannel& channel = written.channels[c];
        channel.measured = run.signals[static_cast<std::size_t>(channel.simulated)];
        for (double& v : channel.measured) v += random.normal(0.0, channel.noise);
      }
      const FitProblem problem({&written}, base, rows);
      const Search s = search(problem, 40, seed);
      const double floor = 0.5 * static_cast<double>(problem.data_rows());
      record.add(trial,
                 {std::to_string(problem.n()), std::to_string(found(problem, s.by_genes, truth)),
                  std::to_string(found(problem, s.refined, truth)), fmt::format("{:.3f}", s.cost_by_genes / floor),
                  fmt::format("{:.3f}", s.cost_refined / floor)});
    }
  struct Count {
    int trials = 0, rows = 0, genes = 0, refined = 0, all_genes = 0, all_refined = 0;
  };
  std::map<int, Count> counts;
  for (const auto& [trial, cells] : record.rows()) {
    Count& c = counts[std::stoi(cells[0])];
    const int n = std::stoi(cells[0]), genes = std::stoi(cells[1]), refined = std::stoi(cells[2]);
    ++c.trials, c.rows += n, c.genes += genes, c.refined += refined;
    c.all_genes += genes == n, c.all_refined += refined == n;
  }
  fmt::print(
      "Paper: low classification performance of some parameters reduces the number that can be used at once.\nHere, "
      "rows within a tenth of their range of the truth, 50 individuals and 40 generations:\n");
  for (const auto& [n, c] : counts)
    fmt::print(
        "{:3d} rows at once: {:2d} trials  rows found {:4.0f} % by the search, {:4.0f} % refined  all found {:2d} "
        "and {:2d}\n",
        n, c.trials, 100.0 * c.genes / c.rows, 100.0 * c.refined / c.rows, c.all_genes, c.all_refined);
}

void large_faults(Setup& setup) {
  // Twelve rows without a failure mode identifier: the paper's 1, 2, 6, 9 and 10, and what trades with them.
  const std::vector<int> positions = {row::filter_blockage_positive, row::filter_blockage_negative,
                                      row::torque_motor_gain,        row::flapper_stiffness,
                                      row::hydraulic_amplifier_gain, row::nozzle_gap,
                                      row::fixed_orifice_diameter,   row::valve_glitch,
                                      row::feedback_wire_stiffness,  row::spool_friction,
                                      row::radial_clearance,         row::servovalve_null};
  const std::vector<std::pair<std::string, std::string>> logs = {
      {"fault/f05_wire_lost_mild", "small"},         {"fault/f06_wire_lost_medium", "large"},
      {"fault/f01_clogged_filter_medium", "small"},  {"fault/f02_clogged_filter_severe", "large"},
      {"fault/f10_torque_motor_loss_mild", "small"}, {"fault/f11_torque_motor_loss_severe", "large"},
      {"fault/f07_sticky_spool_medium", "small"},    {"fault/f08_sticky_spool_severe", "large"},
      {"fault/f12_clearance_wear_mild", "small"},    {"fault/f13_clearance_wear_severe", "large"}};
  std::string head = "log,size,cost";
  for (const int p : positions) head += fmt::format(",row_{}", p + 1);
  Record record(setup.dir + "/large_faults.csv", head);
  std::vector<FreeValue> rows;
  for (const int p : positions) {
    FreeValue f{coordinate(setup.tuned[p]), p};
    if (p == row::servovalve_null) f.lower = -0.2, f.upper = 0.2;
    rows.push_back(f);
  }
  for (const auto& [name, size] : logs) {
    const LogData data = prepare(shipped(setup, name), setup.rig);
    const ParameterVector base = candidate_of(setup.tuned);
    const Trajectory reference = reference_of(data, base, 0);
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const std::string trial = fmt::format("{}@{}", name, seed);
      if (record.has(trial) || !setup.may()) continue;
      FitProblem problem({&data}, base, rows);
      whiten(problem, 0, error_model_of(setup.tuned), reference);
      const Search s = search(problem, 30, seed);
      std::vector<std::string> cells = {name, size, fmt::format("{:.1f}", s.cost_by_genes)};
      for (const double u : s.by_genes) cells.push_back(fmt::format("{:.4f}", u));
      record.add(trial, cells);
    }
  }
  fmt::print(
      "Paper: large changes may lead to erratic solutions of different combinations.\nHere, standard deviation of "
      "a row over five seeds, of its range, mean of the rows; least and largest cost:\n");
  for (const auto& [name, size] : logs) {
    std::vector<std::vector<double>> ends;
    std::vector<double> costs;
    for (const auto& [trial, cells] : record.rows()) {
      if (cells[0] != name) continue;
      costs.push_back(std::stod(cells[2]));
      ends.emplace_back();
      for (std::size_t j = 3; j < cells.size(); ++j) ends.back().push_back(std::stod(cells[j]));
    }
    if (ends.size() < 2) continue;
    double spread = 0;
    for (std::size_t j = 0; j < ends.front().size(); ++j) {
      double mean = 0, square = 0;
      for (const auto& e : ends) mean += e[j] / static_cast<double>(ends.size());
      for (const auto& e : ends) square += (e[j] - mean) * (e[j] - mean) / static_cast<double>(ends.size() - 1);
      spread += std::sqrt(square) / static_cast<double>(ends.front().size());
    }
    const auto [least, most] = std::minmax_element(costs.begin(), costs.end());
    fmt::print("{:36s} {}  {} seeds  spread {:.3f}  cost {:.0f} to {:.0f}\n", name, size, ends.size(), spread, *least,
               *most);
  }
}

}  // namespace servodx::experiments
