"""Stomach and liver with barium: organs, trunk, people, a polyp or an ulcer."""

from phantoms.stomach_and_liver.parameters import Parameters
from phantoms.stomach_and_liver.phantom import SOURCES, entry

__all__ = ["SOURCES", "Parameters", "entry"]
