"""Pictures of brakes: matplotlib axes in, matplotlib axes out."""
