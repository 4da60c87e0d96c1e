"""Worker processes, and a store on disk for finished parts of a long computation."""
