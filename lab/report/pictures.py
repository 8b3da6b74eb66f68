"""Pictures in the style of the documents: PNG of twice as many pixels each way."""

# Colours of Okabe and Ito, which colour-blind readers tell apart.
BLACK, ORANGE, SKY_BLUE, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILION, PURPLE, GREY = "#0072B2", "#D55E00", "#CC79A7", "#888888"

STYLE = {
    "axes.axisbelow": True,
    "axes.edgecolor": "#444444",
    "axes.formatter.useoffset": False,
    "axes.grid": True,
    "axes.linewidth": 0.8,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlesize": "medium",
    "figure.constrained_layout.use": True,
    "figure.dpi": 100,
    "font.size": 10.5,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "lines.linewidth": 1.5,
    "lines.markersize": 4,
    "savefig.facecolor": "white",
}


def panels(width_px, height_px, *grid, **options):
    """A figure and its axes, as from pyplot.subplots."""
    # Imported here: the tests of the pages need no matplotlib.
    import matplotlib
    matplotlib.use("Agg")
    matplotlib.rcParams.update(STYLE)
    from matplotlib import pyplot
    return pyplot.subplots(*grid, figsize=(width_px / 100, height_px / 100), **options)


def plain_ticks(axis, ticks=None, labels=None, digits=(1, 2, 5)):
    """Ticks of a logarithmic axis as plain numbers, by default those that begin with one of the
    digits; no minor ones."""
    if ticks is None:
        low, high = axis.get_view_interval()
        ticks = [digit * 10.0**power for power in range(-4, 8) for digit in digits
                 if low <= digit * 10.0**power <= high]
    axis.set_ticks(ticks, labels or [f"{tick:g}" for tick in ticks])
    axis.set_ticks([], minor=True)


def save(figure, folder, name):
    """Writes NAME.png; a palette makes it a quarter as large."""
    from PIL import Image
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / f"{name}.png", dpi=200)
    image = Image.open(folder / f"{name}.png").convert("RGB").quantize(64)
    image.save(folder / f"{name}.png", optimize=True)
