"""Comparison with other programs on the same cases: accuracy and time.  Run: python -m benchmarks.peers"""
