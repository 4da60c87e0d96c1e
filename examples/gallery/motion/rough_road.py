"""
A rough road, by its statistics
===============================

Root strain of a harvester's strip in a wheel on a road of class C at 90 km/h: density over frequency,
and the root mean square that a fatigue estimate starts from.
"""

import matplotlib.pyplot as plt

import beamdyn as bd

scene = bd.load_scene("../../harvester_on_road.toml")
road = bd.random_response(scene, 25 / 0.3, bd.RoadRoughness("C", highest=10.0), output="root strain")
print(f"root mean square {road.rms:.2e}, stated error {road.rms_error:.0e}")

fig, ax = plt.subplots()
road.plot(ax)
