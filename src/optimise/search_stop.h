// How a local search stopped, and the figures that tell it. Its words: report/shared/search_words.h.
#pragma once
#include <optional>
#include <tuple>

namespace servodx {

struct SearchStop {
  enum class How {
    not_run,  // nothing was searched
    // Our bounded search, and Ceres where it went on from there.
    start_failed,  // could not be evaluated
    converged,
    converged_to_rounding,  // of the cost: no step can lower what is still promised
    goal,                   // the misfit asked for
    stalled,                // no step that promises more than the tolerance lowers the cost
    too_slow,               // so many iterations together lowered it by less than a tenth
    iteration_limit,
    evaluation_limit,
    interrupted,  // on request
    // Ceres alone.
    ceres_converged,
    ceres_no_convergence,
    ceres_failure,
    ceres_interrupted,
    // NLopt's BOBYQA, after so many evaluations.
    bobyqa_cost_converged,
    bobyqa_step_converged,
    bobyqa_evaluation_limit,
    bobyqa_rounding,  // its model is rounding
    bobyqa_interrupted,
    bobyqa_gave_up,
    bobyqa_stopped  // by another criterion of NLopt
  };
  struct Figures {
    double cost = 0, gradient_cosine = 0, promised_gain = 0;
    bool operator==(const Figures&) const = default;
  };

  How how = How::not_run;
  long count = 0;                  // iterations or evaluations, where `how` speaks of some
  std::optional<Figures> at = {};  // where it stopped; none: nothing was measured there
  int missing_columns = 0;         // of the Jacobian that it stalled by

  bool operator==(const SearchStop&) const = default;
};
inline auto fields(SearchStop::Figures& f) {
  auto& [cost, gradient_cosine, promised_gain] = f;
  return std::tie(cost, gradient_cosine, promised_gain);
}
inline auto fields(SearchStop& s) {
  auto& [how, count, at, missing_columns] = s;
  return std::tie(how, count, at, missing_columns);
}

}  // namespace servodx
