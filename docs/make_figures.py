"""Make the pictures of the README and the gallery with the commands that are shown beside them.

Run from the project's root: ``uv run python docs/make_figures.py``.
"""

from __future__ import annotations

import shlex
import subprocess
from pathlib import Path

FILM = "--columns 600 --rows 750 --pitch-mm 0.36"
COMMANDS = (
    f"phantom radiograph knee-1993 --view ap {FILM} -o docs/images/knee-ap.png",
    f"phantom radiograph knee-1993 --view mediolateral {FILM} -o docs/images/knee-lateral.png",
    "phantom radiograph fan --view ap --columns 600 --rows 600 -o docs/images/fan.png",
)
GALLERY = (
    "phantom radiograph deformed --view ap --columns 600 --rows 600 -o docs/images/deformed.png",
    "python docs/reference_shapes.py",
    "python docs/paper_figures.py",
)


def main() -> None:
    Path("docs/images").mkdir(exist_ok=True)
    for command in (*COMMANDS, *GALLERY):
        print(command)
        subprocess.run(shlex.split(command), check=True)


if __name__ == "__main__":
    main()
