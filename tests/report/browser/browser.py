"""A headless Chromium for pages of servodx, and how long such a page takes: browser.py PAGE.html..."""
import pathlib, shutil, statistics, sys, time

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
except ImportError:
    print("skipped: python3-selenium is not installed (scripts/setup installs it)")
    sys.exit(77)

DRIVER, CHROMIUM = shutil.which("chromedriver"), shutil.which("chromium")
if not DRIVER or not CHROMIUM:
    print("skipped: chromium and chromedriver are not installed (scripts/setup installs them)")
    sys.exit(77)

FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-dev-shm-usage",
         "--disable-background-networking", "--disable-component-update", "--disable-sync", "--window-size=1280,1000"]

# From the key to the frame that shows the new range: uPlot draws in a microtask, the screen in the next frame.
ZOOM = """
const done = arguments[0], shown = () => new Promise((r) => requestAnimationFrame(() => setTimeout(r)));
(async () => {
  const took = [];
  for (const element of servodx.drawn.keys()) {
    element.scrollIntoView({block: 'center'});
    await shown();
    for (const key of ['+', 'ArrowRight', '0']) {
      const began = performance.now();
      servodx.step(element, key);
      await shown();
      took.push(performance.now() - began);
    }
  }
  done(took);
})();"""

MOST_FRAMES = 1000
NEVER = 3600  # [s] for a browser that died; what a page fails to do is counted in frames


def start(profile):
    options = webdriver.ChromeOptions()
    options.binary_location = CHROMIUM
    for flag in FLAGS + [f"--user-data-dir={profile}"]:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(service=Service(DRIVER), options=options)
    driver.set_script_timeout(NEVER)
    driver.set_page_load_timeout(NEVER)
    return driver


def frames(driver):
    """Counts the page's own frames while something is waited for: a busy machine shows them later, and no fewer."""
    for count in range(MOST_FRAMES):
        yield count
        driver.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")


def draw_all(driver):
    """Charts draw when they come near the screen."""
    left = "return [...document.querySelectorAll('.chart')].filter((e) => !servodx.drawn.has(e))"
    for _ in frames(driver):
        if not (waiting := driver.execute_script(left)):
            return
        driver.execute_script("arguments[0].scrollIntoView()", waiting[0])
    raise TimeoutError(f"{len(waiting)} charts are not drawn after {MOST_FRAMES} frames")


def measure(driver, page):
    """Of a page: bytes, milliseconds to load, to draw every chart, and of each zoom step on each chart until all linked
    charts show it; and the processor's time of the page's thread, which a busy machine leaves as it is."""
    def busy():
        metrics = driver.execute_cdp_cmd("Performance.getMetrics", {})["metrics"]
        return 1e3 * next(m["value"] for m in metrics if m["name"] == "TaskDuration")

    driver.execute_cdp_cmd("Performance.disable", {})
    driver.execute_cdp_cmd("Performance.enable", {"timeDomain": "threadTicks"})
    began = time.time()
    driver.get(pathlib.Path(page).resolve().as_uri())
    loaded = time.time()
    driver.execute_script("for (const d of document.querySelectorAll('details')) d.open = true")
    draw_all(driver)
    drawn, at_drawn = time.time(), busy()
    zoom = driver.execute_async_script(ZOOM)
    at_end = busy()
    driver.execute_cdp_cmd("Performance.disable", {})
    return {"bytes": pathlib.Path(page).stat().st_size, "charts": driver.execute_script("return servodx.drawn.size"),
            "load": 1e3 * (loaded - began), "draw": 1e3 * (drawn - loaded), "open_cpu": at_drawn,
            "zoom": zoom, "zoom_cpu": (at_end - at_drawn) / len(zoom)}


def words(m):
    return (f"{m['bytes'] / 1e6:.2f} MB, {m['charts']} charts; loaded in {m['load']:.0f} ms, all drawn {m['draw']:.0f} ms "
            f"later, {m['open_cpu']:.0f} ms of processor; a zoom on all linked charts: {m['zoom_cpu']:.0f} ms of "
            f"processor, to the screen median {statistics.median(m['zoom']):.0f}, longest {max(m['zoom']):.0f} ms")


if __name__ == "__main__":
    import tempfile

    with tempfile.TemporaryDirectory() as profile:
        driver = start(profile)
        try:
            for page in sys.argv[1:]:
                print(page + ":", words(measure(driver, page)))
        finally:
            driver.quit()
