// A foreign hydraulic test rig and its logs, from a seed: equations and numerics that are neither the fitted model's
// nor the virtual rig's, so that tune, diagnose and explain are judged on what they do not know.
//   servodx_foreign --seed N -o DIR [--only healthy|fault|hidden|pair] [--logs assorted|acceptance|both] [--keep]
//   [--dry-run]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <string>

#include "design.h"
#include "run.h"
#include "set.h"
#include "sheet.h"
#include "write.h"

using namespace servodx::foreign;

int main(int argc, char** argv) {
  std::uint64_t seed = 1;
  std::string out, only, logs = "both";
  bool dry = false, keep = false;
  CLI::App app("a foreign hydraulic test rig and its logs");
  app.add_option("--seed", seed, "of everything drawn")->capture_default_str();
  app.add_option("-o,--output", out, "folder")->required();
  app.add_option("--only", only, "one part of the logs")->check(CLI::IsMember({"healthy", "fault", "hidden", "pair"}));
  app.add_option("--logs", logs, "which fault-free logs")
      ->check(CLI::IsMember({"assorted", "acceptance", "both"}))
      ->capture_default_str();
  app.add_flag("--keep", keep, "leave logs that are there already");
  app.add_flag("--dry-run", dry, "write all but the logs");
  CLI11_PARSE(app, argc, argv);
  try {
    const std::filesystem::path folder = out;
    const Design design = draw_design(seed);
    Wanted wanted;
    wanted.healthy = only.empty() || only == "healthy";
    wanted.fault = only.empty() || only == "fault";
    wanted.hidden = only.empty() || only == "hidden";
    wanted.pair = only.empty() || only == "pair";
    wanted.assorted = logs != "acceptance";
    wanted.acceptance = logs != "assorted";
    const Sheet sheet = draw_sheet(design);
    std::string truth = truth_header();
    for (const Planned& p : plan(design, {})) truth += truth_row(design, p);
    write_text(folder / "truth.csv", truth);
    write_text(folder / "rig.toml", rig_toml(design, sheet));
    write_text(folder / "datasheet.md", datasheet(design, sheet));
    write_text(folder / "design.txt", design_text(design));
    int made = 0;
    for (const Planned& p : plan(design, wanted)) {
      if (dry || (keep && std::filesystem::exists(folder / p.truth.path))) continue;
      write_text(folder / p.truth.path, csv_of(design, run(design, p.job)));
      ++made;
    }
    fmt::print("{} logs in {}\n", made, out);
  } catch (const std::exception& error) {
    fmt::print(stderr, "servodx_foreign: {}\n", error.what());
    return 1;
  }
  return 0;
}
