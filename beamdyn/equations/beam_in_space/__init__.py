"""The beam in space: bent, twisted, sheared and stretched by any amount, and linear about any such state."""
