// The committed logs and tables, as a user would give them to the program.
#pragma once
#include <string>

#include "fit/log_data.h"
#include "parameters/table.h"
#include "servodx/data_sheet.h"
#include "servodx/rig.h"
#include "signals/log.h"

namespace servodx {

inline std::string shipped(const std::string& path) { return std::string(SERVODX_SOURCE_DIR) + "/" + path; }
inline RigFile shipped_rig() { return read_rig_file(shipped("data/rig.toml")); }
inline Log shipped_log(const std::string& name) { return read_log(shipped("data/" + name + ".csv"), shipped_rig()); }
inline LogData shipped_data(const std::string& name) { return prepare(shipped_log(name), shipped_rig()); }
// The table of the flight actuator with the data sheet's facts on it: what a fit starts from.
inline Table shipped_table() { return apply_rig_facts(read_table(shipped("params/borello2009.csv")), shipped_rig()); }

}  // namespace servodx
