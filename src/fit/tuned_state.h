// What a tuned table carries beside its rows: how wrong its model is, how its logs were filtered, and which they were.
//
// It stands in the table's own file, ahead of the header, as lines "#% ..." of TOML that other readers of CSV pass over
// as comments. A tune replaces it whole. Tables of earlier versions carry the same as comments for people ("model error
// ...", "moving average: ...", "tuned by ..."); these are read where there is no section (fit/tuning_comments.h).
#pragma once
#include <string>
#include <vector>

#include "fit/error_model.h"
#include "fit/recorder.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "servodx/tuned_by.h"

namespace servodx {

// A channel that the tune did not bring near its logs.
struct Unfollowed {
  Signal signal;
  double over_noise = 0;  // rms of what the fit leaves, over the sensor's noise
};

struct TunedState {
  static constexpr int schema = 1;
  ErrorModel error;
  Recorder recorder;
  std::vector<TunedBy> by;
  std::vector<Unfollowed> unfollowed;  // empty: the tune is good enough, or an earlier version did not ask

  bool is_by(const Log& log) const;
};

// Throws InputError where the section cannot be read or is of a newer schema.
TunedState tuned_state(const Table& table);
// Replaces the section; comments that carried it in earlier versions go.
void set_tuned_state(Table& table, const TunedState& state);
// Parts of it, where one is all that is asked for.
inline ErrorModel error_model_of(const Table& table) { return tuned_state(table).error; }
// Throws InputError where the table has none: it was not tuned.
ErrorModel required_error_model(const Table& tuned);
inline Recorder recorder_of(const Table& table) { return tuned_state(table).recorder; }
// The table's state stands in comments, as earlier versions wrote it.
bool has_old_state(const Table& table);

}  // namespace servodx
