"""The mathematics of one shape: curves, frames, contours, sweeps, quadrics and their validity."""
