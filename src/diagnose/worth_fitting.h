// Which fits are worth their runs: pure functions of misfits, -2 log likelihood each.
#pragma once

namespace servodx {

// Whether a hypothesis leaves more than health does, and so much more than the best that its chance is nothing: by how
// much is then of no use to anyone. `degrees`: independent samples of the log.
bool is_hopeless(double misfit, double healthy, double best, double degrees);

// What two faults at once gain over the best single one, but for what a model that errs by a part of the effect may
// lend the second.
double pair_gain(double misfit, double best, double healthy);
// Whether any pair could gain: none leaves less than nothing.
inline bool pair_could_gain(double best, double healthy) { return pair_gain(0, best, healthy) > 0; }

}  // namespace servodx
