// The command of a log that is sampled faster than its run steps. Between two points of the scenario a step spans many
// samples, and a step takes an input as a line: the one with the samples' mean and first moment over the step. What is
// left of the command has neither. Between it and a pressure the valve integrates at least twice, and answers by the
// third order of the step, while the mean alone, held, leaves an edge within a step wrong to the second order.
// Source: the moments that an impulse response of finite memory sees (any text on linear systems).
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

namespace servodx {

struct CommandSamples {
  std::vector<double> time, value;  // [s], [A] every sample of the log, none missing
};

// Value at a step's begin and its end. [A]
struct CommandLine {
  double from = 0, to = 0;
};
struct CommandLines {
  CommandLine held, joined;  // each sample held until the next; a line from each to the next
};

struct FastCommand {
  std::shared_ptr<const CommandSamples> samples;  // null: the scenario's `command` is every sample
  std::vector<std::size_t> at;                    // of each point of the scenario, its sample
  std::vector<double> move;  // [A] from each point to the next, the most that the command moves within a usual step

  explicit operator bool() const { return samples != nullptr; }
  // Over [begin, end] [s], which lies between points k and k + 1.
  CommandLines over(std::size_t k, double begin, double end) const;
};

inline CommandLines FastCommand::over(std::size_t k, double begin, double end) const {
  const std::vector<double>&t = samples->time, &x = samples->value;
  const std::size_t last = at[k + 1];
  const double part = (begin - t[at[k]]) / (t[last] - t[at[k]]);
  // Even stamps put it here; others are a few samples off.
  std::size_t j = at[k] + static_cast<std::size_t>(part > 0 ? part * static_cast<double>(last - at[k]) : 0.0);
  while (j > at[k] && t[j] > begin) --j;
  while (j + 1 < last && t[j + 1] <= begin) ++j;
  const double h = end - begin, middle = begin + 0.5 * h;
  double mean_held = 0, moment_held = 0, mean_joined = 0, moment_joined = 0;
  for (double from = begin; j < last; ++j) {
    const double to = j + 1 < last && t[j + 1] < end ? t[j + 1] : end;
    const double width = to - from, centre = 0.5 * (from + to) - middle;
    const double slope = (x[j + 1] - x[j]) / (t[j + 1] - t[j]);
    const double there = x[j] + slope * (centre + middle - t[j]);
    mean_held += width * x[j], moment_held += width * centre * x[j];
    mean_joined += width * there, moment_joined += width * (centre * there + width * width / 12 * slope);
    if (to >= end) break;
    from = to;
  }
  const auto line = [&](double integral, double moment) {
    const double mean = integral / h, half = 6 * moment / (h * h);
    return CommandLine{mean - half, mean + half};
  };
  return {line(mean_held, moment_held), line(mean_joined, moment_joined)};
}

}  // namespace servodx
