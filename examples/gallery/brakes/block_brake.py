"""
Friction decides: a block brake
===============================

A lever presses a block on a drum. The friction turns the lever about its fulcrum, too: towards the drum
if the drum turns one way, away from it if it turns the other.
"""

import matplotlib.pyplot as plt
import numpy as np

from brakes import planar


def torque(friction):
    """Torque [N m] of the brake as the drum turns anticlockwise and clockwise."""
    joints = (
        planar.Pin("fulcrum", "lever", "ground", at=(0.0, 0.0)),
        planar.Pin("axle", "drum", "ground", at=(0.25, -0.2)),
        planar.Contact("block", "lever", "drum", at=(0.25, -0.05), normal=(0, 1), friction=friction),
    )
    hand = planar.Force("hand", "lever", at=(0.6, 0.0), direction=(0, -1), magnitude=500.0)
    brake = planar.Mechanism(("lever", "drum"), joints, (hand, planar.Moment("torque", "drum")))
    found = planar.solve_with_friction(brake, "torque")
    return [abs(float(way.amplitudes["torque"])) for way in (found.squeeze, found.release)]


friction = np.linspace(0.05, 1.0, 20)
ours = np.array([torque(mu) for mu in friction])
arm, height, radius = 0.6 / 0.25, 0.05 / 0.25, 0.15  # by hand: N (1 -+ mu h) = F a, T = mu N r

fig, ax = plt.subplots()
ax.plot(friction, ours[:, 0], "o", label="anticlockwise")
ax.plot(friction, ours[:, 1], "s", label="clockwise")
for side in (-1, 1):
    ax.plot(friction, friction * radius * 500 * arm / (1 + side * friction * height), "k-", lw=0.8)
ax.set(xlabel="friction of the block", ylabel="torque [N m] for 500 N at the grip")
ax.legend(title="the drum turns")
