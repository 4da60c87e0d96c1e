"""
Twelve digits from eight functions
==================================

Error of the first frequency of a clamped beam at rest, whose exact value is known, over the size of the
model: Legendre polynomials (Ritz) against cubic Hermite elements, whose error of fourth order is
extrapolated away (Richardson) until rounding, which grows with that power of their number, takes over.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import brentq

import beamdyn as bd

beta = brentq(lambda b: np.cos(b) * np.cosh(b) + 1, 1.8, 1.9, xtol=1e-15)
scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0))


def error(discretization):
    modes = bd.natural_modes(scene, modes=1, discretization=discretization)
    return max(abs(2 * np.pi * modes.frequency[0] / beta**2 - 1), 1e-16)


functions, elements = np.arange(3, 15), np.array([2, 4, 8, 16, 32, 64])
ritz = [error(bd.Ritz(int(n))) for n in functions]
fem = [error(bd.Fem(int(n), mesh="uniform")) for n in elements]

fig, ax = plt.subplots()
ax.loglog(functions, ritz, "o-", label="Ritz, Legendre polynomials")
ax.loglog(2 * elements, fem, "s-", label="Hermite elements")
ax.loglog(2 * elements, fem[1] * (8 / (2 * elements)) ** 6.0, "k:", label="sixth order")
ax.set(xlabel="unknowns", ylabel="relative error", ylim=(3e-17, 1))
ax.legend()
