"""How accurate an answer is, and how it is refined until it is accurate enough."""
