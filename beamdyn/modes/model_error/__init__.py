"""Model error: changes of a result by the physical effects that its model neglects."""
