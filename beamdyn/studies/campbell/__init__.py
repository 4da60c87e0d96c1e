"""Campbell diagrams: frequencies over speed, lines of excitation, crossings and margins."""
