"""Worker processes, and a store of finished parts of a long computation."""
