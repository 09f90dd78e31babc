// Calls to copy, in the order in which a rig's owner needs them: under each command's help and in the manual page.
#pragma once
#include <array>
#include <string_view>

namespace servodx {

struct Example {
  std::string_view purpose;  // "What a log holds"
  std::string_view call;     // "servodx check-log log.csv": the second word is the command
};

inline constexpr std::array examples = {
    Example{"Begin a rig file and a parameter table from a log's header",
            "servodx init log.csv -o bench.toml --table params.csv"},
    Example{"See what logs hold, and what is suspicious in them", "servodx check-log healthy/*.csv --rig bench.toml"},
    Example{"Bring two recorders of one test to one clock", "servodx join rig.csv valve.csv -o log.csv"},
    Example{"Tune the model to fault-free logs",
            "servodx tune healthy/*.csv --rig bench.toml --params params.csv -o tuned.csv --report tuned.html"},
    Example{"Set the threshold from other fault-free logs, with 5 % of false alarms",
            "servodx baseline other/*.csv --rig bench.toml --params tuned.csv --false-alarm 0.05 -o base.json"},
    Example{
        "Judge a log, with a page that shows why",
        "servodx diagnose suspect.csv --rig bench.toml --params tuned.csv --baseline base.json --report verdict.html"},
    Example{"Judge several logs of one valve in one state as one",
            "servodx diagnose open.csv closed.csv --pool --rig bench.toml --params tuned.csv --baseline base.json"},
    Example{"Judge logs by the thousand",
            "servodx diagnose --list logs.txt --out results --params tuned.csv --baseline base.json"},
    Example{"Plan a test of 2 s that distinguishes two faults",
            "servodx plan --params tuned.csv --between sticky_spool,feedback_wire_backlash --seconds 2 -o command.csv"},
    Example{"One table and page of many results, beside the truth",
            "servodx gather results --truth truth.csv --report fleet.html -o fleet.csv"},
    Example{"Judge new logs of a folder as they come",
            "servodx watch incoming --out results --params tuned.csv --baseline base.json"},
    Example{"Watch a log that grows",
            "servodx watch --follow log.csv --state watch.json --params tuned.csv --baseline base.json"},
    Example{"Ask what the simulation gets wrong, and why",
            "servodx explain log.csv --rig bench.toml --params tuned.csv --baseline base.json -o extended.csv"},
    Example{"Simulate a log", "servodx simulate log.csv --params tuned.csv -o sim.csv"},
    Example{"Store the prognostic checks of a log at 120 h",
            "servodx check log.csv --params tuned.csv --history h.db --valve V7 --at 120"},
    Example{"See what wears, first to warn first", "servodx trend --history h.db --all"},
    Example{"Note a maintenance event", "servodx history event filter_changed --valve V7 --at 150 --history h.db"},
    Example{"Standard figures of a valve on a test stand, with a picture",
            "servodx curves flow_gain.csv --rig bench.toml --svg curves.svg"},
    Example{"Write a log of the virtual rig with a fault in it",
            "servodx rig --excitation mixed --fault clogged_filter=0.5 -o clogged.csv"},
    Example{"See what changed between two verdicts", "servodx compare then.json now.json"},
    Example{"Make a result again and compare every bit", "servodx rerun verdict.json.manifest.json"},
};

}  // namespace servodx
