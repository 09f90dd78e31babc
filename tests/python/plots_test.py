"""Every result draws and shows its head: with marks for what it holds, and as HTML that closes what it opens."""
import html.parser, json, unittest

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy
from common import *


class Closed(html.parser.HTMLParser):
    ALONE = {"br", "hr", "img"}

    def __init__(self, text):
        super().__init__()
        self.open, self.said = [], ""
        self.feed(text)
        if self.open:
            raise AssertionError(f"left open: {self.open}")

    def handle_starttag(self, tag, attributes):
        if tag not in self.ALONE:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if self.open.pop() != tag:
            raise AssertionError(f"</{tag}> closes another")

    def handle_data(self, data):
        self.said += data


def life(desk):
    rows = "".join(f"V7,{10 * k},parameter:22,{3e-6 + 4e-8 * max(0, k - 15) ** 1.5},1e-7\n" for k in range(40))
    (desk / "life.csv").write_text("valve,at [h],name,value,std_error\n" + rows)
    sx.History.import_csv(desk / "h.db", desk / "life.csv")
    return sx.trend(sx.History(desk / "h.db"), "V7")


class Plots(unittest.TestCase):
    def tearDown(self):
        plt.close("all")

    def drawn(self, figure, axes):
        figure.canvas.draw()
        self.assertEqual(len(figure.axes), axes)
        for panel in figure.axes:
            self.assertTrue(panel.lines or panel.patches or panel.collections, panel.get_ylabel())
        return figure

    def test_traces_have_a_panel_a_signal(self):
        log = suspect()
        self.drawn(log.plot(), len(log.signals))
        panel = log.plot(["pressure_a"]).axes[0]
        numpy.testing.assert_allclose(panel.lines[0].get_ydata(), log.signals["pressure_a"] / 1e5)
        self.assertIn("[bar]", panel.get_ylabel())
        self.drawn(tuned().simulate(log).plot(), 4)
        figure, ax = plt.subplots()
        self.assertIs(log.plot(["pressure_a"], ax=ax), figure)

    def test_residuals_stand_in_their_band(self):
        run = tuned().replay(suspect())
        figure = self.drawn(run.plot(), 2 * len(run.signals))
        right = figure.axes[1]
        self.assertTrue(right.collections)  # the band
        numpy.testing.assert_allclose(right.lines[0].get_ydata(), run.signals["spool_position"]["residual"] * 1e3)

    def test_hypotheses_causes_and_searches_draw(self):
        figure = self.drawn(verdict().plot(), 1)
        likely = [p for p in verdict().probabilities.values() if p > 1e-4]
        self.assertEqual(len(figure.axes[0].patches), min(len(likely), 12))
        self.drawn(tuned().explain([suspect()], baseline()).plot(), 2)
        self.drawn(tuned().plot(), 2)
        self.drawn(tuned().objective([suspect()]).plot("spool_friction", points=3), 1)

    def test_a_trend_has_levels_and_a_fan(self):
        with Desk() as desk:
            trend = life(desk)
        figure = self.drawn(trend.plot(), len(trend.trends))
        labels = {line.get_label() for panel in figure.axes for line in panel.lines}
        self.assertLessEqual({"threshold", "median life"}, labels)
        self.assertTrue(any(panel.patches for panel in figure.axes))

    def test_plans_draw(self):
        self.drawn(tuned().plan(faults=["clogged_filter"], seconds=0.3, rounds=0).plot(), 1)


class Heads(unittest.TestCase):
    def said(self, thing):
        return Closed(thing._repr_html_()).said

    def test_a_verdicts_head_says_what_it_is(self):
        said = self.said(verdict())
        self.assertIn(verdict().fault or verdict().kind.name, said)
        self.assertIn(verdict().action, said)

    def test_every_result_has_a_head(self):
        with Desk() as desk:
            trend = life(desk)
        for thing in (rig(), params(), suspect(), tuned(), baseline(), trend, tuned().simulate(suspect()),
                      tuned().explain([suspect()], baseline()),
                      tuned().plan(faults=["clogged_filter"], seconds=0.3, rounds=0),
                      tuned().check(sx.read_log(SOURCE / "data/healthy/h09_preflight_hot.csv", rig()), track=False)):
            with self.subTest(type(thing).__name__):
                self.assertGreater(len(self.said(thing)), 20)
        self.assertIn("V7", self.said(trend))

    def test_names_cannot_break_the_page(self):
        log = sx.Log(excerpt(TUNED_ON, 50).frame(), rig=rig(), name="<b>&")
        self.assertIn("<b>&", self.said(log))


main()
