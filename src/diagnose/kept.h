// What a checkpoint keeps of the fits of hypotheses, field by field (base/bytes.h). A fault goes by its name.
#pragma once
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/bytes.h"
#include "diagnose/hypotheses.h"
#include "diagnose/hypothesis_fit.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "fit/fit_work.h"

namespace servodx {

template <>
struct Bytes<const Fault*> {
  static void write(std::string& to, const Fault* const& fault) {
    write_bytes(to, std::string(fault ? fault->name : ""));
  }
  static void read(ByteReader& from, const Fault*& fault) {
    std::string name;
    read_bytes(from, name);
    fault = name.empty() ? nullptr : find_fault(name);
    if (!fault && !name.empty()) from.refuse();
  }
};

inline auto fields(FaultSize& s) {
  auto& [fault, severity, lower, upper, at_least, at_worst, shapes] = s;
  return std::tie(fault, severity, lower, upper, at_least, at_worst, shapes);
}
// Without `free`, which follows from the hypothesis.
inline auto fields(HypothesisFit& f) {
  return std::tie(static_cast<FaultSize&>(f), f.beside, f.ok, f.misfit, f.point, f.standard_error, f.channel_adequacy,
                  f.channel_rms, f.stops, f.promised);
}
inline auto fields(Screened& s) {
  auto& [fault, severity, misfit, left, beside, gain, work] = s;
  return std::tie(fault, severity, misfit, left, beside, gain, work);
}

// What an attempt has come to.
struct KeptAttempt {
  HypothesisFit fit;
  std::vector<double> square;
  FitWork work;
};
inline auto fields(KeptAttempt& a) {
  auto& [fit, square, work] = a;
  return std::tie(fit, square, work);
}

}  // namespace servodx
