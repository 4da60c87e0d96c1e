"""Six calipers squeezed by 40 N: force of each pad over that of the finger, and what friction and wear do.

Writes caliper.png into the current directory.
"""

from beamdyn.common.drawing.layout import Paper
from beamdyn.common.drawing.on_axes import figure_of
from beamdyn.common.results.pictures import save_figure
from brakes import calipers
from brakes.drawings.caliper import caliper_drawing


def draw():
    """Each caliper open (grey) and closed on the rim, with its forces."""
    named = [calipers.NAMED[name]().build() for name in calipers.NAMED]
    drawn = [caliper_drawing(caliper, caliper.equilibrium(finger=40.0)) for caliper in named]
    return figure_of([drawn[:3], drawn[3:]], Paper(1320.0, (440.0, 440.0)))


def line(name):
    """What a caliper does, in a line."""
    caliper = calipers.NAMED[name]().build()
    run = caliper.stroke(finger=40.0)
    right, left = run.advantage[-1]
    closes, arrives = 1e3 * run.finger[-1], 100 * caliper.friction(0.15).squeeze
    return (
        f"{name:13} {right:.3f} right, {left:.3f} left; closes at {closes:.2f} mm of finger travel; "
        f"{arrives:.1f} % arrives with friction 0.15 in the pivots"
    )


if __name__ == "__main__":
    print(*map(line, calipers.NAMED), sep="\n")
    save_figure(draw(), "caliper.png", force=True)
