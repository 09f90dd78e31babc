// Effects hidden in logs of the virtual rig: how many does `explain` name, place and size, and how many controls does
// it accuse. The must of the study: docs/explain.md.
//   servodx_hidden [--valves N] [--first V] [--cases N] [--controls N] [--unlisted N] [--seed S] [--remove] [--out DIR]
// A valve is tuned once and its healthy logs are read once: table, reference and every answer are kept in DIR, so a
// study that is stopped goes on where it was, and a larger one begins with what the smaller has done. --again judges
// anew what the table and the reference are kept for.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/progress.h"
#include "explain/explain.h"
#include "explain/healthy.h"
#include "explain/outcome.h"
#include "explain/score_healthy.h"
#include "hidden/cases.h"
#include "parameters/table.h"
#include "report/explain/explain_report.h"
#include "report/explain/explain_words.h"
#include "report/shared/json.h"
#include "servodx/explain.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "store/healthy_file.h"
#include "tune/tune.h"

using namespace servodx;

int main(int argc, char** argv) {
  int valves = 2, first = 1, cases = 28, controls = 20, unlisted = 0, healthy = 19, tuning = 6, generations = 12;
  double seconds = 3.0, level = 0.05;
  std::uint64_t seed = 1;
  bool again = false;
  std::string out = "build/hidden", source = SERVODX_SOURCE_DIR, only;
  bool remove = false;
  CLI::App app("hidden effects: named, placed, sized; controls accused");
  app.add_option("--valves", valves, "drawn from the rig's tolerances")->capture_default_str();
  app.add_option("--first", first, "the first of them")->capture_default_str();
  app.add_option("--cases", cases, "with an effect, over all valves")->capture_default_str();
  app.add_option("--controls", controls, "without")->capture_default_str();
  app.add_option("--unlisted", unlisted, "with an effect that the list does not have")->capture_default_str();
  app.add_option("--healthy", healthy, "logs of the baseline, a valve")->capture_default_str();
  app.add_option("--generations", generations, "of the tuning search")->capture_default_str();
  app.add_option("--seconds", seconds, "of a log")->capture_default_str();
  app.add_option("--level", level, "false-alarm rate asked for")->capture_default_str();
  app.add_option("--seed", seed)->capture_default_str();
  app.add_option("--only", only, "one effect");
  app.add_flag("--remove", remove, "leave the hidden effect's own file out of the list: `unexplained` is right then");
  app.add_flag("--again", again, "do not take answers that are there");
  app.add_option("--out", out)->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  std::filesystem::create_directories(out);
  std::vector<hidden::Score> scores;
  Progress progress("hidden effects", {});
  for (int v = 0; v < valves; ++v) {
    const int valve = first + v;
    hidden::Bench bench{std::filesystem::path(out), source + "/params/rigs/borello2009.toml",
                        read_rig_file(source + "/data/rig.toml"), static_cast<std::uint64_t>(valve)};
    const auto read = [&](const std::vector<std::string>& paths) {
      std::vector<Log> logs;
      for (const std::string& p : paths) logs.push_back(read_log(p, bench.rig));
      return logs;
    };
    const std::string table_path = fmt::format("{}/tuned_v{}.csv", out, valve);
    if (!std::filesystem::exists(table_path)) {
      TuneOptions options;
      options.generations = generations;
      options.seed = seed;
      write_table(table_path,
                  tune_table(read(hidden::healthy_logs(bench, seed, tuning, fmt::format("tune_v{}", valve), seconds)),
                             read_table(source + "/params/borello2009.csv"), bench.rig, options)
                      .table);
    }
    const Table tuned = read_table(table_path);
    const std::string reference_path = fmt::format("{}/reference_v{}.json", out, valve);
    if (!std::filesystem::exists(reference_path)) {
      HealthyCounts counts;
      HealthyReference reference = score_healthy(
          read(hidden::healthy_logs(bench, seed + 1000, healthy, fmt::format("base_v{}", valve), seconds)), tuned,
          bench.rig, 0, counts);
      for (HealthyLog& l : reference.logs) l.log = std::filesystem::path(l.log).filename();  // they stand beside it
      std::ofstream(reference_path) << report::Json{{"explain", report::healthy_json(reference)}};
    }
    const HealthyReference reference = store::read_healthy(reference_path);
    const auto judge = [&](std::uint64_t s, const std::string& effect) {
      const std::string answer_path =
          fmt::format("{}/answer_v{}_{}_{}{}.json", out, valve, s, effect, remove ? "_removed" : "");
      hidden::Score sc;
      if (!again && std::filesystem::exists(answer_path)) {
        std::ifstream in(answer_path);
        sc = hidden::from_json(report::Json::parse(in).at("score"));
      } else {
        const hidden::Case c = hidden::make_case(bench, s, effect, seconds);
        ExplainOptions options;
        options.level = std::max(level, 1.0 / (healthy + 1.0));
        if (remove) options.without = {effect};
        const ExplainResult answer = explain_logs(read(c.logs), tuned, bench.rig, &reference, options);
        sc = hidden::score(hidden::unseal(c.sealed), answer);  // opened after the answer
        if (remove) sc.named = answer.verdict == ExplainVerdict::unexplained;
        std::ofstream(answer_path) << report::Json{{"score", hidden::to_json(sc)},
                                                   {"answer", report::explain_json(answer)}};
      }
      scores.push_back(sc);
      progress.update(static_cast<double>(scores.size()) / (cases + controls + unlisted),
                      static_cast<long>(scores.size()));
      fmt::print("v{} {} {:22} {:34} -> {:11} {:22} {:22} {} {} size {}{} gain {:.0f} %{}{}\n", valve, s,
                 sc.truth.effect, sc.truth.size, report::word_of(sc.verdict), sc.first, sc.where,
                 sc.named ? "named" : "-", sc.placed ? "placed" : "-",
                 sc.size_inside ? (*sc.size_inside ? "in" : "out") : "?",
                 sc.variable ? *sc.variable ? " variable" : " variable -" : "", 100 * sc.heldout_gain,
                 sc.gain_share ? fmt::format(", {:.0f} % of the true one's", 100 * *sc.gain_share) : "",
                 sc.note.empty() ? "" : "\n      " + sc.note);
      std::fflush(stdout);
    };
    const auto share = [&](int n) { return n / valves + (v < n % valves); };
    for (int k = 0; k < share(cases); ++k)
      judge(seed * 100000 + static_cast<std::uint64_t>(k),
            !only.empty() ? only : hidden::effects()[static_cast<std::size_t>(k) % hidden::effects().size()]);
    for (int k = 0; k < share(unlisted); ++k)
      judge(seed * 100000 + 30000 + static_cast<std::uint64_t>(k),
            hidden::unlisted()[static_cast<std::size_t>(k) % hidden::unlisted().size()]);
    for (int k = 0; k < share(controls); ++k) judge(seed * 100000 + 60000 + static_cast<std::uint64_t>(k), "none");
  }

  fmt::print("\n{}", hidden::tally(scores));
  return 0;
}
