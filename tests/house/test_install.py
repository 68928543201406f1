"""Installs the built project and builds another CMake project against it: every installed header
compiles by itself, and both halves of the library run.

Usage: test_install.py PROJECT_FOLDER BUILD_FOLDER CMAKE
"""

import pathlib
import subprocess
import sys
import tempfile


def call(*arguments):
    result = subprocess.run([str(a) for a in arguments], capture_output=True, text=True,
                            check=False)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, arguments))}\n{result.stdout}\n{result.stderr}")
    return result.stdout


def write_header_sources(include, folder):
    """One source file for each installed header, so that each has to stand alone."""
    folder.mkdir()
    headers = sorted(include.rglob("*.h"))
    if len(headers) < 15:
        sys.exit(f"only {len(headers)} headers were installed below {include}")
    for number, header in enumerate(headers):
        text = f'#include "{header.relative_to(include)}"\n'
        (folder / f"header_{number}.cpp").write_text(text, encoding="utf-8")


def main():
    root, build, cmake = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
    with tempfile.TemporaryDirectory() as scratch:
        prefix = pathlib.Path(scratch) / "prefix"
        call(cmake, "--install", build, "--prefix", prefix)
        headers = pathlib.Path(scratch) / "headers"
        write_header_sources(prefix / "include" / "scalefcn", headers)
        consumer = pathlib.Path(scratch) / "consumer"
        call(cmake, "-S", root / "tests/house/consumer", "-B", consumer, "-G", "Ninja",
             f"-DCMAKE_PREFIX_PATH={prefix}", f"-DHEADER_SOURCES={headers}")
        call(cmake, "--build", consumer, "-j2")
        for program, expected in (("solve_problem", "value 7"), ("find_creases", "12 arcs")):
            output = call(consumer / program)
            if expected not in output:
                sys.exit(f"{program}: expected '{expected}', got: {output}")
        version = call(prefix / "bin" / "scalefcn", "--version")
        if not version.startswith("scalefcn "):
            sys.exit(f"the installed program says: {version}")


if __name__ == "__main__":
    main()
