// What a checkpoint keeps of `explain` and of the healthy logs' scores, field by field (base/bytes.h).
//
// A fit is known by where it ended: its rows, a few megabytes, are made again from that point (SearchEnd). To keep them
// would take as long as to make them.
#pragma once
#include <tuple>

#include "base/bytes.h"
#include "base/stages.h"
#include "evidence/conditions.h"
#include "explain/cause_score.h"
#include "explain/healthy.h"
#include "explain/missing.h"
#include "explain/subject.h"
#include "explain/valve.h"
#include "fit/fit_work.h"
#include "optimise/box_least_squares.h"

namespace servodx {

inline auto fields(SearchEnd& e) {
  auto& [point, start_cost, promised, central, evaluations, failed, iterations, reason, stop] = e;
  return std::tie(point, start_cost, promised, central, evaluations, failed, iterations, reason, stop);
}
inline auto fields(ProbeScore& p) {
  auto& [size, std_error] = p;
  return std::tie(size, std_error);
}
inline auto fields(CauseScore& s) {
  auto& [cause, gain, alternative, probes, of] = s;
  return std::tie(cause, gain, alternative, probes, of);
}
inline auto fields(Miss& m) {
  auto& [part, size] = m;
  return std::tie(part, size);
}
inline auto fields(UsualError& e) {
  auto& [signal, size, memory, effective, rate] = e;
  return std::tie(signal, size, memory, effective, rate);
}
inline auto fields(KnownRig& k) {
  auto& [errors, air, command_slope, drive_delay] = k;
  return std::tie(errors, air, command_slope, drive_delay);
}
inline auto fields(TestConditions& t) {
  auto& [span, band, temperature, rms] = t;
  return std::tie(span, band, temperature, rms);
}
inline auto fields(HealthyScore& s) {
  auto& [effect, where, sizes, gain, prior, thickness] = s;
  return std::tie(effect, where, sizes, gain, prior, thickness);
}
inline auto fields(HealthyShare& s) {
  auto& [effect, where, share, lower, prior] = s;
  return std::tie(effect, where, share, lower, prior);
}
inline auto fields(HealthyLog& l) {  // sets_no_share goes by the suspects: not kept
  auto& [log, sha256, other, sets_no_share, test, adequacy, scores, misses, shares, has_shares, errors, air, slope,
         delay] = l;
  return std::tie(log, sha256, other, test, adequacy, scores, misses, shares, has_shares, errors, air, slope, delay);
}
inline auto fields(MissingInput& m) {
  auto& [where, quantity, unit, rms, std_error, gain, likely, variable, share, value, error] = m;
  return std::tie(where, quantity, unit, rms, std_error, gain, likely, variable, share, value, error);
}
inline auto fields(MissingInputs& m) {
  auto& [places, time] = m;
  return std::tie(places, time);
}

// What a stage came to, and the simulations that it took.
template <class T>
struct Counted {
  T made;
  long simulations = 0, failed = 0;
};
template <class T>
auto fields(Counted<T>& c) {
  return std::tie(c.made, c.simulations, c.failed);
}

// A stage of a fit whose work is `work`. Its simulations count, be they run now or not.
template <class Make, class... Input>
auto counted(FitWork& work, const Stages& stages, std::string_view name, const Make& make, const Input&... inputs) {
  if (!stages.keeps()) return make();
  const FitWork before = work;
  const auto with_work = [&] {
    Counted<std::invoke_result_t<Make>> out{make()};
    out.simulations = work.simulations - before.simulations, out.failed = work.failed - before.failed;
    return out;
  };
  auto kept = stages.made(name, with_work, inputs...);
  work = before;
  work.add({kept.simulations, kept.failed});
  return std::move(kept.made);
}

}  // namespace servodx
