#include "faults/registry.h"

#include <algorithm>

#include "faults/clogged_filter.h"
#include "faults/corner_wear.h"
#include "faults/cylinder_leakage.h"
#include "faults/driver_fault.h"
#include "faults/feedback_wire_backlash.h"
#include "faults/feedback_wire_lost.h"
#include "faults/null_shift.h"
#include "faults/plugged_nozzle.h"
#include "faults/radial_clearance_wear.h"
#include "faults/sensor_fault.h"
#include "faults/sticky_spool.h"
#include "faults/supply_fault.h"
#include "faults/torque_motor_loss.h"

namespace servodx {

const std::vector<const Fault*>& fault_list() {
  static const std::vector<const Fault*> list = {
      &clogged_filter,          //
      &torque_motor_loss,       //
      &feedback_wire_backlash,  //
      &feedback_wire_lost,      //
      &sticky_spool,            //
      &radial_clearance_wear,   //
      &corner_wear,             //
      &null_shift,              //
      &plugged_nozzle,          //
      &sensor_fault,            //
      &cylinder_leakage,        //
      &supply_fault,            //
      &driver_fault,            //
  };
  return list;
}

const Fault* fault_told_by(Record record) {
  const auto& all = fault_list();
  const auto it = std::find_if(all.begin(), all.end(), [&](const Fault* f) { return f->told_by == record; });
  return it == all.end() ? nullptr : *it;
}

const Fault* find_fault(std::string_view name) {
  for (const Fault* f : fault_list())
    if (f->name == name) return f;
  return nullptr;
}

}  // namespace servodx
