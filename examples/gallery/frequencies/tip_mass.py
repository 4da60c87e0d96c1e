"""
A tip mass tunes a harvester
============================

The first frequency over the mass at the tip, beside the formula of textbooks: a spring 3 EI/L^3 that
carries the tip mass and 33/140 of the strip's.
"""

import matplotlib.pyplot as plt
import numpy as np

import beamdyn as bd

length, width, thickness, modulus, density = 0.05, 0.01, 0.0002, 200e9, 7850.0
beam = bd.Beam.rectangular(length, width, thickness, modulus, density, tip=bd.TipMass(1e-4))
masses = np.geomspace(1e-5, 1e-1, 41)
study = bd.study(bd.Scene(beam), {"beam.tip.mass": masses}, modes=1)
exact = study.value[:, 0]

stiffness = 3 * modulus * width * thickness**3 / 12 / length**3
strip = density * width * thickness * length
formula = np.sqrt(stiffness / (masses + 33 / 140 * strip)) / (2 * np.pi)

fig, (above, below) = plt.subplots(2, 1, sharex=True, height_ratios=[2, 1], layout="constrained")
above.loglog(masses / strip, exact, label="beamdyn")
above.loglog(masses / strip, formula, "--", label="formula")
above.set_ylabel("first frequency [Hz]")
above.legend()
below.semilogx(masses / strip, 100 * (formula / exact - 1))
below.set(xlabel="tip mass over the strip's", ylabel="formula too high [%]")
