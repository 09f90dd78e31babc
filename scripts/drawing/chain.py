"""From a log and a rig file to a verdict: the stages in order, with the functions that begin them."""
import re

import shapes
from shapes import Box

WIDTH, HEIGHT = 900, 756
LEFT, RIGHT = Box(16, 166, 240, 372), Box(296, 166, 588, 576)  # once for a rig; for each suspect log

# Stage: box, heading, words, functions with their files.
STAGES = {
    "reader": (Box(16, 88, 868, 54), "Readers",
               "every file from outside goes through one, which refuses it with an InputError or accepts it",
               {"read_log": "src/signals/log.cpp", "read_rig_file": "src/signals/rig_file.cpp",
                "read_table": "src/parameters/table.cpp"}),
    "tune": (Box(32, 200, 208, 88), "tune", "fits the rows to fault-free logs, learns how wrong the model is",
             {"tune_table": "src/tune/tune.cpp"}),
    "baseline": (Box(32, 376, 208, 88), "baseline", "assesses other fault-free logs alike and keeps their scores",
                 {"make_baseline": "src/diagnose/make_baseline.cpp"}),
    "judgeable": (Box(328, 216, 524, 54), "Is there anything to judge?", "if not: unknown, with the reason",
                  {"unjudgeable": "src/diagnose/judgeable.cpp"}),
    "records": (Box(328, 290, 164, 94), "Without a fit", "stops; records of supply, driver, sensors",
                {"gross_finding": "src/diagnose/gross.cpp", "look_at_records": "src/diagnose/records.cpp"}),
    "hypotheses": (Box(508, 290, 164, 94), "Hypotheses", "health, each fault, pairs of faults: a fit each",
                   {"fit_hypotheses": "src/diagnose/hypotheses.cpp"}),
    "readings": (Box(688, 290, 164, 94), "Further questions", "since when; was the log read wrongly",
                 {"find_onset": "src/diagnose/onset.cpp", "other_reading": "src/diagnose/other_reading.cpp"}),
    "evidence": (Box(328, 452, 246, 72), "Evidence", "what a fault gains beyond what it gains on healthy logs",
                 {"evidence_of": "src/diagnose/judge.cpp"}),
    "rules": (Box(606, 452, 246, 72), "Rules", "evidence in, verdict out: no fit, no log",
              {"decide": "src/diagnose/decide.cpp"}),
    "explain": (Box(704, 564, 164, 74), "explain", "missing physics: which, where, how large",
                {"explain_logs": "src/explain/explain.cpp"}),
}
# One function that calls what it holds.
GROUPS = {
    "assess": (Box(312, 194, 556, 202), "assess", "src/diagnose/diagnose.cpp"),
    "judge": (Box(312, 428, 556, 108), "judge", "src/diagnose/judge.cpp"),
}
VERDICT, SHOWN = Box(312, 564, 364, 74), Box(312, 664, 556, 62)  # what is decided, and as what it is given
VERDICTS = [("healthy", "good"), ("fault", "bad"), ("unknown", "doubt")]
# File: box, heading, words, and the function that writes it, where one of the figure's stages does not.
FILES = {
    "healthy": (Box(16, 14, 132, 46), "fault-free logs", "CSV or MAT", {}),
    "table": (Box(156, 14, 100, 46), "first table", "CSV", {}),
    "rig": (Box(296, 14, 130, 46), "rig file", "TOML", {}),
    "suspect": (Box(525, 14, 130, 46), "suspect log", "CSV or MAT", {}),
    "tuned": (Box(62, 312, 148, 40), "tuned table", "", {}),
    "base": (Box(62, 488, 148, 40), "its baseline", "", {}),
    "text": (Box(328, 673, 164, 44), "text", "", {"text_of": "src/report/diagnose/diagnosis_text.cpp"}),
    "page": (Box(508, 673, 164, 44), "page", "", {"diagnose_page": "src/report/diagnose/diagnose_page.cpp"}),
    "json": (Box(688, 673, 164, 44), "JSON", "", {"to_json": "src/report/diagnose/diagnosis_json.cpp"}),
}


def names_of(root, functions):
    """Their names in a line, each found in its file."""
    for name, path in functions.items():
        if not (root / path).exists() or not re.search(rf"\b{name}\(", (root / path).read_text()):
            raise shapes.Refused(f"{path} has no {name}, which the figure shows")
    return ", ".join(functions)


def draw_groups(root, figure):
    for box, name, path in GROUPS.values():
        figure.rect(box, "group")
        figure.line_of(box.x + 16, box.y + 15, names_of(root, {name: path}), "code", "soft")
    figure.rect(SHOWN, "group")
    figure.rect(VERDICT, "group")
    figure.line_of(VERDICT.x + 16, VERDICT.y + 22, "Verdict", "head")
    for at, (word, colour) in enumerate(VERDICTS):
        pill = Box(VERDICT.x + 16 + at * 114, VERDICT.y + 34, 104, 28)
        figure.rect(pill, "file", radius=14)
        figure.line_of(pill.x + pill.w / 2, pill.y + 18.5, word, "body", colour, "middle", pill.w - 16)


def draw_boxes(root, figure):
    for box, head, body, functions in STAGES.values():
        figure.stage(box, head, body, names_of(root, functions))
    for box, head, body, functions in FILES.values():
        figure.stage(box, head, body, names_of(root, functions), style="file")


def draw_preparation(figure):
    box = {name: held[0] for name, held in {**STAGES, **FILES}.items()}
    for name in ("healthy", "table", "rig", "suspect"):
        figure.arrow(box[name].below(), (box[name].below()[0], box["reader"].y))
    figure.arrow((box["tune"].on_top(0.75)[0], box["reader"].bottom), box["tune"].on_top(0.75))
    for begin, end in (("tune", "tuned"), ("tuned", "baseline"), ("baseline", "base")):
        figure.arrow(box[begin].below(), box[end].on_top())
    for name, group in (("tuned", "assess"), ("base", "judge")):
        y = box[name].at_right()[1]
        figure.arrow(box[name].at_right(), (GROUPS[group][0].x, y))


def draw_diagnosis(figure):
    box = {name: held[0] for name, held in {**STAGES, **FILES, **GROUPS}.items()}
    figure.arrow((box["judgeable"].below()[0], box["reader"].bottom), box["judgeable"].on_top())
    for name in ("records", "hypotheses", "readings"):
        figure.arrow((box[name].below()[0], box["judgeable"].bottom), box[name].on_top())
    x = box["evidence"].below()[0]
    figure.arrow((x, box["assess"].bottom), (x, box["evidence"].y))
    figure.arrow(box["evidence"].at_right(), box["rules"].at_left())
    x = box["rules"].x + 24
    figure.arrow((x, box["rules"].bottom), (x, VERDICT.y))
    y = VERDICT.y + 48
    figure.arrow((VERDICT.x + 16 + 2 * 114 + 104, y), (box["explain"].x, y))
    for x, bottom in ((VERDICT.below()[0], VERDICT.bottom), box["explain"].below()):
        figure.arrow((x, bottom), (x, SHOWN.y))


def draw_legend(figure):
    x, y = LEFT.x, LEFT.bottom + 40
    for at, (style, says) in enumerate((("stage", "a stage; in grey the function"), ("file", "a file, or what is shown"),
                                        ("group", "a function that calls what it holds"))):
        figure.rect(Box(x, y + at * 28 - 12, 40, 16), style)
        figure.line_of(x + 52, y + at * 28, says, "small", "soft", room=LEFT.w - 52)


def draw(root):
    figure = shapes.Figure(WIDTH, HEIGHT, "From a log and a rig file to a verdict",
                           "Readers take logs, rig file and table. Once for a rig, tune makes a tuned table and "
                           "baseline its baseline. For each suspect log, diagnose fits hypotheses, weighs the "
                           "evidence against the baseline and decides: healthy, fault or unknown. After unknown, "
                           "explain looks for missing physics. The verdict is given as text, page and JSON.")
    for panel, head in ((LEFT, "Once for a rig"), (RIGHT, "diagnose, for each suspect log")):
        figure.rect(panel, "panel", radius=8)
        figure.line_of(panel.x + 16, panel.y + 22, head, "head")
    draw_groups(root, figure)
    draw_boxes(root, figure)
    draw_preparation(figure)
    draw_diagnosis(figure)
    draw_legend(figure)
    return figure
