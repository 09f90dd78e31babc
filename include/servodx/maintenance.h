// What is done to a valve in its life. A fault names the exchange of a part that renews it; a swap, an overhaul and a
// tune renew everything, a note nothing.
#pragma once

namespace servodx {

enum class EventKind { filter_changed, valve_swapped, overhauled, retuned, note };

}  // namespace servodx
