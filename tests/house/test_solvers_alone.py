"""solvers/ configures and builds although no geometry package can be found, and a program that
knows nothing else solves a problem with it.

Usage: test_solvers_alone.py PROJECT_FOLDER CMAKE
"""

import pathlib
import subprocess
import sys
import tempfile

FORBIDDEN = ["Eigen3", "OpenMesh", "TBB", "nlohmann_json", "CGAL", "PNG", "CLI11", "fmt", "spdlog"]


def call(*arguments):
    result = subprocess.run([str(a) for a in arguments], capture_output=True, text=True,
                            check=False)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, arguments))}\n{result.stdout}\n{result.stderr}")
    return result.stdout


def main():
    root, cmake = pathlib.Path(sys.argv[1]), sys.argv[2]
    with tempfile.TemporaryDirectory() as scratch:
        build = pathlib.Path(scratch) / "build"
        prefix = pathlib.Path(scratch) / "prefix"
        call(cmake, "-S", root, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
             "-DCMAKE_CXX_FLAGS_RELEASE=-O0", "-DSCALEFCN_SOLVERS_ONLY=ON",
             "-DSCALEFCN_WITH_CBC=OFF", "-DSCALEFCN_BUILD_TESTS=OFF",
             f"-DCMAKE_INSTALL_PREFIX={prefix}",
             *[f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in FORBIDDEN])
        call(cmake, "--build", build, "-j2")
        call(cmake, "--install", build)
        consumer = pathlib.Path(scratch) / "consumer"
        call(cmake, "-S", root / "tests/house/consumer", "-B", consumer, "-G", "Ninja",
             "-DSOLVERS_ALONE=ON", f"-DCMAKE_PREFIX_PATH={prefix}")
        call(cmake, "--build", consumer)
        output = call(consumer / "solve_problem")
        if "value 7" not in output:
            sys.exit(f"expected the optimum 7, got: {output}")


if __name__ == "__main__":
    main()
