"""fit_lean.py: prints the coefficients of kernels/pillar/lean.h.

Least squares of the moments under random rigid bodies pressed on an elastic half-space, some
narrower than a pillar. Lengths in pillars. Equations: docs/derivations/sensor_effects.md, E7."""

import os
from multiprocessing import Pool

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy

BODIES = 1500
SEED = 100000
PILLARS, POINTS = 24, 5  # of the patch, and of a pillar, each way
PEAK_COUNTS, NOISE_COUNTS, THRESHOLD_COUNTS = 150, 0.25, 2  # of a pillar's normal force
SIDE = PILLARS * POINTS
PLACES = (numpy.arange(SIDE) + 0.5) / POINTS - PILLARS / 2
X, Y = numpy.meshgrid(PLACES, PLACES)
NOWHERE = 99.0  # height where a body does not reach


def response():
    """Transform of the displacement by a unit pressure on one point's square."""
    at = numpy.arange(-SIDE, SIDE) / POINTS
    x, y = numpy.meshgrid(at, at)

    def corner(a, b):
        return b * numpy.log(a + numpy.hypot(a, b)) + a * numpy.log(b + numpy.hypot(a, b))

    h = 0.5 / POINTS
    return numpy.fft.rfft2(numpy.fft.ifftshift(corner(x + h, y + h) - corner(x - h, y + h)
                                               - corner(x + h, y - h) + corner(x - h, y - h)))


RESPONSE = response()


def displacement(pressure):
    whole = (2 * SIDE, 2 * SIDE)
    return numpy.fft.irfft2(RESPONSE * numpy.fft.rfft2(pressure, whole), whole)[:SIDE, :SIDE]


def press(height, depth, tolerance=1e-3):
    """Pressure under a rigid body, by conjugate gradients with bounds (Polonsky and Keer)."""
    gap = height - depth
    pressure = numpy.maximum(-gap, 0)
    step, last, conjugate = numpy.zeros_like(gap), 1.0, 0.0
    for _ in range(250):
        residual = displacement(pressure) + gap
        touching = pressure > 0
        square = (residual[touching] ** 2).sum()
        step = numpy.where(touching, residual + conjugate * square / last * step, 0)
        last, moved = square, displacement(step)
        factor = (residual * step).sum() / max((moved * step).sum(), 1e-300)
        pressure = numpy.maximum(pressure - factor * step, 0)
        entering = (pressure == 0) & (residual < 0) & ~touching
        pressure = numpy.where(entering, -factor * residual, pressure)
        conjugate = 0.0 if entering.any() else 1.0
        if conjugate and (square / max(touching.sum(), 1)) ** 0.5 < tolerance * -gap.min():
            break
    return pressure


# Heights of bodies, over their lowest point.

def face(outside, radius):
    """A flat face with a rounded edge, from the distance outside it."""
    beyond = numpy.maximum(outside + radius, 0)
    arc = radius - numpy.sqrt(numpy.maximum(radius**2 - beyond**2, 0))
    return numpy.where(beyond < radius, arc, radius + 40 * (beyond - radius))


def dome(distance, radius):
    """A ball or a cylinder."""
    arc = radius - numpy.sqrt(numpy.maximum(radius**2 - distance**2, 0))
    return numpy.where(abs(distance) < radius, arc, NOWHERE)


def to_line(x, y, start, end):
    """Distance from a line between two points."""
    (ax, ay), (bx, by) = start, end
    along = ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / ((bx - ax) ** 2 + (by - ay) ** 2)
    along = numpy.clip(along, 0, 1)
    return numpy.hypot(x - ax - along * (bx - ax), y - ay - along * (by - ay))


def roughness(random, deviation):
    waves = numpy.hypot(*numpy.meshgrid(*2 * [numpy.fft.fftfreq(SIDE, 1 / POINTS)]))
    spectrum = numpy.where((waves <= 1) & (waves > 0), numpy.maximum(waves, 1 / 8) ** -1.8, 0)
    height = numpy.fft.ifft2(spectrum * numpy.fft.fft2(random.normal(size=X.shape))).real
    return height * deviation / height.std()


def body(kind, random):
    """Height and depth."""
    uniform = random.uniform

    def spread(low, high):
        return numpy.exp(uniform(numpy.log(low), numpy.log(high)))

    def profile(distance, width, part):
        """A flat stroke of this width, in this part of the cases, or a round one."""
        if uniform() < part:
            return face(distance - width / 2, min(spread(0.05, 0.6), width / 2))
        return distance**2 / (2 * spread(0.3, 3))

    turn = uniform(0, 2 * numpy.pi)
    right, up = X - uniform(-1.5, 1.5), Y - uniform(-1.5, 1.5)
    x = numpy.cos(turn) * right + numpy.sin(turn) * up
    y = numpy.cos(turn) * up - numpy.sin(turn) * right
    r, depth = numpy.hypot(x, y), spread(0.05, 0.8)
    if kind in ("ball", "rough"):
        radius = spread(3, 60)
        reach = min(uniform(0.25, 0.7) * radius, uniform(1, 9.5))
        height, depth = dome(r, radius), reach**2 / radius
        if kind == "rough":
            height = height + roughness(random, spread(0.006, 0.045))
    elif kind == "ellipsoid":
        a, b, c = uniform(3.5, 13), uniform(3.5, 18), uniform(3.5, 13)
        height = c * dome(numpy.hypot(x / a, y / b), 1)
        depth = min(uniform(0.03, 0.3) * c, 70 * c / max(a, b) ** 2)
    elif kind == "punch":
        height = face(r - uniform(2.2, 9.5), spread(0.1, 2))
    elif kind == "square":
        edge = spread(0.1, 1.5)
        outside = [numpy.maximum(abs(a) - uniform(1.5, 8) + edge, 0) for a in (x, y)]
        height = face(numpy.hypot(*outside) - edge, edge)
    elif kind == "cylinder":
        radius = uniform(2.5, 15)
        height = dome(y, radius) + face(abs(x) - uniform(2, 8), spread(0.15, 2))
        depth = 0.8 * min(uniform(0.15, 0.6) * radius, 8) ** 2 / radius
    elif kind == "edge":
        height = profile(abs(y), spread(0.2, 2.2), 0.5)
        height = height + face(abs(x) - uniform(2, 10), spread(0.05, 1))
        if uniform() < 0.4:  # as of a coin on its rim
            height = height + x**2 / uniform(16, 120)
    elif kind == "ring":
        height = profile(abs(r - uniform(1.5, 8)), spread(0.25, 2.2), 0.5)
    elif kind == "letter":
        joints = random.integers(-1, 2, (4, 2)) * uniform(1.5, 5) + uniform(-0.5, 0.5, (4, 2))
        strokes = [to_line(x, y, *ends) for ends in zip(joints, joints[1:])]
        height = profile(numpy.min(strokes, axis=0), spread(0.4, 2), 0.7)
    else:
        pins = [numpy.hypot(x - uniform(-6, 6), y - uniform(-6, 6)) for _ in range(
            random.integers(1, 8))]
        height = numpy.min([uniform(0, 0.1) + (
            face(pin - radius, min(radius, 0.2)) if uniform() < 0.5 else dome(pin, radius))
            for pin in pins for radius in [spread(0.3, 2.5)]], axis=0)
    height = numpy.minimum(height, NOWHERE)
    if kind in ("punch", "square", "ring", "letter") and uniform() < 0.6:  # it tilts
        height = height + uniform(0, 0.04) * (numpy.cos(turn) * X + numpy.sin(turn) * Y)
    return height - height.min(), depth


KINDS = ("ball", "ellipsoid", "punch", "square", "cylinder", "rough",
         "edge", "ring", "letter", "pins")


def pressed(number):
    """Normal forces that are read, counts, and moments over the pitch [x or y, row, col]."""
    random = numpy.random.default_rng(SEED + number)
    pressure = press(*body(KINDS[number % len(KINDS)], random))
    parts = pressure.reshape(PILLARS, POINTS, PILLARS, POINTS)
    offset = (numpy.arange(POINTS) + 0.5) / POINTS - 0.5
    normal = parts.sum((1, 3))
    moments = numpy.stack([numpy.einsum("aibj,j->ab", parts, offset),
                           numpy.einsum("aibj,i->ab", parts, offset)])
    scale = PEAK_COUNTS * random.uniform(0.4, 1.2) / normal.max()
    read = scale * normal + random.normal(0, NOISE_COUNTS, normal.shape)
    return numpy.where(scale * normal > THRESHOLD_COUNTS, read, 0), scale * moments


def part(outer, inner):
    whole = outer + inner
    return numpy.where(whole > 0, outer / numpy.where(whole > 0, whole, 1), 0)


def ratios(normal):
    """d, e, s and t of all pillars along x."""
    padded = numpy.pad(normal, ((0, 0), (2, 2)))
    far_low, low, own, high, far_high = (padded[:, i:i + normal.shape[1]] for i in range(5))
    a, b, far_a, far_b = part(low, own), part(high, own), part(far_low, low), part(far_high, high)
    return numpy.stack([b - a, far_b - far_a, b + a - 1, far_b + far_a - 1])


TERMS = ("dss", "dsss", "dtt", "dttt", "ddd", "ddds", "dddt", "dees", "eee", "esst")


def products(z):
    return numpy.stack([numpy.prod([z["dest".index(each)] for each in term], axis=0)
                        for term in TERMS], axis=1)


def samples(number):
    """d, e, s and t, normal forces and moments of a body's pillars along x and y, and weights."""
    normal, moments = pressed(number)
    loaded = normal > 2 * THRESHOLD_COUNTS
    z = [ratios(normal)[:, loaded], ratios(normal.T)[:, loaded.T]]
    own, moment = ((numpy.concatenate([a[loaded], b.T[loaded.T]]))
                   for a, b in ((normal, normal), moments))
    # Errors are relative to a body's own.
    weight = numpy.full(own.size, (moment**2).sum() ** -0.5)
    return numpy.concatenate(z, axis=1), own, moment, weight


def main():
    with Pool() as pool:
        found = pool.map(samples, range(BODIES), 1)
    z, own, moment, weight = (numpy.concatenate(each, axis=-1) for each in zip(*found))
    columns, rest, weight = products(z), moment / own - z[0] / 6, weight * own
    odd = numpy.linalg.lstsq(columns * weight[:, None], rest * weight, rcond=None)[0]
    for term, value in zip(TERMS, odd):
        print(f"{' '.join(term):10}{value:8.3f}")
    left = abs(numpy.clip(z[0] / 6 + columns @ odd, -0.5, 0.5) - moment / own)
    d, e, s, _ = z
    sizes = numpy.stack([s * s, (d * s) ** 2, abs(e - d)], axis=1)
    weight = numpy.minimum(own / numpy.sqrt((own**2).mean()), 3**0.5)
    values = numpy.linalg.lstsq(sizes * weight[:, None], left * weight, rcond=None)[0]
    print("mean error of s^2, (d s)^2, |e - d|:", *(f"{value:.3f}" for value in values))


if __name__ == "__main__":
    main()
