#include "diagnose/diagnose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/progress.h"
#include "diagnose/hypotheses.h"
#include "fit/nominal.h"

namespace servodx {
namespace {

// How the two ways of being unlike health are brought to one scale: the root of a likelihood gain is a normal deviate;
// the log of the worst channel's adequacy scatters by about this much among healthy logs of different excitation.
constexpr double adequacy_spread = 0.3;

double worst_adequacy(const HypothesisFit& f) {
  return f.channel_adequacy.empty() ? 1e3 : *std::max_element(f.channel_adequacy.begin(), f.channel_adequacy.end());
}

std::string_view label(const HypothesisFit& f) { return f.fault ? f.fault->name : std::string_view("healthy"); }

ParameterVector candidate_at(const LogData& log, const ParameterVector& base, const HypothesisFit& f) {
  return FitProblem({&log}, base, f.free).candidate(f.point, 0);
}

// A fault's model is a textbook model too: its own error is some tenth of its effect. Two hypotheses that both explain
// a large effect to within that are not told apart by what is left.
constexpr double effect_error = 0.1;

// What one unit of misfit is worth: 1 where the best hypothesis fits as well as on the tuning logs, more where it does
// not, or where the effect to be explained is large.
double misfit_scale(double healthy, double best, double degrees) {
  return std::max(1.0, best / degrees) + effect_error * effect_error * std::max(0.0, healthy - best) / degrees;
}

constexpr std::size_t shortest_part = 200;  // samples on either side of a change

struct ChangePoint {
  std::size_t at = 0;
  bool found = false;
};

// One change of variance of the healthy residual: quiet before, at least twice as large (rms) after.
ChangePoint change_point(const std::vector<double>& square, double degrees) {
  const std::size_t n = square.size();
  std::vector<double> sum(n + 1, 0.0);
  for (std::size_t k = 0; k < n; ++k) sum[k + 1] = sum[k] + square[k];
  const auto margin = std::max(shortest_part, n / 10);  // either part must be able to speak for itself
  if (n < 4 * margin || sum[n] <= 0) return {};
  ChangePoint best;
  double best_cost = static_cast<double>(n) * std::log(sum[n] / static_cast<double>(n)), whole = best_cost;
  for (std::size_t k = margin; k + margin <= n; ++k) {
    const double before = sum[k] / static_cast<double>(k), after = (sum[n] - sum[k]) / static_cast<double>(n - k);
    if (after < 4 * before || before <= 0) continue;
    const double cost = static_cast<double>(k) * std::log(before) + static_cast<double>(n - k) * std::log(after);
    if (cost < best_cost) best_cost = cost, best = {k, true};
  }
  // Scaled to independent samples; 30 is far beyond what a healthy log's own restlessness makes.
  best.found = best.found && (whole - best_cost) * degrees / static_cast<double>(n) / 4.0 > 30.0;
  return best;
}

// The wire holds the spool against the torque; without it the spool runs to its stops, both of them, at any current.
std::string gross_finding(const LogData& log, const ParameterVector& base) {
  const auto spool = std::find_if(log.channels.begin(), log.channels.end(),
                                  [](const FitChannel& c) { return c.signal == Signal::spool_position; });
  if (spool == log.channels.end()) return "";
  const double stop = 0.95 * base[row::spool_stop], small = 0.5 * log.scenario.rated_current;
  long up = 0, down = 0, n = 0, quiet = 0;
  double lowest = 1e300, highest = -1e300, command_low = 1e300, command_high = -1e300;
  for (std::size_t k = 0; k < spool->measured.size(); ++k) {
    const double x = spool->measured[k],
                 i = log.scenario.command[k] + base[row::servovalve_null] * log.scenario.rated_current;
    if (std::isnan(x)) continue;
    ++n;
    lowest = std::min(lowest, x), highest = std::max(highest, x);
    command_low = std::min(command_low, i), command_high = std::max(command_high, i);
    if (std::abs(i) > small) continue;
    ++quiet;
    up += x > stop;
    down += x < -stop;
  }
  if (n == 0) return "";
  if (up > quiet / 50 && down > quiet / 50) return "spool on both stops at small current";
  if (up > quiet / 4 || down > quiet / 4) return "spool on one stop at small current";
  const double asked = (command_high - command_low) / log.scenario.rated_current * base[row::spool_stop];
  if (asked > 0.05 * base[row::spool_stop] && highest - lowest < 0.02 * asked) return "the spool does not respond";
  return "";
}

}  // namespace

Assessment assess(const Log& log, const Table& tuned, const RigFile& rig, const DiagnoseOptions& options) {
  Assessment out;
  out.log = log.path;
  out.sha256 = log.sha256;
  out.notes = log.notes;
  const LogData data = prepare(log, rig, moving_average_of(tuned));
  require_channels(data);
  const ErrorModel error = error_model_of(tuned);
  if (error.channels.empty())
    throw InputError({.file = tuned.path}, "the table does not say how wrong its model is",
                     "make it with 'servodx tune'; its header carries the lines 'model error ...'");
  const ParameterVector base = candidate_of(tuned);
  HypothesisSettings settings;
  settings.null_limit = rig.null_limit;
  settings.threads = options.threads;
  settings.stop = options.stop;
  out.test = conditions_of(log);
  // A change in mid-log has its parts judged alone: about a third as much again, where the log is long enough.
  const double first_part = data.scenario.time.size() >= 4 * shortest_part ? 0.75 : 1.0;
  if (options.progress)
    settings.progress = [&](double part, long simulations) { options.progress(first_part * part, simulations); };
  HypothesisFits h = fit_hypotheses(data, base, error, settings);
  out.simulations = h.simulations;
  out.failed_simulations = h.failed;
  settings.progress = {};
  if (options.stop && options.stop->load()) return out;
  out.gross = gross_finding(data, base);
  for (std::size_t c = 0; c < data.channels.size() && c < h.fits.front().channel_rms.size(); ++c)
    out.channels.push_back({data.channels[c].signal, log.channels[index(data.channels[c].signal)].unit,
                            h.fits.front().channel_rms[c], data.channels[c].noise, h.fits.front().channel_rms[c]});

  const auto explain = [&](const HypothesisFit& f, std::size_t from) {
    if (f.ok) out.explanations.push_back({std::string(label(f)), candidate_at(data, base, f), from});
  };

  // A fault that steps in: before it the log is healthy, after it the hypotheses are judged on what is left.
  std::vector<std::size_t> changes;
  if (const ChangePoint c = change_point(h.healthy_square, h.degrees); c.found) changes.push_back(c.at);
  // A large one drags the nuisances of the whole log along, and nothing is quiet: health is asked of the beginning too.
  if (const std::size_t n = data.scenario.time.size(); n >= 4 * shortest_part) {
    const std::vector<double> square = square_beyond_beginning(data, std::max(shortest_part, n / 4), base, error,
                                                               settings, &out.simulations, &out.failed_simulations);
    const ChangePoint c = square.empty() ? ChangePoint{} : change_point(square, h.degrees);
    if (c.found && (changes.empty() || changes.front() != c.at)) changes.push_back(c.at);
  }
  const auto best_misfit = [](const HypothesisFits& f) {
    double m = 1e300;
    for (const HypothesisFit& fit : f.fits) m = std::min(m, fit.misfit);
    return m;
  };
  std::size_t judged_from = 0;
  for (const std::size_t at : changes) {
    HypothesisFits before = fit_hypotheses(slice(data, 0, at), base, error, settings);
    HypothesisFits after = fit_hypotheses(slice(data, at, data.scenario.time.size()), base, error, settings);
    out.simulations += before.simulations + after.simulations;
    out.failed_simulations += before.failed + after.failed;
    const double whole = best_misfit(h), split = before.fits.front().misfit + best_misfit(after);
    const double scale = std::max(1.0, split / h.degrees);
    // What was gone before cannot be the fault that is there after: that fault gains next to nothing before.
    std::size_t fault = 0;
    for (std::size_t k = 1; k < after.fits.size(); ++k)
      if (after.fits[k].misfit < after.fits[fault].misfit) fault = k;
    const double gain_before = before.fits.front().misfit - before.fits[fault].misfit;
    const double gain_after = after.fits.front().misfit - after.fits[fault].misfit;
    // A second set of nuisances and a time were bought: they must pay for themselves.
    if (gain_after / scale > 25.0 && gain_before < 0.1 * gain_after && (whole - split) / scale > 25.0) {
      out.onset = data.scenario.time[at];
      judged_from = at;
      explain(before.fits.front(), 0);
      h = std::move(after);
      break;
    }
  }

  for (const HypothesisFit& f : h.fits)
    if (f.fault || !out.onset) explain(f, judged_from);

  const HypothesisFit& healthy = h.fits.front();
  const double smallest = best_misfit(h);
  const double scale = std::max(1.0, smallest / h.degrees);
  const double separation = misfit_scale(healthy.misfit, smallest, h.degrees);
  const auto weight = [&](const HypothesisFit& f) {
    return (f.fault ? f.fault->prior : 1.0) * std::exp(-0.5 * (f.misfit - smallest) / separation);
  };
  double total = 0;
  for (const HypothesisFit& f : h.fits) total += weight(f);
  for (const HypothesisFit& f : h.fits) {
    HypothesisResult r;
    r.name = label(f);
    r.meaning = f.fault ? std::string(f.fault->meaning) : "as the fault-free logs, within every fault's tolerance";
    r.misfit = f.misfit;
    r.gain = f.ok ? (healthy.misfit - f.misfit) / scale : 0.0;
    r.probability = weight(f) / total;
    r.severity = f.severity;
    r.severity_lower = std::min(f.severity_lower, f.severity_upper);
    r.severity_upper = std::max(f.severity_lower, f.severity_upper);
    r.unit = f.fault ? std::string(f.fault->unit) : "";
    r.at_least = f.at_least;
    r.adequacy = worst_adequacy(f);
    if (f.ok) r.null = candidate_at(data, base, f)[row::servovalve_null];
    r.moved = moved_rows(f, data, base, tuned);
    r.stops = f.stops;
    out.hypotheses.push_back(std::move(r));
  }
  std::stable_sort(out.hypotheses.begin() + 1, out.hypotheses.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });

  return out;
}

double score_of(const Assessment& a, const std::map<std::string, double>& usual) {
  double score = std::log(std::max(1.0, a.hypotheses.front().adequacy)) / adequacy_spread;
  for (const HypothesisResult& h : a.hypotheses) {
    const auto known = usual.find(h.name);
    const double of_health = known == usual.end() ? 0.0 : known->second;
    score = std::max(score, std::sqrt(std::max(0.0, h.gain) / (1.0 + of_health)));
  }
  return a.gross.empty() ? score : std::max(score, 1e3);
}

std::map<std::string, double> usual_gains(const Baseline& baseline, int left_out) {
  std::map<std::string, double> usual;
  for (std::size_t i = 0; i < baseline.scores.size(); ++i)
    if (static_cast<int>(i) != left_out)
      for (const auto& [fault, gain] : baseline.scores[i].gains) usual[fault] += std::max(0.0, gain);
  const auto logs = static_cast<double>(baseline.scores.size()) - (left_out >= 0 ? 1.0 : 0.0);
  for (auto& [fault, gain] : usual) gain /= logs;
  return usual;
}

Baseline make_baseline(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig, double false_alarm,
                       const DiagnoseOptions& options, long* simulations, long* failed) {
  if (!(false_alarm > 0 && false_alarm < 1))
    throw InputError({.file = "--false-alarm"}, fmt::format("{} is not a rate", false_alarm),
                     "give a number between 0 and 1, such as 0.01");
  const std::vector<std::string> used = tuned_by(tuned);
  for (std::size_t i = 0; i < logs.size(); ++i) {
    if (std::find(used.begin(), used.end(), logs[i].sha256) != used.end())
      throw InputError({.file = logs[i].path},
                       "this log tuned " + tuned.path + ": its residual is smaller than a new log's",
                       "give fault-free logs that the fit has not seen");
    for (std::size_t j = 0; j < i; ++j)
      if (logs[j].sha256 == logs[i].sha256)
        throw InputError({.file = logs[i].path}, "the same log as " + logs[j].path,
                         "give each log once: the rate counts independent logs");
  }
  if (logs.size() < 3)
    throw InputError({}, fmt::format("{} logs cannot set a threshold", logs.size()),
                     "give at least 3 fault-free logs; the rate that can be promised is 1/(n+1)");
  Baseline b;
  b.asked = false_alarm;
  b.logs = static_cast<int>(logs.size());
  b.null_limit = rig.null_limit;
  b.tuned_sha256 = tuned.sha256;
  Progress progress("baseline", {.quiet = options.quiet});
  long total = 0;
  std::vector<Assessment> judged;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    DiagnoseOptions of_log = options;
    of_log.progress = [&](double part, long so_far) {
      progress.update((static_cast<double>(i) + part) / static_cast<double>(logs.size()), total + so_far);
    };
    const Assessment a = assess(logs[i], tuned, rig, of_log);
    if (options.stop && options.stop->load()) break;
    b.scores.push_back({a.log,
                        a.sha256,
                        0.0,
                        a.hypotheses.front().adequacy,
                        {},
                        a.test,
                        a.explanations.empty() ? Candidate{} : a.explanations.front()});
    for (const HypothesisResult& h : a.hypotheses)
      if (h.name != "healthy") b.scores.back().gains[h.name] = h.gain;
    judged.push_back(a);
    b.adequacy_limit = std::max(b.adequacy_limit, a.hypotheses.front().adequacy);
    total += a.simulations;
    if (simulations) *simulations += a.simulations;
    if (failed) *failed += a.failed_simulations;
    progress.update(static_cast<double>(i + 1) / static_cast<double>(logs.size()), total);
  }
  b.logs = static_cast<int>(b.scores.size());
  if (b.scores.empty()) return b;
  for (std::size_t i = 0; i < judged.size(); ++i)
    b.scores[i].score = score_of(judged[i], usual_gains(b, static_cast<int>(i)));
  std::vector<double> sorted;
  for (const Baseline::Score& s : b.scores) sorted.push_back(s.score);
  std::sort(sorted.begin(), sorted.end());
  const auto n = static_cast<double>(sorted.size());
  // A new log exchangeable with n healthy ones exceeds the k-th smallest with probability (n + 1 - k) / (n + 1).
  const auto k = static_cast<std::size_t>(std::min(n, std::ceil((1.0 - false_alarm) * (n + 1.0) - 1e-9)));
  b.threshold = sorted[k - 1];
  b.promised = (n + 1.0 - static_cast<double>(k)) / (n + 1.0);
  b.promised_95 = 1.0 - std::pow(0.05, 1.0 / n);
  b.logs_needed = static_cast<int>(std::ceil(1.0 / false_alarm - 1e-9)) - 1;
  b.statement = fmt::format(
      "{} fault-free logs promise a false-alarm rate of {:.1f} % on average over baselines (below {:.0f} % with 95 % "
      "confidence)",
      sorted.size(), 100 * b.promised, 100 * b.promised_95);
  if (b.promised > false_alarm + 1e-12)
    b.statement += fmt::format("; {:.3g} % takes {} logs, {} more", 100 * false_alarm, b.logs_needed,
                               b.logs_needed - static_cast<int>(sorted.size()));
  return b;
}

namespace {

std::optional<Diagnosis::Unlike> unlike_all(const TestConditions& test, const Baseline& baseline) {
  const Baseline::Score* nearest = nullptr;
  double least = HUGE_VAL;
  for (const Baseline::Score& s : baseline.scores) {
    if (!s.test) return {};  // made by an earlier version: nothing is known of its tests
    if (const double d = distance(test, *s.test); !nearest || d < least) least = d, nearest = &s;
  }
  if (!nearest || least <= 1) return {};
  return Diagnosis::Unlike{nearest->log, *nearest->test};
}

}  // namespace

Diagnosis judge(Assessment a, const Baseline& baseline) {
  constexpr double ambiguous_probability = 0.05;
  // A fault is known less well than health: its hypothesis may leave twice the worst error that healthy logs show, and
  // a quarter of what it has to explain.
  constexpr double fault_allowance = 2.0;
  constexpr double unexplained_part = 0.25;
  Diagnosis d;
  d.log = a.log;
  d.error = score_of(a, usual_gains(baseline));
  d.threshold = baseline.threshold;
  d.onset = a.onset;
  long above = 1;
  for (const Baseline::Score& s : baseline.scores) above += s.score >= d.error;
  d.p_value = static_cast<double>(above) / static_cast<double>(baseline.scores.size() + 1);
  d.baseline_logs = static_cast<int>(baseline.scores.size());
  d.unlike = unlike_all(a.test, baseline);
  for (const HypothesisResult& h : a.hypotheses) d.probabilities[h.name] = h.probability;
  const HypothesisResult* told = &a.hypotheses.front();  // health
  if (d.error <= baseline.threshold) {
    d.verdict = "healthy";
  } else {
    const HypothesisResult& best =
        *std::max_element(a.hypotheses.begin(), a.hypotheses.end(),
                          [](const auto& x, const auto& y) { return x.probability < y.probability; });
    const bool wire = a.gross == "spool on both stops at small current";
    const double to_explain = a.hypotheses.front().adequacy;  // healthy comes first
    const bool adequate = best.adequacy <= std::hypot(fault_allowance * std::max(1.0, baseline.adequacy_limit),
                                                      unexplained_part * to_explain);
    const HypothesisResult* named = nullptr;
    if (wire) {
      for (const HypothesisResult& h : a.hypotheses)
        if (h.name == "feedback_wire_lost") named = &h;
      for (auto& [name, p] : d.probabilities) p = name == "feedback_wire_lost" ? 1.0 : 0.0;
    } else if (adequate && best.name != "healthy") {
      named = &best;
    }
    told = named ? named : &best;
    if (!named) {
      d.verdict = "unknown";
      d.probabilities["unknown"] = 1.0;
      for (auto& [name, p] : d.probabilities)
        if (name != "unknown") p = 0.0;
    } else {
      d.verdict = "fault";
      d.fault = named->name;
      d.severity.value = wire ? 0.0 : named->severity;
      d.severity.lower = wire ? 0.0 : named->severity_lower;
      d.severity.upper = wire ? std::max(0.1, named->severity_upper) : named->severity_upper;
      d.severity.unit = named->unit;
      for (const auto& [name, p] : d.probabilities)
        if (name != *d.fault && p > ambiguous_probability) d.ambiguous_with.push_back(name);
      const Fault* fault = find_fault(*d.fault);
      if (fault) d.action = fault->action;
      if (fault && !d.ambiguous_with.empty()) d.separating_test = fault->test;
    }
  }
  d.told = told->name;
  d.null = told->null;
  d.moved = told->moved;
  d.assessment = std::move(a);
  return d;
}

}  // namespace servodx
