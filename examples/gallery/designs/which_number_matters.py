"""
Which number of the scene matters
=================================

By how many percent each frequency changes if a number changes by one percent: derivatives of the
eigenproblem, not differences of two runs.
"""

import matplotlib.pyplot as plt

import beamdyn as bd

scene = bd.load_scene("../../tyre_harvester.toml")
found = bd.frequency_sensitivities(scene, speed=50.0, modes=3)

fig, ax = plt.subplots(figsize=(8, 4), layout="constrained")
found.plot(ax)
