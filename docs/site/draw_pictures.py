"""Draws the pictures of README.md and of the pages in docs/ that show the programs, and writes the gallery.

Usage: draw_pictures.py FOLDER_OF_PROGRAMS, from anywhere; needs Pillow, and the Python package in PYTHONPATH.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap
import time
import tomllib

import pillarfield
from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
HEADINGS = {
    "contacts": "Contacts of closed form",
    "bodies": "Bodies of any shape",
    "calibration": "Recordings for calibration",
}


def run(command, folder):
    subprocess.run(["bash", "-ec", command], cwd=folder, check=True, stdout=subprocess.DEVNULL)


def compress(source, target):
    """Writes a picture with a palette: half of its bytes."""
    target.parent.mkdir(parents=True, exist_ok=True)
    picture = Image.open(source).convert("RGB")
    picture.quantize(256, Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE).save(target, optimize=True)


def draw_readme(folder):
    """Draws the README's picture, which moves: an animated PNG with one palette."""
    run("pillarfield-viewer scenes/touch/hand.toml --headless --frames 1:36 --range 0:0.2 --size 800x600 "
        "--png hand.png", folder)
    pictures = sorted(folder.glob("hand_*.png"))
    # Mail, search and print show the first frame: the fullest, which compresses least.
    fullest = pictures.index(max(pictures, key=lambda path: path.stat().st_size))
    frames = [Image.open(path).convert("RGB") for path in pictures[fullest:] + pictures[:fullest]]
    width, height = frames[0].size
    sheet = Image.new("RGB", (width, height * len(frames)))
    for index, frame in enumerate(frames):
        sheet.paste(frame, (0, index * height))
    palette = sheet.quantize(256, Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    frames = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    rate_hz = tomllib.loads((ROOT / "scenes/touch/hand.toml").read_text())["time"]["rate_hz"]
    frames[0].save(DOCS / "pictures/hand.png", save_all=True, append_images=frames[1:], loop=0, optimize=True,
                   duration=1000 / rate_hz)


def draw_tutorial(folder):
    page = (DOCS / "tutorial.md").read_text()
    for block in re.findall(r"^```sh\n(.*?)^```$", page, re.MULTILINE | re.DOTALL):
        run(block, folder)
    for picture in re.findall(r"\]\((pictures/.*?\.png)\)", page):
        compress(folder / pathlib.Path(picture).name, DOCS / picture)


def block_with(words, page):
    """The Python block of a page that has these words."""
    blocks = re.findall(r"^```python\n(.*?)^```$", (DOCS / page).read_text(), re.MULTILINE | re.DOTALL)
    (block,) = (block for block in blocks if words in block)
    return block


def draw_calibration(folder):
    """The tutorial's skin after its first and after all steps of calibration."""
    run("pillarfield solve rolled.h5 --calibration cal1.h5 -o tared.h5\n"
        "pillarfield-viewer tared.h5 after.h5 --headless --frame 20 --size 960x440 --png steps.png", folder)
    compress(folder / "steps.png", DOCS / "pictures/calibration/steps.png")


def draw_stream(folder):
    """The sensor of streams.md, as the viewer shows a recording of it."""
    stream = subprocess.Popen(["pillarfield", "stream", "udp:127.0.0.1:9870", "--seconds", "4", "--record", "spot.h5"],
                              cwd=folder)
    time.sleep(1)  # It listens before the first frame.
    sensor = subprocess.Popen([sys.executable, "-c", block_with("sendto", "streams.md")])
    stream.wait()
    sensor.kill()
    run("pillarfield-viewer spot.h5 --headless --frame 60 --size 720x480 --png spot.png", folder)
    compress(folder / "spot.png", DOCS / "pictures/streams/spot.png")


def draw_simulation():
    """The last frame of the simulation in python.md."""
    names = {"pf": pillarfield}
    exec(block_with("pf.simulate(", "python.md"), names)
    picture = DOCS / "pictures/python/spin.png"
    picture.parent.mkdir(exist_ok=True)
    picture.write_bytes(pillarfield.solve(names["simulation"])[-1].picture())


def draw_axes(folder):
    """Four pillars of formats.md under the same normal force: without shear, and with shear along and across the axes."""
    readings = [[0] * 16 for _ in range(12)]
    for row, column, shear_x, shear_y in ((0, 0, 0, 0), (0, 4, 0.2, 0), (3, 1, 0, 0.2), (4, 6, 0.15, -0.15)):
        for down, right in ((0, 0), (0, 1), (1, 0), (1, 1)):
            shear = ((2 * right - 1) * shear_x + (1 - 2 * down) * shear_y) / 2**0.5
            readings[2 * row + down][2 * column + right] = round(320 * (0.4 + shear))
    (folder / "axes.csv").write_text(",".join(str(reading) for line in readings for reading in line))
    run("pillarfield-viewer axes.csv --shape 12x16 --layout pillars --rate 1 --pitch-mm 0.632 --counts-per-newton 320 "
        "--threshold 2 --headless --size 600x400 --png axes.png", folder)
    compress(folder / "axes.png", DOCS / "pictures/formats/axes.png")


def draw_scene(scene, folder):
    picture = folder / f"{scene.stem}.png"
    options = "--headless --no-legend --no-contacts --size 480x320"
    # The most loaded frame comes before the twist.
    if scene.stem == "twist":
        options += " --frame 7"
    run(f"pillarfield-viewer {scene} {options} --png {picture}", folder)
    compress(picture, DOCS / "pictures/gallery" / picture.name)


def group_of(scene):
    if scene.parent.name == "calibration":
        return "calibration"
    return "bodies" if "[[indenter]]" in scene.read_text() else "contacts"


def entry(path):
    """The first sentence of the scene's comment, below its picture; a recording for calibration has its name alone."""
    name = f"`{path.relative_to(ROOT)}`."
    if group_of(path) == "calibration":
        return f"{name}\n"
    text = path.read_text()
    comment = " ".join(line.lstrip("# ") for line in text[: text.index("\ntitle")].splitlines() if line)
    sentence = re.match(r"[^.:;]*(?:\.(?! |$)[^.:;]*)*", comment)[0]
    return f"![{path.stem}](pictures/gallery/{path.stem}.png)\n\n" + textwrap.fill(f"{name} {sentence}.", 110) + "\n"


def write_gallery(scenes):
    groups = {name: [] for name in HEADINGS}
    for path in scenes:
        groups[group_of(path)].append(entry(path))
    lines = ["<!-- Generated by `./dev docs --pictures` from scenes/. Do not edit. -->\n\n# Gallery of scenes\n\n"
             "The scenes of `scenes/`, touches at their most loaded frame: normal force as a heat map, shear as arrows.\n"
             "`pillarfield-viewer scenes/touch/NAME.toml` shows one in motion; [scenes.md](scenes.md) describes the keys.\n"
             "Those for calibration name their experiment in their first line.\n"]
    for name, heading in HEADINGS.items():
        lines += [f"\n## {heading}\n", *("\n" + item for item in groups[name])]
    (DOCS / "gallery.md").write_text("".join(lines))


def main():
    os.environ["PATH"] = f"{pathlib.Path(sys.argv[1]).resolve()}:{os.environ['PATH']}"
    scenes = sorted((ROOT / "scenes").rglob("*.toml"), key=lambda path: path.name)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "scenes").symlink_to(ROOT / "scenes")
        draw_readme(folder)
        draw_tutorial(folder)
        draw_calibration(folder)
        draw_stream(folder)
        draw_simulation()
        draw_axes(folder)
        for scene in scenes:
            if group_of(scene) != "calibration":
                draw_scene(scene, folder)
    write_gallery(scenes)


if __name__ == "__main__":
    main()
