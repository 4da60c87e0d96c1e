"""
Tongues: a wheel whose speed fluctuates
=======================================

Where the speed fluctuates at twice a natural frequency, or at the sum of two, free motion of the strip grows
without being pushed. Damping of 0.1 % of critical lifts the tongues off the axis.
"""

import matplotlib.pyplot as plt
import numpy as np

import beamdyn as bd

scene = bd.load_scene("../../pulsating_wheel.toml")
vary = {"motion.frequency": np.linspace(55, 135, 161), "motion.fluctuation": np.linspace(0, 0.4, 81)}
chart = bd.stability_chart(scene, vary, modes=2)

fig, ax = plt.subplots()
chart.plot(ax)
first = bd.natural_modes(scene, speed=50.0, modes=1).frequency[0]
ax.axvline(2 * first, color="0.5", linestyle=":", label="twice the first frequency")
ax.legend()
