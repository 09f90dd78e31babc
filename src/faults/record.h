// Whose record in a log tells a fault without the model: the supply's, the driver's (its current beside the command),
// a sensor's own.
#pragma once

namespace servodx {

enum class Record { supply, driver, sensor };

}  // namespace servodx
