"""Greatest memory of a whole process that makes one radiograph.

Each is a process of its own, since a process never tells of less than it once had.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from bench.scenes import KNEE_LIKE

WATCH = """
import json, resource, sys
from pathlib import Path
sys.argv = json.loads(sys.argv[1])
from phantom.cli import main
try:
    main()
finally:
    # Linux lets a process's ru_maxrss begin with its parent's; VmHWM begins with the process.
    told = Path("/proc/self/status")
    lines = told.read_text().splitlines() if told.exists() else []
    peak = [int(line.split()[1]) for line in lines if line.startswith("VmHWM")]
    kib = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    print(peak[0] if peak else kib if sys.platform != "darwin" else kib // 1024)
"""


def with_bytecode():
    """Return an environment in which Python keeps what it compiled, as it does by default."""
    return {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"} | {
        "PYTHONPYCACHEPREFIX": str(Path(tempfile.gettempdir()) / f"phantom-bench-{os.getuid()}")
    }


def command_line(target, side, *words):
    """Return seconds and MiB of ``phantom radiograph TARGET``, side x side, start included."""
    with tempfile.TemporaryDirectory() as folder:
        made = str(Path(folder) / "image.png")
        size = ["--columns", str(side), "--rows", str(side)]
        argv = ["phantom", "radiograph", str(target), "-o", made, *size, *words]
        start = time.perf_counter()
        done = subprocess.run(
            [sys.executable, "-c", WATCH, json.dumps(argv)],
            check=True,
            capture_output=True,
            text=True,
            env=with_bytecode(),
        )
        spent = time.perf_counter() - start
    return spent, int(done.stdout.split()[-1]) / 1024


def knee_like(side):
    return command_line(KNEE_LIKE, side, "--view", "ap")


def help_seconds():
    """Return the seconds that ``phantom --help`` takes."""
    start = time.perf_counter()
    words = "import sys; sys.argv = ['phantom', '--help']; from phantom.cli import main; main()"
    subprocess.run(
        [sys.executable, "-c", words], check=True, capture_output=True, env=with_bytecode()
    )
    return time.perf_counter() - start
