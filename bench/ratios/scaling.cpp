// How time grows with the length of a log, the population and the number of parameters: exponents of fitted powers.
#include <fmt/format.h>

#include "ratios/measure.h"
#include "ratios/rows.h"
#include "ratios/twin.h"

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

void add(Report& report, const char* over, const std::vector<double>& at,
         const std::vector<std::function<void()>>& tasks, int turns) {
  const std::vector<Timing> t = take_turns(tasks, turns);
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = 0; i < at.size(); ++i) {
    points.push_back({at[i], t[i].median});
    report.json["scaling"][over]["points"].push_back({at[i], t[i].median});
  }
  const double p = exponent(points);
  report.json["scaling"][over]["exponent"] = p;
  report.notes.push_back(fmt::format("time grows as ({})^{:.2f}, {:g} to {:g}", over, p, at.front(), at.back()));
}

}  // namespace

void scaling_rows(Report& report, const Choice& choice) {
  const ParameterVector v = candidate_of(table());
  const int turns = std::min(3, choice.turns);
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
  add(report, "seconds of log", lengths, tasks, turns);

  tasks.clear();
  const std::vector<double> populations = {8, 16, 32, 64, 128, 256};
  for (double n : populations) tasks.push_back([&, n] { batch(logs[0], static_cast<int>(n)); });
  add(report, "population", populations, tasks, turns);

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
  add(report, "parameters of a Jacobian", counts, tasks, turns);
}

}  // namespace servodx::bench
