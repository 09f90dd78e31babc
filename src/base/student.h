// Student's t.
#pragma once

namespace servodx {

// Two-sided tail.
double student_tail(double t, double degrees);

}  // namespace servodx
