"""Own data beside the answers of a scene: pairs, deviations, what explains them, numbers found from data."""
