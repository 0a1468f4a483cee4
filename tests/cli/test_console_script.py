"""The console script itself, as a person or a program starts it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

import pytest

SCRIPT = str(Path(sys.executable).with_name("phantom"))


def start(*words: str, **options) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [SCRIPT, *words], capture_output=True, text=True, timeout=300, check=False, **options
    )


def test_help_needs_nothing_of_the_engine():
    check = (
        "import sys; sys.argv = ['phantom', '--help']\n"
        "from phantom.cli import main\n"
        "try: main()\n"
        "except SystemExit: pass\n"
        "heavy = {'numba', 'numpy', 'scipy', 'pydantic', 'fastapi', 'OpenImageIO', 'xraylib'}\n"
        "sys.exit(', '.join(heavy & set(sys.modules)) or 0)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", check], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    for command in ("list", "show", "validate", "radiograph", "serve"):
        assert command in done.stdout


def test_a_picture_from_a_program(tmp_path: Path):
    done = start("radiograph", "sphere", "--columns", "8", "-o", "a.png", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["output"] == "a.png"
    assert "\x1b" not in done.stderr, "no terminal, no bar"
    assert (tmp_path / "a.png").is_file()


def test_bad_input_leaves_with_2_and_says_where(tmp_path: Path):
    done = start("radiograph", "nobody", "--view", "x", "-o", "a.png", cwd=tmp_path)
    assert done.returncode == 2
    lines = done.stderr.splitlines()
    assert [line.split(":")[0] for line in lines] == ["/phantom/name", "/view/preset"]
    assert start("validate", "no-such-file.json").returncode == 2
    assert start("radiograph", "x" * 5000).returncode == 2
    assert start("radiograph", "sphere", "--no-such-option").returncode == 2


def test_odd_text_reaches_a_plain_terminal_as_escapes(tmp_path: Path):
    (tmp_path / "odd.json").write_text('{"\\u001b[31m": 1, "é": 2}')
    done = start(
        "validate", "odd.json", cwd=tmp_path, env=os.environ | {"PYTHONIOENCODING": "ascii"}
    )
    assert done.returncode == 2
    assert "\x1b" not in done.stderr
    assert "Traceback" not in done.stderr


@pytest.fixture
def served(tmp_path: Path):
    """The running service's address."""
    port = 20_000 + os.getpid() % 20_000
    process = subprocess.Popen(
        [SCRIPT, "serve", "--port", str(port)], stderr=subprocess.PIPE, text=True, cwd=tmp_path
    )
    address = f"http://127.0.0.1:{port}"
    try:
        deadline = time.monotonic() + 120
        while True:
            try:
                urllib.request.urlopen(f"{address}/healthz", timeout=5).close()
                break
            except OSError:
                assert process.poll() is None, process.stderr.read()
                assert time.monotonic() < deadline
                time.sleep(0.2)
        yield address
    finally:
        process.terminate()
        process.communicate(timeout=30)


def test_the_service_over_a_real_socket(served):
    with urllib.request.urlopen(f"{served}/v1/radiographs/sphere?columns=8") as response:
        assert response.headers["content-type"] == "image/png"
        assert response.read().startswith(b"\x89PNG")
    body = json.dumps({"phantom": {"name": "sphere"}, "origins": [[-99, 0, 0]],
                       "directions": [[1, 0, 0]]}).encode()  # fmt: skip
    request = urllib.request.Request(
        f"{served}/v1/path-lengths", body, {"Content-Type": "application/json"}
    )
    with urllib.request.urlopen(request) as response:
        assert json.load(response)["path_lengths_mm"] == [[pytest.approx(50.0)]]
