"""Worker processes, and a store of finished parts of long work."""
