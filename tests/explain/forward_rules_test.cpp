// The rules of the forward selection on made-up evidence: each row changes one thing, and the rule answers to it.
#include "explain/forward_rules.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "explain/outcome.h"

namespace servodx {
namespace {

constexpr double level = 0.01;

WholeEvidence whole(int accepted, double p_left, double p_left_rows, bool compared = true) {
  WholeEvidence w;
  w.accepted = accepted, w.level = level, w.compared = compared;
  w.p_left = p_left, w.p_left_rows = p_left_rows;
  return w;
}
WholeEvidence normal(int accepted = 0) { return whole(accepted, 0.5, 0.5); }
WholeEvidence abnormal(int accepted = 0) { return whole(accepted, level / 2, level / 2); }
ScoredEvidence scored(int cause, double p_new, double gain, double prior = 1) {
  return {cause, true, false, p_new, prior, gain};
}

TEST(ForwardRules, ASecondAlarmIsAsRareAsTwoAndBothQuestionsShareTheLevel) {
  EXPECT_EQ(level_of_round(0.05, false, 0), 0.05);
  EXPECT_EQ(level_of_round(0.05, true, 0), 0.025);
  EXPECT_EQ(level_of_round(0.05, false, 1), 0.05 * 0.05);
  EXPECT_EQ(level_of_round(0.05, true, 2), 0.025 * 0.025);
}

TEST(ForwardRules, ACauseIsNewByItselfOrBecauseTheDataAreAbnormal) {
  struct Case {
    const char* what;
    ScoredEvidence cause;
    WholeEvidence whole;
    bool is_new;
  };
  ScoredEvidence unseen = scored(0, level / 2, 9);
  unseen.looked_at = false;
  const Case cases[] = {
      {"news by itself", scored(0, level / 2, 9), normal(), true},
      {"at the level", scored(0, level, 9), normal(), true},
      {"no news", scored(0, 0.5, 9), normal(), false},
      {"no news in abnormal data", scored(0, 0.5, 9), abnormal(), true},
      {"not looked at", unseen, abnormal(), false},
      {"rare, first", scored(0, level / 2, 9, 0.1), normal(), true},
      {"rare, beside another that suffices", scored(0, level / 2, 9, 0.1), normal(1), false},
      {"rare, beside another that does not suffice", scored(0, level / 2, 9, 0.1), abnormal(1), true},
      {"rare, where nothing says what suffices", scored(0, level / 2, 9, 0.1), whole(1, 1, 1, false), true},
      {"common, beside another that suffices", scored(0, level / 2, 9), normal(1), true},
  };
  for (const Case& c : cases) EXPECT_EQ(is_new(c.cause, c.whole), c.is_new) << c.what;
}

TEST(ForwardRules, AbnormalByTheBlocksAloneIsNotAbnormalByTheRows) {
  EXPECT_TRUE(is_abnormal(whole(0, level / 2, 0.5)));
  EXPECT_FALSE(has_abnormal_rows(whole(0, level / 2, 0.5)));
  EXPECT_TRUE(has_abnormal_rows(abnormal()));
  EXPECT_FALSE(is_abnormal(whole(0, level / 2, level / 2, false))) << "not compared";
}

TEST(ForwardRules, NewsIsTriedFirstThenWhatPromisesMoreWithinTheBudget) {
  using Order = std::vector<int>;
  const std::vector<ScoredEvidence> causes = {scored(0, 0.5, 90), scored(1, level / 2, 20), scored(2, 0.5, 70),
                                              scored(3, level / 2, 40, 0.1), scored(4, level / 2, 5)};
  EXPECT_EQ(order_of_trial(causes, normal(), {8, 4, 0}, 7), (Order{3, 1})) << "4 promises too little, 0 and 2 are old";
  EXPECT_EQ(order_of_trial(causes, normal(), {8, 4, 1}, 7), (Order{3, 1, 0})) << "one that stands";
  EXPECT_EQ(order_of_trial(causes, normal(), {8, 0, 0}, 7), (Order{1})) << "no rare one";
  EXPECT_EQ(order_of_trial({scored(0, 0.5, 90, 0.1)}, normal(), {8, 4, 1}, 7), Order{}) << "rare, and no news";
  EXPECT_EQ(order_of_trial(causes, abnormal(), {8, 4, 0}, 7), (Order{3, 1, 0, 2})) << "news by itself first";
  EXPECT_EQ(order_of_trial(causes, abnormal(), {2, 4, 0}, 7), (Order{3, 1, 0}));
  std::vector<ScoredEvidence> in = causes;
  in[3].accepted_already = true;
  EXPECT_EQ(order_of_trial(in, normal(), {8, 4, 0}, 7), (Order{1}));
}

TEST(ForwardRules, AShareIsAskedOfTheFirstCauseAlone) {
  WholeEvidence w = normal();
  EXPECT_FALSE(is_news_by_share(1e-9, w)) << "not asked";
  w.level_of_shares = 0.05;
  EXPECT_TRUE(is_news_by_share(0.05, w));
  EXPECT_FALSE(is_news_by_share(0.051, w));
  w.accepted = 1;
  EXPECT_FALSE(is_news_by_share(1e-9, w));
}

TEST(ForwardRules, TheCommonerIsJudgedFirstAndEachKindHasItsShare) {
  const std::vector<FittedEvidence> fitted = {
      {0.1, true, true, 900}, {1, true, false, 50}, {1, true, true, 20}, {1, true, true, 30}};
  EXPECT_EQ(order_of_judging(fitted, 1), (std::vector<int>{1, 3, 2, 0})) << "what gains most, then what is news";
  const std::vector<FittedEvidence> four = {
      {1, true, true, 20}, {1, true, false, 15}, {1, true, false, 10}, {1, true, true, 5}};
  EXPECT_EQ(order_of_judging(four, 1), (std::vector<int>{0, 3, 1, 2}));
  EXPECT_EQ(order_of_judging(four, 2), (std::vector<int>{0, 1, 3, 2})) << "a twin that gains nearly as much";
  EXPECT_EQ(order_of_judging(four, 9), (std::vector<int>{0, 1, 2, 3}));
  const std::vector<FittedEvidence> rare = {
      {0.1, true, false, 9}, {1, true, false, 5}, {0.1, true, false, 8}, {0.1, true, true, 7}};
  EXPECT_EQ(order_of_judging(rare, 2), (std::vector<int>{1, 0, 3, 2})) << "of the rare one leads";
  JudgingBudget budget(2, 2);
  EXPECT_TRUE(budget.takes(fitted[3]));
  EXPECT_FALSE(budget.takes({1, true, true, 0})) << "its gain is not worth its added parameters";
  EXPECT_TRUE(budget.takes(fitted[2]));
  EXPECT_FALSE(budget.takes(fitted[1])) << "two were judged";
  EXPECT_FALSE(budget.takes({1, false, false, 1})) << "what stands takes a place, as a healthy log's causes do";
  EXPECT_TRUE(budget.takes(fitted[0]));
  EXPECT_FALSE(budget.takes(fitted[0])) << "one rare one was judged";
}

TEST(ForwardRules, WhyAJudgedCauseIsRefused) {
  const JudgedEvidence good{false, true, false, true, 0.5, level, true, 0.1, 0.2, 0.0, 0.3};
  EXPECT_EQ(refusal_of(good), std::nullopt);
  struct Case {
    const char* what;
    JudgedEvidence judged;
    std::optional<Fate> fate;
  };
  std::vector<Case> cases;
  const auto with = [&](const char* what, std::optional<Fate> fate, auto change) {
    JudgedEvidence j = good;
    change(j);
    cases.push_back({what, j, fate});
  };
  with("the data stay abnormal", Fate::abnormal_with_it, [](JudgedEvidence& j) { j.p_left_rows = level; });
  with("so they do, but it is news", std::nullopt,
       [](JudgedEvidence& j) { j.p_left_rows = 0, j.news_by_itself = true; });
  with("so they do, but it is a curve", std::nullopt, [](JudgedEvidence& j) { j.p_left_rows = 0, j.curve = true; });
  with("so they do, but only by the blocks", std::nullopt,
       [](JudgedEvidence& j) { j.p_left_rows = 0, j.abnormal_rows = false; });
  with("so they do, and it stands in health", std::nullopt,
       [](JudgedEvidence& j) { j.p_left_rows = 0, j.is_new = false; });
  with("re-tuning does it", Fate::retuning_does_as_well, [](JudgedEvidence& j) { j.beyond_retuning = 0; });
  with("re-tuning would, and is not asked", std::nullopt,
       [](JudgedEvidence& j) { j.beyond_retuning = 0, j.beside_retuning = false; });
  with("no gain beyond the interval", Fate::no_heldout_gain, [](JudgedEvidence& j) { j.heldout_lower = 0; });
  with("it removes a percent, and more is not asked", std::nullopt, [](JudgedEvidence& j) { j.share = 0.01; });
  with("it removes a percent where a twentieth is asked", Fate::removes_too_little,
       [](JudgedEvidence& j) { j.share = 0.01, j.least_share = 0.05; });
  for (const Case& c : cases) EXPECT_EQ(refusal_of(c.judged), c.fate) << c.what;
}

TEST(ForwardRules, ARarerCauseHasToDoBetterBeyondTheInterval) {
  struct Case {
    const char* what;
    Rivals rivals;
    bool first;
  };
  const Case cases[] = {
      {"alike: the one of more gain", {1, 1, false, false, 0, 30, 20}, true},
      {"alike: the one of less gain", {1, 1, true, false, 0, 10, 20}, false},
      {"rarer, and better beyond the interval", {0.1, 1, false, false, 0.1, 10, 20}, true},
      {"rarer, and not", {0.1, 1, false, false, 0.0, 90, 20}, false},
      {"rarer and better, but the other suffices", {0.1, 1, true, true, 0.1, 90, 20}, false},
      {"commoner, and the other not better", {1, 0.1, false, false, 0.0, 10, 20}, true},
      {"commoner, and the other better", {1, 0.1, false, false, 0.1, 90, 20}, false},
      {"commoner, the other better, but it suffices", {1, 0.1, true, false, 0.1, 10, 20}, true},
  };
  for (const Case& c : cases) EXPECT_EQ(first_is_better(c.rivals), c.first) << c.what;
}

TEST(ForwardRules, WhatDoesAsWellIsWithinTheIntervalOrTheOdds) {
  EXPECT_TRUE(does_as_well({0.0, 100, 10})) << "within the interval";
  EXPECT_TRUE(does_as_well({0.1, 100, 94.1})) << "at odds below twenty to one";
  EXPECT_FALSE(does_as_well({0.1, 100, 94.0}));
}

TEST(ForwardRules, TwoNamesThatAreNewAreToldApartByMoreThanANameGainsOnHealthyLogs) {
  const InItsPlace within_the_model_error{0.1, 1000, 10, true, true, 0.3};
  EXPECT_TRUE(does_as_well(within_the_model_error));
  const auto with = [&](auto&& change) {
    InItsPlace other = within_the_model_error;
    change(other);
    return does_as_well(other);
  };
  EXPECT_FALSE(with([](InItsPlace& o) { o.p_best_share = 0.04; })) << "healthy logs hardly show such a share";
  EXPECT_FALSE(with([](InItsPlace& o) { o.other_is_new = false; })) << "it would not be said alone";
  EXPECT_FALSE(with([](InItsPlace& o) { o.both_named = false; })) << "healthy logs were asked of names";
  EXPECT_FALSE(with([](InItsPlace& o) { o.p_best_share = 0; })) << "no healthy log was asked";
}

TEST(ForwardRules, ACauseIsMissedBeyondItsInterval) {
  EXPECT_TRUE(is_missed({0.2, 0.1, 0.3}));
  EXPECT_FALSE(is_missed({0.2, 0.0, 0.3}));
}

}  // namespace
}  // namespace servodx
