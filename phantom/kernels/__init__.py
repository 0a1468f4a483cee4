"""Compiled loops on scalars and flat arrays; they never raise, and release the lock."""
