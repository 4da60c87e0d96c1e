"""
What a tolerance is worth
=========================

Thickness, material and radius of a harvester within their tolerances: the spread of its first frequency,
and which of them it comes from. Bars: the share of an input in the variance, with all that it does together
with others (total Sobol' index) and the standard error; diamonds: its share alone.
"""

import matplotlib.pyplot as plt

import beamdyn as bd

scene = bd.load_scene("../../tyre_harvester.toml")
tolerances = {
    "beam.thickness": "+-2%",
    "beam.youngs_modulus": "sd 1%",
    "mount.radius": bd.Uniform(0.213, 0.217),
}
found = bd.spread(scene, tolerances, speed=50.0, modes=1, samples=512)
print(f"{found.worst.smallest[0]:.2f} to {found.worst.largest[0]:.2f} Hz at worst")

fig, axes = plt.subplots(2, 1, figsize=(8, 7), layout="constrained")
found.plot(axes[0])
found.plot_indices(axes[1])
