"""Campbell diagrams: loci of scenes, per-rev lines and the motion's lines, crossings and margins."""
