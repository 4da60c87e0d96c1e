"""
A shaken wheel: one frequency in, two out
=========================================

The axle is shaken along a fixed direction, but the strip turns: it feels each frequency f at f less and
plus n, the turns per second. The two curves are the strain at its root at these two.
"""

import matplotlib.pyplot as plt
import numpy as np

import beamdyn as bd

scene = bd.load_scene("../../rough_road.toml")
found = bd.frequency_response(scene, 50.0, np.geomspace(5, 1000, 600), input="n2", output="root strain")

fig, ax = plt.subplots()
found.plot(ax)
