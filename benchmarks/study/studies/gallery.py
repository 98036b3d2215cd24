"""Pictures of the scenes that ship: docs/gallery.md and its pictures."""

from PIL import Image

from darts_bench.program import Bench, Scene
from darts_bench.run import PROJECT

TITLE = "Gallery"
# Passes (10 to 30 CPU seconds each), and what is seen.
SCENES = {
    "cornell-fog": (40, "The front of a pulse on the walls and the floor of a foggy box and on two blocks, the taller one just being passed."),
    "mirror-fog": (15, "A mirror at the end of a room shows the fog around the corner, lit by a warm pulse that the camera cannot see."),
    "two-pulses": (15, "The shells of two pulses in fog over a floor, the blue one later: every third of 20 frames."),
    "pulse-shapes": (48, "Light that takes its time: a flash as wide as the sensor's response, a lamp that decays and one that shines evenly for a while: every third of 20 frames."),
    "two-peaks": (200, "A sensor that is sensitive at two short times: the glow of both in one picture."),
    "glass-tank": (12, "Milky water behind refracting walls, lit by a pulse inside."),
    "fogged-box": (80, "The shell of a pulse that has scattered once, cut by walls and blocks, and in it what has scattered more often."),
    "laser-in-fog": (300, "Nothing but fog and a beam of light in it, whose head is the bright point, and the ball that what scattered has reached."),
    "amber-half-space": (120, "Three beams, one after the other, into a medium that absorbs blue: the older the redder."),
    "volumetric-caustic": (100, "A glass ball in fog delays the front of a pulse, turns it inside out and gathers it."),
}


def strip(folder, frames):
    """Frames in rows of four."""
    images = [Image.open(folder / f"image_{frame:02}.png").convert("RGB") for frame in frames]
    width, height = (side // 2 for side in images[0].size)
    sheet = Image.new("RGB", (4 * width, -(-len(images) // 4) * height))
    for i, image in enumerate(images):
        sheet.paste(image.resize((width, height), Image.Resampling.LANCZOS), (i % 4 * width, i // 4 * height))
    return sheet


def run(bench: Bench):
    page = (bench.work if bench.quick else PROJECT / "docs") / f"{bench.name}.md"
    folder = page.parent / "gallery"
    folder.mkdir(parents=True, exist_ok=True)
    text = ["# Gallery", "The scenes of `data/scenes`, each with the command that makes its picture in 10 to 30 seconds of one "
            "core (`--spp` the number of passes). `benchmarks/bench.py study gallery` makes this page."]
    for name, (passes, line) in SCENES.items():
        scene = Scene.own(name, 0)
        passes = bench.short(passes, 1)
        made = bench.plain(scene, passes)
        frames = sorted(made.glob("image_*.png"), key=lambda file: int(file.stem.split("_")[1]))
        picture = strip(made, range(0, len(frames), 3)[:8]) if frames else Image.open(made / "image.png").convert("RGB")
        picture.save(folder / f"{name}.jpg", quality=88)
        command = f"build/bin/tungsten -s 1 --spp {passes} -o {name}.png -e {name}.exr {scene.file.relative_to(PROJECT)}"
        text += [f"## {name}", line, f"![{name}](gallery/{name}.jpg)", f"```sh\n{command}\n```"]
    page.write_text("\n\n".join(text) + "\n")
    print(page)
