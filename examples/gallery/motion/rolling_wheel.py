"""
A wheel spins up and rolls over a wavy road
===========================================

The published case (Lee and Yoo 2019, Fig. 5): the strip is undamped, so that what the start excites
rings on.
"""

import matplotlib.pyplot as plt

import beamdyn as bd

beam = bd.Beam.rectangular(length=0.05, width=0.01, thickness=0.0002, youngs_modulus=200e9, density=7850.0)
motion = bd.RollingWheel(
    rolling_radius=0.3,
    speed=bd.SpinUp(55.0, duration=10.0),
    road=bd.RoadWave(wavelength=0.3, velocity_amplitude=0.01),
)
run = bd.simulate(bd.Scene(beam, bd.Mount(radius=0.215), motion), t_end=30.0, modes=3)
peak = run.peak(20.0, 30.0)
print(f"largest deflection in 20 to 30 s: {1e3 * peak:.3f} mm")

fig, (above, below) = plt.subplots(2, 1, figsize=(9, 6), layout="constrained")
run.plot(above)
run.plot(below)
below.set(xlim=(20.0, 20.3), title="0.3 s of it")
