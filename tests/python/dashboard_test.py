"""The example dashboard asks for metrics that `watch` and `trend --prometheus` write, by labels that they give them."""
import json, re, unittest

from common import SOURCE, main

MADE = "".join((SOURCE / "src" / name).read_text() for name in ("fleet/prometheus.cpp", "report/trend/life_gauges.cpp"))


class Dashboard(unittest.TestCase):
    def test_it_asks_for_what_is_written(self):
        board = json.loads((SOURCE / "examples/grafana/servodx.json").read_text())
        asked = [target["expr"] for panel in board["panels"] for target in panel["targets"]]
        asked += [variable["query"] for variable in board["templating"]["list"]]
        metrics = {name for text in asked for name in re.findall(r"servodx_\w+", text)}
        self.assertEqual(metrics, set(re.findall(r'head\(out, "(servodx_\w+)"', MADE)))
        for text in asked:
            for label in re.findall(r"[{,](\w+)=~?\"", text):
                if "node_textfile" not in text:
                    self.assertIn(f"{label}={{}}", MADE)

    def test_panels_do_not_overlap(self):
        board = json.loads((SOURCE / "examples/grafana/servodx.json").read_text())
        held = set()
        for panel in board["panels"]:
            at = panel["gridPos"]
            cells = {(x, y) for x in range(at["x"], at["x"] + at["w"]) for y in range(at["y"], at["y"] + at["h"])}
            self.assertFalse(cells & held, panel["title"])
            held |= cells


main()
