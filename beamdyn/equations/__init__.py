"""Equations of motion of a scene: discretizations, terms of each displacement field, and their list."""
