#include "baseline_beside.h"

#include <fmt/format.h>

#include "base/trouble.h"
#include "door/baseline_parts.h"

namespace servodx {

Baseline baseline_beside(Invocation& invocation, const std::string& path, const RigFile& rig) {
  Baseline out = read_baseline(path);
  invocation.note(out.notes);
  invocation.header().call.baseline = path;
  const std::string& made_with = parts_of(out).rig_file;
  if (rig.path.empty() && !made_with.empty())
    invocation.note(
        {fmt::format("{} WAS MADE WITH A RIG FILE AND THIS CALL NAMES NONE: oil, supply, null limit and columns are "
                     "taken as the program's own, and what follows is in doubt; add --rig {}{}",
                     path, made_with, mark_of(Trouble::rig_forgotten))});
  return out;
}

}  // namespace servodx
