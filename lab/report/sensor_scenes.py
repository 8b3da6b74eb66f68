"""Scenes of the report on sensors: effects, experiments that calibrate them, histories that judge.

No constant of the product was chosen by these histories."""

import math
from typing import NamedTuple

PILLARS = 36  # each way
PITCH_MM = 2 * 0.632455532
COUNTS_PER_NEWTON = 320
NOISE_COUNTS = 0.5
PEAK_COUNTS = 150
SOFT_KPA = 400  # modulus of the skin before a history is scaled to its peak


class Effect(NamedTuple):
    """An effect at the size of published skins."""
    title: str
    sensor: str  # lines of a scene's [sensor]
    steps: tuple  # of its calibration, after the tare; names of CALIBRATIONS
    surface: str = ""
    coefficient: float = 1  # of shear, which decides the sensels that a force loads


PRESSURES = ("press12", "press30", "press60", "press100", "press160", "press190")

EFFECTS = {
    "off_centre": Effect("off-centre pressure, arm 0.224 mm", "pillar_arm_mm = 0.224",
                         ("one pressure", "arm")),
    "leak": Effect("leak between sensels, 5 % inside, 2 % across",
                   "leak_inside = 0.05\nleak_across = 0.02", ("one pressure", "leak")),
    "dead_zone": Effect("dead zone 5 counts", "dead_zone_counts = 5", ("pressures",)),
    "curve": Effect("response curve, power 0.9",
                    "power_law_exponent = 0.9\npower_law_reference_counts = 100", ("pressures",)),
    "hysteresis": Effect("hysteresis 5 %", "hysteresis = 0.05\nhysteresis_range_counts = 160",
                         ("one pressure", "memory")),
    "shear": Effect("shear coefficient 0.9", "shear_coefficient = 0.9", ("one pressure", "shear"),
                    coefficient=0.9),
    "gains": Effect("gains 5 %", "gain_spread = 0.05", ("one pressure",)),
    "creep": Effect("creep 5 % a decade", "creep_per_decade = 0.05", ("one pressure", "memory")),
    "wires": Effect("wires, 50 Ω and 10 kΩ a sensel, tiles of 36 × 36",
                    "wires = { tile = [36, 36], row_ohm = 50, column_ohm = 50, "
                    "sensel_ohm = 10000 }", ("wires", "one pressure")),
    "pillar_leak": Effect("leak between pillars, 2 % edge, 0.5 % corner",
                          "pillar_leak_edge = 0.02\npillar_leak_corner = 0.005",
                          ("one pressure", "leak")),
    "bending": Effect("bending, cylinder of 60 mm, 300 counts·mm", "tare_counts = 20",
                      ("one pressure", "bending"),
                      "[surface]\nbend_spread_counts_mm = 300\n"
                      f"curvature_per_mm = [{1 / 60}, 0, 0]\n"),
}
CENTRED = ("leak", "dead_zone", "curve", "hysteresis", "shear", "gains", "creep", "wires",
           "pillar_leak", "bending")
CENTRED_STEPS = ("wires", "bending", "pressures", "leak", "shear", "memory")


def together(title, names, steps):
    return Effect(title, "\n".join(EFFECTS[name].sensor for name in names), steps,
                  EFFECTS["bending"].surface, EFFECTS["shear"].coefficient)


EFFECTS["centred"] = together("all but off-centre pressure", CENTRED, CENTRED_STEPS)
EFFECTS["all"] = together("all together", ("off_centre", *CENTRED), (*CENTRED_STEPS, "arm"))


def scene(sensor, *, contacts="", frames=1, rate_hz=100, skin=f"pillars = [{PILLARS}, {PILLARS}]",
          modulus_kpa=SOFT_KPA):
    return f"""[skin]
{skin}
threshold_counts = {4 * NOISE_COUNTS}
modulus_kpa = {modulus_kpa}
counts_per_newton = {COUNTS_PER_NEWTON}
[sensor]
{sensor}
[time]
rate_hz = {rate_hz}
frames = {frames}
seed = 7
{contacts}"""


# --- Histories ---

class Indenter(NamedTuple):
    shape: str
    load_n: float  # on a skin of SOFT_KPA
    drag_mm: float


FRICTION = 1.6
RATE_HZ = 20
FRAMES = 24
BODIES = {
    "fingertip": Indenter('shape = "ellipsoid"\nradii_mm = [9, 14, 11]', 14, 6),
    "small ball": Indenter('shape = "sphere"\nradius_mm = 10', 8, 3),
    "large ball": Indenter('shape = "sphere"\nradius_mm = 50', 40, 6),
    "punch": Indenter('shape = "punch"\nradius_mm = 7\nedge_radius_mm = 1', 18, 5),
    "rough ball": Indenter('shape = "sphere"\nradius_mm = 18\nroughness_um = 30', 22, 5),
    "cylinder": Indenter('shape = "cylinder"\nradius_mm = 10\nlength_mm = 12\nedge_radius_mm = 1.5',
                     18, 4),
}


def history(indenter, sensor, surface="", stiffness=1):
    """An indenter that presses, rests, is dragged, half unloaded, and dragged and turned further."""
    load = indenter.load_n * stiffness
    path = ((0, -4, 0, 0, 0.2), (0.2, -4, 0, 0, 1), (0.4, -4, 0, 0, 1), (0.6, -2.5, 0.4, 0, 1),
            (0.8, -2.5, 0.4, 0, 0.5), (1.15, indenter.drag_mm - 4, 1.2, 15, 0.8))
    keys = ",\n".join(f"  {{ time_s = {time}, position_mm = [{x}, {y}], angle_deg = {angle}, "
                      f"load_n = {part * load:g} }}" for time, x, y, angle, part in path)
    return scene(sensor, frames=FRAMES, rate_hz=RATE_HZ, modulus_kpa=SOFT_KPA * stiffness,
                 contacts=f"{surface}[[indenter]]\n{indenter.shape}\nfriction = {FRICTION}\n"
                          f"path = [\n{keys}\n]\n")


# --- Experiments ---

def pressed(counts, path=""):
    """[direction_sweep] of a uniform pressure at which an ideal sensel reads `counts`."""
    return (f"[direction_sweep]\ndirections = {PILLARS}\ninclinations = {PILLARS}\n"
            f"max_theta_deg = 0\nmagnitudes_n = [{counts / COUNTS_PER_NEWTON}]\n{path}")


def kilopascals(counts):
    return 1000 * counts / COUNTS_PER_NEWTON / PITCH_MM**2


CYCLES_COUNTS = 160
# As fast as the histories, and held as long.
CYCLES = ((0, 0), (0.5, 0.4), (1, 0), (1.7, 0.7), (2.4, 0.2), (3, 0.7), (3.7, 0), (4.5, 1), (5.3, 0),
          (10, 0), (10.1, 0.6), (11.3, 0.6), (11.4, 0), (13, 0))


def cycles(sensor):
    path = ", ".join(f"{{ time_s = {time}, factor = {factor} }}" for time, factor in CYCLES)
    return scene(sensor, skin="", frames=260, rate_hz=20,
                 contacts=pressed(CYCLES_COUNTS, f"path = [{path}]\n"))


def cycles_log():
    return "time_s,pressure_kpa\n" + "".join(f"{time},{factor * kilopascals(CYCLES_COUNTS)}\n"
                                             for time, factor in CYCLES)


PULL_N = 30
PULLS_DEG = {"right": 0, "up": 90, "left": 180, "down": 270}


def punch(direction_deg, friction, radius_mm, path):
    keys = ",\n".join(f"  {{ time_s = {time:g}, position_mm = [{x:g}, {y:g}], load_n = {load:g} }}"
                      for time, x, y, load in path)
    return ('[[contact]]\nshape = "flat_punch"\nmotion = "slide"\n'
            f"contact_radius_mm = {radius_mm}\nfriction = {friction}\n"
            f"direction_deg = {direction_deg}\npath = [\n{keys}\n]\n")


def pulled(sensor, direction_deg):
    """A flat indenter of four times its tangential load."""
    return scene(sensor, frames=100, rate_hz=20,
                 contacts=punch(direction_deg, 0.25, 15, [(0, 0, 0, 4 * PULL_N)]))


TIP_N = 0.5
TIP_FRICTION = 2


def tip_path(rows):
    """A tip that presses every fifth pillar of these rows for five frames each."""
    time, path = 0.0, []
    for row in rows:
        for col in range(3, PILLARS - 2, 5):
            x, y = ((at - (PILLARS - 1) / 2) * PITCH_MM for at in (col, row))
            path += [(time, x, y, 0), (time + 0.05, x, y, TIP_N), (time + 0.3, x, y, TIP_N),
                     (time + 0.35, x, y, 0)]
            time += 0.4
    return path


def tips(sensor):
    """Two sticky tips on single pillars, pulled in two directions."""
    paths = tip_path((3, 8, 13)), tip_path((22, 27, 32))
    return scene(sensor, frames=int(20 * paths[0][-1][0]) + 1, rate_hz=20,
                 contacts="".join(punch(direction, TIP_FRICTION, 0.3, path)
                                  for direction, path in zip((30, 120), paths)))


def balls(sensor):
    """Four balls that press straight down, of 100 counts on average."""
    places = ((-11.3, -10.8, 5), (10.7, -11.1, 6), (-10.4, 11.2, 7), (11.4, 10.6, 8))
    return scene(sensor, frames=100, rate_hz=20, contacts="".join(
        f'[[contact]]\nshape = "sphere"\nmotion = "press"\ncontact_radius_mm = {radius}\n'
        f"position_mm = [{x}, {y}]\nload_n = {kilopascals(100) / 1000 * math.pi * radius**2:g}\n"
        for x, y, radius in places))


# The places of a second indenter: alone, in the rows of the first one, its columns, and neither.
OTHERS_MM = {"alone": None, "in_rows": (-5, 16), "in_columns": (-16, 5), "in_neither": (-5, 5)}


def resting(sensor, other_mm):
    """A ball at rest in the upper left tile, and another one of twice its load."""
    places = [((-16, 16), 20)] + ([(other_mm, 40)] if other_mm else [])
    return scene(sensor, frames=100, rate_hz=20, contacts="".join(
        f'[[contact]]\nshape = "sphere"\nmotion = "press"\ncontact_radius_mm = 5\n'
        f"position_mm = [{x}, {y}]\nload_n = {load}\n" for (x, y), load in places))


CYLINDERS = {"bent_x": (90, 1, 0, 0), "bent_y": (0, 0, 1, 0), "bent_xy": (45, 0.5, 0.5, -1),
             "bent_yx": (135, 0.5, 0.5, 1)}
CYLINDER_MM = 60


def bent(sensor, surface, curvature):
    values = ", ".join(f"{part / CYLINDER_MM}" for part in curvature)
    lines = [line for line in surface.splitlines() if "curvature" not in line]
    return scene(sensor, frames=100, contacts="\n".join(
        [*(lines or ["[surface]"]), f"curvature_per_mm = [{values}]", ""]))


def experiment(name, effect):
    """The scene of a recording that calibrates a sensor."""
    if name == "idle":
        return scene(effect.sensor, frames=100)
    if name.startswith("press"):
        return scene(effect.sensor, skin="", frames=100, rate_hz=20,
                     contacts=pressed(int(name[5:])))
    if name == "cycles":
        return cycles(effect.sensor)
    if name == "balls":
        return balls(effect.sensor)
    if name == "tips":
        return tips(effect.sensor)
    if name in OTHERS_MM:
        return resting(effect.sensor, OTHERS_MM[name])
    if name in CYLINDERS:
        return bent(effect.sensor, effect.surface, CYLINDERS[name][1:])
    return pulled(effect.sensor, PULLS_DEG[name])


def shears_n():
    """Tangential forces of the pulls, as --shear-n takes them."""
    angles = map(math.radians, PULLS_DEG.values())
    return ",".join(f"{round(PULL_N * math.cos(angle))},{round(PULL_N * math.sin(angle))}"
                    for angle in angles)


# Command, recordings and options of a step. `wires` comes before the tare, the others after it.
CALIBRATIONS = {
    "wires": ("wires", tuple(OTHERS_MM), ("--tile-rows", "36", "--tile-cols", "36")),
    "tare": ("tare", ("idle",), ()),
    "one pressure": ("equilibrate", ("press60",), ("--pressure-kpa", f"{kilopascals(60)}")),
    "pressures": ("equilibrate", PRESSURES,
                  ("--pressure-kpa", ",".join(f"{kilopascals(int(name[5:]))}"
                                              for name in PRESSURES))),
    "leak": ("leak", ("tips",), ()),
    "arm": ("arm", ("balls",), ()),
    "memory": ("memory", ("cycles",), ("--pressure", "cycles.csv")),
    "shear": ("shear", tuple(PULLS_DEG), ("--shear-n", shears_n(), "--load-n", ",".join([f"{4 * PULL_N}"] * len(PULLS_DEG)))),
    "bending": ("bending", tuple(CYLINDERS),
                ("--radius-mm", ",".join(f"{CYLINDER_MM}" for _ in CYLINDERS), "--axis-deg",
                 ",".join(f"{values[0]}" for values in CYLINDERS.values()))),
}
