"""measure_choices.py PROGRAM FOLDER: prints the errors of the ways to solve, as JSON.

The histories are those of measure_sensors.py, by an ideal sensor and by one with all effects but
off-centre pressure. PROGRAM is pillarfield, whose recordings and calibrations are made in FOLDER."""

import concurrent.futures
import json
import sys
from pathlib import Path

import page
import sensor_scenes as scenes
from measure_sensors import IDEAL, Sensor, stiffness_for_peak

ESTIMATORS = ("paper", "direct", "contact")


def measure(sensor, calibrations):
    """Scores by what is known of the sensor and by estimator."""
    return {known: {estimator: sensor.score("--calibration", calibration, noise=False,
                                            estimator=estimator)
                    for estimator in ESTIMATORS}
            for known, calibration in calibrations.items()}


def main(program, folder):
    program, folder = Path(program).resolve(), Path(folder)
    stiffness = stiffness_for_peak(program, folder / "peak")
    effect = scenes.EFFECTS["centred"]
    ideal = Sensor(program, folder / "ideal", IDEAL, stiffness)
    real = Sensor(program, folder / "real", effect, stiffness)

    def ideal_scores():
        return measure(ideal, {"none": ideal.taken_for_ideal()})

    def real_scores():
        return measure(real, {"none": real.taken_for_ideal(),
                              "calibrated": real.calibrated(("one pressure",)),
                              "sensor": real.calibrated(effect.steps)})

    with concurrent.futures.ThreadPoolExecutor(2) as threads:
        found = [threads.submit(scores) for scores in (ideal_scores, real_scores)]
    json.dump(dict(zip(("ideal", "real"), (scores.result() for scores in found))), sys.stdout,
              indent=1)


if __name__ == "__main__":
    page.run(main)
