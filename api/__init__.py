"""The HTTP service: it translates requests and answers; the engine does the work."""
