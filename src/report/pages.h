// The page of each command: its result struct in, verdict first, then the parts that show why.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "diagnose/baseline.h"
#include "diagnose/diagnose.h"
#include "diagnose/judge.h"
#include "fit/bode.h"
#include "fit/replay.h"
#include "report/certificate_part.h"
#include "report/json.h"
#include "report/page.h"
#include "report/tune_words.h"
#include "report/two_tests.h"
#include "tune/tune.h"

namespace servodx::report {

// Logs whose traces a page shows at most; of the rest it shows the figures.
inline constexpr std::size_t most_replays = 12;

// What stands beside a verdict about one log.
struct BesideVerdict {
  std::optional<TwoTests> last;  // since the last test of this valve
  std::vector<Bode> bodes;       // of the valve as tuned, and as this log has it
};

// `replays`: of some of the result's logs, by path; what is not there is not drawn.
Page tune_page(const Header& header, const TuneResult& result, const GoodEnough& good,
               const std::vector<Replay>& replays);
Page simulate_page(const Header& header, const Replay& replay);
Page baseline_page(const Header& header, const DetectionBaseline& baseline, const std::vector<Replay>& replays);
// `truths`: what each log was made with, "" where that is not known; they enter the confusion table and nothing else.
Page diagnose_page(const Header& header, const std::vector<Diagnosis>& results, const DetectionBaseline& baseline,
                   const std::vector<Replay>& replays, const std::vector<std::string>& truths = {},
                   const CertificateOf& certificate = {}, const BesideVerdict& beside = {});

}  // namespace servodx::report
