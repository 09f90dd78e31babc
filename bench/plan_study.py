#!/usr/bin/env python3
"""plan_study.py PROGRAM OUT [--valves N] [--rigs borello2009,bench] [--pairs a=s:b=s,...] [--faults f=s,...] [--jobs N]

What planned tests are worth, blind: valves drawn from a virtual rig's tolerances, each with its own table and baseline.
Of every valve: three logs of mixed steps tune; the plan is made from that table; the healthy valve plays mixed logs,
the planned and the random test for the baseline; then a valve with the fault plays the planned and the random test at
another temperature, and `diagnose` judges each play alone. Counts with Wilson's 95 % intervals.

The random test is the one that `plan --random` writes: pieces drawn blindly, as long, and within the same limits.
"""
import argparse, concurrent.futures, json, math, pathlib, subprocess, sys, time

SOURCE = pathlib.Path(__file__).resolve().parents[1]
RIGS = {"borello2009": ("data/rig.toml", "params/borello2009.csv"), "bench": ("data/bench/rig.toml", "params/bench.csv")}
TUNING, MIXED, PLAYS = 3, 3, 3  # logs of a valve: that tune; of the baseline mixed, and of each test


def wilson(k, n):
    if n == 0:
        return 0.0, 1.0
    z = 1.96
    p, grown = k / n, 1 + z * z / n
    centre, half = (p + z * z / (2 * n)) / grown, z / grown * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    return max(0.0, centre - half), min(1.0, centre + half)


class Valve:
    """One valve of one rig, its files in a folder; a file that is there is not made again."""

    def __init__(self, program, out, rig, number):
        self.program, self.rig, self.number = program, rig, number
        self.folder = out / rig / f"valve{number}"
        self.folder.mkdir(parents=True, exist_ok=True)
        sheet, table = RIGS[rig]
        self.sheet, self.nominal = str(SOURCE / sheet), str(SOURCE / table)

    def call(self, *words):
        made = subprocess.run([self.program, *map(str, words), "--quiet", "--threads", "1"], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        if made.returncode not in (0, 3):
            raise RuntimeError(f"{' '.join(map(str, words))}: {made.stderr}")

    def log(self, name, seed, temperature, command=None, seconds=2.0, fault=None):
        path = self.folder / f"{name}.csv"
        if not path.exists():
            drive = ["--command", command] if command else ["--excitation", "mixed", "--duration", seconds]
            self.call("rig", "--rig-model", SOURCE / f"params/rigs/{self.rig}.toml", "--valve", self.number, *drive,
                      "--seed", 1000 * self.number + seed, "--temperature", temperature,
                      *(["--fault", fault] if fault else []), "-o", path)
        return path

    def tuned(self):
        path = self.folder / "tuned.csv"
        logs = [self.log(f"tune{i}", i, 35 + 5 * i, seconds=2.5) for i in range(TUNING)]
        if not path.exists():
            self.call("tune", *logs, "--rig", self.sheet, "--params", self.nominal, "--generations", 4, "-o", path)
        return path

    def plan(self, name, wish):
        command, blind = self.folder / f"{name}.plan.csv", self.folder / f"{name}.random.csv"
        result = self.folder / f"{name}.plan.json"
        if not result.exists():
            self.call("plan", "--params", self.tuned(), "--rig", self.sheet, "--like", self.log("tune0", 0, 35), *wish,
                      "--seconds", 2, "--seed", self.number, "-o", command, "--random", blind, "--json", result)
        return command, blind, json.loads(result.read_text())

    def baseline(self, name, tests):
        path = self.folder / f"{name}.base.json"
        if not path.exists():
            logs = [self.log(f"mixed{i}", 20 + i, 32 + 6 * i) for i in range(MIXED)]
            for which, command in tests.items():
                logs += [self.log(f"{name}.{which}.healthy{i}", 40 + i, 34 + 6 * i, command) for i in range(PLAYS)]
            self.call("baseline", *logs, "--rig", self.sheet, "--params", self.tuned(), "--false-alarm", 0.1, "-o", path)
        return path

    def judge(self, log, base):
        path = log.with_suffix(".verdict.json")
        if not path.exists():
            self.call("diagnose", log, "--rig", self.sheet, "--params", self.tuned(), "--baseline", base, "--json", path)
        return json.loads(path.read_text())["results"][0]

    def study(self, name, wish, faults):
        """[(test, fault, verdict, foreseen)] of each fault under the planned and the random test."""
        command, blind, foreseen = self.plan(name, wish)
        tests = {"planned": command, "random": blind}
        base = self.baseline(name, tests)
        out = []
        for i, fault in enumerate(faults):
            for which, played in tests.items():
                log = self.log(f"{name}.{which}.{fault.replace('=', '_')}", 60 + i, 42, played, fault=fault)
                out.append((which, fault, self.judge(log, base), foreseen["seconds"]))
        return out


def one(task):
    valve, name, wish, faults = task
    try:
        return task, valve.study(name, wish, faults)
    except RuntimeError as error:
        return task, error


def show(title, rows):
    print(title)
    for key in sorted({(rig, which, fault) for rig, which, fault, _ in rows}):
        verdicts = [v for rig, which, fault, v in rows if (rig, which, fault) == key]
        label = key[2].split("=")[0]
        named = sum(v["fault"] == label for v in verdicts)
        alone = sum(v["fault"] == label and not v["ambiguous_with"] for v in verdicts)
        found = sum(v["verdict"] != "healthy" for v in verdicts)
        n, (low, high) = len(verdicts), wilson(named, len(verdicts))
        others = sorted({str(v["fault"] or v["verdict"]) for v in verdicts if v["fault"] != label})
        print(f"  {key[0]:12} {key[1]:8} {key[2]:32} found {found:2} named {named:2} of {n:2} "
              f"({100 * low:.0f} to {100 * high:.0f} %), alone {alone:2}  {' '.join(others)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program"), parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--valves", type=int, default=10)
    parser.add_argument("--rigs", default="borello2009,bench")
    parser.add_argument("--faults", default="clogged_filter=0.6,sticky_spool=6,radial_clearance_wear=3")
    parser.add_argument("--pairs", default="sticky_spool=4:feedback_wire_backlash=8e-6,"
                        "torque_motor_loss=0.85:feedback_wire_lost=0.85,clogged_filter=0.6:plugged_nozzle=0.3")
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    program = str(pathlib.Path(options.program).resolve())
    tasks = []
    for number in range(1, options.valves + 1):
        for rig in options.rigs.split(","):
            valve = Valve(program, options.out, rig, number)
            if options.faults:
                tasks.append((valve, "find", ["--faults", options.faults], options.faults.split(",")))
            for pair in filter(None, options.pairs.split(",")):
                a, b = pair.split(":")
                name = a.split("=")[0] + "-" + b.split("=")[0]
                tasks.append((valve, name, ["--between", f"{a},{b}"], [a, b]))
    rows, seconds, begun = {}, [], time.time()
    # One task at a time of each valve: its table is made once.
    by_valve = {}
    for task in tasks:
        by_valve.setdefault((task[0].rig, task[0].number), []).append(task)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for done in pool.map(lambda some: [one(t) for t in some], by_valve.values()):
            for (valve, name, _, _), result in done:
                if isinstance(result, RuntimeError):
                    print(f"  set aside: {valve.rig} {valve.number} {name}: {result}", file=sys.stderr)
                    continue
                for which, fault, verdict, took in result:
                    rows.setdefault(name, []).append((valve.rig, which, fault, verdict))
                    seconds.append(took)
            print(f"{time.time() - begun:.0f} s", file=sys.stderr)
    for name in rows:
        show(name, rows[name])
    if seconds:
        seconds.sort()
        print(f"planning took {seconds[len(seconds) // 2]:.1f} s in the middle, {seconds[-1]:.1f} s at most, one thread")


if __name__ == "__main__":
    main()
