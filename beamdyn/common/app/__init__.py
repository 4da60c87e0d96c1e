"""What the interactive programs share: forms from descriptions of inputs, state, and the page itself."""
