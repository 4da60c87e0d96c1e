"""Equations of motion of a scene: discretizations, operators of the fields, and the list of terms."""
