"""
A drum brake that locks itself
==============================

Torque of a leading and of a trailing shoe over friction. The leading shoe is helped by its own friction,
without limit at the friction at which it locks.
"""

import matplotlib.pyplot as plt
import numpy as np

from brakes import drum

shoe = drum.Shoe(0.138, face_width=0.05, lining=np.radians((30, 110)), pivot=(0.020, -0.110), force_arm=0.115)
friction = np.linspace(0.01, 0.98, 200)
leading = drum.shoe_torque(shoe, force=1000.0, friction=friction, leading=True)
trailing = drum.shoe_torque(shoe, force=1000.0, friction=friction, leading=False)
locks = float(np.asarray(leading.locking_friction).flat[0])
print(f"locks at friction {locks:.3f}")

fig, ax = plt.subplots()
ax.plot(friction, np.where(leading.locked, np.nan, leading.torque), label="leading shoe")
ax.plot(friction, trailing.torque, label="trailing shoe")
ax.axvline(locks, ls=":", color="C3", label=f"locks at {locks:.2f}")
ax.set(xlabel="friction of lining and drum", ylabel="torque [N m] for 1 kN", ylim=(0, 2000))
ax.legend()
