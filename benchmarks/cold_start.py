"""Cold starts against the import floor: each command in a process of its own, in turn, medians of the rounds."""

import statistics
import subprocess
import sys
import time

ROUNDS = 11
RATFIT = "from ratfit.cli import main; import sys; sys.argv = ['ratfit', *sys.argv[1:]]; main()"
COMMANDS = {
    "python -c pass": [sys.executable, "-c", "pass"],
    "import sympy (the floor)": [sys.executable, "-c", "import sympy"],
    "import ratfit": [sys.executable, "-c", "import ratfit"],
    "ratfit --help": [sys.executable, "-c", RATFIT, "--help"],
    "ratfit derive eq19": [sys.executable, "-c", RATFIT, "derive", "eq19"],
    "ratfit derive eq19 --format json": [sys.executable, "-c", RATFIT, "derive", "eq19", "--format", "json"],
}


def seconds(command: list[str]) -> float:
    start = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - start


def main() -> None:
    times: dict[str, list[float]] = {name: [] for name in COMMANDS}
    for command in COMMANDS.values():
        seconds(command)  # compiled files are written, the disk is read
    for _ in range(ROUNDS):
        for name, command in COMMANDS.items():
            times[name].append(seconds(command))
    floor = statistics.median(times["import sympy (the floor)"])
    for name, found in times.items():
        median = statistics.median(found)
        print(f"{name:34} {median:6.3f} s   {median / floor:5.2f} x import sympy")


if __name__ == "__main__":
    main()
