"""The hand: 27 bones, the ends of the forearm, soft tissue; parameters, people, abnormalities."""

from phantoms.hand.parameters import Parameters
from phantoms.hand.phantom import SOURCES, entry

__all__ = ["SOURCES", "Parameters", "entry"]
