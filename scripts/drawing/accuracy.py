"""How often verdicts are right: the table of rigs judged blind in docs/accuracy.md, as bars with 95 % intervals."""
import re, typing

import shapes

SECTION, TOGETHER = "## Faults on rigs judged blind", "**together**"
WIDTH, LEFT, RIGHT, PITCH, THICK = 900, 262, 640, 26, 15  # [pixels]
DEVIATES = 1.959964  # of a 95 % interval


class Count(typing.NamedTuple):
    hits: int
    cases: int

    @property
    def share(self):
        return self.hits / self.cases

    def interval(self):
        """Wilson's."""
        n, z2 = self.cases, DEVIATES ** 2
        middle = (self.share + z2 / (2 * n)) / (1 + z2 / n)
        half = DEVIATES / (1 + z2 / n) * (self.share * (1 - self.share) / n + z2 / (4 * n * n)) ** 0.5
        return max(0.0, middle - half), min(1.0, middle + half)

    def words(self):
        """83 % (77 to 87): tenths where the share is small."""
        digits = 1 if 0 < self.share < 0.05 else 0
        share, lower, upper = (f"{100 * part:.{digits}f}" for part in (self.share, *self.interval()))
        return f"{share} % ({lower} to {upper})"


class Counts(typing.NamedTuple):
    rigs: int
    diagnosed_rigs: int
    explained_rigs: int
    severe: Count
    medium: Count
    mild: Count
    wrong: Count
    accused: Count
    full: Count
    third: Count
    controls: Count


def table_of(page):
    """The cells of the section's first table, a list a row; stars of bold type are left out."""
    if SECTION not in page:
        raise shapes.Refused(f"docs/accuracy.md has no section '{SECTION}'")
    section = page.split(SECTION, 1)[1].split("\n#", 1)[0]
    rows = [line.strip().strip("|").split("|") for line in section.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in row] for row in rows]


def counts_in(cell, shape):
    found = re.fullmatch(shape, cell.strip("*"))
    if not found:
        raise shapes.Refused(f"docs/accuracy.md, row {TOGETHER}: '{cell}' is not {shape}")
    return [int(number) for number in found.groups()]


def counts_of(page):
    head, _, *rows = table_of(page)
    column = {name: next((at for at, cell in enumerate(head) if cell.startswith(name)), None)
              for name in ("severe", "wrong fault", "`explain`")}
    together = next((row for row in rows if row[0] == TOGETHER), None)
    if together is None or None in column.values():
        raise shapes.Refused(f"docs/accuracy.md: the table has no row {TOGETHER}, or not the columns {list(column)}")
    rigs = [row for row in rows if re.match(r"\d+:", row[0])]
    severe, medium, mild, cases = counts_in(together[column["severe"]], r"(\d+), (\d+), (\d+) of (\d+)")
    wrong, faulty, accused, healthy = counts_in(together[column["wrong fault"]], r"(\d+) of (\d+); (\d+) of (\d+)")
    full, third, hidden, controls, clean = counts_in(together[column["`explain`"]],
                                                     r"(\d+), (\d+) of (\d+); (\d+) of (\d+)")
    judged = lambda name: sum(row[column[name]] != "-" for row in rigs)
    return Counts(len(rigs), judged("severe"), judged("`explain`"), Count(severe, cases), Count(medium, cases),
                  Count(mild, cases), Count(wrong, faulty), Count(accused, healthy), Count(full, hidden),
                  Count(third, hidden), Count(controls, clean))


def groups_of(c):
    """Heading, style, rows of a label and a count."""
    return [
        (f"diagnose names the fault: {c.diagnosed_rigs} rigs", "bar",
         [("severe faults", c.severe), ("medium faults", c.medium), ("mild faults", c.mild)]),
        (f"diagnose is wrong: {c.diagnosed_rigs} rigs", "bar-bad",
         [("faulty valves given a wrong fault", c.wrong), ("healthy logs accused", c.accused)]),
        (f"explain names missing physics: {c.explained_rigs} rigs", "bar",
         [("at full size", c.full), ("at a third of that size", c.third)]),
        (f"explain is wrong: {c.explained_rigs} rigs", "bar-bad", [("controls accused", c.controls)]),
    ]


def place_of(share):
    return LEFT + share * (RIGHT - LEFT)


def draw_row(figure, y, label, count, style):
    lower, upper = (place_of(part) for part in count.interval())
    middle = y + THICK / 2
    figure.line_of(LEFT - 12, middle + 4, label, anchor="end", room=LEFT - 30)
    figure.rect(shapes.Box(LEFT, y, place_of(count.share) - LEFT, THICK), style, radius=0)
    for x1, y1, x2, y2 in ((lower, middle, upper, middle), (lower, middle - 4, lower, middle + 4),
                           (upper, middle - 4, upper, middle + 4)):
        figure.straight(x1, y1, x2, y2, "range")
    figure.line_of(RIGHT + 92, middle + 4, f"{count.hits} of {count.cases}", anchor="end")
    figure.line_of(WIDTH - 16, middle + 4, count.words(), anchor="end", room=140)


def draw_grid(figure, top, bottom, labelled=False):
    for percent in range(0, 101, 25):
        x = place_of(percent / 100)
        figure.straight(x, top, x, bottom, "grid")
        if labelled:
            figure.line_of(x, bottom + 16, f"{percent} %", "small", "soft", "middle")


def draw(root):
    counts = counts_of((root / "docs/accuracy.md").read_text())
    groups = groups_of(counts)
    bottom = 44 + sum(30 + PITCH * len(rows) for _, _, rows in groups)
    said = "; ".join(f"{label}: {count.hits} of {count.cases}, {count.words()}" for _, _, rows in groups
                     for label, count in rows)
    figure = shapes.Figure(WIDTH, bottom + 48, f"Verdicts on {counts.rigs} simulated rigs that were judged blind",
                           f"Bars of the share of cases, with 95 % intervals by Wilson's formula. {said}.")
    figure.line_of(16, 28, figure.title, "title")
    y = 44
    for heading, style, rows in groups:
        figure.line_of(16, y + 20, heading, "head")
        y += 30
        draw_grid(figure, y - 4, y + PITCH * len(rows) - 6, labelled=heading == groups[-1][0])
        for label, count in rows:
            draw_row(figure, y, label, count, style)
            y += PITCH
    figure.line_of(16, bottom + 36, "Bar: share of the cases. Line across its end: 95 % interval by Wilson's formula, "
                   "which takes the cases as independent.", "small", "soft")
    return figure
