// The page of `diagnose`: verdicts first, then the parts that show why.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "diagnose/baseline.h"
#include "diagnose/judge.h"
#include "report/diagnose/two_tests.h"
#include "report/shared/certificate_part.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "servodx/baseline.h"
#include "servodx/bode.h"
#include "servodx/diagnose.h"
#include "servodx/replay.h"

namespace servodx::report {

// What stands beside a verdict about one log.
struct BesideVerdict {
  std::optional<TwoTests> last;  // since the last test of this valve
  std::vector<Bode> bodes;       // of the valve as tuned, and as this log has it
};

// `replays`: of some of the result's logs, by path; what is not there is not drawn.
// `truths`: what each log was made with, "" where that is not known; they enter the confusion table and nothing else.
Page diagnose_page(const Header& header, const std::vector<Diagnosis>& results, const DetectionBaseline& baseline,
                   const std::vector<Replay>& replays, const std::vector<std::string>& truths = {},
                   const CertificateOf& certificate = {}, const BesideVerdict& beside = {});
// None of them interrupted.
Page diagnose_page(const Header& header, const std::vector<servodx::Verdict>& verdicts, const Baseline& baseline,
                   const std::vector<Replay>& replays, const std::vector<std::string>& truths = {},
                   const CertificateOf& certificate = {}, const BesideVerdict& beside = {});

}  // namespace servodx::report
