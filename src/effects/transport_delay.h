// Transport delay between command and torque: a digital controller's cycle, a bus, a filter of high order. The torque
// motor feels the command of `delay` seconds ago.
//
// A pure delay of the samples, linear between them; between samples the command then runs as the rig's own does. Valid
// up to 24 samples, beyond which the history ends. Leaves out: jitter of the delay; the short steps after
// a jump of the command, which follow the log's time and not the delayed one. (Any text on sampled systems:
// Astrom & Wittenmark, Computer-Controlled Systems, 1997, ch. 3.)
#pragma once
#include "base/pack.h"
#include "effects/effect.h"

namespace servodx {

struct TransportDelay {
  static constexpr const char* name = "transport_delay";
  static constexpr const char* place = "drive";
  static constexpr const char* meaning = "the torque motor feels the command some time later";
  static constexpr const char* best_test =
      "steps and a multisine: lag in proportion to frequency, no loss of amplitude";
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 1;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"transport_delay", "s", 0.0, 0.0, 0.01, 1e-3, "time from command to torque"},
  };
  static constexpr int history = 24;

  template <class T>
  struct Memory {
    double time[history];  // [s] newest first
    T current[history];    // [A]
    bool begun = false;
    void take_lane(const Memory& from, int lane) {
      for (int j = 0; j < history; ++j) servodx::take_lane(current[j], from.current[j], lane);
    }
  };
  // History of a current that stood still.
  template <class T>
  static void rest(Memory<T>& m, const T& current, const T&, const T*, const T&) {
    for (T& c : m.current) c = current;
    m.begun = false;
  }
  template <class T>
  static T drive(Memory<T>& m, double time, const T& current, const T&, const T* q, const T&) {
    using std::max;
    using std::min;
    if (!m.begun)
      for (int j = 0; j < history; ++j) m.time[j] = time - 1e-6 * (j + 1);
    m.begun = true;
    for (int j = history - 1; j > 0; --j) m.time[j] = m.time[j - 1], m.current[j] = m.current[j - 1];
    m.time[0] = time, m.current[0] = current;
    T delayed = current;
    for (int j = 0; j + 1 < history; ++j) {
      const T part = (q[0] - T(time - m.time[j])) * T(1.0 / (m.time[j] - m.time[j + 1]));
      delayed = delayed + (m.current[j + 1] - m.current[j]) * max(T(0.0), min(T(1.0), part));
    }
    return delayed;
  }
};

}  // namespace servodx
