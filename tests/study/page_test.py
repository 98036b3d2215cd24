#!/usr/bin/python3
"""Pages to look at: what they keep of images, and, in headless Chromium where there is one, how they answer to their user."""

import base64
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import zlib
from pathlib import Path
from types import SimpleNamespace

import numpy as np

PROJECT = Path(__file__).resolve().parents[2]
TUNGSTEN = os.environ.get("TUNGSTEN", str(PROJECT / "build/bin/tungsten"))
sys.path.insert(0, str(PROJECT / "benchmarks"))

from darts_bench.film_code import encode  # noqa: E402
from darts_bench.images import read_exr  # noqa: E402
from darts_bench.page import template, trace_points, write_html  # noqa: E402

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
FRAMES, WIDTH, HEIGHT = 4, 30, 20

#: What a driver may call: a click or a drag at pixels of the picture, an event at a control, the colour of a pixel.
HELPERS = """
const at = (x, y) => {
  const canvas = document.getElementById("canvas"), box = canvas.getBoundingClientRect(), scale = box.width / canvas.width;
  return { clientX: box.left + (x + 0.5) * scale, clientY: box.top + (y + 0.5) * scale, bubbles: true };
};
Element.prototype.setPointerCapture = () => {}; // no pointer is down
const drag = (from, to) => {
  const canvas = document.getElementById("canvas");
  for (const [type, place] of [["pointerdown", from], ["pointermove", to], ["pointerup", to]])
    canvas.dispatchEvent(new PointerEvent(type, at(...place)));
};
const set = (id, value, type) => {
  document.getElementById(id).value = value;
  document.getElementById(id).dispatchEvent(new Event(type));
};
const colour = (x, y) => [...document.getElementById("canvas").getContext("2d").getImageData(x, y, 1, 1).data].slice(0, 3);
const text = (id) => document.getElementById(id).textContent;
const visible = (id) => document.getElementById(id).offsetParent !== null;
const rows = (table) => [...table.tBodies[0].rows].map((row) => row.cells[0].textContent);
"""


def drive(page, script):
    """What the script, the body of an async function, returns when it runs in the page once that is shown."""
    driver = f"""<script>{HELPERS}
      const tell = (result) => document.body.replaceChildren(Object.assign(document.createElement("pre"),
        {{ id: "told", textContent: btoa(unescape(encodeURIComponent(JSON.stringify(result)))) }}));
      ready.then(async () => {{ {script} }}).then(tell, (error) => tell({{ failure: String(error.stack) }}));</script></body>"""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "page.html"
        copy.write_text(page.read_text().replace("</body>", driver))
        dump = subprocess.run([CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={folder}/profile",
                               "--host-resolver-rules=MAP * ~NOTFOUND", "--window-size=1280,800", "--virtual-time-budget=60000",
                               "--dump-dom", copy.as_uri()], capture_output=True, text=True, timeout=200)
    told = re.search(r'id="told">([^<]*)<', dump.stdout)
    if told is None:
        raise AssertionError(f"the page did not answer: {dump.stderr[-2000:]}")
    return json.loads(base64.b64decode(told[1]))


def decoded(description, payload):
    """(values, shares of red and green, errors) as arrays (frames, height, width)."""
    d, data = description, np.frombuffer(zlib.decompress(base64.b64decode(payload)), np.uint8)
    samples = d["frames"] * d["height"] * d["width"]
    zigzag = data[:samples].astype(np.int64) + 256 * data[samples:2 * samples].astype(np.int64)
    codes = np.cumsum(np.where(zigzag % 2, -(zigzag + 1) // 2, zigzag // 2)) & 0xFFFF
    values = np.where(codes == 0, 0.0, 2.0 ** (d["top"] - (65535 - codes) * d["step"]))
    blocks = (d["frames"], -(-d["height"] // d["block"]), -(-d["width"] // d["block"]))
    planes = np.cumsum(data[2 * samples:].reshape(-1, np.prod(blocks)).astype(np.int64), axis=1) & 255
    errors = np.where(planes[-1] == 0, 0.0, 2.0 ** (d["errorTop"] - (255 - planes[-1]) * d["errorStep"])) if d["hasError"] else None
    return (values.reshape(d["frames"], d["height"], d["width"]), planes[:2].reshape(2, *blocks) / 255,
            None if errors is None else errors.reshape(blocks))


class Codes(unittest.TestCase):
    def test_images_come_back(self):
        generator = np.random.default_rng(1)
        image = generator.lognormal(0, 3, (17, 23, 3))
        image[3, 4] = 0
        error = 0.2 * image
        description, payload = encode("a", "id", image, error)
        values, shares, errors = decoded(description, payload)
        grey, lit = image.mean(axis=-1), image.mean(axis=-1) > 0
        self.assertEqual(values[0][3, 4], 0)
        self.assertLess(np.abs(np.log2(values[0][lit] / grey[lit])).max(), 0.5001 / 1024)
        self.assertLess(np.abs(np.log2(errors[0][lit] / (0.2 * grey[lit]))).max(), 0.5001 / 8)
        self.assertLess(np.abs(shares[:, 0] - image[..., :2].transpose(2, 0, 1) / np.where(lit, 3 * grey, 1))[:, lit].max(), 0.5001 / 255)

    def test_precision_gives_way(self):
        image = np.random.default_rng(2).lognormal(0, 1, (167, 201, 3))
        for budget in (150000, 60000):
            description, payload = encode("a", "id", image, 0.1 * image, budget)
            self.assertLess(len(payload) * 3 / 4, 1.05 * budget)
        self.assertGreater(description["block"], 1)
        grey = image.mean(axis=-1)
        values = decoded(description, payload)[0][0]
        self.assertLess(np.abs(np.log2(values / grey)).max(), 0.5001 * description["step"])


def write_two_methods(folder):
    """A page of a scene with reference and two methods: one 10 % too bright on its left half, one right but for its error."""
    reference = np.ones((HEIGHT, WIDTH, 3))
    bright = reference.copy()
    bright[:, :WIDTH // 2] = 1.1
    films, payloads = [], {}
    for name, image, error in (("reference", reference, None), ("bright", bright, 0.05 * bright), ("right", reference, 0.1 * reference)):
        film, payloads[f"film-{len(films)}"] = encode(name, f"film-{len(films)}", image, error)
        films.append(film)
    point = {"cpu": 1, "wall": 2, "error": 0.1, "low": 0.08, "high": 0.2}
    scene = {"name": "box", "toneMap": "linear", "quantity": "radiance", "reference": 0, "unit": 1.0, "films": films,
             "curves": {"label": "error", "curves": [{"name": "bright", "points": [point, {**point, "cpu": 4, "error": 0.05}]}]},
             "tables": [{"title": "Accuracy", "seconds": 2, "header": ["method", "MSE"],
                         "rows": [["bright", "1.5e-2"], ["right", "< 0.003"], ["none", "–"], ["best", "2×"]]}],
             "commands": {"bright": [{"label": "seed 1", "seconds": 2, "command": "tungsten <b> & 'c'"},
                                     {"label": "seed 1", "seconds": 9, "command": "another time"}]}}
    again, payloads["again"] = encode("alone", "again", reference)
    scenes = [scene, {"name": "again", "toneMap": "linear", "quantity": "radiance", "reference": None, "films": [again]}]
    data = {"title": "Two methods", "subtitle": "", "scenes": scenes, "tables": [],
            "facts": [{"name": "machine", "value": "this"}], "notes": "- **MSE**: of </script>."}
    write_html(folder / "two.html", data, payloads)
    return folder / "two.html"


@unittest.skipUnless(CHROMIUM, "there is no Chromium: apt-get install chromium")
class InTheBrowser(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.scratch.name)
        subprocess.run([TUNGSTEN, "--quiet", "-t", "2", "--resolution", f"{WIDTH}x{HEIGHT}", "-d", cls.folder, "-o", "a.png", "-e",
                        "a.npy", "--html", cls.folder / "film.html", "--trace", cls.folder / "trace", "--spp", "64",
                        "-s", str(2**64 - 1), "--set", "renderer.spp_step=4", "--set", "integrator.type=path_tracer", "--set",
                        f"integrator.frame_num={FRAMES}", "--set", "integrator.start_time=4.4",  # dark at first
                        PROJECT / "data/scenes/two-pulses/scene.json"], check=True)
        cls.film, cls.frames = cls.folder / "film.html", np.load(cls.folder / "a.npy")
        cls.two = write_two_methods(cls.folder)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def test_a_film_loads_slides_plays_and_is_picked(self):
        told = drive(self.film, """
          const told = { shown: ["loading", "time-row", "histogram", "curves"].map(visible), title: document.title, first: state.frame };
          told.values = Array.from(film(0).codes, (code) => film(0).table[code]);
          set("frame", 2, "input");
          told.frame = text("frame-text");
          drag([5, 7], [5, 7]);
          told.pixel = { title: text("pick-title"), value: document.querySelector("#pick tbody").rows[0].cells[1].textContent };
          drag([4, 3], [9, 12]);
          told.patch = { title: text("pick-title"), plot: document.querySelectorAll("#histogram canvas").length };
          document.body.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight", bubbles: true }));
          told.next = state.frame;
          const before = colour(15, 10).join();
          set("ev", state.ev - 4, "input");
          told.darker = before !== colour(15, 10).join();
          document.getElementById("play").click();
          const seen = new Set();
          for (let i = 0; i < 20; ++i) { await new Promise((done) => setTimeout(done, 50)); seen.add(state.frame); }
          document.getElementById("play").click();
          await new Promise((done) => setTimeout(done, 1000));
          return { ...told, played: seen.size, address: location.hash, tables: text("tables") };""")
        self.assertNotIn("failure", told)
        self.assertEqual(told["shown"], [False, True, True, True])
        values, grey = np.reshape(told["values"], (FRAMES, HEIGHT, WIDTH)), self.frames.mean(axis=-1)
        self.assertEqual(told["first"], np.argmax(values.sum(axis=(1, 2))), "opens at the brightest frame")
        self.assertGreater(told["first"], 0)
        self.assertLess(np.abs(values - grey).max(), 4e-4 * grey.max())
        np.testing.assert_allclose(values[grey > 0], grey[grey > 0], rtol=4e-4)
        self.assertIn(f"frame 2 of 0–{FRAMES - 1}, time", told["frame"])
        self.assertEqual(told["pixel"]["title"], "At pixel 5, 7, frame 2")
        self.assertAlmostEqual(float(told["pixel"]["value"]), grey[2, 7, 5], delta=0.006 * grey[2, 7, 5])
        self.assertEqual(told["patch"], {"title": "At patch 4–9 × 3–12 (60 pixels), frame 2", "plot": 1})
        self.assertEqual(told["next"], 3)
        self.assertTrue(told["darker"])
        self.assertEqual(told["played"], FRAMES)
        self.assertIn("pick=4,3,9,12", told["address"])
        self.assertIn(str(2**64 - 1), told["tables"])

    def test_methods_are_compared(self):
        told = drive(self.two, """
          const told = { plots: visible("curves"), time: visible("time-row"), strip: document.querySelectorAll("#strip canvas").length };
          for (const [id, value] of [["a", 1], ["b", 2], ["show", "difference"], ["layout", "split"]]) set(id, value, "change");
          set("limit", -4, "input");
          told.split = [colour(2, 5), colour(25, 5)];
          drag([15, 10], [8, 10]);
          told.divider = state.split;
          told.afterDrag = [colour(2, 5), colour(12, 5)];
          set("layout", "side", "change");
          told.side = [document.getElementById("canvas").width, colour(2, 5), colour(32, 5)];
          drag([32, 4], [32, 4]);
          told.sidePick = text("pick-title");
          set("layout", "flip", "change");
          const flips = new Set();
          for (let i = 0; i < 20; ++i) { await new Promise((done) => setTimeout(done, 100)); flips.add(colour(2, 5).join()); }
          told.flips = flips.size;
          set("show", "error", "change");
          told.scale = [text("scale-low"), text("scale-high")];
          const table = document.querySelector("#tables table"), head = table.querySelectorAll("th button")[1];
          head.click();
          told.ascending = rows(table);
          head.click();
          told.descending = rows(table);
          [...table.tBodies[0].rows].find((row) => row.cells[0].textContent === "bright").cells[1].click();
          told.commands = [document.getElementById("commands").open, text("command-list")];
          set("scene", 1, "change");
          await new Promise((done) => setTimeout(done, 100));
          return { ...told, scene: [state.scene, visible("layout-choice"), visible("curves")], notes: text("tables") };""")
        self.assertNotIn("failure", told)
        self.assertEqual((told["plots"], told["time"], told["strip"]), (True, False, 3))
        red, white = [103, 0, 31], [247, 247, 247]
        close = lambda found, colour: np.testing.assert_allclose(found, colour, atol=6)  # noqa: E731
        close(told["split"][0], red)  # a tenth too bright, beyond the end of the scale
        close(told["split"][1], white)
        self.assertAlmostEqual(told["divider"], 8.5 / WIDTH, delta=0.02)
        close(told["afterDrag"][0], red)
        close(told["afterDrag"][1], white)  # the other method's now
        self.assertEqual(told["side"][0], 2 * WIDTH)
        close(told["side"][1], red)
        close(told["side"][2], white)
        self.assertEqual(told["sidePick"], "At pixel 2, 4")
        self.assertEqual(told["flips"], 2)
        self.assertEqual(told["scale"], ["0", "6.25 % of the reference's mean"])
        self.assertEqual(told["ascending"], ["right", "bright", "best", "none"])
        self.assertEqual(told["descending"], ["best", "bright", "right", "none"])
        self.assertEqual(told["commands"][0], True)
        self.assertIn("tungsten <b> & 'c'", told["commands"][1])
        self.assertNotIn("another time", told["commands"][1])
        self.assertEqual(told["scene"], [1, False, False])
        self.assertIn("MSE: of </script>.", told["notes"])


class Renders(unittest.TestCase):
    def test_traces_become_curves(self):
        with tempfile.TemporaryDirectory() as folder:
            run, without = (SimpleNamespace(folder=Path(folder) / name) for name in ("run", "without"))
            subprocess.run([TUNGSTEN, "--quiet", "--spp", "64", "--resolution", "8x8", "-d", run.folder, "-o", "a.png", "-e", "a.exr",
                            "--trace", run.folder / "trace", "--set", "integrator.type=path_tracer", "--set", "renderer.spp_step=1",
                            PROJECT / "data/scenes/cornell-fog/scene.json"], check=True)
            error = read_exr(run.folder / "a.exr")["stderr"]
            points = trace_points([run, without], SimpleNamespace(mean=2.0))
        self.assertAlmostEqual(points[-1]["error"], np.sqrt(np.mean(error.mean(axis=-1) ** 2)) / 2, delta=1e-6)
        self.assertEqual([point["cpu"] for point in points], sorted(point["cpu"] for point in points))

    def test_both_writers_have_the_same_page(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([TUNGSTEN, "--quiet", "--spp", "1", "--resolution", "4x4", "-d", folder, "-o", "a.png", "--html",
                            Path(folder) / "a.html", "--set", "integrator.type=path_tracer",
                            PROJECT / "data/scenes/cornell-fog/scene.json"], check=True)
            page = (Path(folder) / "a.html").read_text()
        before, after = template()
        self.assertTrue(page.startswith(before + "\n<script"))
        self.assertTrue(page.endswith("</script>" + "\n" + after))
        self.assertNotRegex(before + after, r"(?:src|href)=\"?http")


if __name__ == "__main__":
    unittest.main()
