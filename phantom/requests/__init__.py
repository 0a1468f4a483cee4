"""Requests as people write them, on the command line and over HTTP alike, and what they give."""
