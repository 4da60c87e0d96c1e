"""
Past the critical speed the beam bends to one side
==================================================

An inward beam buckles like a column in a press. Linear theory ends there; with large deflection the
branch goes on, and the picture is the fork of the textbooks.
"""

import matplotlib.pyplot as plt

import beamdyn as bd

beam = bd.Beam.rectangular(length=0.05, width=0.01, thickness=0.0002, youngs_modulus=200e9, density=7850.0)
scene = bd.Scene(beam, bd.Mount(radius=0.215), physics=bd.Physics(large_deflection=True))
found = bd.equilibrium_branches(scene, top_speed=200.0)
print(f"buckles at {found.critical_speed:.3f} rad/s")

fig, ax = plt.subplots()
found.plot(ax)
