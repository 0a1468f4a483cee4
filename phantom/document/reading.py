"""Documents from files, text and trees: refused with all their problems, or read."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from phantom.document.documents import Document
from phantom.document.json_text import decode_json
from phantom.document.labels import leaf_problems
from phantom.document.nesting import extents, oversize
from phantom.document.references import in_order, undefined_names, uses
from phantom.document.tree import survey
from phantom.document.validation import judge
from phantom.document.words import arranged, quoted
from phantom.document.yaml_text import decode_yaml
from phantom.errors import InvalidDocumentError, InvalidInputError, Problem

LARGEST_FILE_BYTES = 64 * 2**20
_YAML, _ENDINGS = (".yaml", ".yml"), (".json", ".yaml", ".yml")


def read(source: Path | str | bytes | Mapping[str, object] | Document) -> Document:
    """Read a document from a file, JSON text or a tree.

    Parameters
    ----------
    source
        A path; a string that is the path of a file or ends as one (``.json .yaml .yml``); any
        other string or bytes are JSON; a mapping is a tree already parsed.

    Raises
    ------
    InvalidDocumentError
        With every problem of the document.
    """
    if isinstance(source, Document):
        return parse(source.model_dump(mode="python"))
    if isinstance(source, Mapping):
        return parse(source if isinstance(source, dict) else dict(source))
    try:
        if isinstance(source, Path) or (isinstance(source, str) and _is_path(source)):
            tree = read_tree(Path(source))
        else:
            tree = decode_json(source)
    except InvalidInputError as error:
        raise InvalidDocumentError(error.problems) from None
    return parse(tree)


def parse(tree: object) -> Document:
    """Return the document that a plain tree describes.

    Raises
    ------
    InvalidDocumentError
        With every problem of the document.
    """
    document, problems = judge(Document, tree, across)
    if document is None or problems:
        raise InvalidDocumentError(arranged(problems))
    return document


def across(tree: object) -> Iterator[Problem]:
    """Yield the problems that no single part of a document shows."""
    solids = survey(tree)
    yield from undefined_names(tree, solids)
    order, circles = in_order(uses(solids))
    yield from circles
    if circles:
        return
    too_large = list(oversize(extents(solids, order), solids))
    yield from too_large
    if not too_large:
        yield from leaf_problems(tree)


def _is_path(text: str) -> bool:
    if text.lstrip()[:1] in ("{", "["):
        return False
    if text.lower().endswith(_ENDINGS) and len(text) < 4096:
        return True
    try:
        return Path(text).is_file()
    except (OSError, ValueError):
        return False


def read_tree(path: Path) -> object:
    """Return the tree in a file, YAML or else JSON by its ending; nothing of it is judged yet."""
    shown = quoted(str(path)[-60:])
    try:
        if path.stat().st_size > LARGEST_FILE_BYTES:
            problem = f"found a file over {LARGEST_FILE_BYTES} bytes; expected a smaller one"
            raise InvalidInputError([Problem("", "too_large", problem)])
        data = path.read_bytes()
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or type(error).__name__
        message = f"found no readable file {shown}: {reason}"
        raise InvalidInputError([Problem("", "unreadable", message)]) from None
    if path.suffix.lower() not in _YAML:
        return decode_json(data)
    try:
        return decode_yaml(data.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        message = f"found a byte that is not UTF-8 at {error.start}; expected UTF-8"
        raise InvalidInputError([Problem("", "invalid_utf8", message)]) from None
