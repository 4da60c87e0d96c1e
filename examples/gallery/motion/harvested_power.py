"""
Harvested power over speed
==========================

A steel strip between two piezoelectric layers points inward on the rim of a wheel, which rolls over a wavy
road. Power peaks beside the resonances with the road, and where gravity meets the beam that rotation softens:
there the strain of the layers sets the limit. A random road, even a very good one, gives more, if the wheel
follows it.
"""

import matplotlib.pyplot as plt
import numpy as np

import beamdyn as bd

scene = bd.load_scene("../../bimorph.toml")
speeds = np.linspace(36, 126, 46)
found = bd.harvest(scene, speeds, modes=2, road=bd.RoadRoughness("A", highest=10.0))

fig, ax = plt.subplots()
found.plot(ax).legend(loc="lower right")
km_per_hour = 3.6 * scene.motion.rolling_radius * speeds
at = np.argmax(found.power[speeds < 80])
ax.annotate(
    f"{1e6 * found.power[at]:.0f} µW at {km_per_hour[at]:.0f} km/h",
    (speeds[at], found.power[at]),
    xytext=(72, 2 * found.power[at]),
    arrowprops={"arrowstyle": "-", "color": "0.4"},
)
