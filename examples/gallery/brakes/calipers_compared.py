"""
Six bicycle calipers, squeezed alike
====================================

Force of a pad over that of the finger while the brake closes. That of the eeBrake rises most over the
stroke: quick at first, strong at the end. The V-brake has the largest, and pays for it by the longest travel.
"""

import matplotlib.pyplot as plt

from brakes import calipers

fig, ax = plt.subplots()
for name, design in calipers.NAMED.items():
    run = design().build().stroke(finger=40.0)
    ax.plot(1e3 * run.finger, run.advantage[:, 0], label=name)
ax.set(xlabel="travel of the finger [mm]", ylabel="force of the right pad over the finger's")
ax.legend()
