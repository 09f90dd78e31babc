// What was found, as a user reads it: a cause with its numbers in their units, and the error of each.
#pragma once
#include <string>

#include "explain/answer.h"
#include "explain/beside_healthy.h"
#include "explain/engine.h"
#include "explain/explain.h"
#include "explain/fit_causes.h"
#include "explain/inquiry.h"
#include "explain/subject.h"

namespace servodx {

// The effect, and of a sensor's fault which sensor.
std::string name_of(const Cause& cause);

// `told_by`: the subject that it was found on, the valve's or the replay of its blocks; `fit`: whose point the numbers
// are taken at. The error of a number is that of the fit, and what healthy logs scatter.
ExplainedCause described(const Inquiry& inquiry, const Subject& told_by, const CauseResult& cause,
                         const ExplainedFit& fit);
// One that was told between command and coil current (explain/ask_drive.cpp).
ExplainedCause described_of_drive(const Inquiry& inquiry, const Answer& answer, const CauseResult& cause);
std::string meaning_of(const Cause& cause);
// A number as a size: its interval ends where the number may not go, and tells nothing where it covers all of that.
// value, std_error: of the number. `factor`: [unit of the size] per unit of the number.
ExplainedParameter sized(const Number& number, double value, double std_error, double factor = 1);
// How a number of a cause scatters over healthy logs. [its unit] 0 where that is not known. `of`: what it is a factor
// on.
double healthy_spread(const Subject& subject, const HealthyTest& test, int cause, std::size_t number, double std_error,
                      double of = 1);
// A cause that healthy logs show too was fitted alone.
ExplainedCause described_standing(const Inquiry& inquiry, const CauseResult& cause);

}  // namespace servodx
