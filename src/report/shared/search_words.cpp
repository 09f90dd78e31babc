#include "report/shared/search_words.h"

#include <fmt/format.h>

namespace servodx::report {
namespace {

std::string how_in_words(const SearchStop& stop) {
  using How = SearchStop::How;
  const auto ceres = [](CeresEnd end) { return "Ceres: " + word_of(end); };
  const auto bobyqa = [&](const char* why) { return fmt::format("BOBYQA: {} after {} evaluations", why, stop.count); };
  switch (stop.how) {
    case How::not_run:
      return ceres(CeresEnd::not_run);
    case How::start_failed:
      return "the start point itself could not be evaluated";
    case How::converged:
      return "converged";
    case How::converged_to_rounding:
      return "converged to the rounding of the cost";
    case How::goal:
      return "the misfit goal was reached";
    case How::stalled:
      return "stalled: no step that promises more than the tolerance lowers the cost";
    case How::too_slow:
      return fmt::format("too slow: {} iterations", stop.count);
    case How::iteration_limit:
      return fmt::format("iteration limit of {}", stop.count);
    case How::evaluation_limit:
      return fmt::format("evaluation limit of {}", stop.count);
    case How::interrupted:
      return "interrupted on request";
    case How::ceres_converged:
      return ceres(CeresEnd::converged);
    case How::ceres_no_convergence:
      return ceres(CeresEnd::no_convergence);
    case How::ceres_failure:
      return ceres(CeresEnd::failure);
    case How::ceres_interrupted:
      return ceres(CeresEnd::interrupted);
    case How::bobyqa_cost_converged:
      return bobyqa("converged in cost");
    case How::bobyqa_step_converged:
      return bobyqa("converged in step");
    case How::bobyqa_evaluation_limit:
      return bobyqa("evaluation limit");
    case How::bobyqa_rounding:
      return bobyqa("rounding");
    case How::bobyqa_interrupted:
      return bobyqa("interrupted");
    case How::bobyqa_gave_up:
      return bobyqa("gave up") + " (nlopt failure)";
    case How::bobyqa_stopped:
      return bobyqa("stopped");
  }
  return "";
}

}  // namespace

std::string word_of(CeresEnd end) {
  switch (end) {
    case CeresEnd::not_run:
      return "not_run";
    case CeresEnd::converged:
      return "converged";
    case CeresEnd::no_convergence:
      return "no_convergence";
    case CeresEnd::failure:
      return "failure";
    case CeresEnd::interrupted:
      return "interrupted";
  }
  return "";
}

std::string words_of(const SearchStop& stop) {
  std::string text = how_in_words(stop);
  if (stop.at)
    text += fmt::format("; cost {:.3g}, gradient cosine {:.3g}, promised gain {:.3g}", stop.at->cost,
                        stop.at->gradient_cosine, stop.at->promised_gain);
  if (stop.missing_columns > 0) text += fmt::format(", {} Jacobian columns missing", stop.missing_columns);
  return text;
}

}  // namespace servodx::report
