#include "diagnose/record_law.h"

#include <algorithm>
#include <cmath>

#include "base/student.h"
#include "diagnose/broken_sensors.h"
#include "diagnose/constants.h"
#include "diagnose/record_figures.h"
#include "evidence/log_scatter.h"
#include "faults/record.h"
#include "faults/registry.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

double usual_spread(FigureKind kind) {
  switch (kind) {
    case FigureKind::supply_level:
      return k::spread_of_level;
    case FigureKind::supply_step:
      return k::spread_of_step;
    case FigureKind::supply_left:
      return k::spread_of_left;
    case FigureKind::driver_gain:
    case FigureKind::driver_offset:
      return k::spread_of_driver;
    case FigureKind::driver_left:
      return k::spread_of_residue;
    case FigureKind::sensor_noise:
      return k::spread_of_noise;
  }
  return 1;
}

// A supply that holds better, a driver that errs less and a sensor that is quieter are no faults.
bool is_fault_on(FigureKind kind, bool above) {
  switch (kind) {
    case FigureKind::supply_left:
      return !above;
    case FigureKind::driver_left:
    case FigureKind::sensor_noise:
      return above;
    default:
      return true;
  }
}

// Whether a figure over its usual value is the fault's severity; the others say that something is wrong, and no size.
bool is_size(FigureKind kind) {
  return kind == FigureKind::supply_level || kind == FigureKind::supply_step || kind == FigureKind::driver_gain;
}

const RecordFigure* same(const RecordFigure& of, const std::vector<RecordFigure>& figures) {
  for (const RecordFigure& f : figures)
    if (f.kind == of.kind && f.signal == of.signal) return &f;
  return nullptr;
}

std::vector<double> healthy_values(const RecordFigure& of, const std::vector<std::vector<RecordFigure>>& healthy) {
  std::vector<double> out;
  for (const auto& log : healthy)
    if (const RecordFigure* f = same(of, log)) out.push_back(f->value);
  return out;
}

// A fault steps in where the figure was a healthy one before: what was wrong from the first sample on has no onset.
bool was_healthy_before(const RecordFigure& figure, const std::vector<std::vector<RecordFigure>>& healthy,
                        double rate) {
  if (!figure.before) return true;
  const Deviate d = deviate_of(*figure.before, healthy_values(figure, healthy),
                               {usual_spread(figure.kind), k::usual_logs}, figure.error);
  return 0.5 * student_tail(d.t, d.degrees) > rate;
}

std::optional<RecordFinding> compare(const RecordFigure& figure, const std::vector<std::vector<RecordFigure>>& healthy,
                                     double rate) {
  const std::vector<double> values = healthy_values(figure, healthy);
  const Deviate d = deviate_of(figure.value, values, {usual_spread(figure.kind), k::usual_logs}, figure.error);
  if (d.t == 0 || !is_fault_on(figure.kind, d.t > 0)) return {};
  double mean = 0;
  for (const double v : values) mean += std::log(v) / static_cast<double>(values.size());
  RecordFinding out;
  out.fault = fault_told_by(record_of(figure.kind));
  out.figure = figure.kind, out.signal = figure.signal;
  out.value = figure.value, out.usual = std::exp(mean);
  const double spread = (std::log(figure.value) - mean) / d.t;
  const double factor = std::exp(student_quantile(1 - 0.95, d.degrees) * spread);
  out.severity = is_size(figure.kind) ? out.value / out.usual : std::nan("");
  out.lower = out.severity / factor, out.upper = out.severity * factor;
  out.chance = 0.5 * student_tail(d.t, d.degrees);
  if (was_healthy_before(figure, healthy, rate)) out.since = figure.since;
  return out;
}

}  // namespace

std::vector<RecordFinding> record_findings(const std::vector<RecordFigure>& figures,
                                           const std::vector<BrokenSensor>& broken,
                                           const std::vector<std::vector<RecordFigure>>& healthy, double rate) {
  std::vector<RecordFinding> out;
  for (const BrokenSensor& b : broken) {
    RecordFinding f;
    f.fault = fault_told_by(Record::sensor), f.broken = b.finding, f.signal = b.signal;
    f.severity = f.lower = f.upper = std::nan("");
    out.push_back(f);
  }
  const double each = figures.empty() ? rate : rate / static_cast<double>(figures.size());
  for (const RecordFigure& figure : figures)
    if (const auto f = compare(figure, healthy, each); f && f->chance <= each) out.push_back(*f);
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.chance < b.chance; });
  return out;
}

}  // namespace servodx
