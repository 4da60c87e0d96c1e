"""Names of arguments in error messages, where files and commands use other names than Python."""

from __future__ import annotations

from beamdyn.common.words import Named, Words

FROM_STIFFNESS = Named("Beam.from_stiffness", "mass_per_length and bending_stiffness in [beam]")
RECTANGULAR = Named("Beam.rectangular", "width and thickness in [beam]")
ROLLING_WHEEL = Named("a RollingWheel", 'a table [motion] with kind = "rolling"')
REPEATING = Named("a PulsatingRotation", 'a table [motion] with kind = "pulsating"')

IN_RADIANS = Words("is it in degrees? give ", Named("math.radians(...)", "it the unit deg"))
GIVE_IT = Words("give it to ", FROM_STIFFNESS)
GIVE_OR_COMPUTE = Words(GIVE_IT, "; ", RECTANGULAR, " computes it")
GIVE_OR_RATIO = Words(GIVE_IT, ", or poissons_ratio to ", RECTANGULAR)
WITH_WHEEL = Words(ROLLING_WHEEL, " with a road, or gravity, excites the beam")
