// The prognosis study: figures 8 to 13 of Borello et al. 2009, lives of random valves to their end, progressive series
// of a rig, the store at size, and the monitor's speed. Its parts are in bench/prognosis/. Lives are checked by the
// excitation preflight_slew, or by preflight_wear where `--test preflight_wear` stands first.
//
//   servodx_prognosis figures TUNED RIG.toml RIG_MODEL.toml OUT_DIR
//   servodx_prognosis lives   TUNED RIG.toml RIG_MODEL.toml OUT_DIR [UNITS [CHECKS [FIRST [DEGRADATION...]]]]   of each
//   servodx_prognosis series  TUNED RIG.toml OUT_DIR SERIES_DIR...                       t01.csv, t02.csv, ...
//   servodx_prognosis store   FILE ROWS
//   servodx_prognosis predictor UNITS              of lives whose readings are the truth
//   servodx_prognosis speed   TUNED RIG.toml RIG_MODEL.toml     of the monitor
#include <algorithm>
#include <cstdio>

#include "parameters/table.h"
#include "prognosis/study.h"
#include "rig/rig_model.h"
#include "servodx/rig.h"

namespace servodx::study {
namespace {

int run(int argc, char** argv) {
  const char* test = "preflight_slew";
  if (argc > 2 && std::string_view(argv[1]) == "--test") test = argv[2], argv += 2, argc -= 2;
  const std::string what = argc > 1 ? argv[1] : "";
  const auto bench = [&](bool with_model) {
    Bench b{read_table(argv[2]), read_rig_file(argv[3]), {}, test};
    if (with_model) b.model = rig::read_rig_model(argv[4]);
    return b;
  };
  if (what == "figures" && argc == 6) return figures(bench(true), argv[5]), 0;
  if (what == "lives" && argc >= 6)
    return lives(bench(true), argv[5], argc > 6 ? std::stoi(argv[6]) : 40, argc > 7 ? std::stoi(argv[7]) : 40,
                 argc > 8 ? std::stoi(argv[8]) : 0, {argv + std::min(argc, 9), argv + argc}),
           0;
  if (what == "series" && argc >= 6) return series(bench(false), argv[4], {argv + 5, argv + argc}), 0;
  if (what == "predictor" && argc == 3) return predictor(std::stoi(argv[2]), 40), 0;
  if (what == "speed" && argc == 5) return speed(bench(true)), 0;
  if (what == "store" && argc == 4) return store(argv[2], std::stol(argv[3])), 0;
  std::fprintf(stderr,
               "usage: servodx_prognosis [--test preflight_wear] figures|lives TUNED RIG.toml RIG_MODEL.toml OUT "
               "[UNITS [CHECKS [FIRST "
               "[DEGRADATION...]]]]\n"
               "       servodx_prognosis series TUNED RIG.toml OUT SERIES_DIR...\n"
               "       servodx_prognosis store FILE ROWS\n"
               "       servodx_prognosis predictor UNITS\n"
               "       servodx_prognosis speed TUNED RIG.toml RIG_MODEL.toml\n");
  return 2;
}

}  // namespace
}  // namespace servodx::study

int main(int argc, char** argv) {
  try {
    return servodx::study::run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "servodx_prognosis: %s\n", e.what());
    return 1;
  }
}
