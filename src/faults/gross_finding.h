// What a spool shows without any fit.
#pragma once

namespace servodx {

enum class GrossFinding {
  none,
  spool_on_both_stops,  // in turn, at small current
  spool_on_one_stop,    // at small current
  no_response,          // the spool rests while the current moves
};

}  // namespace servodx
