"""Descriptions and checks of inputs, designs as combinations of inputs, access to inputs by path."""
