"""Long runs in one process: what is simulated, and what is watched meanwhile."""
