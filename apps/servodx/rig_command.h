// `servodx rig`: the virtual rig writes a log and, beside it, the truth.
#pragma once

namespace CLI {
class App;
}

namespace servodx {

void add_rig_command(CLI::App& app);

}  // namespace servodx
