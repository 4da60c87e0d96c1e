"""
Modes of a plate that is clamped along one edge
===============================================

A strip as wide as it is long bends, twists and cambers at frequencies of one order. Seen from above, the
nodal lines tell which: across it in bending, along it in torsion, and curved in camber.
"""

import matplotlib.pyplot as plt
import numpy as np

import beamdyn as bd

side, thickness, youngs_modulus, density, nu = 0.05, 0.0002, 200e9, 7850.0, 0.3
plate = bd.Beam.rectangular(side, side, thickness, youngs_modulus, density, poissons_ratio=nu)
scene = bd.Scene(plate, physics=bd.Physics(torsion=True, camber=True), units={"length": "mm"})
modes = bd.natural_modes(scene, modes=6, tolerance=1e-3)
fig, ax = plt.subplots(figsize=(9, 5.5), layout="constrained")
modes.plot(ax)

# %%
# Over the frequency (D/(density thickness))^(1/2)/side^2, with the bending stiffness D of the plate, they are
# the same for every thin square plate of the same Poisson's ratio:

D = youngs_modulus * thickness**3 / 12 / (1 - nu**2)
scaled = 2 * np.pi * modes.frequency * side**2 * np.sqrt(density * thickness / D)
print(*(f"{kind}: {value:.2f}" for kind, value in zip(modes.kind, scaled, strict=True)), sep=", ")
