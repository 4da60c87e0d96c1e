"""
Campbell diagram of a 5 MW blade
================================

Frequencies of the NREL 5 MW reference blade over rotor speed, beside the lines at whole multiples of it.
Flap and edge are coupled by the twist.
"""

import matplotlib.pyplot as plt
import numpy as np

import beamdyn as bd

rpm = np.pi / 30
blade = bd.load_scene("../../twisted_blade.toml")
diagram = bd.campbell(
    {"NREL 5 MW": blade},
    np.linspace(0, 15, 61) * rpm,
    modes=4,
    rated=12.1 * rpm,
    operating=(6.9 * rpm, 12.1 * rpm),
    unit="rpm",
)
fig, ax = plt.subplots(figsize=(8, 6.5), layout="constrained")
diagram.plot(ax)

# %%
# How far each frequency is from the nearest line at rated speed:
for margin in diagram.margins:
    if margin.where == "rated speed":
        print(
            f"{margin.name:8} {margin.frequency:.3f} Hz, {100 * margin.margin:+.0f} % from {margin.line.name}"
        )
