"""
A toggle clamp over its travel
==============================

Any planar mechanism is described by bodies, joints and loads. Here: a toggle clamp (Hibbeler, Statics,
problem 6-80); the force on the work over the travel of the hand, down to where the hand is about to
stand still.
"""

import matplotlib.pyplot as plt
import numpy as np

from brakes import planar

joints = (
    planar.Pin("A", "arm", "ground", at=(0, -0.04)),
    planar.Pin("B", "arm", "handle", at=(0, 0)),
    planar.Bar("CD", "handle", "ground", at=(0.02, 0.02), to=(0.04, 0.0546410162)),
)
loads = (
    planar.Force("hand", "handle", at=(0.08, 0.012), direction=(0, -1), magnitude=100.0),
    planar.Force("work", "arm", at=(0.06, -0.04), direction=(0, 1)),
)
clamp = planar.Mechanism(("handle", "arm"), joints, loads)
run = planar.stroke(clamp, "hand", np.linspace(0, 0.013, 53))
held = planar.solve(clamp, run.position)
ratio = np.abs(held.amplitudes["work"]) / 100.0
print(f"as drawn: {ratio[0]:.4f}")

fig, ax = plt.subplots()
ax.plot(1e3 * run.values, ratio)
ax.set(xlabel="travel of the hand [mm]", ylabel="force on the work over that of the hand")
