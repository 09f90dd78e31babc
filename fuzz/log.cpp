// A CSV log: without a rig file, and by one that maps columns and gives the facts that relative units ask for.
#include "servodx/log.h"

#include "base/csv.h"
#include "harness.h"
#include "servodx/rig.h"
#include "signals/log_formats.h"

namespace servodx::fuzz {

void read(std::string_view input) {
  static const RigFile rig = make_rig("rig.toml", R"(
valve.rated_current = "40 mA"
valve.spool_stroke = "0.8 mm"
[columns]
"i" = { signal = "command", unit = "mA" }
"t" = { signal = "time", unit = "ms" }
"u" = { signal = "spool_position", unit = "V", gain = "0.1 mm/V", offset = "0.1 mm" }
"p" = { signal = "pressure_a", unit = "psi" }
)");
  const InputFile file(input);
  refusing([&] { content_hash(read_csv_log(file.path(), {}, {.minimum_rows = 3})); });
  read_csv_log(file.path(), rig, {.minimum_rows = 1, .require_response = false, .require_drive = false});
}

}  // namespace servodx::fuzz
