"""Pages in a real headless Chromium: made-up results (sample_pages) and what the program itself writes. Called by
ctest: browser_test.py SAMPLE_PAGES SERVODX SOURCE [FOLDER]

With FOLDER pages and screenshots are kept there: light, dark, phone, print. Exit code 77: no browser here, skipped."""
import base64, csv, io, json, os, pathlib, random, shutil, subprocess, sys, tempfile, time, unittest

import browser
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

# A log may have any name.
HOSTILE = "<script>alert('log')<_script><img src=x onerror=alert(1)>.csv"
MADE_UP = ["diagnose", "many", "baseline", "tune", "gather"]  # watch writes pages of diagnose
REAL = ["explain", "check", "trend", "map", "curves", "check-log", "check-logs", "simulate", "compare", "certificate",
        "sensitivity", "selftest", "plan"]
PAGES = MADE_UP + REAL

# Relative luminance and contrast as WCAG 2 defines them, of every element that holds text of its own.
CONTRAST = """
const rgb = (c) => { const m = c.match(/[\\d.]+/g).map(Number); return m.length < 4 ? [...m, 1] : m; };
const linear = (v) => { v /= 255; return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; };
const luminance = ([r, g, b]) => 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
const behind = (e) => { for (; e; e = e.parentElement) { const c = rgb(getComputedStyle(e).backgroundColor); if (c[3] > 0.99) return c; } return [255, 255, 255]; };
const low = [];
for (const e of document.querySelectorAll('body *')) {
  if (!e.offsetParent || ![...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim())) continue;
  const a = luminance(rgb(getComputedStyle(e).color)), b = luminance(behind(e));
  const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
  if (ratio < 4.5) low.push(e.className + ': ' + e.textContent.trim().slice(0, 40) + ' ' + ratio.toFixed(2));
}
return low;"""


# Words of tables that stand in more than one line: letters below each other. What is longer than `most` may break.
TORN = """
const most = 16, torn = [];
for (const cell of document.querySelectorAll('figure:not(.plot) th, figure:not(.plot) td')) {
  const walk = document.createTreeWalker(cell, NodeFilter.SHOW_TEXT);
  for (let node; (node = walk.nextNode());)
    for (const word of node.data.matchAll(/\\S+/g)) {
      if (word[0].length > most) continue;
      const range = document.createRange();
      range.setStart(node, word.index);
      range.setEnd(node, word.index + word[0].length);
      if (new Set([...range.getClientRects()].map((r) => Math.round(r.top))).size > 1) torn.push(word[0]);
    }
}
return torn;"""


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(KEEP or tempfile.mkdtemp())
        cls.folder.mkdir(parents=True, exist_ok=True)
        subprocess.run([SAMPLES, str(cls.folder)], check=True)
        with tempfile.TemporaryDirectory() as desk:
            cls.real_pages(pathlib.Path(desk))
        cls.profile = tempfile.mkdtemp()
        cls.driver = browser.start(cls.profile)

    @classmethod
    def real_pages(cls, desk):
        """What the program writes of short shipped logs under a hostile name, with a table that was never tuned."""
        def rows(log, seconds):
            lines = (SOURCE / "data" / log).read_text().splitlines(True)
            head = next(i for i, line in enumerate(lines) if line.startswith("time"))
            return "".join(lines[head:head + 1 + round(1000 * seconds)])

        def servodx(command, *arguments, page=""):
            call = [PROGRAM, command, *arguments, "--report", str(cls.folder / f"{page or command}.html"), "--quiet"]
            ended = subprocess.run(call, cwd=desk, text=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            if ended.returncode:
                raise RuntimeError(f"servodx {command} ended with {ended.returncode}\n{ended.stderr}")

        table = (SOURCE / "params/borello2009.csv").read_text().splitlines()
        head = next(i for i, line in enumerate(table) if line.startswith("id,"))
        tuned = [table[head] + ",std_error"] + [line + "," for line in table[head + 1:] if line]
        error = [f"# model error {name}: floor {floor}, per activity 0.1, independent 20 1/s"
                 for name, floor in (("spool_position", "1e-6 m"), ("piston_position", "1e-5 m"), ("pressure_a", "2e4 Pa"),
                                     ("pressure_b", "2e4 Pa"))]
        (desk / "tuned.csv").write_text("\n".join(error + tuned) + "\n")
        given = ["--params", "tuned.csv", "--rig", str(SOURCE / "data/rig.toml")]
        log = desk / HOSTILE

        log.write_text(rows("healthy/h12_mixed.csv", 0.6))
        servodx("check-log", HOSTILE, *given)
        far = desk / "a_folder_whose_name_is_longer_than_a_phone_is_wide"
        far.mkdir()
        for name, seconds in ((HOSTILE, 0.6), ("two.csv", 0.7)):
            (far / name).write_text(rows("healthy/h12_mixed.csv", seconds))
        servodx("check-log", *(f"{far.name}/{name}" for name in (HOSTILE, "two.csv")), page="check-logs")
        servodx("simulate", HOSTILE, *given, "-o", "simulated.csv")
        servodx("sensitivity", HOSTILE, *given)
        servodx("selftest", HOSTILE, *given, "--repeats", "2")
        servodx("plan", *given, "--faults", "sticky_spool,null_shift", "--seconds", "0.5", "--rounds", "1", "-o", "plan.csv")
        servodx("explain", HOSTILE, *given, "-o", "extended.csv", "--json", HOSTILE + ".json")
        # The same result but for a name, a size and a verdict.
        other = json.loads((desk / (HOSTILE + ".json")).read_text())
        other["verdict"] = "sufficient"
        for channel in other["channels"]:
            channel["rms_after"] *= 1.5
        (desk / "other.json").write_text(json.dumps(other))
        servodx("compare", HOSTILE + ".json", "other.json")
        log.write_text(rows("healthy/h07_triangle.csv", 4))
        servodx("curves", HOSTILE, "--rig", str(SOURCE / "data/rig.toml"))
        said = json.dumps(HOSTILE.replace("_", "/"))
        (desk / "sheet.toml").write_text(f"""number = {said}
date = "2026-11-25"
issued = "2026-11-27"
laboratory = {said}
customer = {said}
method = {said}
authorised_by = {said}
[[instrument]]
name = {said}
signal = "spool_position"
uncertainty = "0.5 %"
due = "2026-11-01"
""")
        servodx("curves", HOSTILE, "--rig", str(SOURCE / "data/rig.toml"), "--certificate", "sheet.toml", page="certificate")
        log.write_text(rows("healthy/h09_preflight_hot.csv", 2.4))
        servodx("check", HOSTILE, *given, "--history", "one.db", "--valve", HOSTILE, "--at", "10")
        servodx("map", "--model", "C3", "--params", str(SOURCE / "params/borello2009.csv"), "-o", "map.csv")
        chance = random.Random(5)
        wear = [f"{HOSTILE},{10 * k},parameter:9,{max(0, k - 15) * 1e-6 + 3e-7 * chance.gauss(0, 1):.3g},3e-7"
                for k in range(30)]
        (desk / "history.csv").write_text("valve,at [h],name,value,std_error\n" + "\n".join(wear) + "\n")
        subprocess.run([PROGRAM, "history", "import", "history.csv", "--history", "wear.db", "--quiet"], cwd=desk,
                       check=True, stdout=subprocess.DEVNULL)
        servodx("trend", "--history", "wear.db", "--valve", HOSTILE)

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()
        shutil.rmtree(cls.profile, ignore_errors=True)
        if not KEEP:
            shutil.rmtree(cls.folder, ignore_errors=True)

    def setUp(self):
        self.set_size(1280, 1000)
        self.media("light")

    def media(self, scheme):
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})

    def set_size(self, width, height):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600})

    def open(self, name):
        for kind in ("browser", "performance"):
            self.driver.get_log(kind)
        self.driver.get((self.folder / f"{name}.html").as_uri())
        self.run("document.querySelectorAll('details').forEach((d) => d.open = true)")
        self.wait("window.servodx")

    def run(self, script, *arguments):
        if isinstance(script, str):
            return self.driver.execute_script(script, *arguments)
        return super().run(script)  # unittest calls this one

    def wait(self, condition):
        for _ in browser.frames(self.driver):
            if self.run("return Boolean(" + condition + ")"):
                return
        self.fail(f"{condition}: not after {browser.MOST_FRAMES} frames")

    def draw_all(self):
        browser.draw_all(self.driver)

    def screenshot(self, name):
        if not KEEP:
            return
        self.run("scrollTo(0, 0)")
        size = self.run("return [document.documentElement.clientWidth, document.documentElement.scrollHeight]")
        shot = self.driver.execute_cdp_cmd("Page.captureScreenshot", {
            "captureBeyondViewport": True, "clip": {"x": 0, "y": 0, "width": size[0], "height": min(size[1], 6000), "scale": 1}})
        (self.folder / f"{name}.png").write_bytes(base64.b64decode(shot["data"]))

    def test_no_console_error_and_nothing_is_fetched(self):
        for name in PAGES:
            self.open(name)
            self.draw_all()
            self.assertEqual([e["message"] for e in self.driver.get_log("browser")], [], name)
            asked = []
            for entry in self.driver.get_log("performance"):
                message = json.loads(entry["message"])["message"]
                if message["method"] == "Network.requestWillBeSent":
                    asked.append(message["params"]["request"]["url"])
            self.assertEqual([u for u in asked if not u.startswith(("file:", "data:"))], [], name)
            self.screenshot(name)

    def test_every_chart_shows_ink(self):
        for name in PAGES:
            self.open(name)
            self.draw_all()
            blank = self.run("""
                return [...servodx.drawn.keys()].filter((element) => {
                  const c = element.querySelector('canvas'), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
                  const seen = new Set();
                  for (let k = 0; k < d.length; k += 4) if (d[k + 3] > 200) seen.add(d[k] << 16 | d[k + 1] << 8 | d[k + 2]);
                  return seen.size < 3;
                }).length""")
            self.assertEqual(blank, 0, name)

    def test_what_came_from_a_file_is_text(self):
        for name in PAGES:
            self.open(name)
            self.assertEqual(self.run("return document.querySelectorAll('img').length"), 0, name)
            self.assertEqual(self.run("return document.scripts.length"), 3, name)  # data, uPlot, the page's own
            if name not in ("diagnose", "map", "plan"):  # these have no file of a hostile name
                self.assertIn("<script>alert('log')<", self.run("return document.body.innerText"), name)
        self.assertIn("script-src 'sha256-", (self.folder / "many.html").read_text())

    def test_an_injected_script_would_not_run(self):
        page = (self.folder / "baseline.html").read_text()
        (self.folder / "injected.html").write_text(page.replace("</main>", "<script>window.injected = 1</script></main>"))
        self.open("injected")
        self.assertIsNone(self.run("return window.injected ?? null"))
        self.assertTrue(self.run("return Boolean(window.servodx)"))

    def ranges(self):
        return self.run("return [...servodx.drawn.values()].map(({chart}) => [chart.scales.x.min, chart.scales.x.max])")

    def test_zoom_links_all_channels(self):
        self.open("diagnose")
        self.draw_all()
        self.assertGreaterEqual(len(self.ranges()), 9)  # command; value and residual of four channels
        whole = self.ranges()[0]
        over = self.driver.find_elements(By.CSS_SELECTOR, ".u-over")[1]
        self.run("arguments[0].scrollIntoView({block: 'center'})", over)
        ActionChains(self.driver).move_to_element_with_offset(over, -100, 0).click_and_hold().move_by_offset(200, 0).release().perform()
        zoomed = self.ranges()
        self.assertGreater(zoomed[0][0], whole[0])
        self.assertLess(zoomed[0][1], whole[1])
        self.assertTrue(all(r == zoomed[0] for r in zoomed), zoomed)
        self.screenshot("diagnose_zoomed")
        ActionChains(self.driver).double_click(over).perform()
        self.assertTrue(all(r == whole for r in self.ranges()), self.ranges())

    def test_keys_reach_and_move_the_charts(self):
        self.open("diagnose")
        self.draw_all()
        whole = self.ranges()[0]
        self.run("scrollTo(0, 0); document.activeElement.blur()")
        for _ in range(40):
            ActionChains(self.driver).send_keys(Keys.TAB).perform()
            if self.run("return document.activeElement.classList.contains('chart')"):
                break
        else:
            self.fail("no chart can be reached with the tab key")
        self.assertNotEqual(self.run("return getComputedStyle(document.activeElement).outlineStyle"), "none")
        self.driver.switch_to.active_element.send_keys("+")
        zoomed = self.ranges()
        self.assertTrue(all(r == zoomed[0] != whole for r in zoomed), zoomed)
        self.driver.switch_to.active_element.send_keys(Keys.ARROW_RIGHT)
        self.assertGreater(self.ranges()[0][0], zoomed[0][0])
        self.driver.switch_to.active_element.send_keys("0")
        self.assertEqual(self.ranges()[0], whole)
        unreachable = self.run("return [...document.querySelectorAll('button, .chart, .u-series th, summary')].filter((e) => e.tabIndex < 0).length")
        self.assertEqual(unreachable, 0)

    def test_text_can_be_read_in_light_and_dark(self):
        for name in PAGES:
            for scheme in ("light", "dark"):
                self.media(scheme)
                self.open(name)
                self.draw_all()
                self.assertEqual(self.run(CONTRAST), [], f"{name} {scheme}")
                if scheme == "dark":
                    self.screenshot(name + "_dark")

    def test_a_phone_shows_all_words_whole_without_scrolling_sideways(self):
        for name in PAGES:
            self.set_size(390, 844)
            self.open(name)
            self.draw_all()
            time.sleep(0.1)
            self.assertLessEqual(self.run("return document.documentElement.scrollWidth"), 390, name)
            self.assertEqual(self.run(TORN), [], name)
            folded = self.run("return [...document.querySelectorAll('[data-folded]')].filter((e) => e.getClientRects().length).length")
            self.assertEqual(folded, 0, name)
            self.screenshot(name + "_phone")

    def test_a_width_that_depends_on_the_charts_ends(self):
        # As where a chart taken down lets a scroll bar go: pages once drew for ever then.
        self.open("diagnose")
        self.draw_all()
        self.driver.execute_async_script("""
            const done = arguments[0], style = document.createElement('style');
            style.textContent = '.chart { width: 600px; } .chart:not(:has(.uplot)) { width: 580px; }';
            document.head.append(style);
            document.body.style.width = '1200px';
            setTimeout(done, 300);""")
        widths = self.run("return [...servodx.drawn.values()].map(({chart}) => chart.width)")
        self.assertEqual(set(widths), {600})

    def test_every_axis_of_time_says_its_unit(self):
        self.open("diagnose")
        self.draw_all()
        last = self.run("""return [...servodx.drawn.values()].map(({chart}) => chart.axes[0])
            .map((axis) => axis.label || axis._values.filter((v) => v != null).at(-1))""")
        self.assertTrue(last)
        self.assertEqual([text for text in last if not str(text).endswith((" s", "[s]"))], [])

    def test_a_legend_shows_dots_filled_and_dashes_dashed(self):
        def marker(page, series):
            self.open(page)
            self.draw_all()
            return self.run("""const row = [...document.querySelectorAll('.u-series')].find((e) => e.textContent.includes(arguments[0]));
                const style = getComputedStyle(row.querySelector('.u-marker'));
                return [style.backgroundColor, style.borderTopStyle];""", series)
        fill, _ = marker("trend", "taken as healthy")
        self.assertNotIn(fill, ("transparent", "rgba(0, 0, 0, 0)"))
        _, rim = marker("diagnose", "healthy")
        self.assertEqual(rim, "dashed")

    def test_every_figure_has_a_csv_that_reads_back(self):
        for name in PAGES:
            self.open(name)
            figures = self.driver.find_elements(By.TAG_NAME, "figure")
            self.assertTrue(figures)
            for figure in figures:
                self.assertEqual(len(figure.find_elements(By.CSS_SELECTOR, "button.csv")), 1)
                rows = list(csv.reader(io.StringIO(self.run("return servodx.csv(arguments[0])", figure))))
                self.assertGreater(len(rows), 1)
                self.assertEqual({len(r) for r in rows}, {len(rows[0])}, rows[:3])

    def test_a_million_rows_stay_small_and_keep_their_peak(self):
        took = browser.measure(self.driver, self.folder / "long.html")
        print("a million rows:", browser.words(took))
        self.assertLess(took["bytes"], 5_000_000)
        self.assertEqual(took["charts"], 9)
        # What its times rest on: few samples, and lines of one pixel; wider ones take ten times as long to the screen.
        self.assertLess(max(self.run("return [...servodx.drawn.values()].map(({chart}) => chart.data[0].length)")), 20_000)
        widths = self.run("""return [...servodx.drawn.values()].filter(({chart}) => chart.data[0].length > 4000)
            .flatMap(({chart}) => chart.series.slice(1).map((s) => s.width * devicePixelRatio))""")
        self.assertTrue(widths)
        self.assertLessEqual(max(widths), 1)
        spool = self.run("const e = [...servodx.drawn.keys()].find((e) => e.ariaLabel.startsWith('spool position [mm]')); return servodx.drawn.get(e).chart.data[1].reduce((a, b) => Math.max(a, b))")
        self.assertAlmostEqual(spool, 1.5, places=6)  # the lone sample, in mm

    def test_paper_gets_light_pages_with_every_chart(self):
        for name in PAGES:
            self.media("dark")
            self.open(name)
            pdf = base64.b64decode(self.driver.execute_cdp_cmd("Page.printToPDF", {"printBackground": True})["data"])
            self.assertTrue(pdf.startswith(b"%PDF"))
            self.assertGreater(len(pdf), 20_000, name)
            # And the screen is as before.
            self.assertEqual(self.run("return document.documentElement.dataset.print ?? null"), None)
            if KEEP:
                (self.folder / f"{name}.pdf").write_bytes(pdf)

    def test_nothing_is_cut_off_and_no_word_torn_on_paper(self):
        for name in PAGES:
            self.set_size(720, 1000)
            self.open(name)
            self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
            self.run("dispatchEvent(new Event('beforeprint'))")
            torn = self.run(TORN)
            cut = self.run("return [...document.querySelectorAll('.wide')].filter((e) => e.scrollWidth > e.clientWidth + 1 && getComputedStyle(e).overflowX !== 'visible').length")
            wide = self.run("return document.documentElement.scrollWidth")
            self.run("dispatchEvent(new Event('afterprint'))")
            self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
            self.assertEqual(cut, 0, name)
            self.assertEqual(torn, [], name)
            self.assertLessEqual(wide, 720, name)


SAMPLES, PROGRAM, SOURCE = sys.argv[1], str(pathlib.Path(sys.argv[2]).resolve()), pathlib.Path(sys.argv[3]).resolve()
KEEP = sys.argv[4] if len(sys.argv) > 4 else os.environ.get("SERVODX_SCREENSHOTS", "")
unittest.main(argv=sys.argv[:1], verbosity=2)
