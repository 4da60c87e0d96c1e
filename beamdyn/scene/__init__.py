"""Input of all analyses: beam, mount, motion and limits of the theory; immutable, validated, in SI units."""
