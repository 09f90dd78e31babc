"""The model's stages with the signals between them, and where each fault of the registry sits."""
import re

import faults, shapes
from shapes import Box

WIDTH, HEIGHT, MARGIN, BOX, CHIP = 900, 658, 14, 172, 20
GAP = (WIDTH - 2 * MARGIN - 4 * BOX) / 3
ROWS = {1: (66, 172), 2: (292, 132), 3: (478, 118)}  # top and height of the boxes

# Stage, by its section of docs/model.md: column, row, the place of the rows that act there, what is in it.
STAGES = {
    "1": (0, 1, "drive", "null, amplifier and coil"),
    "2": (1, 1, "first_stage", "armature on its spring, flapper, wire"),
    "3": (2, 1, "first_stage", "two pilot pressures on the ends of the spool"),
    "5": (3, 1, "spool", "inertia, friction, flow force, stops"),
    "4": (3, 2, "metering", "four edges, and the drop of the lines behind them"),
    "6": (3, 3, "flow_a", "oil and air, the lines' walls, leak of the seal"),
    "7": (2, 3, "piston_force", "rod and load, friction, stops"),
    "8": (1, 3, "sensor", "motion, pressures and flows, each by its sensor"),
}
SUPPLY = "supply"
# Where an effect of the first stage acts: rows stand in the tables of sections 2 and 3, effects do not.
FIRST_STAGE_EFFECTS = {"nozzle_plugging": "3"}

# Arrow from stage to stage: words over it, signal under it, style, part of the side where it stands.
ALONG = [
    ("1", "2", "current", "i", "flow", 0.5),
    ("2", "3", "flapper", "x_f", "flow", 0.3),
    ("3", "2", "pressure", "p_1 - p_2", "back", 0.66),
    ("3", "5", "pressures", "p_1, p_2", "flow", 0.3),
    ("5", "3", "its speed", "x_s'", "back", 0.66),
    ("6", "7", "pressures", "p_A, p_B", "flow", 0.3),
    ("7", "6", "its speed", "v", "back", 0.72),
    ("7", "8", "piston", "x", "flow", 0.5),
]
DOWN = [
    ("5", "4", "spool", "x_s", "flow", 0.3),
    ("4", "5", "flow force", "", "back", 0.62),
    ("4", "6", "flows", "q", "flow", 0.3),
    ("6", "4", "pressures", "p_A, p_B", "back", 0.62),
]


def sections_of(page):
    """Number -> title and text."""
    found = re.findall(r"^## (\d)\. ([^\n]+)\n(.*?)(?=^## |\Z)", page, re.M | re.S)
    lacking = STAGES.keys() - {number for number, _, _ in found}
    if lacking:
        raise shapes.Refused(f"docs/model.md has no section {', '.join(sorted(lacking))}")
    return {number: (title, text) for number, title, text in found}


def stage_of(fault, sections):
    """The one at the fault's place; in the first stage the one whose table has its row."""
    if fault.place == SUPPLY:
        return SUPPLY
    fitting = [number for number, (_, _, place, _) in STAGES.items() if place == fault.place]
    if len(fitting) > 1:
        fitting = [number for number in fitting for moved in fault.moves
                   if f"`{moved}` (" in sections[number][1] or FIRST_STAGE_EFFECTS.get(moved) == number]
    if len(set(fitting)) != 1:
        raise shapes.Refused(f"the fault {fault.name} acts at '{fault.place}' by {', '.join(fault.moves)}: no one stage "
                             "of the figure holds that; say which in scripts/drawing/model.py")
    return fitting[0]


def box_of(number):
    column, row = STAGES[number][:2] if number != SUPPLY else (2, 2)
    top, height = ROWS[row]
    return Box(MARGIN + column * (BOX + GAP), top, BOX, height)


def draw_chips(figure, box, there):
    for at, fault in enumerate(reversed(there)):
        chip = Box(box.x + 8, box.bottom - 8 - CHIP - at * (CHIP + 4), box.w - 16, CHIP)
        figure.add(f"<g><title>{shapes.html.escape(fault.meaning)}</title>")
        figure.rect(chip, "fault", radius=10)
        figure.line_of(chip.x + chip.w / 2, chip.y + 14, fault.name, "code", "bad", "middle", chip.w - 8)
        figure.add("</g>")


def draw_stage(figure, number, title, says, there):
    box, chips = box_of(number), len(there) * (CHIP + 4)
    figure.rect(box, "outside" if number == SUPPLY else "stage")
    lower = Box(box.x, box.y, box.w, box.h - chips)
    figure.stage(lower, title, says, style="none", from_top=True)
    draw_chips(figure, box, there)


def along(figure, begin, end, over, under, style, part):
    """Between neighbours of a row."""
    a, b = box_of(begin), box_of(end)
    right = a.x < b.x
    start, goal = (a.at_right(part), b.at_left(part)) if right else (a.at_left(part), b.at_right(part))
    middle = (start[0] + goal[0]) / 2
    figure.arrow(start, goal, style=style)
    figure.line_of(middle, start[1] - 6, over, "code", "soft", "middle", GAP)
    figure.line_of(middle, start[1] + 15, under, "body", "ink", "middle", GAP, symbols=True)


def down(figure, begin, end, beside, under, style, part):
    """Between neighbours of a column; words stand at the right."""
    a, b = box_of(begin), box_of(end)
    start, goal = (a.below(part), b.on_top(part)) if a.y < b.y else (a.on_top(part), b.below(part))
    middle = (start[1] + goal[1]) / 2
    figure.arrow(start, goal, style=style)
    figure.line_of(start[0] + 6, middle - (2 if under else -4), beside, "code", "soft")
    figure.line_of(start[0] + 6, middle + 12, under, "body", "ink", symbols=True)


def draw_wire(figure):
    motor, spool = box_of("2"), box_of("5")
    start, goal = spool.on_top(), motor.on_top()
    figure.arrow(start, (start[0], 40), (goal[0], 40), goal, style="back")
    says = "the feedback wire: the spool's travel pulls at the flapper"
    figure.line_of((start[0] + goal[0]) / 2, 34, says, "code", "soft", "middle")


def draw_inputs(figure):
    """What the log drives the model with, and what it is compared with."""
    driver, piston, reported = box_of("1"), box_of("7"), box_of("8")
    command = Box(driver.x, 14, BOX, 28)
    figure.stage(command, "", "command of the log", style="outside")
    figure.arrow(command.below(), driver.on_top())
    load = Box(piston.x, HEIGHT - 42, BOX, 28)
    figure.stage(load, "", "load force of the log", style="outside")
    figure.arrow(load.on_top(), piston.below())
    misfit = Box(MARGIN, reported.y, BOX, reported.h)
    figure.stage(misfit, "Misfit", "what the log measured, less what the model reports", from_top=True)
    figure.arrow(reported.at_left(), misfit.at_right())


def draw_supply(figure):
    supply = box_of(SUPPLY)
    figure.arrow(supply.on_top(), box_of("3").below())
    figure.line_of(supply.x + BOX / 2 + 6, supply.y - 24, "pressure", "code", "soft")
    figure.line_of(supply.x + BOX / 2 + 6, supply.y - 9, "p_S, p_R", "body", "ink", symbols=True)
    y = supply.y + 0.5 * supply.h
    figure.arrow((supply.right, y), (box_of("4").x, y))
    figure.line_of(supply.right + GAP / 2, y - 6, "pressure", "code", "soft", "middle", GAP)
    figure.line_of(supply.right + GAP / 2, y + 15, "p_S, p_R", "body", "ink", "middle", GAP, symbols=True)


def draw_legend(figure):
    x, y = MARGIN, ROWS[2][0] + 14
    room = box_of("2").right - x - 66
    entries = ["a stage: a section of this page", "a fault of the registry, where it acts",
               "what goes on to the next stage", "what acts back", "what drives the model: from the log"]
    for at, says in enumerate(entries):
        figure.line_of(x + 52, y + at * 26 + 4, says, "small", "soft", room=room)
    figure.rect(Box(x, y - 8, 40, 16), "stage")
    figure.rect(Box(x, y + 18, 40, 16), "fault", radius=8)
    figure.arrow((x, y + 52), (x + 40, y + 52))
    figure.arrow((x, y + 78), (x + 40, y + 78), style="back")
    figure.rect(Box(x, y + 96, 40, 16), "outside")


def draw(root):
    sections, known = sections_of((root / "docs/model.md").read_text()), faults.registry(root)
    at = {}
    for fault in known:
        at.setdefault(stage_of(fault, sections), []).append(fault)
    titles = {number: f"{number}. {sections[number][0]}" for number in STAGES}
    titles[SUPPLY] = "Supply and return"
    said = "; ".join(f"{titles[number]}: {', '.join(f.name for f in there)}" for number, there in at.items())
    figure = shapes.Figure(WIDTH, HEIGHT, "The stages of the model, the signals between them, and the faults",
                           "From the command through driver, torque motor, nozzles, spool, metering edges, lines and "
                           f"chambers to the piston. Faults by stage: {said}.")
    for number, (_, _, _, says) in STAGES.items():
        draw_stage(figure, number, titles[number], says, at.get(number, []))
    draw_stage(figure, SUPPLY, titles[SUPPLY], "rows 36 and 37 where the log has none", at.get(SUPPLY, []))
    for arrow in ALONG:
        along(figure, *arrow)
    for arrow in DOWN:
        down(figure, *arrow)
    draw_wire(figure)
    draw_inputs(figure)
    draw_supply(figure)
    draw_legend(figure)
    return figure
