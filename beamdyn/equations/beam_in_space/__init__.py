"""Beams with large deflections in space (bending, twist, shear and stretch), and small motions about them."""
