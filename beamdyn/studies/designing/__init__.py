"""Which numbers of a scene make its answers take wanted values: designs sought backwards."""
