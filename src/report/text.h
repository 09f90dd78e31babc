// Results as text that a person reads in ten seconds: the verdict first, then what it rests on.
#pragma once
#include <string>
#include <vector>

#include "diagnose/baseline.h"
#include "diagnose/diagnose.h"
#include "diagnose/judge.h"
#include "report/call_names.h"
#include "report/tune_words.h"
#include "tune/tune.h"

namespace servodx::report {

struct TextOptions {
  bool colour = false;     // the verdict's word, for a terminal
  std::string written_to;  // the command's output file, if any
  CallNames call = {};     // of the calls that are advised
};

std::string text_of(const TuneResult& result, const GoodEnough& good, const TextOptions& options);
std::string text_of(const DetectionBaseline& baseline, const TextOptions& options);
std::string text_of(const Diagnosis& diagnosis, const TextOptions& options);

}  // namespace servodx::report
