"""
Where a wheel on a wavy road resonates
======================================

The road acts at a frequency proportional to speed, and the turning strip sees it at that less and plus
the speed itself. Resonance is where one of these lines meets a natural frequency, which itself falls
with speed (circles). Squares: parametric resonances, at which a line meets twice the natural frequency; with
this damping the motion does not grow there. Below: the amplitude, and the sum of all its lines as a bound.
"""

import matplotlib.pyplot as plt
import numpy as np

import beamdyn as bd

beam = bd.Beam.rectangular(length=0.05, width=0.01, thickness=0.0002, youngs_modulus=200e9, density=7850.0)
road = bd.RoadWave(wavelength=0.3, velocity_amplitude=0.01)
wheel = bd.RollingWheel(rolling_radius=0.3, speed=55.0, road=road)
scene = bd.Scene(beam, bd.Mount(radius=0.215), wheel, damping_ratio=0.01)

fig, (above, below) = plt.subplots(2, 1, figsize=(8, 8), layout="constrained")
crossings = bd.resonance_speeds(scene, top_speed=150.0, modes=1)
crossings.plot(above)
bd.steady_response(scene, np.linspace(1, 150, 300), modes=3).plot(below)
