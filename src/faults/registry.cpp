#include "faults/registry.h"

#include "faults/clogged_filter.h"
#include "faults/cylinder_leakage.h"
#include "faults/feedback_wire_backlash.h"
#include "faults/feedback_wire_lost.h"
#include "faults/null_shift.h"
#include "faults/plugged_nozzle.h"
#include "faults/radial_clearance_wear.h"
#include "faults/sensor_fault.h"
#include "faults/sticky_spool.h"
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
      &null_shift,              //
      &plugged_nozzle,          //
      &sensor_fault,            //
      &cylinder_leakage,        //
  };
  return list;
}

const Fault* find_fault(std::string_view name) {
  for (const Fault* f : fault_list())
    if (f->name == name) return f;
  return nullptr;
}

}  // namespace servodx
