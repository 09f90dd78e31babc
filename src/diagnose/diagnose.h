// `baseline` and `diagnose`: is this log like the fault-free ones, and if not, which fault, how large, since when.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "diagnose/conditions.h"
#include "diagnose/moved.h"
#include "fit/error_model.h"
#include "fit/replay.h"
#include "fit/tune.h"
#include "parameters/table.h"
#include "signals/log.h"

namespace servodx {

struct DiagnoseOptions {
  std::uint64_t seed = 1;
  int threads = 0;
  bool quiet = false;
  const std::atomic<bool>* stop = nullptr;
  // Part of a log's work that is done, its simulations so far. From any thread.
  std::function<void(double part, long simulations)> progress = {};
};

struct HypothesisResult {
  std::string name;     // "healthy" or a fault's label
  std::string meaning;  // in words
  double misfit = 0;    // penalised -2 log likelihood
  double gain = 0;      // misfit of healthy less this one
  double probability = 0;
  double severity = 0, severity_lower = 0, severity_upper = 0;  // 95 %
  std::string unit;
  double adequacy = 0;               // whitened rms of the worst channel, 1 when like the healthy logs
  std::vector<std::string> stops;    // how each start ended
  bool at_least = false;             // at the mildest that is called this fault: the fit has found none of it
  double null = 0;                   // [fraction of rated]
  std::vector<MovedRow> moved = {};  // the fault's rows first
};

// What a log says before any threshold.
struct Assessment {
  std::string log, sha256;
  std::vector<HypothesisResult> hypotheses;  // healthy first, then by misfit
  std::vector<ChannelResult> channels;       // replay under health: rms beside noise
  std::string gross;                         // non-empty: seen without a fit (spool on its stop, no response)
  std::optional<double> onset;               // [s] change point where one stands out
  std::vector<Candidate> explanations;       // what each hypothesis that could be fitted says the log should be
  TestConditions test;
  std::vector<std::string> notes;
  long simulations = 0, failed_simulations = 0;
};

// Interrupted through options.stop, it returns at once with an assessment to be thrown away.
Assessment assess(const Log& log, const Table& tuned, const RigFile& rig, const DiagnoseOptions& options);

struct Baseline {
  double threshold = 0;
  double asked = 0.01, promised = 0, promised_95 = 0;  // false-alarm rates
  int logs = 0, logs_needed = 0;
  std::string statement;
  struct Score {
    std::string log, sha256;
    double score = 0, adequacy = 0;
    std::map<std::string, double> gains = {};  // of each fault over health
    std::optional<TestConditions> test = {};   // files of earlier versions have none
    Candidate healthy = {};                    // not in the file: for the report
  };
  std::vector<Score> scores;
  double adequacy_limit = 0;  // largest adequacy of a healthy log
  double null_limit = 0.05;
  std::string tuned_sha256;  // of the table it was made with
};

// Refuses logs that tuned the table (by hash) and fewer than three logs.
Baseline make_baseline(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig, double false_alarm,
                       const DiagnoseOptions& options, long* simulations = nullptr, long* failed = nullptr);

struct Diagnosis {
  std::string log;
  std::string verdict;  // healthy | fault | unknown
  double error = 0, threshold = 0, p_value = 1;
  int baseline_logs = 0;
  // Set where no log of the baseline is of a test like this one: the nearest. The threshold was set by other tests.
  struct Unlike {
    std::string log;
    TestConditions test;
  };
  std::optional<Unlike> unlike;
  std::optional<std::string> fault;  // label
  std::map<std::string, double> probabilities;
  std::vector<std::string> ambiguous_with;
  std::string separating_test;
  std::string action;
  struct {
    double value = 0, lower = 0, upper = 0;
    std::string unit;
  } severity;
  std::optional<double> onset;  // [s]
  std::string told;  // the hypothesis that null and rows are of: the verdict's; of an unknown state the nearest
  double null = 0;   // [fraction of rated]
  std::vector<MovedRow> moved;
  Assessment assessment;
};

// Detection statistic of a log: how far it is from health in deviates, by the fault that explains most or by what no
// fault explains. `usual`: what each fault gains on fault-free logs, on average; a fault that health shows too must
// gain the more.
double score_of(const Assessment& assessment, const std::map<std::string, double>& usual);

// Mean gain of each fault over the baseline's logs, but for log `left_out` (-1: none).
std::map<std::string, double> usual_gains(const Baseline& baseline, int left_out = -1);

Diagnosis judge(Assessment assessment, const Baseline& baseline);

}  // namespace servodx
