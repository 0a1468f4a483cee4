"""Truth from outside the engine: closed forms and slow, obvious twins."""
