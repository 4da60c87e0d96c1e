"""Motions of the carrier: its angle, speed and angular acceleration, and the acceleration of its centre.

A rotation is about a fixed centre; a rolling wheel also travels, without slip.  Angles are not reduced to
one turn: in double precision an angle of 1e8 rad, and any phase computed from it (of the road, of gravity),
is accurate to 1.5e-8 rad.  At a jump, the values of a motion are those after the jump.
"""
