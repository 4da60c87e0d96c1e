"""Model error: changes of an answer by the effects that its model leaves out."""
