"""Program and library under a locale with decimal comma give the bits that they give under C.

The locale is made for the test by localedef, into a folder that LOCPATH names; skipped where that cannot be.
"""
import os, pathlib, re, shutil, subprocess, sys, tempfile, unittest

from common import *

NAME = "de_DE.UTF-8"


def made_in(folder):
    """Whether the locale could be made there, and is one."""
    if not shutil.which("localedef"):
        return False
    made = subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", f"{folder}/{NAME}"], capture_output=True, text=True)
    return made.returncode == 0


FOLDER = tempfile.TemporaryDirectory()
if not made_in(FOLDER.name):
    print("locale: SKIPPED: no locale with decimal comma can be made here; Debian's package 'locales' has its sources "
          "(scripts/setup installs it)")
    sys.exit(77)

# What a script that speaks the user's language does first; then the library reads, tunes, simulates and writes.
SCRIPT = f"""
import locale, sys
sys.argv = {sys.argv[:4]!r}
sys.path.insert(0, {str(pathlib.Path(__file__).parent)!r})
locale.setlocale(locale.LC_ALL, "")
from common import *
tuned = sx.tune([sx.Log.load("log.csv", rig=rig())], **quick())
tuned.save("tuned.csv")
run = sx.simulate(sx.Log.load("log.csv", rig=rig()), params=tuned.table, rig=rig())
run.save("run.csv")
print(float(run["spool_position"].sum()).hex(), tuned.table.sha256)
print(locale.localeconv()["decimal_point"], locale.format_string("%.1f", 1.5), file=sys.stderr)
"""
SECONDS = re.compile(r'"seconds": *[-+.e0-9]+')


def under(name, desk, *words):
    """Standard output and standard error of a call that has to end well."""
    kept = {key: value for key, value in os.environ.items() if not key.startswith("LC_") and key != "LANG"}
    ended = subprocess.run(list(map(str, words)), cwd=desk.name, capture_output=True, text=True,
                           env={**kept, "LC_ALL": name, "LOCPATH": FOLDER.name})
    if ended.returncode != 0:
        raise AssertionError(f"{words}: {ended.returncode}\n{ended.stderr}")
    return ended.stdout, ended.stderr


def bits(name):
    """All that program and library print and write under that locale; what the library's locale writes for 1.5."""
    rig_file, table = SOURCE / "data/rig.toml", SOURCE / "params/borello2009.csv"
    with Desk() as desk:
        (desk / "log.csv").write_text(excerpt_text(TUNED_ON, 300))
        said = [under(name, desk, PROGRAM, *words, "--quiet")[0] for words in (
            ("check-log", "log.csv", "--rig", rig_file, "--params", table, "--json", "look.json"),
            ("simulate", "log.csv", "--rig", rig_file, "--params", table, "-o", "sim.csv", "--json", "sim.json"),
            ("tune", "log.csv", "--rig", rig_file, "--params", table, "--generations", 0, "--rounds", 1, "--effects",
             "none", "-o", "by_program.csv", "--json", "tune.json", "--report", "tune.html"))]
        library, spoken = under(name, desk, sys.executable, "-B", "-c", SCRIPT)
        files = {path.name: SECONDS.sub("", path.read_text()) for path in sorted(pathlib.Path(desk.name).iterdir())
                 if not path.name.endswith(".manifest.json")}
        return {"said": said, "library": library, **files}, spoken


class Locale(unittest.TestCase):
    def test_a_decimal_comma_moves_no_bit(self):
        plain, point = bits("C")
        with_comma, comma = bits(NAME)
        self.assertEqual((point.split()[-2:], comma.split()[-2:]), ([".", "1.5"], [",", "1,5"]))
        self.assertGreater(len(plain), 9)
        for name in plain:
            self.assertEqual(with_comma[name], plain[name], name)


main()
