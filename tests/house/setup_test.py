"""scripts/setup says what it installs while it works: all that apt says on a terminal; elsewhere what is fetched, the
room it takes and a line a package. With stand-ins for apt and dpkg: nothing is installed. Called by ctest."""
import os, pathlib, subprocess, tempfile, unittest

import source

APT = """#!/bin/sh
[ "$1" = update ] && exit 0
echo "Need to get 61.5 MB of archives."
echo "After this operation, 243 MB of additional disk space will be used."
echo "Selecting previously unselected package cmake."
echo "Setting up cmake (3.25.1-1) ..."
echo "Setting up liburing2:amd64 (2.3-3) ..."
exit ${APT_ENDS:-0}
"""
STAND_INS = {"apt-get": APT, "dpkg-query": "#!/bin/sh\nexit 1\n", "sudo": '#!/bin/sh\nexec "$@"\n'}


def setup(terminal=False, ends=0):
    """(exit code, standard output, standard error)"""
    with tempfile.TemporaryDirectory() as name:
        for tool, text in STAND_INS.items():
            (pathlib.Path(name) / tool).write_text(text)
            (pathlib.Path(name) / tool).chmod(0o755)
        ours, theirs = os.openpty() if terminal else os.pipe()
        try:
            ended = subprocess.run([source.ROOT / "scripts/setup", "--run"], stdout=subprocess.PIPE, stderr=theirs, text=True,
                                   env={**os.environ, "PATH": f"{name}:{os.environ['PATH']}", "APT_ENDS": str(ends)})
            said = os.read(ours, 1 << 16).decode()
        finally:
            os.close(ours), os.close(theirs)
        return ended.returncode, ended.stdout, said


class Setup(unittest.TestCase):
    def test_a_log_has_a_line_a_package_and_the_room_it_takes(self):
        code, out, err = setup()
        self.assertEqual(code, 0, err)
        self.assertRegex(out, r"setup: installing \d+ packages with what they need, which takes some minutes: g\+\+ cmake")
        self.assertRegex(out, r"setup: installed \d+ packages in \d+ s\n")
        self.assertEqual(err.splitlines(), [
            "setup: reading the lists of packages", "setup: Need to get 61.5 MB of archives.",
            "setup: After this operation, 243 MB of additional disk space will be used.", "setup: cmake 3.25.1-1",
            "setup: liburing2:amd64 2.3-3"])

    def test_a_terminal_has_all_that_apt_says(self):
        code, out, err = setup(terminal=True)
        self.assertEqual(code, 0, err)
        self.assertIn("Selecting previously unselected package cmake.", err)
        self.assertNotIn("Selecting", out)

    def test_what_apt_fails_at_fails(self):
        code, out, _ = setup(ends=100)
        self.assertEqual(code, 100)
        self.assertNotIn("installed", out)


if __name__ == "__main__":
    unittest.main(verbosity=2)
