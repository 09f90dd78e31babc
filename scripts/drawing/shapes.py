"""Figures as plain SVG: boxes, arrows, words. Standard library only, and the same bytes each time.

Lengths are pixels, y grows downwards. Colours are classes of STYLE, which follows the reader's light or dark; the
background is opaque, so that a page of the other scheme does no harm. Words that would leave their room are refused:
widths are those of DejaVu Sans, the widest of the common sans-serif faces."""
import html, re, typing

FONT = {"title": 16, "head": 13.5, "body": 12, "small": 11, "code": 10.5}
WEIGHT = {"title": 600, "head": 600}

STYLE = """
text{font-family:sans-serif}
.paper{fill:#fff}.ink{fill:#1a1d21}.soft{fill:#565d66}.bad{fill:#b3261e}.good{fill:#1a7340}.doubt{fill:#8a5a00}
.on{fill:#fff}
.panel{fill:#f4f5f7;stroke:#d5d9de}.file{fill:#fff;stroke:#8b949e}.stage{fill:#eaf2fc;stroke:#7ea6d3}
.outside{fill:#fff;stroke:#8b949e;stroke-dasharray:4 3}.fault{fill:#fdeeec;stroke:#e0a19c}
.flow{stroke:#4b535c;fill:none;stroke-width:1.4}.back{stroke:#7ea6d3;fill:none;stroke-width:1.4}
.flow-head{fill:#4b535c}.back-head{fill:#7ea6d3}
.grid{stroke:#e0e3e7}.bar{fill:#7ea6d3}.bar-bad{fill:#e0a19c}.range{stroke:#1a1d21;stroke-width:1.6}.mark{fill:#0a58a8}
.none{fill:none}.group{fill:#fff;stroke:#d5d9de}.frame{fill:none;stroke:#8b949e}
@media (prefers-color-scheme:dark){
.paper{fill:#0f1216}.ink{fill:#e8eaed}.soft{fill:#a9b1bb}.bad{fill:#ff8f86}.good{fill:#6fcf97}.doubt{fill:#f2c14e}
.panel{fill:#171b21;stroke:#333a43}.file{fill:#0f1216;stroke:#7d8590}.stage{fill:#17263a;stroke:#3d6590}
.group{fill:#0f1216;stroke:#333a43}.outside{fill:#0f1216;stroke:#7d8590}.fault{fill:#331a1a;stroke:#8c4a46}
.flow{stroke:#a9b1bb}.back{stroke:#5a8fc7}.flow-head{fill:#a9b1bb}.back-head{fill:#5a8fc7}
.grid{stroke:#262c34}.bar{fill:#3d6590}.bar-bad{fill:#8c4a46}.range{stroke:#e8eaed}
}
"""

# Widths of characters [1/100 em], rounded up; every other one is WIDE.
WIDTHS = {28: "ijl'|", 30: "IJ", 32: " .,", 34: ":;/\\", 36: "f-", 40: "t()[]{}!", 42: "r", 50: "_*", 53: "s?z", 56: "cL",
          60: "vxykFTPY", 64: "aebdghnopqu0123456789E$S", 69: "AVKXZRBC", 76: "HNU", 79: "DGOQ&", 84: "w+=<>~#"}
WIDTH_OF = {character: width for width, characters in WIDTHS.items() for character in characters}
WIDE, BOLD = 99, 1.1


class Refused(Exception):
    """A figure that cannot be drawn, with the reason."""


class Box(typing.NamedTuple):
    x: float
    y: float
    w: float
    h: float

    @property
    def right(self):
        return self.x + self.w

    @property
    def bottom(self):
        return self.y + self.h

    def on_top(self, part=0.5):
        return self.x + part * self.w, self.y

    def below(self, part=0.5):
        return self.x + part * self.w, self.bottom

    def at_left(self, part=0.5):
        return self.x, self.y + part * self.h

    def at_right(self, part=0.5):
        return self.right, self.y + part * self.h


def number(value):
    return f"{value:.1f}".rstrip("0").rstrip(".")


def width_of(text, kind):
    """[pixels] of one line."""
    ems = sum(WIDTH_OF.get(character, WIDE) for character in text) / 100
    return ems * FONT[kind] * (BOLD if kind in WEIGHT else 1)


def wrapped(text, kind, room):
    """Lines that are no wider than the room."""
    lines = [""]
    for word in text.split():
        longer = f"{lines[-1]} {word}".strip()
        if width_of(longer, kind) <= room or not lines[-1]:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines


def spoken(text, size):
    """p_1 - p_2 with its indices lowered."""
    out, drop = "", number(size / 4)
    for at, part in enumerate(re.split(r"_(\w+)", text)):
        if at % 2:
            out += f'<tspan dy="{drop}" font-size="{number(size * 0.75)}">{html.escape(part)}</tspan>'
        elif part:
            out += f'<tspan dy="-{drop}">{html.escape(part)}</tspan>' if at else html.escape(part)
    return out


class Figure:
    def __init__(self, width, height, title, description):
        self.width, self.height, self.title, self.description = width, height, title, description
        self.parts = []

    def add(self, element):
        self.parts.append(element)

    def line_of(self, x, y, text, kind="body", colour="ink", anchor="start", room=None, symbols=False):
        """One line of words; y is its baseline."""
        if not text:
            return
        if room is not None and width_of(text, kind) > room + 0.5:
            raise Refused(f"'{text}' takes {width_of(text, kind):.0f} pixels of {room:.0f}")
        size, weight = FONT[kind], WEIGHT.get(kind)
        self.add(f'<text class="{colour}" x="{number(x)}" y="{number(y)}" font-size="{number(size)}"'
                 + (f' font-weight="{weight}"' if weight else "")
                 + (f' text-anchor="{anchor}"' if anchor != "start" else "")
                 + f'>{spoken(text, size) if symbols else html.escape(text)}</text>')

    def words(self, x, y, text, room, kind="body", colour="ink", anchor="start"):
        """Words in lines from a first baseline on; gives the baseline after the last."""
        for line in wrapped(text, kind, room):
            self.line_of(x, y, line, kind, colour, anchor, room)
            y += round(FONT[kind] * 1.28)
        return y

    def rect(self, box, style, radius=5):
        self.add(f'<rect class="{style}" x="{number(box.x)}" y="{number(box.y)}" width="{number(box.w)}" '
                 f'height="{number(box.h)}" rx="{number(radius)}"/>')

    def straight(self, x1, y1, x2, y2, style):
        self.add(f'<line class="{style}" x1="{number(x1)}" y1="{number(y1)}" x2="{number(x2)}" y2="{number(y2)}"/>')

    def stage(self, box, head, body="", code="", style="stage", from_top=False):
        """A box with a heading, words, and the names that the code has for it; refused where they leave it."""
        self.rect(box, style)
        x, room = box.x + box.w / 2, box.w - 14
        parts = [("head", "ink", head), ("body", "ink", body), ("code", "soft", code)]
        lines = [(kind, colour, line) for kind, colour, text in parts if text for line in wrapped(text, kind, room)]
        steps = [FONT[kind] * 1.3 for kind, _, _ in lines]
        if sum(steps) > box.h - 6:
            raise Refused(f"'{head}' takes {sum(steps):.0f} pixels of a box {box.h:.0f} high")
        y = box.y + (8 if from_top else (box.h - sum(steps)) / 2)
        for (kind, colour, line), step in zip(lines, steps):
            y += step
            self.line_of(x, y - FONT[kind] * 0.3, line, kind, colour, "middle", room)

    def arrow(self, *points, style="flow", head=7.0):
        """Along straight lines; the head ends at the last point."""
        (fx, fy), (tx, ty) = points[-2], points[-1]
        length = ((tx - fx) ** 2 + (ty - fy) ** 2) ** 0.5
        ux, uy = (tx - fx) / length, (ty - fy) / length
        neck = (tx - head * ux, ty - head * uy)
        path = " ".join(f"{number(x)},{number(y)}" for x, y in [*points[:-1], neck])
        self.add(f'<polyline class="{style}" points="{path}"/>')
        corners = [(tx, ty)] + [(neck[0] - side * uy * head / 2, neck[1] + side * ux * head / 2) for side in (1, -1)]
        self.add(f'<polygon class="{style}-head" points="{" ".join(f"{number(x)},{number(y)}" for x, y in corners)}"/>')

    def svg(self):
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width} {self.height}" width="{self.width}" '
                f'height="{self.height}" role="img" aria-labelledby="title desc">\n'
                f'<title id="title">{html.escape(self.title)}</title>\n'
                f'<desc id="desc">{html.escape(self.description)}</desc>\n<style>{STYLE}</style>\n'
                f'<rect class="paper" width="{self.width}" height="{self.height}"/>\n')
        return head + "\n".join(self.parts) + "\n</svg>\n"
