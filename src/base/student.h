// Student's t.
#pragma once

namespace servodx {

// Two-sided tail.
double student_tail(double t, double degrees);

// Deviate whose two-sided tail is this chance, 0 < chance < 1.
double student_quantile(double chance, double degrees);

}  // namespace servodx
