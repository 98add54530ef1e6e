"""The four approximants of the 1994 paper against the copy floor x + 1: 1e6 float32 samples on JAX, one run each."""

import ratfit as rf
from ratfit.gallery import card

SETTINGS = {"eq12": ({}, None), "eq15": ({}, "copper"), "eq19": ({"m": 0.25}, None), "eq21": ({"m": 0.25}, None)}


def main() -> None:
    print("equation  exact ms   fit ms  floor ms  fit/floor  gamma [95 %]")
    for name, (parameters, reference) in SETTINGS.items():
        fit = rf.derive(card(name).problem)
        timed = rf.measure_speed(fit, parameters=parameters, reference=reference)
        times = (1000 * s for s in (timed.exact_s, timed.fit_s, timed.floor_s))
        interval = f"{timed.gamma:.2f} [{timed.gamma_low:.2f}, {timed.gamma_high:.2f}]"
        print(
            name.ljust(8),
            *(f"{t:9.3f}" for t in times),
            f"{timed.fit_s / timed.floor_s:10.2f}",
            f" {interval}  {timed.note}",
        )


if __name__ == "__main__":
    main()
