// `servodx rig`: the virtual rig writes a log and, beside it, the truth; or a labelled set of them.
#pragma once

namespace CLI {
class App;
}

namespace servodx {

void add_rig_command(CLI::App& app, int& exit_code);

}  // namespace servodx
