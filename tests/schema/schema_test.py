"""Real outputs of every command keep the JSON Schemas that the program prints, and nothing stands in one that the other
lacks. Called by ctest: schema_test.py SERVODX SOURCE [TEST...]

A schema lets further fields pass, as readers do. Here it is closed: a field that the list lacks (src/report/list/fields.txt)
fails, and so does one of the list that no output holds."""
import copy, json, pathlib, shutil, subprocess, sys, tempfile, unittest

try:
    import jsonschema
except ImportError:
    print("skipped: python3-jsonschema is not installed (scripts/setup installs it)")
    sys.exit(77)

PROGRAM, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()

# Fields that only a rare outcome holds: group.field, what it takes.
RARE = {
    "check.cause": "a check that points to a cause", "check.told": "a check with the model's own error",
    "check.whole_error": "a check with the model's own error", "truth.interrupted": "a rig that was stopped",
    "truth.changed": "rig --set", "truth.offset": "rig --offset", "truth.jitter": "rig --jitter",
    "truth.viscosity": "rig --viscosity", "truth.amplitude": "rig --amplitude", "truth.frequency": "rig --frequency",
    "truth.balance": "a rig whose facts do not change", "truth.played": "rig --command",
    "same_output.listed": "a manifest that was edited", "baseline.rig_file": "a baseline with a rig file",
    "watch_event": "an alarm", "supply_limit": "a supply in the log",
    "rig.logs": "rig of a fleet", "rig.valves": "rig of a fleet", "watch_limits.supply": "a supply in the log",
}
# Types that only a rare outcome holds, as a whole.
RARE_TYPES = {
    "named_fault", "record_finding", "suspicion", "beyond", "unlike", "pair", "fault_size", "shape", "cause", "sized_row",
    "explain_suspicion", "row_size", "curve", "curve_point", "missing_log", "tangent", "levels", "remaining", "refused",
    "watch_event", "supply_limit", "confusion", "true_class", "counted_rate", "settled_error", "block", "place",
    "missing_place", "candidate", "cause_score", "cause_share", "channel_error", "shown", "input_lag", "residual_map",
    "bin", "bode_point", "difference", "plan_pair", "plan_row", "earned", "finding", "identifiable", "visible", "true_fault",
    "calibration", "calibration_bin", "detectable_found", "beside_bound", "bound_band", "seen_faults",
}


def closed(schema):
    """The same, but no field may stand there that it does not name."""
    out = copy.deepcopy(schema)
    for part in [out, *out.get("$defs", {}).values()]:
        part["additionalProperties"] = False
    return out


def shorter(log, rows):
    lines = (SOURCE / "data" / log).read_text().splitlines(True)
    head = next(i for i, line in enumerate(lines) if not line.startswith("#"))
    return "".join(lines[:head + 1 + rows])


class Schemas(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.place.name)
        cls.schemas = {s["name"]: s["schema"] for s in cls.result("list", "schemas")["schemas"]}
        cls.outputs = {}  # name of the schema -> [(where from, value)]
        cls.make()

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    @classmethod
    def run_program(cls, *arguments, codes=(0,)):
        ended = subprocess.run([PROGRAM, *map(str, arguments), "--quiet"], cwd=cls.folder, text=True, capture_output=True)
        if ended.returncode not in codes:
            raise AssertionError(f"{' '.join(map(str, arguments))}: {ended.returncode}\n{ended.stderr}")
        return ended

    @classmethod
    def result(cls, *arguments, codes=(0,)):
        return json.loads(cls.run_program(*arguments, "--json", "-", codes=codes).stdout)

    @classmethod
    def keep(cls, name, *arguments, codes=(0,)):
        cls.outputs.setdefault(name, []).append((" ".join(map(str, arguments)), cls.result(name, *arguments, codes=codes)))

    @classmethod
    def read(cls, name, file):
        cls.outputs.setdefault(name, []).append((file, json.loads((cls.folder / file).read_text())))

    @classmethod
    def make(cls):
        put = lambda name, text: (cls.folder / name).write_text(text)
        for name, log, rows in (("a", "healthy/h08_preflight_cold.csv", 900), ("b", "healthy/h01_steps_large.csv", 900),
                                ("c", "healthy/h02_steps_small.csv", 900), ("d", "healthy/h04_multisine.csv", 900),
                                ("e", "healthy/h12_mixed.csv", 900), ("f", "fault/f04_backlash_severe.csv", 900)):
            put(name + ".csv", shorter(log, rows))
        put("bad.csv", "time [s],command [mA],spool_position [um]\n0,1\n")
        shutil.copy(SOURCE / "data/rig.toml", cls.folder)
        shutil.copytree(SOURCE / "params", cls.folder / "params")
        rig, table = ("--rig", "rig.toml"), "params/borello2009.csv"
        keep, run = cls.keep, cls.run_program
        for kind in ("faults", "effects", "params", "models", "signals", "excitations", "errors", "fields", "schemas"):
            keep("list", kind)
        keep("list", "params", "--params", table, *rig)
        keep("simulate", "a.csv", "--params", table, *rig, "-o", "sim.csv")
        cls.read("manifest", "sim.csv.manifest.json")
        keep("rerun", "sim.csv.manifest.json")
        keep("check-log", "a.csv", "--params", table, *rig)
        keep("init", "a.csv", "-o", "new.toml", "--table", "new.csv")
        keep("sensitivity", "a.csv", "--params", table, *rig)
        keep("monitor", "a.csv", "--params", table, *rig, "-o", "monitor.csv")
        keep("selftest", "a.csv", "--params", table, *rig, "--repeats", 2)
        keep("tune", "a.csv", "b.csv", "--params", table, *rig, "--generations", 0, "--rounds", 1, "--effects", "none",
             "-o", "tuned.csv")
        tuned = (*rig, "--params", "tuned.csv")
        keep("baseline", "c.csv", "d.csv", "e.csv", *tuned, "--false-alarm", 0.3, "-o", "base.json")
        judged = (*tuned, "--baseline", "base.json")
        keep("diagnose", "f.csv", *judged)
        keep("explain", "f.csv", *judged, "-o", "extended.csv")
        header, *rows = [line for line in (cls.folder / "e.csv").read_text().splitlines() if line[0] != "#"]
        put("last.json", json.dumps(cls.outputs["diagnose"][0][1]))
        keep("diagnose", "e.csv", *judged, "--against", "last.json")
        put("slow.csv", "\n".join([header] + [f"{2 * float(t):.9g},{rest}" for t, rest in (r.split(",", 1) for r in rows)]))
        keep("diagnose", "slow.csv", *judged)
        put("logs.txt", "c.csv\nbad.csv\n")
        run("diagnose", "--list", "logs.txt", "--out", "results", *judged, codes=(3,))
        refusal = next((cls.folder / "results").glob("*.refused.json"))
        cls.read("refused", refusal.relative_to(cls.folder))
        judged_one = next(p for p in (cls.folder / "results").glob("*.json") if not p.name.endswith(".refused.json"))
        cls.read("diagnose", judged_one.relative_to(cls.folder))
        put("truth.csv", "log,class\nc.csv,healthy\n")
        keep("gather", "results", "--truth", "truth.csv", codes=(0, 3))
        (cls.folder / "incoming").mkdir()
        shutil.copy(cls.folder / "c.csv", cls.folder / "incoming")
        keep("watch", "incoming", "--out", "watched", "--once", *judged)
        keep("watch", "--follow", "c.csv", "--until-idle", 0.5, *judged)
        for at in (0, 10, 20):
            keep("check", "a.csv", *tuned, "--history", "h.db", "--valve", "V1", "--at", at)
        put("checks.csv", "log,valve,hours\na.csv,V2,1\nbad.csv,V2,2\n")
        keep("check", "--list", "checks.csv", *tuned, "--history", "h.db", "--out", "checked", codes=(3,))
        wear = "".join(f"V7,{10 * k},parameter:9,{2e-7 * k + 1e-7 * (7 * k % 5 - 2):.6g},1e-7\n" for k in range(24))
        put("lives.csv", "valve,at [h],name,value,std_error\n" + wear)
        keep("history", "import", "lives.csv", "--history", "lives.db")
        keep("history", "show", "--history", "lives.db")
        keep("history", "verify", "--history", "lives.db")
        keep("history", "export", "--history", "lives.db", "-o", "out.csv")
        keep("history", "event", "filter_changed", "--history", "lives.db", "--valve", "V7", "--at", 300)
        keep("trend", "--history", "lives.db", "--valve", "V7")
        keep("trend", "--history", "lives.db", "--all")
        sweep = [(k / 100, 25 * (1 - abs(abs(k / 2500 - 1) * 2 - 1) * 2)) for k in range(5001)]
        put("flow.csv", "time [s],command [mA],control_flow [l/min]\n" + "".join(
            f"{t},{u:.3f},{0.7 * u + 0.01 * (k % 7):.3f}\n" for k, (t, u) in enumerate(sweep)))
        put("stand.toml", 'ports = "free"\n[valve]\nrated_current = "20 mA"\n[limits]\nhysteresis = "4 %"\n')
        keep("curves", "flow.csv", "--rig", "stand.toml")
        rated = (SOURCE / "data/rig.toml").read_text().replace(
            "[valve]\n", '[valve]\nstep_rise_time = "7.3 ms"\nstep_amplitude = "100 %"\nfrequency_response = '
            '[{ frequency = "60 Hz", amplitude = "40 %", gain = "-3 dB" }]\n', 1)
        put("rated.toml", rated)
        keep("curves", "--params", table, "--rig", "rated.toml")
        keep("plan", *tuned, "--faults", "clogged_filter", "--seconds", 0.5, "--rounds", 1, "-o", "plan.csv")
        keep("map", "--model", "C2", "-o", "map.csv")
        model = "params/rigs/borello2009.toml"
        keep("rig", "--rig-model", model, "--excitation", "mixed", "--duration", 0.2, "--rate", 500, "--temperature", 30,
             "--fault", "sticky_spool=4", "-o", "made.csv")
        cls.read("truth", "made.truth.json")
        keep("rig", "--rig-model", model, "--facts")
        halves = [line.split(",") for line in shorter("healthy/h12_mixed.csv", 2000).splitlines() if line[0] != "#"]
        drive = next(i for i, name in enumerate(halves[0]) if name.startswith(("command", "coil_current")))
        spool = next(i for i, name in enumerate(halves[0]) if name.startswith("spool_position"))
        piston = next(i for i, name in enumerate(halves[0]) if name.startswith("piston_position"))
        put("one.csv", "".join(f"{r[0]},{r[drive]},{r[piston]}\n" for r in halves))
        put("two.csv", "".join(f"{r[0]},{r[spool]},{r[piston]}\n" for r in halves))
        keep("join", "one.csv", "two.csv", "-o", "joined.csv")
        put("x.json", json.dumps(cls.outputs["diagnose"][0][1]))
        keep("compare", "x.json", "x.json")

    def test_every_output_keeps_its_schema(self):
        for name, outputs in self.outputs.items():
            jsonschema.Draft202012Validator.check_schema(self.schemas[name])
            whole = jsonschema.Draft202012Validator(self.schemas[name] if name == "refused" else closed(self.schemas[name]))
            for source, output in outputs:
                errors = [f"{'/'.join(map(str, e.absolute_path))}: {e.message[:300]}" for e in whole.iter_errors(output)]
                with self.subTest(name=name, source=source):
                    self.assertFalse(errors, f"{name} {source}:\n" + "\n".join(errors[:12]))

    def test_every_command_with_a_schema_was_run_and_none_lacks_one(self):
        self.assertEqual(set(self.outputs), set(self.schemas))
        told = subprocess.run([PROGRAM, "completion", "bash"], text=True, capture_output=True, check=True).stdout
        commands = {line.split(")")[0].strip() for line in told.splitlines() if ") options=" in line}
        self.assertEqual(commands - set(self.schemas), {"completion", "help", "man"})

    def test_every_field_of_the_list_stands_in_some_output(self):
        seen = set()

        def walk(schema, value, name, of):
            if "$ref" in schema:
                name = schema["$ref"].split("/")[-1]
                schema = of["$defs"][name]
            for choice in schema.get("anyOf", []):
                if value is not None and choice.get("type") != "null":
                    walk(choice, value, name, of)
            if isinstance(value, dict):
                for key, part in schema.get("properties", {}).items():
                    if key in value:
                        seen.add(f"{name}.{key}")
                        walk(part, value[key], name, of)
                if isinstance(schema.get("additionalProperties"), dict):
                    for part in value.values():
                        walk(schema["additionalProperties"], part, name, of)
            if isinstance(value, list) and "items" in schema:
                for part in value:
                    walk(schema["items"], part, name, of)

        listed = set()
        for name, schema in self.schemas.items():
            listed |= {f"{name}.{key}" for key in schema["properties"]}
            listed |= {f"{t}.{key}" for t, of in schema.get("$defs", {}).items() for key in of["properties"]}
            for _, output in self.outputs[name]:
                walk(schema, output, name, schema)
        missing = {f for f in listed - seen if f not in RARE and f.split(".")[0] not in RARE_TYPES}
        self.assertFalse(missing, "no output holds it: take it off the list, or say here what it takes")

    def test_a_field_that_the_list_lacks_is_told(self):
        name, (_, output) = "simulate", self.outputs["simulate"][0]
        more = {**output, "no_such_field": 1}
        self.assertTrue(list(jsonschema.Draft202012Validator(closed(self.schemas[name])).iter_errors(more)))
        self.assertFalse(list(jsonschema.Draft202012Validator(self.schemas[name]).iter_errors(more)))


unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
