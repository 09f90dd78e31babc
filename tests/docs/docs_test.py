"""Every command in the docs, run; every link, followed. Called by ctest: docs_test.py SERVODX SOURCE [TEST...]

A fence ```console holds commands ("$ servodx ...") and what they print. They run in order, in one folder a page, that
begins with data/ and params/. Of the output shown every line must be printed, in order, numbers aside: digits may
move, words may not; a line '...' stands for any lines. They run by the kernels of AVX2, where the machine has them:
last digits differ by instruction set and maker of the processor, and with them now and then which of two effects
stands first: a line that lists effects with their gains is compared without their order. A fence ```sh
holds commands with the reader's own names in them: they are rehearsed (--dry-run) in a folder that has files of these
names. `init` runs, as later lines need its files."""
import os, pathlib, re, shutil, subprocess, sys, tempfile, unittest

PROGRAM, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
PAGES = [SOURCE / "README.md", SOURCE / "CONTRIBUTING.md", SOURCE / "data" / "README.md", *sorted((SOURCE / "docs").glob("*.md")),
         *sorted((SOURCE / "docs" / "derivations").glob("*.md"))]
FENCE = re.compile(r"^```(\w*)\n(.*?)^```", re.S | re.M)


os.environ.setdefault("SERVODX_INSTRUCTION_SET", "avx2")
if subprocess.run([PROGRAM, "list", "models"], capture_output=True).returncode:
    del os.environ["SERVODX_INSTRUCTION_SET"]

RUN = re.compile(r"--help|servodx (man|completion|rerun|init|list)\b")  # quick, or without a rehearsal


def shape(line):
    plain = re.sub(r"\s+", " ", re.sub(r"[-+]?\d[\d.]*(e[-+]?\d+)?", "#", line)).strip()
    return " ".join(sorted(re.split(r"[,;:]? ", plain))) if plain.startswith("effects, with what each gains") else plain


def run(command, folder):
    return subprocess.run(["bash", "-ec", f'servodx() {{ "{PROGRAM}" "$@"; }}; ' + command], cwd=folder, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def blocks(text):
    """(command, lines shown) of a console fence; a command goes on after a backslash."""
    found, lines = [], iter(text.splitlines())
    for line in lines:
        if line.startswith("$ "):
            command = line[2:]
            while command.endswith("\\"):
                command = command[:-1] + next(lines).strip()
            found.append((command, []))
        elif found:
            found[-1][1].append(line)
    return found


class Docs(unittest.TestCase):
    def test_console_commands_print_what_is_shown(self):
        ran = 0
        for page in PAGES:
            fences = [body for kind, body in FENCE.findall(page.read_text()) if kind == "console"]
            if not fences:
                continue
            with tempfile.TemporaryDirectory() as folder:
                for name in ("data", "params"):
                    shutil.copytree(SOURCE / name, pathlib.Path(folder) / name)
                for command, shown in [b for fence in fences for b in blocks(fence)]:
                    ended = run(command, folder)
                    self.assertIn(ended.returncode, (0, 10, 11), f"{page.name}: {command}\n{ended.stderr}")
                    printed = [shape(line) for line in ended.stdout.splitlines()]
                    at = 0
                    for line in shown:
                        wanted = shape(line)
                        if wanted in ("", "..."):
                            continue
                        self.assertIn(wanted, printed[at:], f"{page.name}: {command}\nprinted:\n{ended.stdout}")
                        at += printed[at:].index(wanted) + 1
                    ran += 1
        self.assertGreater(ran, 5)

    def test_sh_commands_are_calls_that_the_program_takes(self):
        rehearsed = 0
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            self.furnish(folder)
            for page in PAGES:
                for kind, body in FENCE.findall(page.read_text()):
                    if kind != "sh":
                        continue
                    for line in re.sub(r"\\\n\s*", "", body).splitlines():
                        line = line.split("#")[0].strip()
                        if not line.startswith("servodx "):
                            continue
                        ended = run(line if RUN.search(line) else line + " --dry-run", folder)
                        made = re.search(r"-o (valve_7|tuned|base)\.csv", line)
                        if made and not (folder / made[0][3:]).exists():  # what a later line reads
                            shutil.copy(folder / "tuned.csv", folder / made[0][3:])
                        self.assertEqual(ended.returncode, 0, f"{page.name}: {line}\n{ended.stderr}")
                        rehearsed += 1
        self.assertGreaterEqual(rehearsed, 3)  # the main job

    def furnish(self, folder):
        """Files of the names that the docs use for the reader's own."""
        for name in ("data", "params"):
            shutil.copytree(SOURCE / name, folder / name)
        logs = sorted((SOURCE / "data" / "healthy").glob("*.csv"))
        for own, some in (("healthy", logs[:4]), ("other_healthy", logs[4:9]), ("acceptance", logs[:3])):
            (folder / own).mkdir()
            for log in some:
                shutil.copy(log, folder / own)
        for name in ("suspect.csv", "log.csv", "LOG.csv", "command.csv"):
            shutil.copy(SOURCE / "data/fault/f02_clogged_filter_severe.csv", folder / name)
        shutil.copy(SOURCE / "data/rig.toml", folder / "rig.toml")
        table = (SOURCE / "params/borello2009.csv").read_text().splitlines()
        head = next(i for i, line in enumerate(table) if line.startswith("id,"))
        tuned = table[:head] + [table[head] + ",std_error"] + [line + "," for line in table[head + 1:] if line]
        error = [f"# model error {name}: floor {floor}, per activity 0.1, independent 20 1/s"
                 for name, floor in (("spool_position", "1e-6 m"), ("piston_position", "1e-5 m"), ("pressure_a", "2e4 Pa"),
                                     ("pressure_b", "2e4 Pa"), ("leakage_flow", "1e-7 m3/s"))]
        (folder / "tuned.csv").write_text("\n".join(error + tuned) + "\n")
        hash_of = subprocess.run(["sha256sum", "tuned.csv"], cwd=folder, text=True, stdout=subprocess.PIPE).stdout.split()[0]
        (folder / "base.json").write_text(
            '{"command": "baseline", "threshold": 3, "adequacy_limit": 1, "null_limit": 0.05, "tuned_sha256": "%s", '
            '"false_alarm": {"asked": 0.1, "promised": 0.25, "promised_95": 0.6, "logs": 3, "logs_needed": 9, '
            '"statement": ""}, "scores": [{"log": "h.csv", "sha256": "1", "score": 1, "adequacy": 1, "gains": {}}]}' % hash_of)
        for name in ("a.json", "b.json"):
            (folder / name).write_text('{"tool": "servodx", "command": "tune"}')
        (folder / "logs.txt").write_text("".join(f"{log.relative_to(folder)}\n" for log in (folder / "healthy").iterdir()))
        (folder / "checks.csv").write_text("log,valve,hours\nlog.csv,V7,120\nsuspect.csv,V8,40\n")
        (folder / "results").mkdir()
        shutil.copytree(folder / "healthy", folder / "incoming")
        (folder / "results" / "log.json").write_text(
            '{"command": "diagnose", "log": "log.csv", "refused": {"file": "log.csv", "line": 2, "column": "", '
            '"rule": "ragged row", "mend": "mend it"}}')
        (folder / "truth.csv").write_text("log,class\nlog.csv,healthy\n")
        wear = "".join(f"V7,{10 * k},parameter:9,{1e-7 * k},1e-7\n" for k in range(20))
        (folder / "lives.csv").write_text("valve,at [h],name,value,std_error\n" + wear)
        (folder / "nodes").mkdir()
        shutil.copy(folder / "lives.csv", folder / "nodes/node3.csv")
        (folder / "seeded.csv").write_text("valve,name,truth,value,oil_temperature [degC]\n" + "".join(
            f"S{v},parameter:9,{size},{size * (1 + v / 100)},{oil}\n" for v in (1, 2) for size in (5e-6, 1e-5, 2e-5) for oil in (20, 60)))
        ended = run("servodx history import lives.csv --history h.db", folder)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        for i, (name, signal) in enumerate((("flow_gain", "control_flow [l/min]"), ("pressure_gain", "load_pressure [psi]"),
                             ("leakage_period_500", "leakage_flow [l/min]"), ("leakage_period_100", "leakage_flow [l/min]"),
                             ("leakage_period_20", "leakage_flow [l/min]"))):
            sweep = [(k / 100, 25 * (1 - abs(abs(k / 500 - 1) * 2 - 1) * 2)) for k in range(1001)]
            (folder / f"{name}.csv").write_text(f"time [s],command [mA],{signal}\n" + "".join(
                f"{t},{u:.3f},{-0.4 * u + 0.01 * (k % (7 + i)):.3f}\n" for k, (t, u) in enumerate(sweep)))
        ended = run("servodx simulate log.csv --params params/borello2009.csv --rig rig.toml -o sim.csv", folder)
        self.assertEqual(ended.returncode, 0, ended.stderr)

    def test_readme_shows_the_tutorials_verdict_digit_by_digit(self):
        """The tutorial's is held by the program."""
        shown = (SOURCE / "docs" / "tutorial.md").read_text().splitlines()
        verdicts = [body for kind, body in FENCE.findall((SOURCE / "README.md").read_text()) if "probability" in body]
        self.assertEqual(len(verdicts), 1)
        at = 0
        for line in verdicts[0].splitlines():
            if line.strip() == "...":
                continue
            self.assertIn(line, shown[at:])
            at += shown[at:].index(line) + 1

    def test_readme_counts_as_the_page_of_accuracy_does(self):
        counts = re.findall(r"\b\d+ of \d+\b", (SOURCE / "README.md").read_text())
        page = (SOURCE / "docs" / "accuracy.md").read_text()
        page = re.sub(r"\b(\d+), (\d+), (\d+) of (\d+)", r"\1 of \4, \2 of \4, \3 of \4", page)  # "166, 184, 174 of 200"
        self.assertGreaterEqual(len(counts), 5)
        for count in counts:
            self.assertRegex(page, rf"\b{count}\b")

    def test_no_command_stands_where_no_test_reads_it(self):
        for page in PAGES:
            for kind, body in FENCE.findall(page.read_text()):
                if re.search(r"^servodx ", body, re.M):
                    self.assertEqual(kind, "sh", f"{page.name}: {body}")

    def test_links_lead_somewhere(self):
        for page in PAGES:
            text = FENCE.sub("", page.read_text())
            for target in re.findall(r"\]\(([^)\s]+)\)", text):
                if target.startswith(("http:", "https:")):
                    continue
                path, _, anchor = target.partition("#")
                to = (page.parent / path).resolve() if path else page
                self.assertTrue(to.exists(), f"{page.name}: {target}")
                if anchor:
                    heads = [re.sub(r"[^\w\- ]", "", h.lower()).strip().replace(" ", "-")
                             for h in re.findall(r"^#+ (.*)$", to.read_text(), re.M)]
                    self.assertIn(anchor, heads, f"{page.name}: {target}")


unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
