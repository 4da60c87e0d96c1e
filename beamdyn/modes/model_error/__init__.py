"""What the effects that a model leaves out would change in its answer."""
