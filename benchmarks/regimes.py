"""The four approximants of the 1994 paper in every regime of this machine: gamma, and the fit over the copy floor.

1e6 float32 samples; exact function, fit and floor `x + 1` interleaved in one run each.
"""

import ratfit as rf
from ratfit._speed import SpeedMeasurement, available
from ratfit.gallery import card

SETTINGS = {"eq12": ({}, None), "eq15": ({}, "copper"), "eq19": ({"m": 0.25}, None), "eq21": ({"m": 0.25}, None)}


def main() -> None:
    print("equation  regime       exact ms    fit ms  floor ms  fit/floor  gamma [95 %]")
    for name, (parameters, reference) in SETTINGS.items():
        fit = rf.derive(card(name).problem)
        for backend in available():
            timed = rf.measure_speed(fit, backend=backend, parameters=parameters, reference=reference)
            print(name.ljust(9), backend.ljust(11), times(timed), ratio(timed), timed.note, sep=" ", flush=True)


def times(timed: SpeedMeasurement) -> str:
    """The three medians in ms and the fit's over the floor's; nothing where no clock ran."""
    if timed.exact_s is None:
        return " " * 40
    seconds = (timed.exact_s, timed.fit_s, timed.floor_s)
    return "".join(f"{1000 * each:10.3f}" for each in seconds) + f"{timed.fit_s / timed.floor_s:10.2f} "


def ratio(timed: SpeedMeasurement) -> str:
    if timed.gamma is None:
        return "none"
    interval = "" if timed.gamma_low is None else f" [{timed.gamma_low:.2f}, {timed.gamma_high:.2f}]"
    return f"{timed.gamma:.2f}{interval} "


if __name__ == "__main__":
    main()
