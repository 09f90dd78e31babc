// A run, and all candidates of a log that follow its steps (simulate/followers.h): it leads by a stretch of samples, of
// which two are kept, the one that is made and the one that is followed. Any follower may be moved by any thread, and
// its bits do not depend on its company. Not for test stands: their steps hold the piston, and are not told of.
// Included only by the translation units that instantiate it.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "simulate/flush_tiny.h"
#include "simulate/followers.h"
#include "simulate/gradient.h"
#include "simulate/kernels.h"
#include "simulate/pack_run.h"
#include "simulate/scenario.h"
#include "simulate/step_recorder.h"

namespace servodx {

// T: packs of doubles in which the runs are; F: of floats, twice as many.
template <class T, class F, class Effects>
class RunAndFollowers : public NearRuns {
 public:
  using G = Gradient<double, Effects>;

  static std::unique_ptr<NearRuns> make(const Scenario& in, const ParameterVector& base, Trajectory& of_base,
                                        const ParameterVector* const* candidates, Trajectory* const* results, int count,
                                        const SimulateOptions& options) {
    return std::make_unique<RunAndFollowers>(in, base, of_base, candidates, results, count, options);
  }
  RunAndFollowers(const Scenario& in, const ParameterVector& base, Trajectory& of_base,
                  const ParameterVector* const* candidates, Trajectory* const* results, int count,
                  const SimulateOptions& options)
      : results_(results, results + count), base_(&base), of_base_(&of_base), run_(in, &base_, &of_base_, 1, options) {
    for (int first = 0; first < count; first += F::lanes)
      followers_.push_back(std::make_unique<Followers<T, F, Effects>>(
          run_, in, candidates + first, results_.data() + first, std::min(count - first, F::lanes), options));
    std::array<bool, G::entries> wanted{};
    for (int i = 0; i < G::n; ++i) std::fill_n(wanted.begin() + G::layout.first[i], G::layout.moving[i], true);
    for (const auto& f : followers_) run_.sticks |= f->sticks(), f->ask_for(wanted);
    // Breakaway is followed by all or none: what it remembers is compared.
    for (const auto& f : followers_)
      if (run_.sticks) f->stick();
    for (auto& r : recorded_)
      for (int e = 0; e < G::entries; ++e)
        if (wanted[e]) r.wanted.push_back(e);
  }

  int followers() const override { return static_cast<int>(followers_.size()); }
  bool lead(int steps) override {
    auto& r = recorded_[next_];
    r.forget();
    while (r.steps() < steps && run_.under_way()) run_.next(r), r.sample();
    return r.samples() > 0;
  }
  void follow(int f) override {
    const FlushTiny flush;
    const auto& r = recorded_[1 - next_];
    for (std::size_t k = 0; k < r.samples(); ++k) followers_[f]->next(r.steps_to(k));
  }
  void turn() override { next_ = 1 - next_; }
  void end() override {
    if (!of_base_->ok)
      for (Trajectory* t : results_)
        if (t->ok) t->ok = false, t->failed_at = of_base_->failed_at;
  }

 private:
  std::vector<Trajectory*> results_;
  const ParameterVector* base_;
  Trajectory* of_base_;
  Run<T, Effects> run_;
  std::vector<std::unique_ptr<Followers<T, F, Effects>>> followers_;
  std::array<StepRecorder<T, Effects>, 2> recorded_;
  int next_ = 0;
};

}  // namespace servodx
