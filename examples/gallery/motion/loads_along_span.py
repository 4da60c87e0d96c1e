"""
What pulls on a blade
=====================

Axial force and bending moments along the NREL 5 MW blade at rated speed, from rotation and its own
weight, with the blade pointing to the side, where the weight bends it edgewise.
"""

import matplotlib.pyplot as plt
import numpy as np

import beamdyn as bd

blade = bd.load_scene("../../twisted_blade.toml")
loads = bd.static_loads(blade, speeds=12.1 * np.pi / 30, at=np.linspace(0, 0.98, 50) * blade.beam.length)

fig, axes = plt.subplots(2, 1, sharex=True, layout="constrained")
axes[0].plot(loads.x, loads.force[0, :, 0] / 1e3)
axes[0].set_ylabel("axial force [kN]")
axes[1].plot(loads.x, loads.moment[0] / 1e3, label=["flap", "edge"])
axes[1].legend()
axes[1].set(xlabel="distance from the root [m]", ylabel="bending moment [kN m]")
