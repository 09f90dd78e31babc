// How far a check, or a valve, has come. In the order of what calls for more: of several checks the last counts.
#pragma once

namespace servodx {

enum class TrendState {
  unknown,  // no word, the notes say why
  blind,    // one check cannot tell failure from health at the false-alarm rate asked: only a trend can
  healthy,
  watch,    // a confirmed trend, or a last check beyond its threshold
  warning,  // a confirmed trend that has passed the warning level
  failed,
};

}  // namespace servodx
