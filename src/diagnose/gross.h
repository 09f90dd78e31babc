// What a spool shows without any fit: on its stops at small current, or at rest while the current moves.
//
// The wire holds the spool against the torque; without it the spool runs to its stops, both of them, at any current.
// Nothing is found where the log holds no spool position.
#pragma once
#include "diagnose/ready_logs.h"
#include "faults/gross_finding.h"
#include "fit/log_data.h"
#include "simulate/scenario.h"

namespace servodx {

// `base`: the tuned candidate; its stop and its null are taken.
GrossFinding gross_finding(const LogData& log, const ParameterVector& base);
// Of several logs of one state the plainest, in the order of GrossFinding: the others need not show it.
GrossFinding gross_finding(const ReadyLogs& logs, const ParameterVector& base);

}  // namespace servodx
