// How time grows with the length of a log, the population, and the numbers of parameters, logs and hypotheses, and
// memory with the length of a log: exponents of fitted powers, and their plot.
#include <fmt/format.h>
#include <omp.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "diagnose/hypotheses.h"
#include "faults/registry.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/error_model.h"
#include "fit/free_values.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "long_log.h"
#include "optimise/unit_cube.h"
#include "ratios/measure.h"
#include "ratios/rows.h"
#include "ratios/trace.h"
#include "ratios/twin.h"
#include "report/shared/line_chart.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx::bench {
namespace {

// Slope of log(y) over log(x).
double exponent(const std::vector<std::pair<double, double>>& points) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [a, b] : points) {
    const double u = std::log(a), v = std::log(b);
    n += 1, x += u, y += v, xx += u * u, xy += u * v;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

void add(Report& report, const std::string& what, const std::string& unit, const std::string& over,
         const std::vector<std::pair<double, double>>& points) {
  const double p = exponent(points);
  for (const auto& [x, y] : points) report.json["scaling"][over]["points"].push_back({x, y});
  report.json["scaling"][over]["exponent"] = p;
  const std::string power = fmt::format("{} grows as ({})^{:.2f}", what, over, p);
  report.notes.push_back(fmt::format("{}, {:g} to {:g}", power, points.front().first, points.back().first));
  fmt::print(stderr, "  {}\n", report.notes.back());
  report::ChartPanel panel;
  panel.title = power, panel.x_label = over, panel.y_label = fmt::format("log10 of {} [{}]", what, unit);
  panel.log_x = true;
  report::ChartLine measured{"measured", {}, {}, "", true}, line{"fitted power", {}, {}, "", false};
  double level = 0;
  for (const auto& [x, y] : points) level += (std::log10(y) - p * std::log10(x)) / static_cast<double>(points.size());
  for (const auto& [x, y] : points) {
    measured.x.push_back(x), measured.y.push_back(std::log10(y));
    line.x.push_back(x), line.y.push_back(level + p * std::log10(x));
  }
  panel.lines = {measured, line};
  report.panels.push_back(std::move(panel));
}

void add_times(Report& report, const std::string& over, const std::vector<double>& at,
               const std::vector<std::function<void()>>& tasks, int turns) {
  const std::vector<Timing> t = take_turns(tasks, turns);
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = 0; i < at.size(); ++i) points.push_back({at[i], t[i].median});
  add(report, "time", "s", over, points);
}

// Largest memory of a process of its own that does `work`. [MB]
double peak_memory(const std::function<void()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    omp_set_num_threads(1);  // the pool's other threads stayed with the parent
    work();
    _exit(0);
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace

void scaling_rows(Report& report, const Choice& choice) {
  const ParameterVector v = candidate_of(table());
  const int turns = std::min(3, choice.turns);
  const std::string data = std::string(SERVODX_SOURCE_DIR) + "/data/";
  const RigFile rig = read_rig_file(data + "rig.toml");

  // Memory: reading a log and one simulation of all of it; first, as a process inherits what its parent holds.
  std::vector<std::pair<double, double>> memory;
  const auto folder = std::filesystem::temp_directory_path();
  for (const long rows : {62500L, 125000L, 250000L, 500000L, 1000000L}) {
    const std::string path = (folder / fmt::format("servodx_memory_{}.csv", rows)).string();
    peak_memory([&] { write_file(path, long_log(rows)); });  // nor may the parent hold what it wrote
    memory.push_back({static_cast<double>(rows), peak_memory([&] {
                        const LogData long_one = prepare(read_log(path), rig);
                        Trajectory t;
                        const std::vector<Job> jobs = {{&long_one.scenario, &v, &t}};
                        simulate(jobs, one_thread());
                      })});
    std::filesystem::remove(path);
  }
  add(report, "memory", "MB", "rows of a log", memory);
  const auto &few = memory.front(), &many = memory.back();
  report.notes.push_back(fmt::format("{:.0f} bytes a row of ten columns, {:.0f} MB before the first",
                                     1048576 * (many.second - few.second) / (many.first - few.first),
                                     few.second - few.first * (many.second - few.second) / (many.first - few.first)));

  std::vector<Scenario> logs;
  std::vector<std::function<void()>> tasks;
  const auto batch = [&v](const Scenario& s, int count) {
    std::vector<Trajectory> t(static_cast<std::size_t>(count));
    std::vector<Job> jobs;
    for (Trajectory& one : t) jobs.push_back({&s, &v, &one});
    simulate(jobs, one_thread());
  };
  const std::vector<double> lengths = {1, 2, 4, 8, 16, 32};
  for (double l : lengths) logs.push_back(trace(l));
  for (const Scenario& s : logs) tasks.push_back([&] { batch(s, 8); });
  add_times(report, "seconds of log", lengths, tasks, turns);

  tasks.clear();
  const std::vector<double> populations = {8, 16, 32, 64, 128, 256};
  for (double n : populations) tasks.push_back([&, n] { batch(logs[0], static_cast<int>(n)); });
  add_times(report, "population", populations, tasks, turns);

  tasks.clear();
  std::vector<Twin> twins;
  const std::vector<double> counts = {8, 16, 24};
  for (double n : counts) twins.emplace_back(static_cast<int>(n), 1, logs[1], 1);
  for (const Twin& twin : twins)
    tasks.push_back([&] {
      std::vector<Point> points(static_cast<std::size_t>(twin.n), Point(static_cast<std::size_t>(twin.n), 0.5));
      for (std::size_t j = 0; j < points.size(); ++j) points[j][j] += 1e-4;
      twin.evaluate(points);
    });
  add_times(report, "parameters of a Jacobian", counts, tasks, turns);

  // Logs: the Jacobian of what they share and of each one's own, as in a tune.
  const Log read = read_log(data + "healthy/h12_mixed.csv", rig);
  const LogData log = slice(prepare(read, rig), 0, 2000);
  const std::vector<LogData> same(8, log);
  tasks.clear();
  const std::vector<double> numbers = {1, 2, 4, 8};
  for (double n : numbers)
    tasks.push_back([&, n] {
      std::vector<const LogData*> some;
      std::vector<FreeValue> free = shared_values(table());
      for (int l = 0; l < static_cast<int>(n); ++l) {
        some.push_back(&same[static_cast<std::size_t>(l)]);
        for (FreeValue& f : nuisance_values(log, l, v, 0.1)) free.push_back(std::move(f));
      }
      FitProblem problem(some, v, free, one_thread());
      const Point x = problem.start();
      Eigen::MatrixXd jacobian;
      problem.jacobian(x, problem.evaluate(std::span(&x, 1)).front().residual, jacobian);
    });
  add_times(report, "logs of a Jacobian", numbers, tasks, turns);

  // Hypotheses: the registry's first faults beside health, which has its share of the time.
  ErrorModel error;
  for (const FitChannel& c : log.channels) {
    const auto [low, high] = std::minmax_element(c.measured.begin(), c.measured.end());
    error.channels.push_back({c.signal, std::hypot(c.noise, 0.01 * (*high - *low)), 0, 50});
  }
  tasks.clear();
  const std::vector<double> hypotheses = {1, 2, 4, 8};
  for (double n : hypotheses)
    tasks.push_back([&, n] {
      HypothesisSettings settings;
      settings.threads = 1;
      settings.among.assign(fault_list().begin(), fault_list().begin() + static_cast<long>(n));
      fit_hypotheses({&log}, v, error, settings);
    });
  add_times(report, "hypotheses beside health", hypotheses, tasks, turns);
}

}  // namespace servodx::bench
