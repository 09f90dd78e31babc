// The engine on models of a line or two: what is there is found and measured, what is not is not.
#include "explain/engine.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "explain/cause_score.h"
#include "explain/deviance.h"
#include "explain/fit_causes.h"
#include "explain/outcome.h"
#include "explain/subject.h"
#include "explain/ties.h"
#include "optimise/box_least_squares.h"
#include "optimise/unit_cube.h"

namespace servodx {
namespace {

// y = a + b t, and causes that add c f(t). Noise is white with the weights known.
class Line : public Subject {
 public:
  struct Shape {
    const char *name, *where;
    double (*f)(double);
  };
  Line(std::vector<Shape> shapes, std::uint64_t seed, int planted, double size, int n = 600)
      : shapes_(std::move(shapes)),
        time_(static_cast<std::size_t>(n)),
        y_(n),
        sigma_(static_cast<std::size_t>(n), 1.0) {
    Random random(seed);
    for (int k = 0; k < n; ++k) {
      const double t = k / static_cast<double>(n);
      time_[static_cast<std::size_t>(k)] = t;
      y_[k] =
          1.0 + 2.0 * t + random.normal() + (planted >= 0 ? size * shapes_[static_cast<std::size_t>(planted)].f(t) : 0);
    }
    for (const Shape& s : shapes_)
      causes_.push_back({s.name, s.where, "", 1.0, {Number{{s.name, "-", -50, 50}}}, {{{1.0}}}});
    series_.push_back({"y", "-", 0, 0, n, &time_, &sigma_, 1.0, 1.0});
  }
  const std::vector<Cause>& causes() const override { return causes_; }
  const std::vector<Series>& series() const override { return series_; }
  void make_rare(std::size_t cause) { causes_[cause].prior = 0.1; }
  SubjectFit fit(const std::vector<int>& causes, bool) const override {
    SubjectFit out;
    out.numbers = {{{"a", "-", -10, 10, false, 0}, 0}, {{"b", "-", -10, 10, false, 0}, 0}};
    for (int c : causes) out.numbers.push_back(causes_[static_cast<std::size_t>(c)].numbers[0]);
    for (const Number& n : out.numbers) out.start.push_back(n.to_unit(n.off));
    out.problem.n = static_cast<int>(out.numbers.size());
    out.problem.evaluate = [this, causes, numbers = out.numbers](std::span<const Point> points) {
      std::vector<Evaluation> e(points.size());
      for (std::size_t i = 0; i < points.size(); ++i) {
        e[i].residual.resize(y_.size());
        for (long k = 0; k < y_.size(); ++k) {
          const double t = time_[static_cast<std::size_t>(k)];
          double m = numbers[0].from_unit(points[i][0]) + numbers[1].from_unit(points[i][1]) * t;
          for (std::size_t c = 0; c < causes.size(); ++c)
            m += numbers[2 + c].from_unit(points[i][2 + c]) * shapes_[static_cast<std::size_t>(causes[c])].f(t);
          e[i].residual[k] = y_[k] - m;
        }
      }
      return e;
    };
    return out;
  }

 private:
  std::vector<Shape> shapes_;
  std::vector<double> time_;
  Eigen::VectorXd y_;
  std::vector<double> sigma_;
  std::vector<Cause> causes_;
  std::vector<Series> series_;
};

const std::vector<Line::Shape> shapes = {{"wave", "here", [](double t) { return std::sin(40 * t); }},
                                         {"slow wave", "here", [](double t) { return std::sin(13 * t); }},
                                         {"kink", "there", [](double t) { return std::abs(t - 0.5); }},
                                         {"same wave", "there", [](double t) { return 2 * std::sin(40 * t + 0.05); }},
                                         {"a line again", "here", [](double t) { return 3 * t - 1; }}};

TEST(Engine, PlantedCauseIsNamedPlacedAndSized) {
  int named = 0, inside = 0;
  constexpr int trials = 20;
  for (int seed = 0; seed < trials; ++seed) {
    Line line({shapes[0], shapes[1], shapes[2], shapes[4]}, static_cast<std::uint64_t>(seed), 1, 0.5);
    const FoundCauses e = explain(line, {});
    if (e.causes.empty()) continue;
    named += line.causes()[static_cast<std::size_t>(e.causes[0].cause)].effect == "slow wave";
    inside += std::abs(e.causes[0].value[0] - 0.5) < 1.645 * e.causes[0].std_error[0];
  }
  EXPECT_GE(named, trials - 2);
  EXPECT_GE(inside, trials - 6);  // 90 % intervals
  EXPECT_LT(inside, trials + 1);
}

TEST(Engine, WhatFitsAsWellIsSaidToBeConfusable) {
  Line line({shapes[0], shapes[3]}, 3, 0, 1.0);
  const FoundCauses e = explain(line, {});
  ASSERT_EQ(e.causes.size(), 1u);
  EXPECT_EQ(e.causes[0].confusable_with.size(), 1u);
}

TEST(Engine, CauseThatTheFreeNumbersImitateScoresNothing) {
  Line line(shapes, 5, 4, 2.0);  // a line, in a model that has a line, and within its bounds
  const FoundCauses e = explain(line, {});
  EXPECT_TRUE(e.causes.empty());
  EXPECT_LT(e.scores[4].gain, 1e-6);
}

// Three knots of which the data show two: the third lies on their line. Without the tie it stays where it began.
TEST(Engine, TiesCarryACurveStraightOnWhereTheDataDoNotReach) {
  Cause cause;
  cause.numbers.assign(3, {{"knot", "-", -10, 10, false, 0.0}, 0.0});
  cause.ties = {{1 / 0.1, -2 / 0.1, 1 / 0.1}};
  for (const bool exact : {false, true}) {
    SubjectFit fit;
    fit.numbers = cause.numbers;
    fit.start = {0.5, 0.5, 0.5};
    fit.problem.n = 3;
    fit.problem.evaluate = [n = cause.numbers[0]](std::span<const Point> points) {
      std::vector<Evaluation> e(points.size());
      for (std::size_t k = 0; k < points.size(); ++k) {
        e[k].ok = true;
        e[k].residual = Eigen::Vector2d((n.from_unit(points[k][0]) - 1) / 0.01, (n.from_unit(points[k][1]) - 2) / 0.01);
      }
      return e;
    };
    if (exact)
      fit.problem.jacobian = [](const Point&, const Eigen::VectorXd&, Eigen::MatrixXd& j) {
        j.setZero(2, 3);
        j(0, 0) = j(1, 1) = 20 / 0.01;
        return true;
      };
    tie(fit, {cause}, {0});
    const LeastSquaresResult r = minimise_least_squares(fit.problem, fit.start, {});
    EXPECT_NEAR(cause.numbers[2].from_unit(r.point[2]), 3, 1e-3) << exact;
    EXPECT_NEAR(cause.numbers[1].from_unit(r.point[1]), 2, 1e-3) << exact;
  }
}

// What is planted is a wave of 1 and a kink of 6; the list names the two, and their sum.
const std::vector<Line::Shape> wave_and_kink = {
    shapes[0], shapes[2], {"sum", "", [](double t) { return std::sin(40 * t) + 6 * std::abs(t - 0.5); }}};

TEST(Engine, TwoCausesAreBothFound) {
  Line line(wave_and_kink, 11, 2, 1.0);
  EngineOptions o;
  o.among = [](const Cause& c) { return c.effect != "sum"; };
  const FoundCauses e = explain(line, o);
  ASSERT_EQ(e.causes.size(), 2u);
  for (const CauseResult& r : e.causes) {
    ASSERT_LT(r.cause, 2);
    const double planted = r.cause == 0 ? 1.0 : 6.0;
    EXPECT_NEAR(r.value[0], planted, 3 * r.std_error[0]) << r.cause;
    EXPECT_EQ(e.candidates[static_cast<std::size_t>(r.cause)].fate, Fate::taken);
  }
  EXPECT_NE(e.causes[0].cause, e.causes[1].cause);
}

TEST(Engine, OneCauseThatIsTwoOthersTogetherStandsAlone) {
  Line line(wave_and_kink, 11, 2, 1.0);
  const FoundCauses e = explain(line, {});
  ASSERT_EQ(e.causes.size(), 1u);
  EXPECT_EQ(e.causes[0].cause, 2);
}

TEST(Engine, RareCauseIsNamedBesideAnotherOnlyWhereTheDataAreStillAbnormal) {
  for (const bool abnormal : {false, true}) {
    Line line(wave_and_kink, 11, 2, 1.0);
    line.make_rare(1);
    EngineOptions o;
    o.among = [](const Cause& c) { return c.effect != "sum"; };
    o.p_new = [](const CauseScore&, int) { return 1e-6; };
    o.p_left = [&](const ExplainedFit&, LeftOf what, int round) {
      const bool with_first = what == LeftOf::rows ? round == 0 : round == 1;
      return (what == LeftOf::rows_and_blocks && round == 0) || (abnormal && with_first) ? 1e-6 : 1.0;
    };
    EXPECT_EQ(explain(line, o).causes.size(), abnormal ? 2u : 1u);
  }
}

TEST(Engine, NoiseAloneIsLeftAlone) {
  int accused = 0;
  for (int seed = 100; seed < 140; ++seed) {
    Line line(shapes, static_cast<std::uint64_t>(seed), -1, 0);
    accused += !explain(line, {}).causes.empty();
  }
  EXPECT_LE(accused, 2);  // of 40
}

TEST(Engine, WhatHealthyDataShowIsNotAccused) {
  Line line(shapes, 7, 1, 1.0);
  EngineOptions o;
  o.p_new = [](const CauseScore&, int) { return 0.5; };
  const FoundCauses e = explain(line, o);
  EXPECT_TRUE(e.causes.empty());
  ASSERT_FALSE(e.standing.empty());
  EXPECT_EQ(line.causes()[static_cast<std::size_t>(e.standing[0].cause)].effect, "slow wave");
}

TEST(Engine, WhatStandsInHealthyDataAndFitsAsWellIsSaidToBeConfusable) {
  Line line({shapes[0], shapes[3]}, 3, 0, 1.0);
  EngineOptions o;
  o.p_new = [](const CauseScore& s, int) { return s.cause == 0 ? 1e-6 : 0.5; };
  const FoundCauses e = explain(line, o);
  ASSERT_EQ(e.causes.size(), 1u);
  EXPECT_EQ(e.causes[0].cause, 0);
  EXPECT_EQ(e.causes[0].confusable_with, std::vector<int>{1});
}

TEST(Engine, WhereTheDataAreAbnormalACauseNeedNotBeNewsByItself) {
  Line line({shapes[0], shapes[1]}, 7, 1, 1.0);
  EngineOptions o;
  o.p_new = [](const CauseScore&, int) { return 0.5; };
  o.p_left = [](const ExplainedFit&, LeftOf what, int round) {
    return what == LeftOf::rows_and_blocks && round == 0 ? 1e-6 : 1.0;
  };
  EXPECT_EQ(explain(line, o).causes.size(), 1u);
}

TEST(Engine, NameThatHelpsAndLeavesTheDataAbnormalIsRefusedAndKept) {
  Line line({shapes[0], shapes[1]}, 7, 1, 1.0);
  EngineOptions o;
  o.p_new = [](const CauseScore&, int) { return 0.5; };
  o.p_left = [](const ExplainedFit&, LeftOf, int) { return 1e-6; };
  const FoundCauses e = explain(line, o);
  EXPECT_TRUE(e.causes.empty());
  ASSERT_FALSE(e.refused.empty());
  EXPECT_GT(heldout_gain(e.before, e.refused.front(), o.seed).lower, 0);
}

TEST(Engine, FarBeyondWhatIsUsualHalvesCountAlike) {
  Line line(shapes, 1, -1, 0);
  const auto far = [&](double size) { return deviance_of(line, Eigen::VectorXd::Constant(600, size)); };
  EXPECT_NEAR(far(64) - far(32), far(8) - far(4), 1e-9);
  EXPECT_NEAR(far(0.8) - far(0.4), 600 * (0.64 - 0.16), 1e-9) << "within the usual it is the sum of squares";
}

TEST(Engine, SameSeedSameResult) {
  Line a(shapes, 9, 0, 0.6), b(shapes, 9, 0, 0.6);
  const FoundCauses x = explain(a, {}), y = explain(b, {});
  ASSERT_EQ(x.causes.size(), y.causes.size());
  for (std::size_t k = 0; k < x.causes.size(); ++k) {
    EXPECT_EQ(x.causes[k].value, y.causes[k].value);
    EXPECT_EQ(x.causes[k].heldout_gain.lower, y.causes[k].heldout_gain.lower);
  }
}

}  // namespace
}  // namespace servodx
