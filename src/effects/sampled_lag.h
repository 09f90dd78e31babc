// First-order lag of a signal that is known at samples and runs straight between them: a ramp comes out late by the
// lag, however short against the period; what is left of the past falls as exp(-period / lag), to second order. No lag:
// the signal itself.
#pragma once

namespace servodx {

template <class T>
struct SampledLag {
  T input{}, output{};
  double time = 0;
  bool begun = false;

  // lag [s]; slope: of the signal at the first sample, before which it was a ramp.
  T operator()(double now, const T& x, const T& lag, const T& slope = T(0.0)) {
    if (!begun) {
      output = x - lag * slope;
    } else {
      const T dt = T(now - time);
      const T past = lag * lag / (lag * lag + lag * dt + T(0.5) * dt * dt);
      output = x - lag / dt * (x - input) * (T(1.0) - past) + past * (output - input);
    }
    input = x, time = now, begun = true;
    return output;
  }
};

}  // namespace servodx
