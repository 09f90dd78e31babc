"""A verdict's page with numbered marks, and what each part of it says."""
import base64, struct, typing

import shapes

PICTURE, SIZE = "docs/pictures/fault.png", (1120, 660)  # [pixels] marks are placed on a picture of this size
WIDTH, MARGIN, PITCH = 900, 16, 53


class Mark(typing.NamedTuple):
    x: float  # of the picture
    y: float
    head: str
    says: str


MARKS = [
    Mark(930, 49, "Call, rig and test", "The log that was judged, the rig of its rig file, and oil and supply of this test."),
    Mark(946, 106, "Verdict", "The fault that is named, its size, and the 95 % interval of that."),
    Mark(840, 141, "What has broken", "The fault in words, and the log that shows it."),
    Mark(130, 178, "Probability", "Of the named fault, beside the other faults and health."),
    Mark(380, 178, "Error / threshold", "How far the log is from health, in standard deviations, and where healthy logs end."),
    Mark(515, 178, "Null", "The null bias in this log, in per cent of rated current."),
    Mark(728, 178, "Kind", "Where to look: a component, its surroundings, the log, the model or another test."),
    Mark(952, 178, "Action", "What to do. Its class is none, abuse, abnormal or critical."),
    Mark(980, 313, "Reasons", "How rare such an error is on healthy logs, what each explanation leaves, which comes next."),
    Mark(357, 453, "Hypotheses", "Each explanation was fitted to this log: its probability, its size and what it leaves."),
    Mark(1018, 454, "CSV", "The numbers behind the table. Every table and chart of a page has this button."),
]


def picture_of(root):
    data = (root / PICTURE).read_bytes()
    size = struct.unpack(">II", data[16:24])
    if size != SIZE:
        raise shapes.Refused(f"{PICTURE} has {size[0]} x {size[1]} pixels; the marks are placed on {SIZE[0]} x {SIZE[1]}")
    return base64.b64encode(data).decode()


def draw_mark(figure, x, y, number):
    figure.add(f'<circle class="mark" cx="{shapes.number(x)}" cy="{shapes.number(y)}" r="9.5"/>')
    figure.line_of(x, y + 4, str(number), "small", "on", "middle")


def draw_legend(figure, top):
    """In two columns, the first one down first."""
    half, room = -(-len(MARKS) // 2), WIDTH / 2 - MARGIN - 42
    for at, mark in enumerate(MARKS):
        x, y = MARGIN + (at // half) * WIDTH / 2, top + (at % half) * PITCH
        draw_mark(figure, x + 10, y, at + 1)
        figure.line_of(x + 28, y + 4.5, mark.head, "head", room=room)
        figure.words(x + 28, y + 20.5, mark.says, room, "small", "soft")


def draw(root):
    scale = (WIDTH - 2 * MARGIN) / SIZE[0]
    height = SIZE[1] * scale
    top = MARGIN + height + 30
    said = " ".join(f"{at}: {mark.head}. {mark.says}" for at, mark in enumerate(MARKS, 1))
    figure = shapes.Figure(WIDTH, round(top + -(-len(MARKS) // 2) * PITCH), "The page of a verdict, part by part",
                           f"A picture of the page with numbered marks. {said}")
    figure.add(f'<image x="{MARGIN}" y="{MARGIN}" width="{WIDTH - 2 * MARGIN}" height="{shapes.number(height)}" '
               f'href="data:image/png;base64,{picture_of(root)}"/>')
    figure.rect(shapes.Box(MARGIN, MARGIN, WIDTH - 2 * MARGIN, height), "frame", radius=0)
    for at, mark in enumerate(MARKS, 1):
        draw_mark(figure, MARGIN + mark.x * scale, MARGIN + mark.y * scale, at)
    draw_legend(figure, top)
    return figure
