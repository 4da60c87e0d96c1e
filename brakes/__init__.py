"""Statics of brake mechanisms."""
