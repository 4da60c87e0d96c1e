"""The interactive program: natural frequencies and steady response of a rotating beam over speed."""
