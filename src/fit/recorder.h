// How a rig records, as a tune found it from many logs: what a fit of one more of its logs takes as known.
#pragma once
#include <optional>

namespace servodx {

// What the command does between samples (nuisance `command_slope`) belongs to the recorder, and a recorder stays the
// same. Free in every log it is a delay of up to half a sample, and takes up what slows the first stage: half of what
// a clogged filter shows.
struct CommandSlope {
  double usual = 0.5;  // over the logs
  double spread = 1;   // standard deviation of one more log's about it
};

struct Recorder {
  int moving_average = 1;                     // [samples] of every channel, 1 for none
  std::optional<CommandSlope> command_slope;  // empty: too few logs told it
};

}  // namespace servodx
