#include "baseline_beside.h"

#include <fmt/format.h>

#include "base/trouble.h"

namespace servodx {

Baseline baseline_beside(Invocation& invocation, const std::string& path, const RigFile& rig) {
  Baseline out = read_baseline(path);
  invocation.note(out.notes);
  invocation.header().call.baseline = path;
  if (rig.path.empty() && !out.rig_file.empty())
    invocation.note(
        {fmt::format("{} WAS MADE WITH A RIG FILE AND THIS CALL NAMES NONE: oil, supply, null limit and columns are "
                     "taken as the program's own, and what follows is in doubt; add --rig {}{}",
                     path, out.rig_file, mark_of(Trouble::rig_forgotten))});
  return out;
}

}  // namespace servodx
