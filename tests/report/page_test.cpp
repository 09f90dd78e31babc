// A page's text is escaped, its data cannot end their element, and no peak is lost to thinning.
#include "report/shared/page.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "report/shared/html.h"
#include "report/shared/json.h"
#include "report/shared/parts.h"
#include "report/shared/plot_samples.h"

namespace servodx::report {
namespace {

const std::string hostile = "</script><script>alert(\"1\")</script>&'.csv";

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST(Html, NoMarkupSurvivesEscaping) {
  EXPECT_EQ(escape_html("<a href=\"x\">&'"), "&lt;a href=&quot;x&quot;&gt;&amp;&#39;");
  const std::string json = script_json(nlohmann::ordered_json{{"log", hostile}});
  EXPECT_EQ(json.find('<'), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(json)["log"], hostile);
}

TEST(Page, EveryPartEscapesEveryText) {
  Header header;
  header.command = hostile;
  header.version = hostile;
  header.inputs = {{hostile, hostile}};
  header.notes = {hostile};
  *header.settings = {{hostile, hostile}};
  Page page(header, hostile);
  page.verdict({Tone::bad, hostile, hostile, hostile, {{hostile, hostile}}, {hostile}}, hostile);
  page.section(hostile, hostile);
  page.add(Plot{.title = hostile,
                .x_label = hostile,
                .x = {0, 1},
                .series = {{hostile, {1, 2}}},
                .band = Band{hostile, {0, 0}, {1, 1}},
                .x_marks = {{0.5, hostile}},
                .y_marks = {{0.5, hostile}},
                .group = hostile});
  Cell cell = hostile;
  cell.link = hostile;
  page.add(TablePart{hostile, "l", {hostile}, {{cell}}, 0});
  page.add(
      Bars{hostile, hostile, hostile, {{hostile, 1, hostile, hostile, Tone::plain, hostile}}, Mark{1, hostile}, {}});
  Moves moves{hostile, {}, 0};
  moves.rows.push_back({.name = hostile,
                        .from = hostile,
                        .to = hostile,
                        .error = hostile,
                        .unit = hostile,
                        .note = hostile,
                        .exact_unit = hostile});
  page.add(moves);
  page.add(Matrix{hostile, hostile, hostile, {hostile}, {hostile}, {{1.0}}, hostile, false});
  const std::string html = page.html();
  EXPECT_EQ(count(html, "</script"), 3u);  // data, uPlot, the page's own
  EXPECT_EQ(count(html, "<script"), 3u);
  EXPECT_EQ(html.find("<script>alert"), std::string::npos);
  EXPECT_EQ(html.find("alert(\"1\")"), std::string::npos);
}

TEST(Page, FetchesNothing) {
  Page page({}, "t");
  const std::string html = page.html();
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
  const std::string head = html.substr(0, html.find("</head>"));
  EXPECT_EQ(head.find("http:"), std::string::npos);
  EXPECT_EQ(count(html, "<script src"), 0u);
  EXPECT_EQ(count(html, "<link rel=\"stylesheet"), 0u);
}

TEST(Page, RowsBeyondThoseShownAreFoldedAndStillThere) {
  Bars bars{.title = "b", .label = "l", .unit = "u", .rows = {}, .mark = {}, .full = {}, .shown = 2};
  for (const char* name : {"first", "second", "third"}) bars.rows.push_back({name, 1, "1"});
  Page page({}, "t");
  page.section("s");
  page.add(bars);
  const std::string html = page.html();
  EXPECT_NE(html.find("class=\"bars\" data-shown=\"2\""), std::string::npos);
  EXPECT_NE(html.find("third"), std::string::npos);
  bars.shown = 3;
  Page all({}, "t");
  all.section("s");
  all.add(bars);
  EXPECT_EQ(all.html().find("class=\"bars\" data-shown"), std::string::npos);
}

// On a narrow screen "data/tutorial/good_1.csv" else breaks within its last word.
TEST(Page, APathInATableBreaksBehindItsFolders) {
  Page page({}, "paths");
  page.add(TablePart{"t", "ll", {"log", "leakage"}, {{"data/tutorial/good_1.csv", "0.02 l/min/bar"}}, 0});
  EXPECT_NE(page.html().find("data/<wbr>tutorial/<wbr>good_1.csv"), std::string::npos);
  EXPECT_NE(page.html().find("0.02 l/min/bar"), std::string::npos);
}

TEST(Page, SameResultSameBytes) {
  const auto make = [] {
    Page page({}, "t");
    page.section("s");
    page.add(Plot{.title = "p", .x = {0, 1, 2}, .series = {{"y", {1, NAN, 3}}}});
    return page.html();
  };
  EXPECT_EQ(make(), make());
  EXPECT_NE(make().find("[1,null,3]"), std::string::npos);  // a gap stays a gap
}

TEST(Thin, KeepsEveryPeakOfEverySeries) {
  constexpr std::size_t n = 1'000'000;
  std::vector<double> x(n), quiet(n, 0.0), noisy(n);
  for (std::size_t k = 0; k < n; ++k)
    x[k] = 1e-3 * static_cast<double>(k), noisy[k] = std::sin(1e-4 * static_cast<double>(k));
  quiet[123457] = 5;
  noisy[765432] = -7;
  const std::vector<const std::vector<double>*> series = {&quiet, &noisy};
  const auto kept = thinned(x, series, 4000);
  EXPECT_LE(kept.size(), 4000u);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  EXPECT_TRUE(std::adjacent_find(kept.begin(), kept.end()) == kept.end());
  for (const std::size_t peak : {std::size_t{0}, std::size_t{123457}, std::size_t{765432}, n - 1})
    EXPECT_TRUE(std::binary_search(kept.begin(), kept.end(), peak)) << peak;
}

TEST(Thin, LeavesShortSeriesAloneAndSurvivesGaps) {
  const std::vector<double> x = {0, 1, 2}, y = {1, 2, 3};
  const std::vector<const std::vector<double>*> one = {&y};
  EXPECT_EQ(thinned(x, one, 10), (std::vector<std::size_t>{0, 1, 2}));
  std::vector<double> long_x(1000), gap(1000, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < 1000; ++k) long_x[k] = static_cast<double>(k);
  gap[500] = 1;
  const std::vector<const std::vector<double>*> holey = {&gap};
  const auto kept = thinned(long_x, holey, 40);
  EXPECT_TRUE(std::binary_search(kept.begin(), kept.end(), std::size_t{500}));
}

}  // namespace
}  // namespace servodx::report
