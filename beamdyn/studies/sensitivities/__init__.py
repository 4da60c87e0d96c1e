"""Sensitivities of frequencies, critical speeds and resonance speeds to the numbers of a scene."""
