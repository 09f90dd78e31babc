// How a search stopped, as results and notes say it: outputs are compared to the character, so these are kept so.
#include "report/shared/search_words.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "diagnose/assessment.h"
#include "optimise/ceres_refinement.h"
#include "optimise/local.h"
#include "optimise/search_stop.h"
#include "report/diagnose/diagnosis_json.h"
#include "report/shared/json.h"
#include "report/tune/tune_json.h"
#include "report/tune/tune_words.h"
#include "servodx/note.h"
#include "tune/tune.h"

namespace servodx::report {
namespace {

using How = SearchStop::How;

TEST(SearchWords, AreTheSameToTheCharacter) {
  const struct {
    SearchStop stop;
    const char* words;
  } cases[] = {
      {{How::not_run}, "Ceres: not_run"},
      {{How::start_failed}, "the start point itself could not be evaluated"},
      {{How::converged}, "converged"},
      {{How::converged_to_rounding}, "converged to the rounding of the cost"},
      {{How::goal}, "the misfit goal was reached"},
      {{How::stalled}, "stalled: no step that promises more than the tolerance lowers the cost"},
      {{How::too_slow, 5}, "too slow: 5 iterations"},
      {{How::iteration_limit, 100}, "iteration limit of 100"},
      {{How::evaluation_limit, 2000}, "evaluation limit of 2000"},
      {{How::interrupted}, "interrupted on request"},
      {{How::ceres_converged}, "Ceres: converged"},
      {{How::ceres_no_convergence}, "Ceres: no_convergence"},
      {{How::ceres_failure}, "Ceres: failure"},
      {{How::ceres_interrupted}, "Ceres: interrupted"},
      {{How::bobyqa_cost_converged, 61}, "BOBYQA: converged in cost after 61 evaluations"},
      {{How::bobyqa_step_converged, 61}, "BOBYQA: converged in step after 61 evaluations"},
      {{How::bobyqa_evaluation_limit, 61}, "BOBYQA: evaluation limit after 61 evaluations"},
      {{How::bobyqa_rounding, 61}, "BOBYQA: rounding after 61 evaluations"},
      {{How::bobyqa_interrupted, 61}, "BOBYQA: interrupted after 61 evaluations"},
      {{How::bobyqa_gave_up, 61}, "BOBYQA: gave up after 61 evaluations (nlopt failure)"},
      {{How::bobyqa_stopped, 61}, "BOBYQA: stopped after 61 evaluations"},
      {{How::converged, 0, SearchStop::Figures{312.4567, 1.23456e-5, 0}},
       "converged; cost 312, gradient cosine 1.23e-05, promised gain 0"},
      {{How::iteration_limit, 12, SearchStop::Figures{1234567, 0.0123, std::numeric_limits<double>::infinity()}},
       "iteration limit of 12; cost 1.23e+06, gradient cosine 0.0123, promised gain inf"},
      {{How::stalled, 0, SearchStop::Figures{1, 0.5, 0.25}, 2},
       "stalled: no step that promises more than the tolerance lowers the cost; cost 1, gradient cosine 0.5, promised "
       "gain 0.25, 2 Jacobian columns missing"},
  };
  int next = 0;  // each way to stop has its words
  for (const auto& c : cases) {
    EXPECT_EQ(words_of(c.stop), c.words);
    next += static_cast<int>(c.stop.how) == next;
  }
  EXPECT_EQ(next, static_cast<int>(How::bobyqa_stopped) + 1);
}

TEST(SearchWords, StandInTheResultOfADiagnosis) {
  HypothesisResult h;
  h.stops = {{How::iteration_limit, 12, SearchStop::Figures{3, 0.5, 0.25}}};
  EXPECT_EQ(to_json(h)["stops"],
            Json::array({"iteration limit of 12; cost 3, gradient cosine 0.5, promised gain 0.25"}));
  EXPECT_EQ(to_json(HypothesisResult{})["stops"], Json::array());
}

TEST(SearchWords, CeresHasAWordForEachEnd) {
  const std::pair<CeresEnd, const char*> words[] = {{CeresEnd::not_run, "not_run"},
                                                    {CeresEnd::converged, "converged"},
                                                    {CeresEnd::no_convergence, "no_convergence"},
                                                    {CeresEnd::failure, "failure"},
                                                    {CeresEnd::interrupted, "interrupted"}};
  for (const auto& [end, word] : words) {
    TuneResult result;
    result.ceres.end = end;
    EXPECT_EQ(tune_json(result)["local"]["ceres"]["end"], word);
  }
}

TEST(SearchWords, ATuneTellsHowItsSearchEndedBetweenItsOtherNotes) {
  TuneResult result;
  result.notes = {{Note::Kind::gaps, "a gap"}};
  result.notes_by_log = {{Note::Kind::command_slope, "held"}};
  result.search_end = {How::converged, 0, SearchStop::Figures{3, 0.5, 0.25}};
  const Note gaps = result.notes.front(), slope = result.notes_by_log.front();
  const Note ended{Note::Kind::search_end, "local stage: converged; cost 3, gradient cosine 0.5, promised gain 0.25"};
  EXPECT_EQ(notes_of(result), (std::vector<Note>{gaps, ended, slope}));

  // The errors of the rows are a stage behind the search, and have no cost.
  result.stages = {{{Stage::Kind::everything}, StageMethod::nlopt, 20.123, 18.5},
                   {{Stage::Kind::errors}, StageMethod::none, std::nan(""), std::nan("")}};
  result.distrust = Distrust::missing_columns;
  EXPECT_EQ(notes_of(result)[2], (Note{Note::Kind::derivatives,
                                       "derivatives were not to be trusted (some could not be had): BOBYQA went on "
                                       "without them, cost 20.12 to 18.5"}));
  result.distrust = Distrust::broken_promise;
  EXPECT_NE(notes_of(result)[2].text.find("(no step kept what they promised)"), std::string::npos);
}

}  // namespace
}  // namespace servodx::report
