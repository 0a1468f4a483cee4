"""The phantom library: every phantom that an installed package offers, by name.

A package offers phantoms through the entry-point group ``phantom.library``; each entry point
names an `Entry`. The engine knows no phantom itself.
"""

from phantom.library.entries import Abnormality, Entry, Technique
from phantom.library.people import Person, PersonParameters, Population, mean_person
from phantom.library.registry import GROUP, build, catalogue, document, entry, names, prepare

__all__ = [
    "GROUP",
    "Abnormality",
    "Entry",
    "Person",
    "PersonParameters",
    "Population",
    "Technique",
    "build",
    "catalogue",
    "document",
    "entry",
    "mean_person",
    "names",
    "prepare",
]
