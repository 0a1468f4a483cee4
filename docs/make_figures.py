"""Make the pictures of the README, the gallery and the page on stereo, as is shown beside them.

Run from the project's root: ``uv run python docs/make_figures.py``.
"""

from __future__ import annotations

import shlex
import subprocess
from pathlib import Path

FILM = "--columns 600 --rows 720"
COMMANDS = (
    f"phantom radiograph knee --view ap {FILM} -o docs/images/readme-knee.png",
    f"phantom radiograph hand --view pa {FILM} -o docs/images/readme-hand.png",
    f"phantom radiograph chest --view pa {FILM} -o docs/images/readme-chest.png",
)
GALLERY = (
    "python docs/paper_pictures.py",
    "phantom radiograph deformed --view ap --columns 600 --rows 600 -o docs/images/deformed.png",
    "python docs/reference_shapes.py",
    "python docs/paper_figures.py",
)

STEREO_FILM = "--columns 480 --rows 640 --pitch-mm 0.4 --baseline-mm 120"
STEREO = (
    f"phantom stereo knee-1993 {STEREO_FILM} --layout anaglyph"
    " -o docs/images/knee-1993-anaglyph.png",
    f"phantom stereo knee {STEREO_FILM} --dose-ugy 10 --layout anaglyph"
    " -o docs/images/knee-anaglyph.png",
    "phantom stereo knee-1993 --columns 300 --rows 400 --pitch-mm 0.6 --baseline-mm 150"
    " --layout cross_eyed -o docs/images/knee-1993-cross-eyed.png",
    "phantom render-pair knee --view three_quarter --hide skin,fat,muscle --columns 300 --rows 400"
    " --zoom 1.5 --baseline-mm 120 --layout cross_eyed --background 0.02,0.02,0.03"
    " -o docs/images/seen-knee-cross-eyed.png",
)

DARK = "--columns 320 --rows 440 --shadows --background 0.02,0.02,0.03"
VISIBLE = (
    f"phantom render knee {DARK} -o docs/images/seen-knee.png",
    f"phantom render knee --hide skin,fat,muscle {DARK} -o docs/images/seen-knee-bones.png",
    f"phantom render knee-1993 --view left_lateral {DARK} -o docs/images/seen-knee-1993.png",
)


def main() -> None:
    Path("docs/images").mkdir(exist_ok=True)
    for command in (*COMMANDS, *STEREO, *VISIBLE, *GALLERY):
        print(command)
        subprocess.run(shlex.split(command), check=True)


if __name__ == "__main__":
    main()
