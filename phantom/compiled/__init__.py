"""Documents turned into flat arrays that kernels read."""
