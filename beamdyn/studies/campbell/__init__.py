"""Campbell diagrams: frequencies over speed, per-rev and motion lines, crossings and margins."""
