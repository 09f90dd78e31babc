// The place, by replaying the model block by block with measured signals in place of simulated ones, so that what one
// block has wrong does not leak into the next.
//
//   current -> spool                        missing current [A]: the spool's residual through the wire's stiffness; the
//                                           valve is ahead of all else, so its free run is its own replay
//   spool and pressures -> flows            missing flow A, B [m3/s] (simulate/balance.h)
//   pressures -> motion                     missing force [N]
//
// A block is looked at where the log has what drives it and what it moves. With healthy logs the rms of what is missing
// is judged against theirs; and the variable that it follows most closely is named. A block says where, not what: the
// places that it covers stand with it, sensors at its ends among them.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "explain/valve.h"
#include "optimise/unit_cube.h"

namespace servodx {

struct BlockReplay {
  std::string block;                 // "current -> spool", ...
  std::vector<std::string> places;   // what it covers
  std::string quantity, unit;        // what is missing
  double missing = 0, passing = 0;   // rms [unit]: missing, and what passes through the block
  std::string variable = {};         // that the missing follows most closely, in a line
  double share = 0;                  // of its square that this line takes
  std::optional<double> p_new = {};  // chance that a healthy log misses as much
};

// One log's share of a block, sample by sample.
struct ReplayedPart {
  std::vector<double> missing, passing;
  std::vector<std::pair<std::string, std::vector<double>>> variables;
};
struct ReplayedBlock {
  BlockReplay about;
  std::vector<ReplayedPart> parts;
  int curve_place = -1;  // the place of Unexplained whose curve adds what the block misses
};
std::vector<ReplayedBlock> replay_parts(const ValveSubject& subject, const Point& point, int log = -1);

// At a point of fit({}): `log` alone, or all pooled (negative).
std::vector<BlockReplay> replay_blocks(const ValveSubject& subject, const Point& point, int log = -1);

}  // namespace servodx
