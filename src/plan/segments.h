// The pieces a planned test is made of: a library of shapes, each with an amplitude and a rate.
//
// Every shape runs in whole cycles and spends as long on either side, so that a piston that integrates it comes back.
// `stairs` holds third parts, `pulses` rests between its strokes. Time is parted evenly among the pieces, between a
// short rest before and after.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "base/random.h"

namespace servodx {

enum class Shape { rest, steps, pulses, stairs, triangle, sine, sweep };
inline constexpr int n_shapes = 7;
std::string name_of(Shape shape);

struct Segment {
  Shape shape = Shape::rest;
  double amplitude = 0;  // [1 of rated current]
  double rate = 0;       // [Hz] asked for; whole cycles are played
};

// When each piece is played.
struct Timing {
  double rate = 1000;              // [Hz] of samples
  std::size_t samples = 0;         // of the whole test
  std::vector<std::size_t> first;  // sample of each piece's begin; one more: the end of the last
  std::size_t pieces() const { return first.size() - 1; }
  double seconds(std::size_t piece) const { return static_cast<double>(first[piece + 1] - first[piece]) / rate; }
};
Timing timing_of(double seconds, double rate);
// The same rests about a single piece of that length.
Timing single_piece(const Timing& of);

// [1 of rated current] one a sample.
std::vector<double> wave_of(const std::vector<Segment>& segments, const Timing& timing);
// Cycles that a piece has time for. [Hz] as played
double played_rate(const Segment& segment, double seconds);

// Every shape at every amplitude and rate that is worth playing. `current` [1 of rated] is the largest amplitude.
std::vector<Segment> segment_library(double current, double seconds, double rate);
Segment random_segment(Random& random, double current, double seconds, double rate);

}  // namespace servodx
