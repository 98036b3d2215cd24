#!/usr/bin/python3
"""What is left out because it cannot arrive sends nothing that arrives: random scenes whose lamps are each rendered alone, by a
renderer that leaves nothing out (`--effects all`). The renderer is named by the environment's TUNGSTEN."""

import copy
import json
import os
import random
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

from renders import render_all  # noqa: E402

TUNGSTEN = os.environ.get("TUNGSTEN", str(Path(__file__).resolve().parents[2] / "build/bin/tungsten"))
SCENES = 24
SEED = 20261123
COUNTS = {"photon_count": 3000, "volume_photon_count": 3000, "gather_radius": 0.5, "volume_gather_radius": 0.5}


def vector(generator, size=1.0):
    return [round(generator.uniform(-size, size), 3) for _ in range(3)]


def lamp(generator, name):
    kind = generator.choice(["point", "spot", "quad", "sphere", "disk"])
    position = [4 * x for x in vector(generator)]
    made = {"name": name, "type": kind, "emission_time": generator.choice([0, 0, 1.5, -1, 3]),
            "emission": 50 if kind in ("point", "spot") else 10,
            "transform": {"position": position, "scale": 0.4, "look_at": [0, 0, 0], "up": [0.1, 1, 0.2]}}
    if kind not in ("point", "spot"):
        made["bsdf"] = {"type": "lambert", "albedo": 0.5}
    return made


def surface(generator, i):
    """Walls, mirrors and panes, some of them right before the sensor."""
    bsdf = generator.choice([{"type": "lambert", "albedo": 0.8}, {"type": "mirror"}, {"type": "dielectric", "ior": 1.5},
                             {"type": "forward"}, {"type": "rough_conductor", "roughness": 0.3}])
    near = generator.random() < 0.4
    made = {"name": f"wall {i}", "type": generator.choice(["quad", "cube"]), "bsdf": bsdf,
            "transform": {"position": vector(generator, 0.3) if near else [3 * x for x in vector(generator)],
                          "scale": 0.5 if near else 3, "rotation": [180 * x for x in vector(generator)]}}
    if bsdf["type"] in ("forward", "dielectric") and made["type"] == "cube":
        made |= generator.choice([{}, {"int_medium": "fast", "ext_medium": "fog"}, {"int_medium": "fog", "ext_medium": "fog"}])
    return made


def gate(generator):
    kind = generator.choice(["gate", "gate", "frames", "response", "delta"])
    if kind == "frames":
        start = generator.choice([-1, 0.3, 1.5])  # of the delay between arrival and record
        delay = generator.choice([{}, {"temporal_response": {"type": "box", "start": start, "end": start + 0.4}}])
        return {"start_time": generator.uniform(0, 3), "transient_time_width": 0.4, "frame_num": 5} | delay
    if kind == "response":
        start = generator.uniform(0.5, 4)
        return {"temporal_response": {"times": [start, start + 0.5, start + 1, start + 9], "values": [0, 1, 0, 0]}}
    centre = generator.uniform(1, 6)
    return {"transient_time_center": centre, "transient_time_width": generator.uniform(0.2, 2), "delta_time_gate": kind == "delta"}


def random_scene(generator):
    when = gate(generator)
    kinds = ["transient_photon_map"] if when.get("delta_time_gate") else ["path_tracer", "light_tracer", "transient_photon_map"]
    integrator = {"type": generator.choice(kinds), "max_bounces": 6, "camera_unwarped": generator.random() < 0.4, **when}
    if integrator["type"] == "transient_photon_map":
        integrator |= COUNTS
    if integrator["type"] != "light_tracer":
        integrator["darts"] = generator.choice(["off", "best"])
    camera = {"type": generator.choice(["pinhole", "pinhole", "thinlens", "orthographic", "detectors"]), "resolution": [4, 4], "fov": 90,
              "medium": "fog", "transform": {"position": [0, 0, 0], "look_at": vector(generator), "up": [0.3, 1, 0.1]}}
    if camera["type"] == "thinlens":
        camera |= {"aperture_size": 0.4, "focus_distance": 2}
    if camera["type"] == "detectors":
        del camera["fov"], camera["resolution"]
        camera["detectors"] = [{"position": [3 * x for x in vector(generator)], "direction": vector(generator), "radius": 0.2}
                               for _ in range(2)]
    lamps = [lamp(generator, f"lamp {i}") | {"ext_medium": "fog"} for i in range(3)]
    if "frame_num" in when or "transient_time_center" in when and not when["delta_time_gate"]:
        for one in lamps:
            start = generator.choice([-2, 0.2, 1])
            one |= generator.choice([{}, {"pulse": {"type": "box", "start": start, "end": start + 0.5}}])
    return {"media": [{"name": "fog", "type": "homogeneous", "sigma_s": 0.3, "speed_of_light": generator.choice([0.5, 1, 1])},
                      {"name": "fast", "type": "homogeneous", "sigma_a": 0.1, "speed_of_light": 2}],
            "primitives": lamps + [surface(generator, i) for i in range(generator.randint(0, 3))],
            "camera": camera, "integrator": integrator, "renderer": {"spp": 16, "spp_step": 8}}


class LeftOut(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.file = Path(self.folder.name) / "scene.json"

    def command(self, scene, *options):
        self.file.write_text(json.dumps(scene))
        done = subprocess.run([TUNGSTEN, "--quiet", "-t", "1", *options, str(self.file)], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def effects(self, scene, *options):
        listed = json.loads(self.command(scene, "--explain=json", *options).stdout)["effects"]
        return {effect["name"]: effect for effect in listed}

    def image(self, scene, *options):
        self.command(scene, "-d", self.folder.name, "-e", "film.npz", *options)
        return np.load(Path(self.folder.name) / "film.npz")["mean"]

    def images(self, scenes, *options):
        """Of each of the scenes, by one process."""
        return [mean for mean, _ in self.films(scenes, *options)]

    def films(self, scenes, *options):
        """Images of the scenes and the effects that were on."""
        return [(mean, {effect["name"]: effect for effect in metadata["statistics"]["effects"]})
                for mean, metadata in render_all(TUNGSTEN, self.folder.name, scenes, "-t", "1", *options)]

    def means(self, scene, spp, passes, axes):
        """With what can be left out left out, and without. Of photon maps, whose noise is that of the light paths, camera samples are
        a quarter."""
        spp //= 4 if "photon_map" in scene["integrator"]["type"] else 1
        more = ("--spp", str(spp), "--set", f"renderer.spp_step={spp // passes}")
        return (self.image(scene, *more, *options).mean(axis=axes) for options in ([], ["--effects", "all"]))

    def alone(self, scene, kept):
        one = copy.deepcopy(scene)
        for primitive in one["primitives"]:
            if primitive["name"].startswith("lamp") and primitive["name"] != kept:
                primitive.pop("emission")
                if primitive["type"] in ("point", "spot"):
                    primitive["emission"] = 0
        return one

    def test_late_lamps_send_nothing(self):
        generator = random.Random(SEED)
        late, lit = 0, 0
        scenes = [random_scene(generator) for _ in range(SCENES)]
        alone = iter(self.images([self.alone(scene, f"lamp {i}") for scene in scenes for i in range(3)], "--effects", "all"))
        for number, (scene, (_, listed)) in enumerate(zip(scenes, self.films(scenes))):
            black = listed["black image"]["on"]
            out = listed["black image" if black else "late emitters left out"]["causes"]
            for i in range(3):
                left = f"primitives[{i}]" in out
                light = float(np.abs(next(alone)).max())
                if left:
                    self.assertEqual(light, 0, f"scene {number}, lamp {i}: {json.dumps(scene)}")
                late, lit = late + left, lit + (light > 0)
        self.assertGreater(late, SCENES // 4)
        self.assertGreater(lit, SCENES // 2)

    def scene(self, **integrator):
        generator = random.Random(3)
        scene = random_scene(generator)
        scene["primitives"] = [{"name": "lamp 0", "type": "point", "emission": 9, "transform": {"position": [0, 1, 1]}, "ext_medium": "fog"},
                               {"name": "lamp 1", "type": "point", "emission": 9, "transform": {"position": [0, 1, 9]}, "ext_medium": "fog"},
                               {"name": "floor", "type": "quad", "transform": {"position": [0, -1, 0], "scale": 9}}]
        scene["camera"] = {"type": "pinhole", "resolution": [4, 4], "fov": 90, "medium": "fog",
                           "transform": {"position": [0, 0, 0], "look_at": [0, 0, 1], "up": [0, 1, 0]}}
        scene["media"][0]["speed_of_light"] = 1
        scene["integrator"] = {"type": "path_tracer", "max_bounces": 5, "transient_time_center": 4, "transient_time_width": 2} | integrator
        return scene

    def test_all_shows_the_same(self):
        """Within errors where a lamp is left out; bit for bit where none is."""
        for kind in ({}, {"type": "light_tracer"}, {"darts": {"plain_share": 0}}, {"type": "transient_photon_map", **COUNTS}):
            scene = self.scene(**kind)
            self.assertEqual(self.effects(scene)["late emitters left out"]["causes"], ["primitives[1]"])
            self.assertFalse(self.effects(scene, "--effects", "all")["late emitters left out"]["on"])
            few, every = self.means(scene, 2048, 32, (0, 1, 2))
            np.testing.assert_allclose(few, every, rtol=0.06)
            del scene["primitives"][1]
            if "photon_map" not in scene["integrator"]["type"]:
                np.testing.assert_array_equal(self.image(scene), self.image(scene, "--effects", "all"))

    def test_the_highest_speed_counts(self):
        scene = self.scene()  # the second lamp is 9.06 away, the sensor closes at 5
        scene["media"][0]["speed_of_light"] = 2
        self.assertFalse(self.effects(scene)["late emitters left out"]["on"])

    def test_what_a_late_lamp_lights_is_in_time_without_the_cameras_time(self):
        self.assertTrue(self.effects(self.scene())["late emitters left out"]["on"])
        self.assertFalse(self.effects(self.scene(camera_unwarped=True))["late emitters left out"]["on"])

    def test_a_lens_is_nearer_than_its_middle(self):
        scene = self.scene()
        scene["primitives"][1]["transform"]["position"] = [0, 0, 5.1]  # the sensor closes at 5
        self.assertTrue(self.effects(scene)["late emitters left out"]["on"])
        scene["camera"] |= {"type": "thinlens", "aperture_size": 0.4, "focus_distance": 2}
        self.assertFalse(self.effects(scene)["late emitters left out"]["on"])

    def test_a_black_image_is_there_at_once_and_says_why(self):
        scene = self.scene(transient_time_center=0.4, transient_time_width=0.4)
        scene["renderer"]["spp"] = 10 ** 9
        done = self.command(scene, "-d", self.folder.name, "-e", "film.npz", "--stats", str(self.file.with_name("stats.json")))
        self.assertIn("the image is black: no light can arrive: the sensor closes at 0.6, light of 'lamp 0' not before 1.414", done.stderr)
        self.assertIn("'lamp 1' not before 9.05", done.stderr)
        self.assertEqual(float(np.abs(np.load(Path(self.folder.name) / "film.npz")["mean"]).max()), 0)
        statistics = json.loads(self.file.with_name("stats.json").read_text())
        self.assertEqual(statistics["counters"].get("rays", 0), 0)
        self.assertLess(statistics["render wall seconds"], 1)

    def test_parallel_rays_and_detectors_have_a_way_of_their_own(self):
        """The lamps are 1 and 9 before the plane of the rays; the sensor closes at 5."""
        scene = self.scene()
        del scene["camera"]["fov"]
        scene["camera"] |= {"type": "orthographic", "orthographic_size": 2}
        self.assertEqual(self.effects(scene)["late emitters left out"]["causes"], ["primitives[1]"])
        scene["primitives"][1]["transform"]["position"] = [90, 0, 4.9]
        self.assertFalse(self.effects(scene)["late emitters left out"]["on"], "rays start all over the plane")
        scene["camera"] = {"type": "detectors", "medium": "fog", "detectors": [
            {"position": [0, 0, 0], "direction": [0, 0, 1], "radius": 0.2}, {"position": [90, 0, 0], "direction": [0, 0, 1], "radius": 0.2}]}
        self.assertFalse(self.effects(scene)["late emitters left out"]["on"], "one of them is near")
        scene["primitives"][1]["transform"]["position"] = [45, 0, 0]
        self.assertEqual(self.effects(scene)["late emitters left out"]["causes"], ["primitives[1]"])

    def test_gates_that_leave_the_cameras_way_out_are_told(self):
        """As those of Liu et al. do. With it some light may arrive; where the pulse itself is late, none does either way."""
        scene = self.scene(transient_time_center=0.4, transient_time_width=0.4)
        self.assertIn('"camera_unwarped": true', self.command(scene, "--explain").stderr)
        self.assertEqual(self.command(scene, "--explain", "--set", "integrator.camera_unwarped=true").stderr, "")
        for lamp in scene["primitives"][:2]:
            lamp["emission_time"] = 7
        said = self.command(scene, "--explain").stderr
        self.assertIn("the image is black: no light can arrive", said)
        self.assertNotIn("camera_unwarped", said)

    def test_whatever_else_leaves_an_image_black_is_told_when_it_is_there(self):
        """A gate after the last light; no number of bounces; nothing but lights that are not seen."""
        def said(**fields):
            scene = self.scene(**fields)
            scene["media"][0]["sigma_s"] = 0
            return self.command(scene, "-d", self.folder.name).stderr
        self.assertEqual(said(), "")
        late = said(transient_time_center=4000)
        for part in ("integrator: the image is black: no path found light", "gate", "camera_unwarped"):
            self.assertIn(part, late)
        self.assertNotIn("camera_unwarped", said(transient_time_center=4000, camera_unwarped=True))
        self.assertIn("no number of interactions", said(min_bounces=5, max_bounces=5))
        steady = said(transient_time_center=-1, transient_time_width=0, max_bounces=1)  # of points, which are not seen themselves
        self.assertIn("the image is black", steady)
        self.assertNotIn("gate", steady)

    def counters(self, scene, *options):
        statistics = self.file.with_name("stats.json")
        self.command(scene, "-d", self.folder.name, "--stats", str(statistics), *options)
        return json.loads(statistics.read_text())["counters"]

    def clouds(self, generator, **integrator):
        """Boxes of two kinds of fog at random places, seen from empty space."""
        scene = self.scene(**integrator)
        scene["camera"].pop("medium")
        scene["media"] = [{"name": "near", "type": "homogeneous", "sigma_s": 0.5, "sigma_a": 0.1},
                          {"name": "far", "type": "homogeneous", "sigma_s": 0.8, "speed_of_light": generator.choice([0.5, 1, 2])}]
        scene["primitives"].pop(1)
        scene["primitives"][0].pop("ext_medium")
        for name in ("near", "far"):
            scene["primitives"].append({"type": "cube", "bsdf": {"type": "forward"}, "int_medium": name, "transform": {
                "position": [3 * x for x in vector(generator)], "scale": 0.8, "rotation": [90 * x for x in vector(generator)]}})
        scene["integrator"] |= {"transient_time_center": generator.uniform(2, 7), "transient_time_width": 1}
        return scene

    def test_media_out_of_time_show_nothing(self):
        """What a medium does that is left out changes no bit, in time."""
        generator, left = random.Random(SEED), []
        scenes = [self.clouds(generator, camera_unwarped=number % 4 == 0) for number in range(24)]
        for number, (scene, (image, listed)) in enumerate(zip(scenes, self.films(scenes))):
            reason = listed["media in time"]["reason"]
            for i, name in enumerate(("near", "far")):
                if f"'{name}' not before" not in reason:
                    continue
                other = copy.deepcopy(scene)
                other["media"][i] |= {"sigma_s": 3, "sigma_a": 1}
                left.append((number, image, scene, other))
        self.assertGreater(len(left), 4)
        every = self.images([one for *_, scene, other in left for one in (scene, other)], "--effects", "all")
        for (number, image, *_), image_of_all, image_of_other in zip(left, every[::2], every[1::2]):
            np.testing.assert_array_equal(image_of_all, image_of_other, str(number))
            np.testing.assert_array_equal(image, image_of_all, str(number))

    def test_media_out_of_time_take_no_tables_and_no_photons(self):
        for darts in ({"preset": "best", "direction": "eda"}, "off"):
            for kind in ({"darts": darts}, {"type": "transient_photon_map", "darts": darts, **COUNTS}):
                scene = self.scene(transient_time_center=1.8, transient_time_width=0.4, **kind)
                scene["media"].append({"name": "far", "type": "homogeneous", "sigma_s": 2})
                scene["primitives"].append({"type": "cube", "bsdf": {"type": "forward"}, "int_medium": "far", "ext_medium": "fog",
                                            "transform": {"position": [0, 0, -4], "scale": 2}})
                some, every = (self.counters(scene, *options) for options in ([], ["--effects", "all"]))
                self.assertEqual(some.get("direction tables"), None if darts == "off" else 1)
                self.assertEqual(every.get("direction tables"), None if darts == "off" else 2)
                few, all_ = self.means(scene, 1024, 16, (0, 1, 2))
                np.testing.assert_allclose(few, all_, rtol=0.085)
                # Now that is the only fog.
                scene["media"] = scene["media"][2:]
                scene["camera"].pop("medium")
                for primitive in scene["primitives"]:
                    primitive.pop("ext_medium", None)
                some = self.counters(scene)
                self.assertEqual([some.get(name, 0) for name in ("direction tables", "control vertices", "stored volume photons")], [0] * 3)

    def test_light_paths_aim_at_no_dark_frame(self):
        frames = {"start_time": 0, "transient_time_width": 0.5, "frame_num": 12}
        scene = self.scene(type="transient_photon_map", darts={"preset": "best", "single_frames": True}, **frames, **COUNTS)
        for name in ("transient_time_center", "delta_time_gate"):
            scene["integrator"].pop(name, None)
        scene["primitives"].pop(1)
        self.assertIn("the first 2 frames", self.effects(scene)["frames before all light"]["reason"])
        self.assertEqual(self.counters(scene)["frames aimed at"], 10)
        self.assertEqual(self.counters(scene, "--effects", "all")["frames aimed at"], 12)
        few, every = self.means(scene, 1024, 16, (1, 2, 3))
        self.assertEqual(float(few[:2].max()), 0)
        np.testing.assert_allclose(few[:7], every[:7], rtol=0.11)  # later ones are noisier
        np.testing.assert_allclose(few.sum(), every.sum(), rtol=0.055)

    def test_surfaces_out_of_time_store_nothing(self):
        scene = self.scene(type="transient_photon_map", transient_time_center=1.6, transient_time_width=0.2, darts="best", **COUNTS)
        scene["primitives"][2]["transform"]["position"] = [0, -3, 0]
        self.assertFalse(self.effects(scene)["surfaces in time"]["on"])
        self.assertTrue(self.effects(scene, "--effects", "all")["surfaces in time"]["on"])
        few, every = self.means(scene, 512, 32, (0, 1, 2))
        np.testing.assert_allclose(few, every, rtol=0.06)
        scene["media"][0]["speed_of_light"] = 2  # the floor's light needs 3 / 2, and the sensor closes at 1.7
        self.assertTrue(self.effects(scene)["surfaces in time"]["on"])


if __name__ == "__main__":
    unittest.main()
