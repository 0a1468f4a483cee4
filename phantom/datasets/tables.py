"""A table of the whole set as Parquet; needs the extra ``tables``."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import islice
from typing import Any, Final

ROWS_AT_ONCE: Final = 10_000


def parquet(stream: Any, rows: Iterable[Mapping[str, Any]]) -> None:
    """Write rows to a stream; the same rows give the same bytes.

    Columns are those of the first rows; a value that is an integer in one row and not in another
    makes a column of numbers.
    """
    import pyarrow
    from pyarrow import parquet as files

    left = iter(rows)
    writer: Any = None
    schema: Any = None
    try:
        while batch := list(islice(left, ROWS_AT_ONCE)):
            names = list(dict.fromkeys(name for row in batch for name in row))
            table = pyarrow.table({name: [row.get(name) for row in batch] for name in names})
            if writer is None:
                schema = table.schema
                writer = files.ParquetWriter(_Sink(stream), schema)
            writer.write_table(table.select(schema.names).cast(schema))
    finally:
        if writer is not None:
            writer.close()


class _Sink:
    """What pyarrow wants of a file that is only written."""

    closed = False

    def __init__(self, stream: Any) -> None:
        self._stream = stream

    def write(self, data: Any) -> int:
        return int(self._stream.write(bytes(data)))

    def tell(self) -> int:
        return int(self._stream.tell())

    def flush(self) -> None:
        pass

    def close(self) -> None:
        pass

    def writable(self) -> bool:
        return True

    def readable(self) -> bool:
        return False

    def seekable(self) -> bool:
        return False
