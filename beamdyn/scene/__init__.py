"""What the user says: beam, mount, motion, and where the theory holds; frozen, in SI units, checked."""
